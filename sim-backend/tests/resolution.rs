//! Local controllers with look-up tables and counts: what they make of joints, seen in the voltage that they set.

use crate::rig::{Rig, lola};
use config::Robot;
use drives::lookup::LookupTable;
use drives::{
    ControlLaw, JointControl, OutOfDomain, Resolution, Sampled, Sampling, Transmission, VoltageLaw,
};
use environment::Environment;
use sim_backend::drive::{JointCubic, JointMotion};
use sim_backend::plant::Plant;
use sim_backend::train::FaultCause;
use std::f64::consts::TAU;

/// \[V/rad\] Gain of a controller that shows its error as a voltage.
const GAIN: f64 = 5.0;
/// Of the tables, in each dimension.
const POINTS: usize = 17;
/// \[rad\] By how much the joints are to move.
const STEP: f64 = 3e-3;
/// \[rad\] What the tables have beyond the ranges of the joints.
const MARGIN: f64 = 0.02;

/// Lola whose controllers set a voltage that is in proportion to the error of the angle.
fn controlled(table_points: Option<u32>, encoder_counts: Option<u32>) -> Robot {
    let mut robot = lola();
    for d in &mut robot.drives {
        d.voltage_limit = 1e9;
        d.control = JointControl {
            law: ControlLaw::Voltage(VoltageLaw { position: GAIN, speed: 0.0 }),
            sampling: Sampling::Cycle(Sampled { delay: false, difference: false }),
            resolution: Resolution { table_points, encoder_counts },
        };
    }
    robot
}

/// A robot at rest in its pose, told to be a step from it; errors of its drives \[rad\].
fn errors(robot: Robot) -> (Rig, Vec<f64>) {
    let (rig, voltages) = voltages(robot, |q| JointCubic::resting(q + STEP));
    (rig, voltages.into_iter().map(|u| u / GAIN).collect())
}

/// A robot at rest in its pose, told to move like this; what its controllers set \[V\], by the rates of the currents.
fn voltages(robot: Robot, told: impl Fn(f64) -> JointCubic) -> (Rig, Vec<f64>) {
    let mut rig = Rig::of(robot, 3, Environment::flat());
    rig.drives = rig.pose.iter().map(|q| told(*q)).collect();
    rig.plant.sample(1e-3, &rig.x, &rig.drives, &rig.inputs);
    let x = rig.x.clone();
    let rates = rig.rate(0.0, &x);
    let places = rig.plant.layout().current();
    let of = |(d, at): (&config::robot::Drive, usize)| rates[at] * d.motor.inductance;
    let found = rig.robot.drives.iter().zip(places).map(of).collect();
    (rig, found)
}

/// Angles of a drive's joints \[rad\], all moved by so much.
fn joints(rig: &Rig, drive: usize, moved: f64) -> [f64; 3] {
    let of = &rig.robot.drives[drive].joints;
    [0, 1, 2].map(|i| of.get(i).map_or(0.0, |j| rig.pose[*j] + moved))
}

/// The table of a drive's linkage in floating point.
fn table(rig: &Rig, drive: usize) -> LookupTable {
    let d = &rig.robot.drives[drive];
    let range = |i: usize| {
        let [lo, hi] = rig.robot.joints[d.joints[i]].range;
        [lo - MARGIN, hi + MARGIN]
    };
    let ranges = if d.joints.len() == 3 { [range(1), range(2)] } else { [range(0); 2] };
    LookupTable::new(&d.transmission, ranges, [POINTS; 2]).unwrap()
}

/// Motor angle of a drive by its linkage or gear itself \[rad\].
fn motor(rig: &Rig, drive: usize, moved: f64) -> f64 {
    rig.robot.drives[drive].transmission.at(joints(rig, drive, moved), [0.0; 3]).unwrap().angle
}

/// Linkages: the table's angle of the targets less the motor's own; the floating-point table says which. Gears: exact.
#[test]
fn the_motor_is_to_be_where_the_table_says() {
    let (rig, found) = errors(controlled(Some(POINTS as u32), None));
    let mut missed = 0.0_f64;
    for (k, d) in rig.robot.drives.iter().enumerate() {
        let exact = motor(&rig, k, STEP) - motor(&rig, k, 0.0);
        if matches!(d.transmission, Transmission::Harmonic { .. }) {
            assert!((found[k] - exact).abs() < 1e-9, "{}: {}, {exact}", d.name, found[k]);
            continue;
        }
        let wanted = table(&rig, k).at(joints(&rig, k, STEP)).unwrap().0 - motor(&rig, k, 0.0);
        assert!((found[k] - wanted).abs() < 5e-6, "{}: {}, {wanted}", d.name, found[k]);
        missed = missed.max((wanted - exact).abs());
    }
    assert!(missed > 1e-3, "17 points are seen: {missed} rad");
}

/// The speed wanted is that of the table's ratios where the joints are to be.
#[test]
fn the_motor_is_to_turn_as_the_table_says() {
    let (speed, cycle) = (1.0, 1e-3);
    let moving = |q| {
        let from = JointMotion { angle: q, speed, ..JointMotion::default() };
        JointCubic::follow(from, q + speed * cycle, speed, cycle)
    };
    let (rig, found) = voltages(controlled(Some(POINTS as u32), None), moving);
    let mut missed = 0.0_f64;
    for (k, d) in rig.robot.drives.iter().enumerate() {
        if matches!(d.transmission, Transmission::Harmonic { .. }) {
            continue;
        }
        let at = joints(&rig, k, 0.0);
        let (angle, ratio) = table(&rig, k).at(at).unwrap();
        let constant = d.motor.torque_constant;
        let of = |ratio: [f64; 3]| constant * speed * ratio.iter().sum::<f64>();
        let wanted = GAIN * (angle - motor(&rig, k, 0.0)) + of(ratio);
        assert!((found[k] - wanted).abs() < 5e-5, "{}: {} V, {wanted}", d.name, found[k]);
        missed = missed.max((of(ratio) - of(d.transmission.at(at, [0.0; 3]).unwrap().ratio)).abs());
    }
    assert!(missed > 1e-3, "17 points are seen: {missed} V");
}

/// Counts: the error is that of the angle's whole counts, for gears and linkages.
#[test]
fn the_motor_is_counted() {
    const COUNTS: u32 = 360;
    let count = TAU / f64::from(COUNTS);
    let (rig, found) = errors(controlled(None, Some(COUNTS)));
    let mut parts = 0;
    for (k, error) in found.iter().enumerate() {
        let is = motor(&rig, k, STEP) - error;
        assert!(((is / count).round() * count - is).abs() < 1e-9, "{is} rad are whole counts");
        let below = motor(&rig, k, 0.0) - is;
        assert!((-1e-9..count + 1e-9).contains(&below), "{below}");
        parts += usize::from(below > 0.1 * count);
    }
    assert!(parts > 3, "standing Lola's motors are not all at whole counts");
}

/// A target that no table has is told, and the drive stays with the last one; without supply nobody looks.
#[test]
fn a_target_beyond_the_table() {
    let robot = controlled(Some(17), None);
    let (knee, joint) = (robot.joint("right_knee_flexion").unwrap(), "right_knee_flexion");
    let drive = robot.drives.iter().position(|d| d.name == joint).unwrap();
    let beyond = robot.joints[knee].range[1] + 2.0 * MARGIN;
    let mut rig = Rig::of(robot, 2, Environment::flat());
    let x = rig.x.clone();
    let current = rig.plant.layout().current().start + drive;
    rig.plant.sample(1e-3, &x, &rig.drives, &rig.inputs);
    let before = rig.rate(0.0, &x)[current];
    assert_eq!(rig.plant.take_fault(), None);
    rig.drives[knee] = JointCubic::resting(beyond);
    rig.plant.sample(1e-3, &x, &rig.drives, &rig.inputs);
    assert_eq!(rig.rate(0.0, &x)[current], before);
    let fault = rig.plant.take_fault().unwrap();
    assert_eq!((fault.drive, fault.why), (drive, FaultCause::Linkage(OutOfDomain::Table { angle: beyond })));
    rig.inputs.switches.powered = false;
    rig.rate(0.0, &x);
    assert_eq!(rig.plant.take_fault(), None);
}

/// A linkage that has a dead point near its range gets no table, and the message says whose.
#[test]
fn a_linkage_without_a_table() {
    let mut robot = controlled(Some(9), None);
    let knee = robot.joint("right_knee_flexion").unwrap();
    robot.joints[knee].range[1] = 3.0;
    let pose = robot.poses["stand"].clone();
    let refused = Plant::new(&robot, Environment::flat(), 2, &pose).err().unwrap().to_string();
    for part in ["drive `right_knee_flexion`: no look-up table", "lever", "leave out table_points"] {
        assert!(refused.contains(part), "{refused}");
    }
}
