//! Which plan is being executed, and where it wants everything at a given time.

use curves::Sample;
use messages::record::{Field, Visit};
use messages::{EventCode, GaitState, LEFT, Plan};

/// The active plan and the one that follows it.
pub struct PlanFollower {
    active: Plan,
    next: Plan,
}

/// Desired task space at one instant, in the planning frame of the active plan (thesis table 4.2).
#[derive(Clone, Copy, Debug)]
pub struct Desired {
    /// \[m\] Centre of gravity.
    pub com: Sample<3>,
    /// \[rad\] phi_x, phi_y, alpha.
    pub torso: Sample<3>,
    /// \[m, rad\] Sole frames: x, y, z, heading; right, left.
    pub feet: [Sample<4>; 2],
    /// \[rad\] Toe joints; right, left.
    pub toes: [Sample<1>; 2],
    /// \[m\] Zero-moment point.
    pub zmp: [f64; 2],
    /// \[1\] Load factors; right, left.
    pub load: [f64; 2],
}

impl PlanFollower {
    /// No plan yet.
    pub fn new() -> Self {
        Self { active: Plan::default(), next: Plan::default() }
    }

    /// Id of the plan being executed; 0 before the first one.
    pub fn id(&self) -> u64 {
        self.active.id
    }

    /// The plan being executed.
    pub fn plan(&self) -> &Plan {
        &self.active
    }

    /// Takes note of the newest plan and switches to the next one in its start cycle, not before and not after.
    pub fn update(&mut self, tick: u64, newest: Option<&Plan>) -> Option<(EventCode, u64)> {
        let mut event = None;
        if let Some(plan) = newest.filter(|p| p.id > self.active.id.max(self.next.id)) {
            if plan.start_tick >= tick && is_finite(plan) {
                self.next = *plan;
            } else {
                self.next.id = plan.id; // looked at once
                self.next.start_tick = u64::MAX;
                event = Some((EventCode::PlanRefused, plan.id));
            }
        }
        if self.next.id > self.active.id && self.next.start_tick <= tick {
            self.active = self.next;
            event = Some((EventCode::PlanActive, self.active.id));
        }
        event
    }

    /// Time since the start of the active plan \[s\].
    pub fn time(&self, tick: u64, dt: f64) -> f64 {
        tick.saturating_sub(self.active.start_tick) as f64 * dt
    }

    /// What the gait is doing at plan time `t` \[s\].
    pub fn gait(&self, t: f64) -> GaitState {
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
    pub fn sample(&self, t: f64) -> Desired {
        let p = &self.active;
        let left = p.load_left.sample(t).position[0].clamp(0.0, 1.0);
        let mut load = [1.0 - left; 2];
        load[LEFT] = left;
        Desired {
            com: p.com.sample(t),
            torso: p.torso.sample(t),
            feet: [p.feet[0].sample(t), p.feet[1].sample(t)],
            toes: [p.toes[0].sample(t), p.toes[1].sample(t)],
            zmp: p.zmp.sample(t).0,
            load,
        }
    }
}

impl Default for PlanFollower {
    fn default() -> Self {
        Self::new()
    }
}

/// Whether every number of a plan is finite.
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

    #[test]
    fn switches_exactly_at_the_start_cycle() {
        let mut f = PlanFollower::new();
        assert_eq!(f.update(5, Some(&plan(1, 10))), None);
        assert_eq!(f.id(), 0);
        assert_eq!(f.update(9, None), None);
        assert_eq!(f.update(10, None), Some((EventCode::PlanActive, 1)));
        assert_eq!(f.time(12, 1e-3), 2e-3);
    }

    #[test]
    fn a_plan_that_begins_in_the_past_is_refused_once() {
        let mut f = PlanFollower::new();
        f.update(10, Some(&plan(1, 10)));
        assert_eq!(f.update(20, Some(&plan(2, 19))), Some((EventCode::PlanRefused, 2)));
        assert_eq!(f.update(21, Some(&plan(2, 19))), None);
        assert_eq!(f.id(), 1);
        assert_eq!(f.update(22, Some(&plan(3, 22))), Some((EventCode::PlanActive, 3)));
    }

    #[test]
    fn a_plan_with_a_nan_anywhere_is_refused() {
        let mut f = PlanFollower::new();
        let mut bad = plan(1, 10);
        bad.com.coefficients[95][2][5] = f64::NAN;
        assert_eq!(f.update(10, Some(&bad)), Some((EventCode::PlanRefused, 1)));
    }

    #[test]
    fn nan_load_factors_never_reach_the_controller() {
        assert!(!f64::NAN.clamp(0.0, 1.0).is_finite(), "clamp lets NaN through: plans are checked before");
    }
}
