//! What the field bus costs: how full its lines are, how long frames take to make and to read, and what the resolution and
//! the cycle of a bus do to the walk.

use std::hint::black_box;
use std::path::Path;

use codec::frames::{DriveCommand, decode_sensors, decode_targets, encode_sensors, encode_targets};
use codec::layout::{Carries, FrameLayout};
use config::method::Integrator;
use config::method::Method;
use config::{Robot, Setup};
use fieldbus::load::{BIT_RATE, DATA_BIT_RATE, Rates, cycle_time};
use messages::{BusFrames, Sensors};
use realtime::clock::thread_time;
use serde_json::{Value, json};

use crate::scorecard::walk;
use crate::sheet::{Column, fixed, plain};
use crate::{Error, Given, Sheet, Study};

/// Robots, and the cycle of their CAN lines \[s\]: Lola's of the thesis (8.2), Johnnie's control cycle (5.5.1); Archie's is what
/// one line per leg leaves room for, in periods of his drives' position loops (320 us).
const ROBOTS: [(&str, f64); 3] = [("lola", 0.0035), ("johnnie", 0.0015), ("archie", 0.00352)];
/// Classic CAN, and CAN FD with the usual data rate.
const CLASSIC: Rates = Rates { nominal: BIT_RATE, data: None };
const FD: Rates = Rates { nominal: BIT_RATE, data: Some(DATA_BIT_RATE) };
/// \[s\] Cycle that CAN FD is to allow.
const FD_CYCLE: f64 = 0.001;
/// Walks, whose joint laws hear their targets and tell their angles by the bus, the cycles they are walked with
/// \[s\], and the integration step \[s\].
const WALKS: [(&str, &[f64], f64); 3] = [
    ("walk_2kmh_type3", &[0.001, 0.0035], 1e-4),
    ("johnnie_type3", &[0.0015], 1e-4),
    ("archie_walk", &[0.00352], 8e-5),
];
/// Cycles that are timed together, and how often; the median counts.
const TIMED: (usize, usize) = (1000, 51);

/// One robot's frames over one kind of bus: load of the fullest line with the worst stuffing, median time of encoding and
/// decoding all frames of a cycle at either end, smallest steps of targets and measured angles.
const BUSES: &[Column] = &[
    plain("/robot", "robot"),
    plain("/kind", "bus"),
    fixed("/cycle_s", "cycle [ms]", 1).times(1e3),
    plain("/frames/0", "frames to"),
    plain("/frames/1", "from"),
    plain("/fullest", "fullest line"),
    fixed("/load", "load [%]", 1).times(100.0),
    fixed("/near_us", "lowlevel [us]", 2),
    fixed("/far_us", "far end [us]", 2),
    fixed("/target_step", "target [urad]", 3).times(1e6),
    fixed("/angle_step", "angle [urad]", 3).times(1e6),
];
/// One walk over one kind of bus: largest inclination errors phi_x, phi_y and tracking error, what ended it before its time.
const WALKED: &[Column] = &[
    plain("/scene", "walk"),
    plain("/kind", "bus"),
    fixed("/cycle_s", "cycle [ms]", 1).times(1e3),
    fixed("/inclination_mrad", "inclination [mrad]", 1),
    fixed("/tracking_mrad", "hips, knees [mrad]", 2),
    plain("/ended", "ended"),
];

/// The study; it has no arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct BusCost {}

impl Study for BusCost {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        let mut buses = Vec::new();
        for (name, cycle) in ROBOTS {
            let robot = Robot::load(&given.config.join("robots").join(name))?;
            buses.push(bus(
                &robot,
                "classic CAN, 1 Mbit/s",
                robot.classic.as_ref().map_err(String::as_str)?,
                CLASSIC,
                cycle,
            ));
            buses.push(bus(&robot, "CAN FD, 1 and 5 Mbit/s", &robot.layout, FD, FD_CYCLE));
        }
        // What the resolution and the cycle of each kind of bus do to the walk.
        let mut walks = Vec::new();
        for (scene, cycles, step) in WALKS {
            for &cycle in cycles {
                for classic in [true, false] {
                    walks.push(one_walk(given.config, scene, (cycle, step), classic)?);
                }
            }
        }
        let mut sheet = Sheet::default();
        sheet.rows("buses", BUSES, &buses);
        sheet.line("");
        sheet.rows("walks", WALKED, &walks);
        Ok(sheet)
    }
}

fn one_walk(root: &Path, scene: &str, (cycle, step): (f64, f64), classic: bool) -> Result<Value, Error> {
    let mut setup = Setup::load(root, scene)?.on_bus(classic)?;
    let substeps = (cycle / step).round() as u32;
    setup.scene.choose(Method { depth: 3, integrator: Integrator::SemiImplicit, substeps });
    setup.scene.cycle = cycle;
    let walked = walk::walk(&setup)?;
    let f = &walked.figures;
    Ok(json!({
        "scene": scene,
        "kind": if classic { "classic CAN" } else { "CAN FD" },
        "cycle_s": cycle,
        "inclination_mrad": f.inclination_error_max_rad.map(|x| 1e3 * x),
        "tracking_mrad": 1e3 * f.hip_knee_tracking_error_max_rad,
        "ended": walked.ended,
    }))
}

fn bus(robot: &Robot, kind: &str, layout: &FrameLayout, rates: Rates, cycle: f64) -> Value {
    let times = cycle_time(layout, rates);
    let (line, time) =
        times.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).expect("a robot has a node");
    let step = |wanted: fn(&Carries) -> bool| {
        let all = layout.messages.iter().flat_map(|m| &m.signals).filter(|s| wanted(&s.carries));
        all.map(|s| s.scale).fold(0.0, f64::max)
    };
    let (near_us, far_us) = costs(layout);
    json!({
        "robot": robot.name,
        "kind": kind,
        "cycle_s": cycle,
        "frames": [layout.sent(true).count(), layout.sent(false).count()],
        "fullest": layout.nodes[line],
        "load": time / cycle,
        "near_us": near_us,
        "far_us": far_us,
        "target_step": step(|c| matches!(c, Carries::Target(_))),
        "angle_step": step(|c| matches!(c, Carries::Angle(_))),
    })
}

/// Median times \[us\] of one cycle at lowlevel and at the far end.
fn costs(layout: &FrameLayout) -> (f64, f64) {
    let (mut command, mut sensors) = (DriveCommand::default(), Sensors::default());
    let (mut tx, mut rx) = (BusFrames::default(), BusFrames::default());
    for j in 0..messages::MAX_JOINTS {
        command.targets.angle[j] = 0.1 * j as f64;
        sensors.joint_angle[j] = -0.1 * j as f64;
    }
    let mut tick = 0;
    encode_targets(layout, &command, &mut tx);
    encode_sensors(layout, &sensors, &mut rx);
    let near = median(|| {
        tick += 1;
        command.targets.header.tick = tick;
        encode_targets(layout, black_box(&command), &mut tx);
        rx.header.tick = 0;
        black_box(decode_sensors(layout, black_box(&rx), &mut sensors));
    });
    let mut told = DriveCommand::default();
    tx.header.tick = tick;
    let far = median(|| {
        sensors.header.tick += 1;
        black_box(decode_targets(layout, black_box(&tx), &mut told));
        encode_sensors(layout, black_box(&sensors), &mut rx);
    });
    (near, far)
}

fn median(mut work: impl FnMut()) -> f64 {
    let mut times: Vec<f64> = (0..TIMED.1)
        .map(|_| {
            let begun = thread_time();
            (0..TIMED.0).for_each(|_| work());
            (thread_time() - begun) as f64 * 1e-3 / TIMED.0 as f64
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[TIMED.1 / 2]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The frames of a cycle fit on every line of every robot.
    #[test]
    fn every_line_has_room_for_its_frames() {
        let root = config::root(None);
        for (name, cycle) in ROBOTS {
            let robot = Robot::load(&root.join("robots").join(name)).unwrap();
            for (layout, rates, cycle) in
                [(robot.classic.as_ref().unwrap(), CLASSIC, cycle), (&robot.layout, FD, FD_CYCLE)]
            {
                for (time, node) in cycle_time(layout, rates).iter().zip(&layout.nodes) {
                    assert!(*time < cycle, "{name}, {node}: {time} s of {cycle}");
                }
            }
        }
    }
}
