//! Nothing of the simulated robot allocates after the start, whatever its type.

mod rig;

use codec::frames::{DriveCommand, encode_targets};
use config::method::Integrator;
use config::{Setup, root};
use drives::Resolution;
use environment::Environment;
use messages::{BusFrames, JointMode, JointTargets, MAX_JOINTS, Power};
use realtime::allocations::{arm, counted, disarm};
use rig::Rig;
use sim_backend::SimBackend;

#[global_allocator]
static ALLOCATOR: realtime::CountingAllocator = realtime::CountingAllocator;

/// Allocations and frees of `work`.
fn during(work: impl FnOnce()) -> [u64; 2] {
    arm();
    work();
    disarm();
    counted()
}

#[test]
fn the_counter_counts() {
    assert_ne!(during(|| drop(std::hint::black_box(vec![0u8; 100])))[0], 0);
}

#[test]
fn equations_of_motion() {
    for depth in 1..=5 {
        let mut rig = Rig::new(depth).moving(0.01, 0.1);
        let mut dx = vec![0.0; rig.x.len()];
        let counts = during(|| {
            let Rig { plant, x, drives, inputs, .. } = &mut rig;
            for i in 0..5 {
                let t = 1e-4 * f64::from(i);
                plant.rate(t, x, drives, inputs, &mut dx);
                plant.implicit_step(t, 1e-4, x, drives, inputs);
            }
            plant.snapshot(5e-4, x, drives);
            plant.advance(5e-4);
        });
        assert_eq!(counts, [0, 0], "type {depth}");
    }
}

/// Look-up tables and counts.
#[test]
fn coarse_controllers() {
    let mut robot = rig::lola();
    for d in &mut robot.drives {
        d.control.resolution = Resolution { table_points: Some(17), encoder_counts: Some(11520) };
    }
    let mut rig = Rig::of(robot, 3, Environment::flat()).moving(0.01, 0.1);
    let counts = during(|| {
        let Rig { plant, x, drives, inputs, .. } = &mut rig;
        for i in 0..5 {
            plant.implicit_step(1e-4 * f64::from(i), 1e-4, x, drives, inputs);
        }
    });
    assert_eq!(counts, [0, 0]);
    assert_eq!(rig.plant.take_fault(), None);
}

#[test]
fn cycles_of_the_simulated_robot() {
    for depth in 1..=5 {
        for integrator in [Integrator::Euler, Integrator::RungeKutta4, Integrator::SemiImplicit] {
            let mut setup = Setup::load(&root(None), "stand").unwrap();
            (setup.scene.depth, setup.scene.integrator, setup.scene.substeps) = (depth, integrator, 1);
            setup.scene.force_step = true;
            let mut sim = SimBackend::new(&setup.robot, &setup.scene).unwrap();
            let mut targets = JointTargets { mode: JointMode::Track as u64, ..JointTargets::default() };
            for (j, q) in setup.robot.poses[&setup.scene.start_pose].iter().enumerate() {
                targets.angle[j] = *q;
            }
            let mut frames = BusFrames::default();
            let counts = during(|| {
                for tick in 1..=5 {
                    targets.header.tick = tick;
                    encode_targets(
                        &setup.robot.layout,
                        &DriveCommand {
                            targets,
                            control: [if tick == 1 { 0x06 } else { 0x0F }; MAX_JOINTS],
                            ..DriveCommand::default()
                        },
                        &mut frames,
                    );
                    sim.step(
                        Some(&frames),
                        Some(&Power { toggle: tick, on: 1, arming: 1, ..Power::default() }),
                    );
                    sim.events().pop();
                }
            });
            assert_eq!(counts, [0, 0], "type {depth}, {integrator:?}");
        }
    }
}
