//! Plan follower: the active plan, the one that is due next, and the desired task space at a given time.

use curves::Sample;
use messages::record::{Field, Visit};
use messages::{Detail, EventCode, EventQueue, GaitState, LEFT, Plan};

/// The active plan and the one that follows it.
#[derive(Clone)]
pub(crate) struct PlanFollower {
    active: Plan,
    next: Plan,
    /// Tick up to which plans are void, whoever made them: the supply was off.
    void: Option<u64>,
    /// \[m\] Rear and front edge of each sole in its frame.
    edges: [[f64; 2]; 2],
    /// \[m\] @I_0 Planned heights of the soles at the end of the last cycle.
    sole_height: [f64; 2],
    /// Pose at the end of the last cycle.
    last: Option<Desired>,
}

/// Desired task space at one instant, in the planning frame of the active plan (thesis table 4.2).
#[derive(Clone, Copy, Debug)]
pub struct Desired {
    /// \[m\] The point of the body that the plan leads: [`messages::BodyPoint`].
    pub body: Sample<3>,
    /// \[rad\] phi_x, phi_y, alpha.
    pub torso: Sample<3>,
    /// \[m, rad\] Sole frames: x, y, z, heading; right, left.
    pub feet: [Sample<4>; 2],
    /// \[rad\] Pitch of the soles; right, left.
    pub pitch: [Sample<1>; 2],
    /// \[rad\] Toe joints; right, left.
    pub toes: [Sample<1>; 2],
    /// \[m\] Zero-moment point at height 0: there the force line of the planned one passes.
    pub zmp: [f64; 2],
    /// \[1\] Load factors; right, left.
    pub load: [f64; 2],
}

impl PlanFollower {
    /// No plan yet; `edges` \[m\] are the rear and the front edge of each sole in its frame.
    pub(crate) fn new(edges: [[f64; 2]; 2]) -> Self {
        Self {
            active: Plan::default(),
            next: Plan::default(),
            void: None,
            edges,
            sole_height: [0.0; 2],
            last: None,
        }
    }

    /// Id of the plan being executed; 0 before the first one.
    pub(crate) fn id(&self) -> u64 {
        self.active.id
    }

    /// The plan being executed.
    pub(crate) fn plan(&self) -> &Plan {
        &self.active
    }

    /// The plan to come, if there is one.
    pub(crate) fn next(&self) -> Option<&Plan> {
        Some(&self.next).filter(|next| next.id > self.active.id && next.start_tick != u64::MAX)
    }

    /// Refuses the plan to come; the active one goes on.
    pub(crate) fn refuse_next(&mut self, events: &mut EventQueue) {
        self.next.start_tick = u64::MAX;
        events.push(EventCode::PlanRefused, Detail::Plan(self.next.id));
    }

    /// Drops all plans, those made up to this tick that are still to come among them: without power nobody follows one.
    pub(crate) fn drop_all(&mut self, tick: u64) {
        // Ids go on rising: what was dropped is not looked at again.
        self.next.id = self.next.id.max(self.active.id);
        self.next.start_tick = u64::MAX;
        self.active = Plan::default();
        self.void = Some(tick);
    }

    /// Takes note of the newest plan and switches to the next one in its start cycle, not before and not after.
    pub(crate) fn update(&mut self, tick: u64, newest: Option<&Plan>, events: &mut EventQueue) {
        let valid = |p: &&Plan| self.void.is_none_or(|void| p.header.tick > void);
        if let Some(plan) = newest.filter(valid).filter(|p| p.id > self.active.id.max(self.next.id)) {
            if plan.start_tick >= tick && is_finite(plan) {
                self.next = *plan;
            } else {
                self.next.id = plan.id; // looked at once
                self.refuse_next(events);
            }
        }
        if self.next.id > self.active.id && self.next.start_tick <= tick {
            self.active = self.next;
            events.push(EventCode::PlanActive, Detail::Plan(self.active.id));
        }
    }

    /// \[m\] Steps in the planned heights of the soles where the plan has changed since the one that was reported last:
    /// a plan that goes on from a sensed contact has its foot where the ground is, not where the plan before wanted it.
    pub(crate) fn height_steps(&mut self, reported: u64, now: &Desired, end: &Desired) -> [Option<f64>; 2] {
        let height = self.active.height;
        let switched = reported > 0 && reported != self.active.id && self.active.measured == 0;
        [0, 1].map(|foot| {
            let step = self.sole_height[foot] - (height + now.feet[foot].position[2]);
            self.sole_height[foot] = height + end.feet[foot].position[2];
            (switched && step.abs() > 1e-4).then_some(step)
        })
    }

    /// Notes the pose at the `end` of this cycle. The one before, if the plan has changed since the one that was reported
    /// last, and begins at the measured pose.
    pub(crate) fn measured_switch(&mut self, reported: u64, end: &Desired) -> Option<Desired> {
        let switched = reported > 0 && reported != self.active.id && self.active.measured == 1;
        self.last.replace(*end).filter(|_| switched)
    }

    /// Time since the start of the active plan \[s\].
    pub(crate) fn time(&self, tick: u64, dt: f64) -> f64 {
        tick.saturating_sub(self.active.start_tick) as f64 * dt
    }

    /// Gait state at plan time `t` \[s\].
    pub(crate) fn gait(&self, t: f64) -> GaitState {
        match GaitState::from(self.active.state) {
            GaitState::Idle => GaitState::Idle,
            _ if t >= self.active.end() => GaitState::Standing,
            state if self.active.steps[0].end <= t && self.active.step_count > 1 => match state {
                GaitState::Starting => GaitState::Walking,
                other => other,
            },
            state => state,
        }
    }

    /// The active plan at plan time `t` \[s\].
    pub(crate) fn sample(&self, t: f64) -> Desired {
        let p = &self.active;
        let left = p.load_left.sample(t).position[0].clamp(0.0, 1.0);
        let mut load = [1.0 - left; 2];
        load[LEFT] = left;
        let (body, zmp) = (p.body.sample(t), p.zmp.sample(t).0);
        let fall = p.zmp_height.sample(t).0[0] / (body.acceleration[2] - multibody::GRAVITY.z);
        let soles = [0, 1].map(|foot| p.sole(foot, t, self.edges[foot]));
        Desired {
            body,
            torso: p.torso.sample(t),
            feet: soles.map(|(sole, _)| sole),
            pitch: soles.map(|(_, pitch)| pitch),
            toes: [p.toes[0].sample(t), p.toes[1].sample(t)],
            zmp: [0, 1].map(|d| zmp[d] - fall * body.acceleration[d]),
            load,
        }
    }
}

/// `true` if every number of a plan is finite.
fn is_finite(plan: &Plan) -> bool {
    struct Finite(bool);
    impl Visit for Finite {
        fn f64(&mut self, value: f64) {
            self.0 &= value.is_finite();
        }
        fn u64(&mut self, _: u64) {}
        fn u32(&mut self, _: u32) {}
        fn u8(&mut self, _: u8) {}
    }
    let mut all = Finite(true);
    plan.visit(&mut all);
    all.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(id: u64, start_tick: u64) -> Plan {
        Plan { id, start_tick, state: GaitState::Standing as u64, ..Plan::default() }
    }

    /// The one event of an update, if any.
    fn update(f: &mut PlanFollower, tick: u64, newest: Option<&Plan>) -> Option<(EventCode, Detail)> {
        let mut events = EventQueue::default();
        f.update(tick, newest, &mut events);
        let first = events.pop();
        assert_eq!(events.pop(), None);
        first
    }

    #[test]
    fn switches_exactly_at_the_start_cycle() {
        let mut f = PlanFollower::new([[-0.1, 0.1]; 2]);
        assert_eq!(update(&mut f, 5, Some(&plan(1, 10))), None);
        assert_eq!(f.id(), 0);
        assert_eq!(update(&mut f, 9, None), None);
        assert_eq!(update(&mut f, 10, None), Some((EventCode::PlanActive, Detail::Plan(1))));
        assert_eq!(f.time(12, 1e-3), 2e-3);
    }

    #[test]
    fn a_plan_that_begins_in_the_past_is_refused_once() {
        let mut f = PlanFollower::new([[-0.1, 0.1]; 2]);
        update(&mut f, 10, Some(&plan(1, 10)));
        assert_eq!(update(&mut f, 20, Some(&plan(2, 19))), Some((EventCode::PlanRefused, Detail::Plan(2))));
        assert_eq!(update(&mut f, 21, Some(&plan(2, 19))), None);
        assert_eq!(f.id(), 1);
        assert_eq!(update(&mut f, 22, Some(&plan(3, 22))), Some((EventCode::PlanActive, Detail::Plan(3))));
    }

    /// Neither the one that was followed, nor the one to come, nor one that was under way while the supply went off.
    #[test]
    fn no_plan_outlives_the_supply() {
        let mut f = PlanFollower::new([[-0.1, 0.1]; 2]);
        let made = |id: u64, tick: u64| {
            let mut plan = plan(id, tick + 10);
            plan.header.tick = tick;
            plan
        };
        update(&mut f, 10, Some(&made(1, 0)));
        update(&mut f, 15, Some(&made(2, 15)));
        f.drop_all(20);
        assert_eq!(f.id(), 0);
        assert_eq!(update(&mut f, 21, Some(&made(2, 15))), None);
        assert_eq!(update(&mut f, 22, Some(&made(3, 19))), None);
        assert_eq!((update(&mut f, 29, None), f.id()), (None, 0));
        assert_eq!(update(&mut f, 32, Some(&made(4, 22))), Some((EventCode::PlanActive, Detail::Plan(4))));
    }

    #[test]
    fn a_plan_with_a_nan_anywhere_is_refused() {
        let mut f = PlanFollower::new([[-0.1, 0.1]; 2]);
        let mut bad = plan(1, 10);
        bad.body.coefficients[95][2][5] = f64::NAN;
        assert_eq!(update(&mut f, 10, Some(&bad)), Some((EventCode::PlanRefused, Detail::Plan(1))));
    }

    #[test]
    fn nan_load_factors_never_reach_the_controller() {
        assert!(!f64::NAN.clamp(0.0, 1.0).is_finite(), "clamp lets NaN through: plans are checked before");
    }
}
