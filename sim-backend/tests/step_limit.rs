//! Longest stable steps of explicit methods: predicted when a scene is loaded, and what happens beyond.

use config::method::Integrator;
use config::{Robot, Setup, root};
use sim_backend::SimBackend;
use sim_backend::step_limit::{StepLimit, step_limit};

fn setup(scene: &str, depth: u8, integrator: Integrator) -> Setup {
    let mut setup = Setup::load(&root(None), scene).unwrap();
    (setup.scene.depth, setup.scene.integrator, setup.scene.tolerance) = (depth, integrator, None);
    setup
}

fn limit(setup: &Setup) -> Option<StepLimit> {
    let (robot, scene): (&Robot, _) = (&setup.robot, &setup.scene);
    step_limit(robot, scene.depth, &robot.poses[&scene.start_pose], scene.integrator).unwrap()
}

/// Explicit Euler damps nothing that swings, so with elastic gears no step of use is stable.
#[test]
fn explicit_steps_have_a_limit_on_every_robot_and_depth() {
    for scene in ["walk_1kmh", "johnnie_2kmh", "archie_walk"] {
        for depth in 1..=5 {
            for integrator in [Integrator::Euler, Integrator::RungeKutta4] {
                let limit = limit(&setup(scene, depth, integrator)).expect("explicit");
                println!("{scene}, type {depth}, {integrator:?}: {:.3e} s, {}", limit.step, limit.regime);
                let swings = integrator == Integrator::Euler && (depth == 3 || depth == 5);
                let useful = if depth == 1 { 3e-3..2e-2 } else { 5e-5..1e-3 };
                assert!(if swings { limit.step < 1e-4 } else { useful.contains(&limit.step) }, "{limit:?}");
            }
        }
        for integrator in [Integrator::SemiImplicit, Integrator::Bdf] {
            assert_eq!(limit(&setup(scene, 2, integrator)), None, "not explicit");
        }
    }
}

#[test]
fn a_longer_step_is_refused_with_what_to_do_unless_it_is_forced() {
    for (depth, integrator) in
        [(1, Integrator::Euler), (2, Integrator::Euler), (2, Integrator::RungeKutta4), (3, Integrator::Euler)]
    {
        let mut setup = setup("walk_1kmh", depth, integrator);
        let longest = limit(&setup).unwrap().step.max(1e-6);
        setup.scene.substeps = 1;
        let mut load = |share: f64, force_step: bool| {
            (setup.scene.cycle, setup.scene.force_step) = (share * longest, force_step);
            SimBackend::new(&setup.robot, &setup.scene).map(|_| ()).map_err(|e| e.to_string())
        };
        let text = load(1.01, false).unwrap_err();
        for part in ["walk_1kmh", "substeps = ", "semi_implicit", "force_step = true"] {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert_eq!(load(1.01, true), Ok(()));
        if depth < 3 {
            assert_eq!(load(0.99, false), Ok(()));
        }
    }
}
