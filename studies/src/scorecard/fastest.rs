//! As fast as it goes: a ladder of speeds upwards, and the edge between the last that is held and the first that is not.

use super::entries::FASTEST;
use super::walk::{set_up, walk};
use super::{Result, ScorecardOptions, ScorecardRow};
use crate::undisturbed::walk_at;

/// \[km/h\] Rungs; the last one is Lola's design speed.
const LADDER: [f64; 5] = [3.34, 3.6, 4.0, 4.5, 5.0];
/// \[km/h\] The edge is found this closely.
const RESOLUTION: f64 = 0.05;
/// Share of the commanded speed that is to be reached.
const REACHED: f64 = 0.97;

/// One rung: the speed that was held \[km/h\], or why it was not; processor time \[s\], model.
fn rung(order: &ScorecardOptions<'_>, kmh: f64, cycle: f64) -> Result<(Result<f64>, f64, String)> {
    let mut setup = set_up(order, FASTEST.0, 3, cycle)?;
    let most = 3.6 * setup.gait.step.by_speed.last().map_or(0.0, |row| row[0]);
    if kmh > most {
        let why = format!("{kmh} km/h: the gait `{}` has no steps beyond {most:.2} km/h", setup.scene.gait);
        return Ok((Err(why), 0.0, String::new()));
    }
    walk_at(&mut setup, kmh)?;
    let walked = walk(&setup)?;
    let f = &walked.figures;
    let reached = 3.6 * f.mean_speed_m_s;
    let held = match &walked.ended {
        Some(ended) => Err(format!("{kmh} km/h: {ended}")),
        None if reached < REACHED * kmh => Err(format!(
            "{kmh} km/h: reaches {reached:.2}, inclination error {:.3} rad",
            f.inclination_error_max_rad[0].max(f.inclination_error_max_rad[1])
        )),
        None => Ok(reached),
    };
    Ok((held, f.cpu_s, f.depth.clone()))
}

/// The row.
pub(super) fn rows(order: &ScorecardOptions<'_>, cycle: f64) -> Result<Vec<ScorecardRow>> {
    let demand = &FASTEST.1;
    let (mut held, mut cpu_s, mut depth) = (None, 0.0, String::new());
    let (mut low, mut high, mut note) = (0.0, f64::INFINITY, String::from("the ladder ends here"));
    let mut rungs = LADDER.into_iter();
    // First the ladder, then, between the last rung that holds and the first that does not, bisection.
    loop {
        let kmh = if high.is_infinite() {
            let Some(next) = rungs.next() else { break };
            next
        } else if high - low > RESOLUTION && held.is_some() {
            0.5 * (low + high)
        } else {
            break;
        };
        let (found, cpu, with) = rung(order, kmh, cycle)?;
        cpu_s += cpu;
        if !with.is_empty() {
            depth = with;
        }
        match found {
            Ok(reached) => (held, low) = (Some(reached), kmh),
            Err(why) => (high, note) = (kmh, why),
        }
    }
    Ok(vec![ScorecardRow {
        entry: "as fast as it goes".into(),
        scene: FASTEST.0.into(),
        what: demand.what.name().into(),
        demanded: demand.text(),
        ours: held,
        unit: demand.what.unit().into(),
        goal: demand.goal(held),
        note,
        depth,
        cycle_s: cycle,
        cpu_s,
        published: demand.published.into(),
    }])
}
