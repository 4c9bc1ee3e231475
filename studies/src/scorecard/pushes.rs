//! The largest push of 0.1 s at the torso that is survived, at five instants of a step.

use realtime::clock::thread_time;

use super::entries::{PUSHED, PUSHES};
use super::walk::set_up;
use super::{Goal, Result, ScorecardOptions, ScorecardRow};
use crate::push;

/// Instants spread evenly over a step, from the beginning of the right foot's single support on; all of them, or with
/// `--quick`.
const INSTANTS: [usize; 2] = [5, 2];

/// Rows of one direction.
pub(super) fn rows(order: &ScorecardOptions<'_>, direction: usize, cycle: f64) -> Result<Vec<ScorecardRow>> {
    let (name, axis, published) = PUSHES[direction];
    let begun = thread_time();
    let setup = set_up(order, PUSHED, 3, cycle)?;
    // A stride is two steps; what happens in the second one is the mirror image of the first.
    let instants = INSTANTS[usize::from(order.quick)];
    let starts = push::at_instants(&setup, 2 * instants).map_err(|e| e.to_string())?;
    let survived: Vec<f64> = starts[..instants]
        .iter()
        .map(|start| push::largest(start, axis, 1.0).map(|impulse| impulse / setup.robot.total_mass))
        .collect::<Result<_>>()?;
    let least = survived.iter().copied().fold(f64::INFINITY, f64::min);
    let each: Vec<String> = survived.iter().map(|x| format!("{x:.3}")).collect();
    Ok(vec![ScorecardRow {
        entry: "pushes of 0.1 s at 1 km/h".into(),
        scene: PUSHED.into(),
        what: format!("{name}, least of the instants"),
        demanded: "the largest survived".into(),
        ours: Some(least),
        unit: "N s/kg".into(),
        goal: Goal::Measured,
        note: format!("{name} at 0, 1/{instants}, ... of a step: {}", each.join(", ")),
        depth: super::depth_of(&setup.scene),
        cycle_s: cycle,
        cpu_s: (thread_time() - begun) as f64 * 1e-9,
        published: published.into(),
    }])
}
