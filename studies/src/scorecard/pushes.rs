//! The largest push of 0.1 s at the torso that is survived whenever it comes: at random instants of a stride, and standing.

use config::Setup;
use messages::Command;
use realtime::clock::thread_time;

use super::entries::{PUSHED, PUSHES, PushedAlong};
use super::walk::set_up;
use super::{Goal, Result, ScorecardOptions, ScorecardRow};
use crate::push::{self, Instant};

/// Instants of a stride, drawn from the seed; all of them, or with `--quick`.
const INSTANTS: [usize; 2] = [8, 2];

/// Row of one direction, walking.
pub(super) fn walking(order: &ScorecardOptions<'_>, k: usize, cycle: f64) -> Result<Vec<ScorecardRow>> {
    let setup = set_up(order, PUSHED, 3, cycle)?;
    let instants = INSTANTS[usize::from(order.quick)];
    let starts = push::at_random(&setup, instants, order.seed).map_err(|e| e.to_string())?;
    row("pushed for 0.1 s at 1 km/h, at random instants", &setup, &starts, (&PUSHES[k], PUSHES[k].walking))
}

/// Row of one direction, standing.
pub(super) fn standing(order: &ScorecardOptions<'_>, k: usize, cycle: f64) -> Result<Vec<ScorecardRow>> {
    let mut setup = set_up(order, PUSHED, 3, cycle)?;
    setup.scene.commands.retain(|(_, command)| *command == Command::Stand);
    let starts = push::at_rest(&setup).map_err(|e| e.to_string())?;
    row("pushed for 0.1 s standing", &setup, &starts, (&PUSHES[k], PUSHES[k].standing))
}

/// Row of the least impulse survived from all of these instants.
fn row(
    entry: &str,
    setup: &Setup,
    starts: &[Instant],
    (pushed, demanded): (&PushedAlong, f64),
) -> Result<Vec<ScorecardRow>> {
    let begun = thread_time();
    let survived = starts.iter().map(|start| push::largest(start, pushed.axis, 1.0));
    let survived = survived.map(|impulse| impulse.map(|impulse| impulse / setup.robot.total_mass));
    let survived = survived.collect::<Result<Vec<f64>>>()?;
    // Whenever it comes: the worst instant counts, and the note has each of them.
    let least = survived.iter().copied().fold(f64::INFINITY, f64::min);
    let each: Vec<String> = survived.iter().map(|x| format!("{x:.3}")).collect();
    Ok(vec![ScorecardRow {
        entry: entry.into(),
        scene: PUSHED.into(),
        what: pushed.name.into(),
        demanded: format!("at least {demanded} N s/kg"),
        ours: Some(least),
        unit: "N s/kg".into(),
        goal: if least >= demanded { Goal::Met } else { Goal::Missed },
        note: if each.len() > 1 { format!("{}: {}", pushed.name, each.join(", ")) } else { String::new() },
        depth: super::depth_of(&setup.scene),
        cycle_s: setup.scene.cycle,
        cpu_s: (thread_time() - begun) as f64 * 1e-9,
        published: pushed.published.into(),
    }])
}
