//! Walks with other tables, counts and bus cycles: what of them is seen in the tracking of the joints.

use std::error::Error;
use std::path::Path;

use config::Setup;
use drives::Resolution;
use serde::Serialize;

use chain::Chain;
use chain::figures::Gatherer;

/// \[s\] As long as it takes to walk at full speed for some strides.
const DURATION: f64 = 12.0;
/// \[s\] From here on it walks at full speed.
const STEADY: f64 = 6.0;
/// Points of the tables, none: computed directly.
const TABLES: [Option<u32>; 9] =
    [None, Some(3), Some(5), Some(9), Some(17), Some(33), Some(65), Some(129), Some(257)];
/// \[s\] Bus cycles.
const CYCLES: [f64; 3] = [1e-3, 2e-3, 3.5e-3];
/// Of Johnnie's encoders, in a turn of a motor: robots/johnnie/README.md.
const JOHNNIES_COUNTS: u32 = 2000;
/// \[s\] Integration step, whatever the cycle.
const STEP: f64 = 2.5e-4;

/// One walk.
#[derive(Clone, Debug, Serialize)]
pub(super) struct TableWalk {
    /// Robot, law, numbers.
    pub what: String,
    /// Points of the tables, if it is a walk for the chart over them; 0: computed directly.
    pub table_points: Option<u32>,
    /// \[s\] Bus cycle.
    pub cycle_s: f64,
    /// Whether it ended in a fall.
    pub fell: bool,
    /// \[rad\] Largest tracking error of hip flexion and knees.
    pub hip_knee_rad: f64,
    /// \[rad\] The same on the motors' side of elastic gears.
    pub motor_side_rad: f64,
    /// \[rad\] Root mean square of the tracking errors of the knees, and of the ankles, while walking at full speed.
    pub rms_rad: [f64; 2],
    /// \[rad\] Largest error of the torso's inclination.
    pub inclination_rad: f64,
}

/// Everything.
pub(super) fn all(config: &Path, tell: &impl Fn(&str)) -> Result<Vec<TableWalk>, Box<dyn Error>> {
    let mut walks = Vec::new();
    let scene = Setup::load(config, "walk_tables")?;
    let counts = scene.scene.joint_control.and_then(|control| control.resolution.encoder_counts);
    for table_points in TABLES {
        let name = table_points.map_or("computed directly".into(), |n| format!("tables of {n} points"));
        let mut setup = scene.clone();
        resolve(&mut setup, Resolution { table_points, encoder_counts: counts });
        let walk = walk(setup, format!("Lola, cascade, {name}, counts"), tell)?;
        walks.push(TableWalk { table_points: Some(table_points.unwrap_or(0)), ..walk });
    }
    for cycle in CYCLES {
        for (bus, classic) in [("CAN FD", false), ("classic CAN", true)] {
            let mut setup = scene.clone();
            resolve(&mut setup, Resolution::default());
            cycled(&mut setup, cycle);
            setup = setup.on_bus(classic)?;
            walks.push(walk(setup, format!("Lola, cascade, exact, frames of {bus}"), tell)?);
        }
    }
    let johnnie = Setup::load(config, "johnnie_type3")?;
    let coarse = Resolution { table_points: Some(65), encoder_counts: Some(JOHNNIES_COUNTS) };
    for (name, resolution, classic) in [
        ("exact, frames of CAN FD", Resolution::default(), false),
        ("exact, frames of classic CAN", Resolution::default(), true),
        ("tables of 65 points, counts, classic CAN", coarse, true),
    ] {
        let mut setup = johnnie.clone();
        resolve(&mut setup, resolution);
        setup = setup.on_bus(classic)?;
        walks.push(walk(setup, format!("Johnnie, voltage law (5.40), {name}"), tell)?);
    }
    Ok(walks)
}

fn resolve(setup: &mut Setup, resolution: Resolution) {
    setup.robot.drives.iter_mut().for_each(|drive| drive.control.resolution = resolution);
}

/// The same scene with another bus cycle, and as long steps.
fn cycled(setup: &mut Setup, cycle: f64) {
    (setup.scene.cycle, setup.scene.substeps) = (cycle, (cycle / STEP).round() as u32);
}

fn walk(setup: Setup, what: String, tell: &impl Fn(&str)) -> Result<TableWalk, Box<dyn Error>> {
    tell(&what);
    let cycle = setup.scene.cycle;
    let mut chain = Chain::new(&setup)?;
    let mut gatherer = Gatherer::default();
    let of = |part: &str| {
        let joints = setup.robot.joints.iter().enumerate();
        joints.filter(|(_, joint)| joint.name.contains(part)).map(|(j, _)| j).collect::<Vec<_>>()
    };
    let parts = [of("knee"), of("ankle")];
    let (mut squares, mut cycles) = ([0.0; 2], 0.0_f64);
    for _ in 0..(DURATION / cycle).round() as usize {
        let c = chain.step();
        gatherer.add(&c.sim_state, &c.controller_state);
        if c.sim_state.time >= STEADY {
            cycles += 1.0;
            for (square, part) in squares.iter_mut().zip(&parts) {
                let of_part = part.iter().map(|&j| c.controller_state.tracking_error[j].powi(2));
                *square += of_part.sum::<f64>() / part.len().max(1) as f64;
            }
        }
    }
    let f = gatherer.figures(&setup, 0.0, None);
    Ok(TableWalk {
        what,
        table_points: None,
        cycle_s: cycle,
        fell: f.fell,
        hip_knee_rad: f.hip_knee_tracking_error_max_rad,
        motor_side_rad: f.hip_knee_motor_side_error_max_rad,
        rms_rad: squares.map(|sum| (sum / cycles.max(1.0)).sqrt()),
        inclination_rad: f.inclination_error_max_rad.into_iter().fold(0.0, f64::max),
    })
}
