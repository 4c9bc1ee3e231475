//! A step of 0.05 rad at one hip joint of Lola, hovering, all her drives at work: motors, controllers, friction, gears
//! (types 2 and 3).
//!
//! Explicit methods and BDF see a ramp in place of dry friction, the semi-implicit step sees it as it is; all are held against
//! its limit ([`super::reference`]). What a ramp adds, no smaller step takes away: a curve for each width shows its floor.

use std::error::Error;

use config::Setup;
use config::scene::FRICTION_RAMP;
use environment::Environment;
use sim_backend::drive::JointCubic;
use sim_backend::plant::{Plant, PlantInputs};
use sim_backend::step_limit::{eigenvalues, euler_limit, runge_kutta_limit};

use super::methods::{RAMPS, beyond};
use super::order::in_ms;
use super::reference::{limit, limits};
use super::system::{SteppingMethod, System, SystemMotion, Times, largest};
use super::{AccuracyInput, ErrorChart, Part, Point};

pub(super) const PART: Part = charts;

const JOINT: &str = "right_hip_adduction";
/// \[rad\]
const STEP: f64 = 0.05;
const TIMES: Times = Times { every: 0.01, count: 10 };
/// \[rad/s\] Joints, and rotors by their gear ratio, outside of every ramp.
const MOVING: [f64; 2] = [0.3, 30.0];
/// \[1/s\] Slower modes are those of a robot that falls.
const SLOW: f64 = 20.0;
const STEPS: [f64; 9] = [2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5, 5e-6];

fn charts(given: &AccuracyInput<'_>) -> Result<Vec<ErrorChart>, Box<dyn Error>> {
    let setup = Setup::load(given.config, "stand")?;
    [2, 3].into_iter().map(|depth| chart(&setup, depth, REFERENCE, methods())).collect()
}

fn chart(
    setup: &Setup,
    depth: u8,
    reference: [f64; 3],
    methods: Vec<JointMethod>,
) -> Result<ErrorChart, Box<dyn Error>> {
    let mut robot = Hovering::new(setup, depth)?;
    let (start, joint) = (robot.start.clone(), robot.joint);
    let apart =
        |a: &SystemMotion, b: &SystemMotion| largest(a, b, |a, b| (a[7 + joint] - b[7 + joint]).abs());
    let motions = reference.map(|h| SteppingMethod::Own(OWN, h).run(&mut robot, &start, TIMES));
    let [dry, coarser] = limits(&motions, limit_of_motions);
    let measure = format!("type {depth}: largest error of the joint's angle in 0.1 s [rad]");
    let about = format!(
        "Hovering robot, all drives. Reference of all methods: dry friction as it is, semi-implicit steps of {} and {} \
         extrapolated, known to {:.0e} rad. Numbers: ramps in its place [rad/s].",
        in_ms(reference[0]),
        in_ms(reference[1]),
        apart(&dry, &coarser)
    );
    let mut chart =
        ErrorChart::new(&format!("joint.type{depth}"), "A step of 0.05 rad at a hip joint", &measure)
            .about(&about);
    for (method, ramp) in methods {
        robot.plant.set_friction_ramp(ramp.unwrap_or(FRICTION_RAMP));
        let (motion, point) = method.measure(&mut robot, &start, TIMES);
        let name = method.name() + &ramp.map_or(String::new(), |ramp| format!(", {ramp} rad/s"));
        let stable = robot.limit(&method)?;
        if let Some(stable) = stable {
            chart.limit(&name, stable);
        }
        let note = point.note.clone().or_else(|| beyond(point.step, stable));
        let (scene, model, error) = ("step".into(), format!("type {depth}"), apart(&motion, &dry));
        chart.add(Point { scene, model, method: name, error, note, ..point });
    }
    chart.expect_order(OWN, 1.0, 1e-6..=3e-5);
    Ok(chart)
}

const OWN: &str = "semi-implicit";
/// \[s\] Steps of the reference.
const REFERENCE: [f64; 3] = [2e-6, 4e-6, 8e-6];

/// A method, and the ramp \[rad/s\] of one that needs it.
type JointMethod = (SteppingMethod, Option<f64>);

fn methods() -> Vec<JointMethod> {
    let mut all: Vec<JointMethod> = Vec::new();
    all.extend(STEPS.map(|h| (SteppingMethod::Euler(h), Some(FRICTION_RAMP))));
    for ramp in RAMPS {
        all.extend(STEPS.map(|h| (SteppingMethod::RungeKutta4(h), Some(ramp))));
    }
    all.extend(STEPS.map(|h| (SteppingMethod::Own(OWN, h), None)));
    for ramp in [FRICTION_RAMP, RAMPS[3]] {
        all.extend([1e-3, 1e-5, 1e-7].map(|tolerance| (SteppingMethod::Bdf(tolerance), Some(ramp))));
    }
    all
}

fn limit_of_motions(fine: &SystemMotion, coarse: &SystemMotion) -> SystemMotion {
    let seen = fine.seen.iter().zip(&coarse.seen).map(|(f, c)| limit(f, c)).collect();
    SystemMotion { seen, ..SystemMotion::default() }
}

/// The robot high above the ground, powered.
struct Hovering {
    plant: Plant,
    drives: Vec<JointCubic>,
    inputs: PlantInputs,
    joint: usize,
    start: Vec<f64>,
}

impl Hovering {
    fn new(setup: &Setup, depth: u8) -> Result<Self, Box<dyn Error>> {
        let robot = &setup.robot;
        let pose = &robot.poses[&setup.scene.start_pose];
        let joint = robot.joints.iter().position(|j| j.name == JOINT).ok_or("no such joint")?;
        let mut plant = Plant::new(robot, Environment::flat(), depth, pose)?;
        let mut start = plant.standing(pose);
        start[2] += 10.0;
        let layer = plant.layout().layer();
        start[layer].fill(0.0);
        let mut drives: Vec<JointCubic> = pose.iter().map(|q| JointCubic::resting(*q)).collect();
        drives[joint] = JointCubic::resting(pose[joint] + STEP);
        Ok(Self { plant, drives, inputs: PlantInputs::POWERED, joint, start })
    }

    /// \[s\] Largest stable step of an explicit method, of the robot at rest with its rotors within the ramp, and moving.
    fn limit(&mut self, method: &SteppingMethod) -> Result<Option<f64>, Box<dyn Error>> {
        let of = match method {
            SteppingMethod::Euler(_) => euler_limit,
            SteppingMethod::RungeKutta4(_) => runge_kutta_limit,
            SteppingMethod::Own(..) | SteppingMethod::Bdf(_) => return Ok(None),
        };
        let l = *self.plant.layout();
        let mut moving = self.start.clone();
        moving[l.speed()][6..].fill(MOVING[0]);
        moving[l.rotor_speed()].fill(MOVING[1]);
        let mut least = f64::INFINITY;
        for x in [self.start.clone(), moving] {
            let mut values = eigenvalues(&x, |x, dx| self.rate(0.0, x, dx))?;
            values.retain(|s| s.norm() > SLOW);
            least = least.min(of(&values).max(0.0));
        }
        Ok(Some(least))
    }
}

impl System for Hovering {
    fn rate(&mut self, t: f64, x: &[f64], dx: &mut [f64]) {
        self.plant.rate(t, x, &self.drives, &self.inputs, dx);
    }

    fn own_step(&mut self, t: f64, h: f64, x: &mut [f64]) {
        self.plant.implicit_step(t, h, x, &self.drives, &self.inputs);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a ramp makes of a motion no step takes away: its distance from dry friction, by steps of two methods and without
    /// the reference, is the least that a method on that ramp may be said to err. It was said to err by 9e-9 rad.
    #[test]
    fn no_method_is_nearer_to_dry_friction_than_its_ramp() {
        let setup = Setup::load(&config::root(None), "stand").unwrap();
        for depth in [2, 3] {
            let mut robot = Hovering::new(&setup, depth).unwrap();
            let (start, joint) = (robot.start.clone(), robot.joint);
            let dry = SteppingMethod::Own(OWN, 5e-6).run(&mut robot, &start, TIMES);
            let mut floor = |ramp| {
                robot.plant.set_friction_ramp(ramp);
                let motion = SteppingMethod::RungeKutta4(5e-5).run(&mut robot, &start, TIMES);
                let apart = |a: &Vec<f64>, b: &Vec<f64>| (a[7 + joint] - b[7 + joint]).abs();
                motion.seen.iter().zip(&dry.seen).map(|(a, b)| apart(a, b)).fold(0.0, f64::max)
            };
            let floors = [10.0, 0.1].map(&mut floor);
            let methods = vec![
                (SteppingMethod::RungeKutta4(1e-4), Some(10.0)),
                (SteppingMethod::Bdf(1e-6), Some(10.0)),
                (SteppingMethod::RungeKutta4(1e-4), Some(0.1)),
            ];
            let chart = chart(&setup, depth, [1e-5, 2e-5, 4e-5], methods).unwrap();
            let errors: Vec<f64> = chart.points.iter().map(|p| p.error).collect();
            // The step of 5 us has an error of its own, of up to 1.5e-5 rad.
            assert!(errors[..2].iter().all(|e| *e > floors[0] - 1.5e-5 && *e > 3e-5), "{errors:?}");
            // A narrow ramp comes to the same limit as the semi-implicit steps do, which know of none.
            assert!(errors[2] < 0.15 * errors[0], "{errors:?}");
        }
    }
}
