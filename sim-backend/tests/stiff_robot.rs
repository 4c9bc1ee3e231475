//! The adaptive stiff method on a whole robot: Lola standing on type 3, one hip told to move.

use config::method::Integrator;
use config::{Setup, root};
use environment::Environment;
use sim_backend::SimBackend;
use sim_backend::drive::JointCubic;
use sim_backend::integrate::Stepper;
use sim_backend::plant::{Plant, PlantInputs};

const CYCLE: f64 = 1e-3;

/// State after some cycles with so many steps in each.
fn moved(setup: &Setup, mut stepper: impl FnMut(usize) -> Stepper, steps: u32) -> Vec<f64> {
    let pose = &setup.robot.poses[&setup.scene.start_pose];
    let mut plant = Plant::new(&setup.robot, Environment::flat(), 3, pose).unwrap();
    let mut x = plant.standing(pose);
    let mut drives: Vec<JointCubic> = pose.iter().map(|q| JointCubic::resting(*q)).collect();
    drives[2] = JointCubic::resting(pose[2] + 1e-3);
    let inputs = PlantInputs::POWERED;
    let mut stepper = stepper(x.len());
    let h = CYCLE / f64::from(steps);
    for _ in 0..4 {
        for i in 0..steps {
            stepper.step(&mut plant, f64::from(i) * h, h, &mut x, &drives, &inputs);
        }
    }
    assert_eq!(stepper.take_gave_up(), None);
    x
}

#[test]
fn agrees_with_small_steps_of_another_method() {
    let setup = Setup::load(&root(None), "stand").unwrap();
    let small = moved(&setup, |n| Stepper::new(Integrator::RungeKutta4, n), 50);
    let of = |tolerance| moved(&setup, |n| Stepper::new(Integrator::Bdf, n).with_tolerance(tolerance), 1);
    let distance = |x: &[f64]| (7..31).map(|k| (x[k] - small[k]).abs()).fold(0.0, f64::max);
    let (loose, tight) = (distance(&of(1e-5)), distance(&of(1e-7)));
    assert!(tight < 1e-7 && tight < loose, "{tight:e} {loose:e}");
    assert!((small[9] - of(1e-7)[9]).abs() < 1e-7 && small[9].is_finite());
}

/// 5 ms of standing on type 4 did not end in 4.9 s of processor time, without a word.
#[test]
fn types_with_pads_are_refused_with_what_to_do() {
    for depth in 1..=5 {
        let mut setup = Setup::load(&root(None), "stand").unwrap();
        (setup.scene.depth, setup.scene.integrator, setup.scene.tolerance) =
            (depth, Integrator::Bdf, Some(1e-5));
        let loaded = SimBackend::new(&setup.robot, &setup.scene).map(|_| ()).map_err(|e| e.to_string());
        if depth <= 3 {
            assert_eq!(loaded, Ok(()));
            continue;
        }
        let text = loaded.unwrap_err();
        for part in ["stand", "integrator = \"bdf\"", &format!("depth = {depth}"), "semi_implicit"] {
            assert!(text.contains(part), "{part}: {text}");
        }
    }
}
