//! `depth = "auto"`: what is chosen, what is said, and whether the estimate of the error holds.

use chain::depth::{Choice, choose, judge, trial::MethodTrial};
use config::method::Integrator::{Euler, SemiImplicit};
use config::method::Method;
use config::tolerance::{Output, Tolerance};
use config::{Setup, root};
use messages::command::PushCommand;

/// Lola stands up; [`Tolerance::trial`] \[s\] of it.
fn standing(trial: f64, outputs: &[(Output, f64)]) -> Setup {
    let mut setup = Setup::load(&root(None), "stand").unwrap();
    setup.scene.auto = Some(Tolerance { outputs: outputs.to_vec(), trial: Some(trial) });
    setup
}

fn chosen(setup: &Setup) -> Choice {
    choose(setup, |_| ()).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn what_every_model_has_is_had_from_the_cheapest() {
    let choice = chosen(&standing(0.2, &[(Output::Inclination, 0.05), (Output::Position, 0.05)]));
    assert_eq!(choice.method, Method { depth: 1, integrator: Euler, substeps: 1 }, "{}", choice.reason());
    assert_eq!(choice.tried.len(), 1);
    assert_eq!(choice.trials, 5, "itself, half the step, types 2, 3 and 5");
}

#[test]
fn torques_and_currents_need_motors() {
    for output in [(Output::JointTorque, 200.0), (Output::MotorCurrent, 50.0)] {
        let choice = chosen(&standing(0.1, &[output]));
        assert!(choice.method.depth >= 2, "{}", choice.reason());
        assert!(choice.tried.iter().all(|t| t.method.depth >= 2), "type 1 is not even tried");
    }
}

/// No clock decides.
#[test]
fn twice_the_same() {
    let setup = standing(0.1, &[(Output::FootForce, 5.0), (Output::MotorCurrent, 1.0)]);
    let found = [choose(&setup, |_| ()), choose(&setup, |_| ())].map(|found| match found {
        Ok(choice) => format!("{} {:?}", choice.method, choice.tried),
        Err(e) => e.to_string(),
    });
    assert_eq!(found[0], found[1]);
}

#[test]
fn too_strict_says_how_near_the_nearest_came() {
    let mut setup = standing(0.05, &[(Output::FootForce, 1e-9)]);
    setup.robot.drives.clear(); // type 1 alone is left
    let said = choose(&setup, |_| ()).unwrap_err().to_string();
    let begin = "scene stand: tolerance: none of 4 methods is accurate enough over 0.1 s; the nearest was type 1, euler x";
    assert!(said.starts_with(begin), "{said}");
    assert!(
        said.contains(": foot_force ") && said.ends_with("or say depth, integrator and substeps"),
        "{said}"
    );
}

#[test]
fn a_robot_without_drives_has_no_torques() {
    let mut setup = standing(0.1, &[(Output::JointTorque, 200.0)]);
    setup.robot.drives.clear();
    assert_eq!(
        choose(&setup, |_| ()).unwrap_err().to_string(),
        "scene stand: tolerance: torques and currents need motors, and robot `lola` has no [[drive]]"
    );
}

/// A push on the standing robot: every estimate against the deepest model at half of its own smallest step.
#[test]
fn estimates_hold_against_the_deepest_model() {
    let mut setup = standing(0.4, &[]);
    setup.scene.pushes = vec![(0.1, PushCommand { force: [60.0, 40.0, 0.0], duration: 0.1 })];
    let truth =
        MethodTrial::run(&setup, Method { depth: 5, integrator: SemiImplicit, substeps: 20 }, 400).unwrap();
    for (depth, integrator, substeps) in
        [(1, Euler, 1), (1, Euler, 4), (2, SemiImplicit, 2), (3, SemiImplicit, 4), (4, SemiImplicit, 4)]
    {
        let method = Method { depth, integrator, substeps };
        let outputs = Output::ALL.into_iter().filter(|output| depth > 1 || !output.needs_motors());
        let outputs: Vec<_> = outputs.map(|output| (output, f64::MAX)).collect();
        setup.scene.auto = Some(Tolerance { outputs: outputs.clone(), trial: Some(0.4) });
        let own = MethodTrial::run(&setup, method, 400).unwrap();
        for (estimate, (output, _)) in judge(&setup, method).unwrap().estimates.iter().zip(outputs) {
            let error = own.distance(&truth, output);
            println!("{method:32} {output:?}: off by {error:.2e}, estimated {:.2e}", estimate.error());
            assert!(estimate.complete && error <= estimate.error(), "{method}: {error} {estimate:?}");
        }
    }
}
