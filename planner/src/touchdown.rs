//! End of a step: by the clock, or by a sensed contact (thesis 4.2, figure 4.5).
//!
//! A swing foot that presses on the ground while it comes down has found the ground higher than planned. Where the
//! rest of its step is longer than a plan needs to reach the controller, the next step begins at once, from the height
//! that was found. Its double support lasts until the instant at which it would have ended anyway: the centre of
//! gravity, which cannot hurry, keeps its time. If no plan from there keeps the zero-moment point in its support, or too
//! little time is left, the clock ends the step, and the next one begins from that height.
//!
//! A foot that finds no ground at its time is lowered by the stabilizer, and the clock goes on. Its height is read at the
//! end of its step: both feet are planned that much lower, and the body follows.

use crate::origin::PlanOrigin;
use crate::planned_walk::{LEAD, PlannedWalk};
use crate::pose::PlanarPose;
use messages::{ControllerState, Phase};

/// \[m\] Differences of height below this one are not told from errors of measurement.
const NOTICED: f64 = 0.008;
/// Cycles that a step must have left, beyond the lead of a plan, to be ended early.
const WORTH: u64 = 20;

/// A swing foot that presses on something while it comes down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Touchdown {
    /// Step of the active plan.
    pub(crate) step: usize,
    pub(crate) foot: usize,
}

/// The touchdown in the present step of the active plan `walk`, if there is one; `cycle_s` \[s\] is the length of a cycle.
pub(crate) fn touched(
    walk: &PlannedWalk,
    state: &ControllerState,
    tick: u64,
    cycle_s: f64,
) -> Option<Touchdown> {
    let plan = &*walk.plan;
    if state.plan_id != plan.id || tick < plan.start_tick {
        return None;
    }
    let t = (tick - plan.start_tick) as f64 * cycle_s;
    let step = walk.steps().iter().position(|s| t < s.end)?;
    let foot = 1 - walk.strides[step].stance;
    let down = plan.phase(foot, t) == Phase::TerminalSwing && state.contact[foot] == 1;
    down.then_some(Touchdown { step, foot })
}

/// Enough of the step is left for a plan from its touchdown.
pub(crate) fn is_early(walk: &PlannedWalk, touchdown: &Touchdown, tick: u64) -> bool {
    let end = walk.plan.start_tick + walk.strides[touchdown.step].end_cycle;
    end > tick + LEAD + WORTH && touchdown.step + 1 < walk.steps().len()
}

/// The active plan at an early touchdown, on the ground that was found; `None` if the foot was met by a wobble, not by
/// the ground.
pub(crate) fn at_contact(
    walk: &PlannedWalk,
    touchdown: &Touchdown,
    state: &ControllerState,
    tick: u64,
    cycle_s: f64,
) -> Option<PlanOrigin> {
    let Touchdown { step, foot } = *touchdown;
    let plan = &*walk.plan;
    let s = walk.strides[step];
    let t = (tick + LEAD - plan.start_tick) as f64 * cycle_s;
    let mut soles = walk.soles(t);
    soles[foot][2] = found(state, foot, s.heights.landing);
    if soles[foot][2] == s.heights.landing {
        return None;
    }
    let ground = PlanarPose::new(soles[foot][0], soles[foot][1], soles[foot][3]);
    let mut from = PlanOrigin::on_plan(walk, t, soles, foot, s.parameters, Some(s.width));
    from.early = Some((s.end - t, ground.local(plan.zmp.sample(s.end).0)));
    Some(from)
}

/// The active plan at the end of its step `k`, on the ground as it was found.
pub(crate) fn at_boundary(
    walk: &PlannedWalk,
    k: usize,
    touchdown: Option<Touchdown>,
    state: &ControllerState,
) -> PlanOrigin {
    let s = &walk.strides[k];
    let mut soles = walk.soles(s.end);
    if let Some(Touchdown { foot, .. }) = touchdown {
        soles[foot][2] = found(state, foot, soles[foot][2]);
    }
    let lower = lowered(state, s.stance);
    for sole in &mut soles {
        sole[2] += lower;
    }
    PlanOrigin::on_plan(walk, s.end, soles, 1 - s.stance, s.parameters, Some(s.width))
}

/// \[m\] Height over the planning frame at which the sole of `foot`, planned at `planned`, has found the ground.
fn found(state: &ControllerState, foot: usize, planned: f64) -> f64 {
    let is = state.feet[foot][2];
    if (is - planned).abs() > NOTICED { is } else { planned }
}

/// \[m\] Offset by which the stabilizer has put the sole of the stance foot lower (negative) or higher than planned.
pub(crate) fn lowered(state: &ControllerState, stance: usize) -> f64 {
    let by = state.modification[stance][0];
    if by.abs() > NOTICED { by } else { 0.0 }
}
