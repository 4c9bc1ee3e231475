//! Drives with a clock of their own: when they are sampled, what they refuse, what their integral carries.

use std::f64::consts::TAU;

use codec::frames::{DriveCommand, encode_targets};
use config::{Setup, root};
use drives::Transmission;
use messages::{BusFrames, JointMode, JointTargets, MAX_JOINTS, Power};
use sim_backend::SimBackend;

fn archie(cycle: f64, substeps: u32, depth: u8) -> Setup {
    let mut setup = Setup::load(&root(None), "archie_stand").unwrap();
    (setup.scene.cycle, setup.scene.substeps, setup.scene.depth) = (cycle, substeps, depth);
    setup
}

fn refusal(setup: &Setup) -> Option<String> {
    SimBackend::new(&setup.robot, &setup.scene).err().map(|error| error.to_string())
}

/// Cycles that are no multiple of 320 us, steps that are no fraction of 160 us.
#[test]
fn steps_and_cycles_that_miss_the_instants_are_refused() {
    for (cycle, substeps) in [(0.0035, 14), (0.001, 10), (0.00352, 14), (0.00352, 21), (0.00336, 21)] {
        let text = refusal(&archie(cycle, substeps, 3)).unwrap();
        for part in ["archie_stand", "each 160 us", "each 320 us", "substeps = ", "force_step"] {
            assert!(text.contains(part), "{part}: {text}");
        }
        // Joints that follow their targets have no drives to sample.
        assert_eq!(refusal(&archie(cycle, substeps, 1)), None);
        let mut forced = archie(cycle, substeps, 3);
        forced.scene.force_step = true;
        assert_eq!(refusal(&forced), None);
    }
    let text = refusal(&archie(0.0035, 14, 3)).unwrap();
    assert!(text.contains("take cycle = 0.00352 with substeps = 22"), "{text}");
    for (cycle, substeps) in [(0.00352, 22), (0.00352, 44), (0.00032, 2), (0.0032, 20)] {
        assert_eq!(refusal(&archie(cycle, substeps, 3)), None);
    }
}

/// Told to stay in the start pose, the robot stands on all types with motors, and sinks into points and pads alike; its
/// motors come back to within a count of where they are to be, whatever they carry.
#[test]
fn stands_by_its_drives_on_all_types_with_motors() {
    for depth in 2..=5 {
        let setup = archie(0.00352, 22, depth);
        let mut sim = SimBackend::new(&setup.robot, &setup.scene).unwrap();
        let (begin, pose) = (sim.integrated().to_vec(), &setup.robot.poses["stand"]);
        let mut frames = BusFrames::default();
        for tick in 1..400 {
            let mut targets = JointTargets { mode: JointMode::Track as u64, ..JointTargets::default() };
            targets.header.tick = tick;
            targets.angle[..pose.len()].copy_from_slice(pose);
            let control = [if tick == 1 { 0x06 } else { 0x0F }; MAX_JOINTS];
            encode_targets(
                &setup.robot.layout,
                &DriveCommand { targets, control, ..DriveCommand::default() },
                &mut frames,
            );
            sim.step(Some(&frames), Some(&Power { toggle: tick, on: 1, arming: 1, ..Power::default() }));
        }
        let (x, l) = (sim.integrated(), *sim.layout());
        let sunk = begin[2] - x[2];
        let worst = setup.robot.drives.iter().enumerate().map(|(k, drive)| {
            let joint = drive.joints[0];
            // The gears of hip rotations are stiff: their rotors have no state.
            let springs = setup.robot.drives[..k].iter().filter(|d| d.elasticity.is_some()).count();
            let elastic = l.elastic > 0 && drive.elasticity.is_some();
            let angle = if elastic { x[l.rotor_angle()][springs] } else { x[l.pose()][7 + joint] };
            let Transmission::Harmonic { ratio } = drive.transmission else { return 0.0 };
            ((angle - pose[joint]) * ratio).abs() / (TAU / 360.0)
        });
        let worst = worst.fold(0.0, f64::max);
        println!("type {depth}: torso {:.3} mm down, worst motor {worst:.2} counts off", 1e3 * sunk);
        assert!(sunk.abs() < 2e-3, "type {depth}: {sunk} m");
        assert!(worst < 1.5, "type {depth}: {worst} counts");
    }
}
