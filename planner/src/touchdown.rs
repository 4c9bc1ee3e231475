//! Steps that end by a sensed contact instead of by the clock (thesis 4.2, figure 4.5).
//!
//! A swing foot that presses on the ground while it comes down has found the ground higher than planned. Where the
//! rest of its step is longer than a plan needs to reach the controller, the next step begins at once, from the height
//! that was found. Its double support lasts until the instant at which it would have ended anyway: the centre of
//! gravity, which cannot hurry, keeps its time. If no plan from there keeps the zero-moment point in its support, or too
//! little time is left, the clock ends the step, and the next one begins from that height.
//!
//! A foot that finds no ground at its time is lowered by the stabilizer, and the clock goes on. Where it then stands is
//! seen at the end of its step: both feet are planned that much lower, and the body follows.

use crate::gait::{LEAD, Planner};
use crate::pose::Pose;
use messages::{ControllerState, GaitState, Phase};

/// \[m\] Differences of height below this one are not told from errors of measurement.
const NOTICED: f64 = 0.008;
/// Cycles that a step must have left, beyond the lead of a plan, to be ended early.
const WORTH: u64 = 20;

impl Planner {
    /// The step of the active plan whose swing foot has come down on something, and that foot.
    pub(crate) fn touched(&self, tick: u64, state: &ControllerState) -> Option<(usize, usize)> {
        let plan = &*self.active.plan;
        if state.plan_id != plan.id || tick < plan.start_tick {
            return None;
        }
        let t = (tick - plan.start_tick) as f64 * self.builder.cycle();
        let k = self.active.steps().iter().position(|s| t < s.end)?;
        let foot = 1 - self.active.strides[k].stance;
        let down = plan.phase(foot, t) == Phase::TerminalSwing && state.contact[foot] == 1;
        down.then_some((k, foot))
    }

    /// Plans on from the contact of `foot` in step `k`, once per step; whether that plan is feasible.
    pub(crate) fn end_early(
        &mut self,
        tick: u64,
        k: usize,
        foot: usize,
        state: &ControllerState,
        to: GaitState,
    ) -> bool {
        let plan = &*self.active.plan;
        let s = self.active.strides[k];
        let early = plan.start_tick + s.end_cycle > tick + LEAD + WORTH && k + 1 < self.active.steps().len();
        let step = (plan.id, k);
        if !early || std::mem::replace(&mut self.tried, step) == step {
            return false;
        }
        let t = (tick + LEAD - plan.start_tick) as f64 * self.builder.cycle();
        let mut soles = self.soles(t);
        soles[foot][2] = found(state, foot, s.heights.landing);
        if soles[foot][2] == s.heights.landing {
            return false; // met by a wobble, not by the ground
        }
        let ground = Pose::new(soles[foot][0], soles[foot][1], soles[foot][3]);
        let mut from = self.origin(t, soles, foot, s.parameters, Some(s.width));
        from.early = Some((s.end - t, ground.local(self.active.plan.zmp.sample(s.end).0)));
        self.walk(&from, to)
    }
}

/// \[m\] Height over the planning frame at which the sole of `foot`, planned at `planned`, has found the ground.
pub(crate) fn found(state: &ControllerState, foot: usize, planned: f64) -> f64 {
    let is = state.feet[foot][2];
    if (is - planned).abs() > NOTICED { is } else { planned }
}

/// \[m\] How much lower (negative) or higher than planned the stabilizer has put the sole of the stance foot.
pub(crate) fn lowered(state: &ControllerState, stance: usize) -> f64 {
    let by = state.modification[stance][0];
    if by.abs() > NOTICED { by } else { 0.0 }
}
