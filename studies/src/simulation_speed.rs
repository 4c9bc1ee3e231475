//! How fast is each model of the robot alone, and how accurate at that speed: a second of motion with recorded joint
//! targets, every cycle of it with one snapshot for the sensors.

use std::error::Error;

use config::Setup;
use config::method::Integrator;
use environment::Environment;
use messages::RIGHT;
use realtime::clock::processor_time;
use serde_json::{Value, json};
use sim_backend::drive::JointCubic;
use sim_backend::integrate::Stepper;
use sim_backend::plant::{Plant, orientation};

use crate::second::Second;
use crate::sheet::{Column, fixed, plain, scientific};

/// Runs of which the fastest counts; one for what takes longer than real time.
const REPEATS: usize = 5;
/// \[s\] Begin of the second that is simulated: the robot stands, or walks periodically.
const BEGIN: f64 = 8.0;
/// Cycles simulated from there.
const CYCLES: usize = 1000;
/// \[N\] A foot that carries less is in the air.
const AIR: f64 = 1.0;

/// One second of a model with recorded joint targets: integrator and steps per cycle, simulated time over processor time with
/// sensors once per cycle, the same for cycles with one foot in the air; largest errors of the torso's position and
/// orientation, root mean square error of the right foot's normal force.
pub(crate) const COLUMNS: &[Column] = &[
    plain("/depth", "type"),
    plain("/motion", "motion"),
    plain("/method", "steps per cycle"),
    fixed("/real_time_factor", "real time [1]", 1),
    fixed("/single_support_factor", "one foot [1]", 1),
    scientific("/position_error_m", "position [m]", 1),
    scientific("/orientation_error_rad", "orientation [rad]", 1),
    scientific("/force_error_rms_n", "normal force, rms [N]", 1),
];

use Integrator::{Euler, RungeKutta4, SemiImplicit};

/// A method and its steps per cycle.
type Method = (Integrator, u32);

/// What each type is measured with, and steps per cycle of its reference, by Runge-Kutta.
const METHODS: [(u8, &[Method], u32); 5] = [
    (1, &[(Euler, 1), (Euler, 4), (Euler, 16), (RungeKutta4, 1), (RungeKutta4, 4), (RungeKutta4, 32)], 64),
    (2, &[(SemiImplicit, 1), (SemiImplicit, 4), (SemiImplicit, 10), (Euler, 10), (RungeKutta4, 10)], 40),
    (3, &[(SemiImplicit, 1), (SemiImplicit, 4), (SemiImplicit, 10), (Euler, 40), (RungeKutta4, 10)], 40),
    (4, &[(SemiImplicit, 1), (SemiImplicit, 4), (SemiImplicit, 10)], 20),
    (5, &[(SemiImplicit, 1), (SemiImplicit, 4), (SemiImplicit, 10)], 20),
];

/// Measures every type with the scenes `stand` and `walk_1kmh`.
///
/// # Errors
/// A configuration or robot is wrong.
pub fn run(stand: &Setup, walk: &Setup) -> Result<Vec<Value>, Box<dyn Error>> {
    let mut rows = Vec::new();
    for (depth, methods, reference) in METHODS {
        for (motion, setup) in [("standing", stand), ("walking at 1 km/h", walk)] {
            let mut setup = setup.clone();
            setup.scene.depth = depth;
            if depth > 1 {
                (setup.scene.integrator, setup.scene.substeps) = (SemiImplicit, 4);
            }
            let second = Second::record(&setup, BEGIN, CYCLES)?;
            let pose = &setup.robot.poses[&setup.scene.start_pose];
            let mut plant = Plant::new(&setup.robot, Environment::flat(), depth, pose)?;
            let reference = simulate(&second, &mut plant, RungeKutta4, reference);
            rows.extend(methods.iter().map(|m| row(depth, motion, (&second, &mut plant), *m, &reference)));
        }
    }
    Ok(rows)
}

/// What a simulation found at the end of a cycle.
struct CycleResult {
    pose: [f64; 7],
    /// \[N\] Normal forces, right and left.
    force: [f64; 2],
    /// \[s\] Processor time of the cycle.
    took: f64,
}

fn simulate(second: &Second, plant: &mut Plant, method: Integrator, steps: u32) -> Vec<CycleResult> {
    let mut x = second.state.clone();
    let mut stepper = Stepper::new(method, x.len());
    let mut drives: Vec<JointCubic> = second.drives(0).collect();
    let mut instants = Vec::with_capacity(second.cycles());
    let mut last = processor_time();
    for cycle in 0..second.cycles() {
        drives.clear();
        drives.extend(second.drives(cycle));
        second.advance(plant, &mut stepper, steps, &drives, &mut x);
        let seen = plant.snapshot(second.cycle, &x, &drives);
        let mut pose = [0.0; 7];
        pose.copy_from_slice(&x[..7]);
        let now = processor_time();
        let took = (now - last) as f64 * 1e-9;
        instants.push(CycleResult { pose, force: seen.foot_wrench.map(|w| w.force[2]), took });
        last = now;
    }
    instants
}

fn row(
    depth: u8,
    motion: &str,
    (second, plant): (&Second, &mut Plant),
    (method, steps): Method,
    reference: &[CycleResult],
) -> Value {
    let mut best = simulate(second, plant, method, steps);
    let repeats = if duration(&best) > 1.0 { 1 } else { REPEATS };
    for _ in 1..repeats {
        let again = simulate(second, plant, method, steps);
        if duration(&again) < duration(&best) {
            best = again;
        }
    }
    // Errors of its motion, the same in every run; then what cycles on one foot cost.
    let pairs = || best.iter().zip(reference);
    let position = pairs().map(|(a, b)| distance(&a.pose[..3], &b.pose[..3]));
    let turned = pairs().map(|(a, b)| orientation(&a.pose).angle_to(&orientation(&b.pose)));
    let square: f64 = pairs().map(|(a, b)| (a.force[RIGHT] - b.force[RIGHT]).powi(2)).sum();
    let on_one = best.iter().filter(|i| i.force.iter().any(|f| *f < AIR));
    let single: Vec<f64> = on_one.map(|i| i.took).collect();
    let single_support =
        (single.len() > CYCLES / 10).then(|| single.len() as f64 * second.cycle / single.iter().sum::<f64>());
    json!({
        "depth": depth,
        "motion": motion,
        "method": format!("{method:?} x {steps}"),
        "real_time_factor": CYCLES as f64 * second.cycle / duration(&best),
        "single_support_factor": single_support,
        "position_error_m": largest(position),
        "orientation_error_rad": largest(turned),
        "force_error_rms_n": (square / CYCLES as f64).sqrt(),
    })
}

/// \[s\] Processor time.
fn duration(instants: &[CycleResult]) -> f64 {
    instants.iter().map(|i| i.took).sum()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// The largest, and infinity where the numbers were lost.
fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |a, b| if b.is_finite() { a.max(b) } else { f64::INFINITY })
}
