//! Grid of time of laws with a clock of their own: their instants are beginnings of integration steps, and every bus cycle
//! begins with one.

use std::error::Error;

use config::components::JointModel;
use config::{Robot, Scene};
use drives::Sampling;

/// Refuses a scene whose cycle or steps miss sampling instants of a drive that it computes, unless it forces its steps: then
/// drives are sampled at the steps next to their instants.
///
/// # Errors
/// They do.
pub(crate) fn check(robot: &Robot, scene: &Scene) -> Result<(), Box<dyn Error>> {
    if scene.components().joints != JointModel::Motors || scene.force_step {
        return Ok(());
    }
    for drive in &robot.drives {
        let Sampling::Period(periods) = drive.control.sampling else { continue };
        let position = periods.speed * f64::from(periods.position_every);
        let fits =
            whole(scene.cycle, position) && whole(periods.speed, scene.cycle / f64::from(scene.substeps));
        if fits {
            continue;
        }
        // The next cycle that fits, with one step per sample.
        let cycle = position * (scene.cycle / position - 1e-6).ceil();
        return Err(format!(
            "scene `{}`: cycle = {} s with substeps = {}: drive `{}` of {} is sampled each {} us, its position loop each \
             {} us; the cycle takes a whole multiple of the latter, and a step may be a whole fraction of the former: take \
             cycle = {} with substeps = {} or a multiple of it, or force_step = true to see what happens",
            scene.name,
            scene.cycle,
            scene.substeps,
            drive.name,
            robot.name,
            microseconds(periods.speed),
            microseconds(position),
            microseconds(cycle) / 1e6,
            (cycle / periods.speed).round(),
        )
        .into());
    }
    Ok(())
}

/// Whether `long` is a whole multiple of `short`, but for rounding.
fn whole(long: f64, short: f64) -> bool {
    let times = long / short;
    times.round() >= 1.0 && (times - times.round()).abs() < 1e-6
}

/// Time \[s\] in microseconds, without the noise of rounding.
fn microseconds(time: f64) -> f64 {
    (1e9 * time).round() / 1e3
}
