//! A step of 0.05 rad at one hip joint of Lola, hovering, all her drives at work: motors, controllers, friction, gears
//! (types 2 and 3).
//!
//! Explicit methods and BDF see dry friction smoothed over 1 rad/s of the rotor, the semi-implicit step sees it as it is;
//! each has a reference of its own law. How far these two are apart is told.

use std::error::Error;

use config::Setup;
use environment::Environment;
use sim_backend::drive::JointCubic;
use sim_backend::plant::{Plant, PlantInputs};

use super::system::{SteppingMethod, System, SystemMotion, Times, largest};
use super::{AccuracyInput, ErrorChart, Part, Point};

pub(super) const PART: Part = charts;

const JOINT: &str = "right_hip_adduction";
/// \[rad\]
const STEP: f64 = 0.05;
const TIMES: Times = Times { every: 0.01, count: 10 };
const STEPS: [f64; 9] = [2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5, 5e-6];

fn charts(given: &AccuracyInput<'_>) -> Result<Vec<ErrorChart>, Box<dyn Error>> {
    let setup = Setup::load(given.config, "stand")?;
    [2, 3].into_iter().map(|depth| chart(&setup, depth)).collect()
}

fn chart(setup: &Setup, depth: u8) -> Result<ErrorChart, Box<dyn Error>> {
    let mut robot = Hovering::new(setup, depth)?;
    let (start, joint) = (robot.start.clone(), robot.joint);
    let apart =
        |a: &SystemMotion, b: &SystemMotion| largest(a, b, |a, b| (a[7 + joint] - b[7 + joint]).abs());
    let smooth = SteppingMethod::RungeKutta4(5e-6).run(&mut robot, &start, TIMES);
    let [finer, coarser] = [2e-6, 4e-6].map(|h| SteppingMethod::Own(OWN, h).run(&mut robot, &start, TIMES));
    let dry = extrapolated(&finer, &coarser);
    let measure = format!("type {depth}: largest error of the joint's angle in 0.1 s [rad]");
    let about = format!(
        "Hovering robot, all drives. References: RK4 of 5 us for smoothed dry friction, extrapolated semi-implicit steps \
         for dry friction; they are {:.1e} rad apart.",
        apart(&smooth, &dry)
    );
    let mut chart =
        ErrorChart::new(&format!("joint.type{depth}"), "A step of 0.05 rad at a hip joint", &measure)
            .about(&about);
    let mut methods: Vec<SteppingMethod> = Vec::new();
    methods.extend(STEPS.map(SteppingMethod::Euler));
    methods.extend(STEPS[..7].iter().map(|h| SteppingMethod::RungeKutta4(*h)));
    methods.extend(STEPS.map(|h| SteppingMethod::Own(OWN, h)));
    methods.extend([1e-3, 1e-5, 1e-7].map(SteppingMethod::Bdf));
    for method in methods {
        let (motion, point) = method.measure(&mut robot, &start, TIMES);
        let reference = if matches!(method, SteppingMethod::Own(..)) { &dry } else { &smooth };
        let error = apart(&motion, reference);
        chart.add(Point { scene: "step".into(), model: format!("type {depth}"), error, ..point });
    }
    chart.expect_order("Euler", 1.0, 1e-6..=3e-5);
    chart.expect_order(OWN, 1.0, 1e-6..=3e-5);
    Ok(chart)
}

const OWN: &str = "semi-implicit";

/// The limit of two motions of first order with steps h and 2 h.
fn extrapolated(finer: &SystemMotion, coarser: &SystemMotion) -> SystemMotion {
    let limit = |(a, b): (&Vec<f64>, &Vec<f64>)| a.iter().zip(b).map(|(a, b)| 2.0 * a - b).collect();
    SystemMotion {
        seen: finer.seen.iter().zip(&coarser.seen).map(limit).collect(),
        ..SystemMotion::default()
    }
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
}

impl System for Hovering {
    fn rate(&mut self, t: f64, x: &[f64], dx: &mut [f64]) {
        self.plant.rate(t, x, &self.drives, &self.inputs, dx);
    }

    fn own_step(&mut self, t: f64, h: f64, x: &mut [f64]) {
        self.plant.implicit_step(t, h, x, &self.drives, &self.inputs);
    }
}
