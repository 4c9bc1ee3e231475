//! Reaction to pushes: in single support, a plan from where the robot is, whose foot lands where it catches the body
//! ([`crate::step_adaptation`]). Where the stabilizer alone can make good for an error, nothing happens.

use crate::commands::Intent;
use crate::footsteps::StepDemand;
use crate::gait::{LEAD_MIN, Planner};
use crate::origin::PlanOrigin;
use crate::pose::PlanarPose;
use crate::skills::{Script, Skill};
use crate::sole::Sole;
use crate::step_adaptation::{self, Divergence, Landing};
use crate::steps::{ROUNDING, StepParameters};
use crate::verdict::PlanVerdict;
use messages::{ControllerState, Detail, EventCode, GaitState};
use multibody::GRAVITY_ACCELERATION as GRAVITY;

/// \[s\] So long must a step be needed before it is changed: a bent frame on the bus jolts the body for 20 ms.
const PERSISTS: f64 = 0.03;
/// \[rad\] A robot that leans farther is not caught by a step.
const LOST: f64 = 0.35;

impl Planner {
    /// Plans on from inside the present step, if the body has to be caught; `true` if there is such a plan.
    pub(crate) fn react(&mut self, tick: u64, state: &ControllerState, gait: GaitState) -> bool {
        let start = tick + LEAD_MIN;
        let cycle_s = self.builder.model.cycle_s;
        let needed = self.catch(start, state, gait);
        let Some((k, zmp, landing)) = needed else {
            self.calm = tick;
            return false;
        };
        if tick.saturating_sub(self.calm) as f64 * cycle_s < PERSISTS {
            return false;
        }
        self.calm = tick;
        // From where she will be when the plan begins.
        let t = (start - self.active.plan.start_tick) as f64 * cycle_s;
        let ahead = (start - state.header.tick) as f64 * cycle_s;
        let cycles = self.builder.model.cycles(landing.rest);
        let from =
            PlanOrigin::inside(&self.active, (k, t), (state, zmp, ahead), &landing.pose, (cycles, cycle_s));
        let to = if self.intent == Intent::Walk { GaitState::Walking } else { GaitState::Stopping };
        if !self.walk_on(&from, to, landing.catches) {
            return false;
        }
        let sound = landing.catches && self.next.verdict == PlanVerdict::Sound;
        let code = if sound { EventCode::StepAdapted } else { EventCode::StepStretched };
        self.events.push(code, Detail::Plan(self.last_id + 1));
        self.publish(start, tick)
    }

    /// Step of the active plan that runs at the tick `start`, the zero-moment point, and the landing that it needs instead of
    /// its own.
    fn catch(
        &self,
        start: u64,
        state: &ControllerState,
        gait: GaitState,
    ) -> Option<(usize, [f64; 2], Landing)> {
        let rules = self.gait.reaction.as_ref()?;
        let walks = matches!(gait, GaitState::Starting | GaitState::Walking | GaitState::Stopping);
        let (walk, model) = (&self.active, &self.builder.model);
        let known = state.plan_id == walk.plan.id && start > walk.plan.start_tick && self.next.plan.id == 0;
        // A skill knows its steps, and knows of heights that others do not.
        if !walks || !known || self.tasks.active != Skill::Walk {
            return None;
        }
        let t = (start - walk.plan.start_tick) as f64 * model.cycle_s;
        let k = walk.steps().iter().position(|s| t < s.end)?;
        let s = &walk.strides[k];
        // Ground that was felt to be higher or lower goes on as it is; what is known to lie there may not.
        let level = (s.heights.landing - s.heights.foothold).abs() < ROUNDING && !s.is_high(&model.step);
        let level = level || self.builder.footsteps.sees_nothing();
        let lean = state.inclination_error;
        if t < s.lift || !level || !lean.iter().all(|x| x.abs() < LOST) {
            return None;
        }
        let foot = state.feet[1 - s.stance];
        let sole = &model.soles[s.stance];
        let zmp = zmp_in_sole(state, &s.foothold, sole);
        let body = divergence(state, zmp, s.heights.foothold, start, model.cycle_s)?;
        let landing = step_adaptation::adapt(rules, walk, (k, t), &body, [foot[0], foot[1]], sole)?;
        Some((k, zmp, landing))
    }

    /// The plan from there: as commanded or, if that leaves the support or one step is not enough, with steps on the spot.
    /// Of two that leave it, the one that leaves it less. `false`: there is none at all.
    fn walk_on(&mut self, from: &PlanOrigin, state: GaitState, catches: bool) -> bool {
        let rest = StepParameters::on_the_spot(self.parameters.duration);
        let wishes = [self.parameters, rest];
        let mut demand =
            StepDemand { from, state, wish: wishes[0], share: 1.0, skill: Skill::Walk, script: Script::NONE };
        let mut margins = [f64::NEG_INFINITY; 2];
        for (wish, margin) in wishes.into_iter().zip(&mut margins).skip(usize::from(!catches)) {
            demand.wish = wish;
            self.builder.walk(&demand, &mut self.next);
            if self.next.verdict == PlanVerdict::Sound {
                return true;
            }
            *margin = self.next.margin;
        }
        if margins[0] > margins[1] {
            demand.wish = wishes[0];
            self.builder.walk(&demand, &mut self.next);
        }
        use PlanVerdict::{LeavesSupport, OverloadsSole, Slips, Sound};
        matches!(self.next.verdict, Sound | LeavesSupport | OverloadsSole | Slips)
    }
}

/// \[m\] Measured zero-moment point, or the nearest place in the sole at `foothold`: that of a foot which bounces, and does not
/// press for a cycle, is metres away. The desired one without a measurement.
fn zmp_in_sole(state: &ControllerState, foothold: &PlanarPose, sole: &Sole) -> [f64; 2] {
    if !state.zmp.iter().all(|x| x.is_finite()) {
        return state.zmp_desired;
    }
    let p = foothold.local(state.zmp);
    foothold.point([0, 1].map(|d| p[d].clamp(sole.center[d] - sole.half[d], sole.center[d] + sole.half[d])))
}

/// Divergent component at the tick `start`, the zero-moment point staying at `zmp`; none without a measurement.
fn divergence(
    state: &ControllerState,
    zmp: [f64; 2],
    ground: f64,
    start: u64,
    cycle_s: f64,
) -> Option<Divergence> {
    let w = (GRAVITY / (state.com[2] - ground)).sqrt();
    let growth = w * (start - state.header.tick) as f64 * cycle_s;
    let error = [0, 1].map(|d| {
        let shift = zmp[d] - state.zmp_desired[d];
        -state.dcm_error[d] + growth * (-state.dcm_error[d] - shift)
    });
    (w.is_finite() && error.iter().all(|e| e.is_finite())).then_some(Divergence { w, error })
}
