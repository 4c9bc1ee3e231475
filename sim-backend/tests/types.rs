//! Every type of model as a robot at the end of the bus: repeatable, harmless when the supply fails, and never a number
//! that is none.

use codec::frames::{DriveCommand, encode_targets};
use config::brake::Brake;
use config::method::Integrator;
use config::{Setup, root};
use messages::command::PushCommand;
use messages::{BusFrames, EventCode, JointMode, JointTargets, MAX_JOINTS, Power, SimState};
use sim_backend::SimBackend;

const KNEE: usize = 5;

fn setup(depth: u8) -> Setup {
    let mut setup = Setup::load(&root(None), "stand").unwrap();
    setup.scene.depth = depth;
    setup.scene.integrator = Integrator::SemiImplicit;
    setup.scene.substeps = 4;
    setup
}

/// Cycles from tick `from` to before `to`, with the supply on or not, to targets changed by `change`.
fn cycles(
    sim: &mut SimBackend,
    setup: &Setup,
    [from, to]: [u64; 2],
    on: bool,
    change: impl Fn(u64, &mut JointTargets),
) -> Option<EventCode> {
    let mut frames = BusFrames::default();
    let mut event = None;
    for tick in from..to {
        let mut targets = JointTargets { mode: JointMode::Track as u64, ..JointTargets::default() };
        targets.header.tick = tick;
        for (j, q) in setup.robot.poses[&setup.scene.start_pose].iter().enumerate() {
            targets.angle[j] = *q;
        }
        change(tick, &mut targets);
        encode_targets(
            &setup.robot.layout,
            &DriveCommand {
                targets,
                control: [if tick == from { 0x06 } else { 0x0F }; MAX_JOINTS],
                ..DriveCommand::default()
            },
            &mut frames,
        );
        let (answer, truth) = sim
            .step(Some(&frames), Some(&Power { toggle: tick, on: on.into(), arming: 1, ..Power::default() }));
        assert!(finite(truth), "cycle {tick}: {truth:?}");
        assert!(answer.count > 0);
        event = event.or(sim.events().pop().map(|e| e.0));
    }
    event
}

fn finite(s: &SimState) -> bool {
    let wrench = s.foot_wrench.iter().flat_map(|w| w.force.into_iter().chain(w.moment));
    let rest =
        [&s.position[..], &s.orientation, &s.velocity, &s.angular_velocity, &s.com, &s.joint_angle[..24]];
    wrench.chain(s.feet.into_iter().flatten()).chain(rest.concat()).all(f64::is_finite)
}

#[test]
fn two_runs_are_bit_for_bit_the_same() {
    for depth in 1..=5 {
        let setup = setup(depth);
        let run = || {
            let mut sim = SimBackend::new(&setup.robot, &setup.scene).unwrap();
            let swing = |tick: u64, t: &mut JointTargets| t.angle[3] += 0.02 * (0.02 * tick as f64).sin();
            assert_eq!(cycles(&mut sim, &setup, [1, 60], true, swing), None, "type {depth}");
            (*sim.state(), sim.integrated().to_vec())
        };
        assert_eq!(run(), run(), "type {depth}");
    }
}

/// Targets that jump between the ends of what a frame can say, and what is no number: the robot falls at worst.
#[test]
fn wild_targets_leave_numbers() {
    for depth in 1..=5 {
        let setup = setup(depth);
        let mut sim = SimBackend::new(&setup.robot, &setup.scene).unwrap();
        let wild = |tick: u64, t: &mut JointTargets| {
            let angle = [1e300, f64::NAN, -1e300, f64::INFINITY][tick as usize % 4];
            (t.angle, t.speed) = ([angle; messages::MAX_JOINTS], [-angle; messages::MAX_JOINTS]);
        };
        cycles(&mut sim, &setup, [1, 40], true, wild);
        assert!(sim.integrated().iter().all(|x| x.is_finite()), "type {depth}");
    }
}

/// A force that no number can follow: the robot stops where it last was, and says so.
#[test]
fn what_diverges_is_reported_and_held() {
    for depth in 1..=5 {
        let setup = setup(depth);
        for force in [1e300, f64::NAN, f64::INFINITY] {
            let mut sim = SimBackend::new(&setup.robot, &setup.scene).unwrap();
            cycles(&mut sim, &setup, [1, 4], true, |_, _| {});
            let before = sim.state().position;
            sim.push(&PushCommand { force: [force, 0.0, 0.0], duration: 0.01 });
            let mut frames = BusFrames::default();
            let mut event = None;
            for tick in 4..8 {
                frames.header.tick = tick;
                sim.step(Some(&frames), Some(&Power { toggle: tick, on: 1, arming: 1, ..Power::default() }));
                event = event.or(sim.events().pop().map(|e| e.0));
            }
            assert_eq!(event, Some(EventCode::Diverged), "type {depth}, {force} N");
            assert!(sim.integrated().iter().all(|x| x.is_finite()), "type {depth}, {force} N");
            assert!((sim.state().position[0] - before[0]).abs() < 1e-3, "type {depth}, {force} N");
        }
    }
}

/// The supply fails on the ground, no drive has a brake: legs with motors fold; one second later the robot is down.
#[test]
fn without_brakes_a_standing_robot_collapses() {
    for depth in 2..=3 {
        let setup = setup(depth);
        let mut sim = SimBackend::new(&setup.robot, &setup.scene).unwrap();
        cycles(&mut sim, &setup, [1, 50], true, |_, _| {});
        let before = sim.state().joint_angle[KNEE];
        cycles(&mut sim, &setup, [50, 1050], false, |_, _| {});
        let given = (sim.state().joint_angle[KNEE] - before).abs();
        assert!(given > 0.5 && sim.state().fallen == 1, "type {depth}: the knee gives way by {given} rad");
    }
}

/// A brake holds its delay after the torque has gone, and not before.
#[test]
fn a_brake_closes_after_its_delay() {
    let given = [0.0, 0.05].map(|delay| {
        let mut setup = setup(2);
        brakes(&mut setup, delay);
        let mut sim = SimBackend::new(&setup.robot, &setup.scene).unwrap();
        cycles(&mut sim, &setup, [1, 50], true, |_, _| {});
        let before = sim.state().joint_angle[KNEE];
        cycles(&mut sim, &setup, [50, 100], false, |_, _| {});
        let early = (sim.state().joint_angle[KNEE] - before).abs();
        cycles(&mut sim, &setup, [100, 250], false, |_, _| {});
        let held = sim.state().joint_angle[KNEE];
        cycles(&mut sim, &setup, [250, 500], false, |_, _| {});
        assert!((sim.state().joint_angle[KNEE] - held).abs() < 1e-3, "held after {delay} s");
        early
    });
    assert!(given[0] < 1e-3 && given[1] > 0.01, "{given:?}");
}

/// Brakes that hold what the motors could hold.
fn brakes(setup: &mut Setup, delay: f64) {
    for drive in &mut setup.robot.drives {
        drive.brake = Some(Brake { torque: drive.motor.torque(drive.current_limit), delay });
    }
}

/// The supply fails on the ground: brakes hold, the robot stays up.
#[test]
fn brakes_hold_a_standing_robot() {
    for depth in 1..=5 {
        let mut setup = setup(depth);
        brakes(&mut setup, 0.0);
        let mut sim = SimBackend::new(&setup.robot, &setup.scene).unwrap();
        cycles(&mut sim, &setup, [1, 50], true, |_, _| {});
        let before = *sim.state();
        let end = if depth > 3 { 250 } else { 2050 };
        cycles(&mut sim, &setup, [50, end], false, |_, _| {});
        let after = *sim.state();
        assert_eq!((after.power, after.fallen), (0, 0), "type {depth}");
        for (j, (a, b)) in before.joint_angle.iter().zip(after.joint_angle).enumerate() {
            assert!((a - b).abs() < 0.01, "type {depth}: joint {j} gives way by {} rad", a - b);
        }
        let carried: f64 = after.foot_wrench.iter().map(|w| w.force[2]).sum();
        assert!((carried - 60.885 * 9.81).abs() < 10.0, "type {depth}: {carried} N");
        // What the sensors see of it is a robot that rests, too.
        let mut sensors = messages::Sensors::default();
        codec::frames::decode_sensors(&setup.robot.layout, sim.step(None, None).0, &mut sensors);
        let felt = sensors.imu.acceleration;
        assert!((felt[2] - 9.81).abs() < 0.05 && felt[0].hypot(felt[1]) < 0.2, "type {depth}: {felt:?}");
    }
}

/// Standing, the contact points of every type are the outlines of the soles; with the robot in the air there are none.
#[test]
fn contact_points_are_the_soles_that_stand() {
    for depth in [1, 4] {
        let setup = setup(depth);
        let mut sim = SimBackend::new(&setup.robot, &setup.scene).unwrap();
        cycles(&mut sim, &setup, [1, 20], true, |_, _| {});
        let state = sim.state();
        let foot = &setup.robot.feet[0];
        // Pads are smaller than the sole's points reach: their outlines from their middles and size.
        let places = if depth == 1 { &foot.points } else { &foot.pads };
        let size = setup.robot.contact.pads.unwrap().size;
        let half = if depth == 1 { [0.0; 2] } else { [0.5 * size[0], 0.5 * size[1]] };
        let sole = foot.sole;
        let front = places.iter().map(|(_, at)| at[0]).fold(f64::MIN, f64::max) + half[0] - sole[0];
        let side = places.iter().map(|(_, at)| at[1]).fold(f64::MIN, f64::max) + half[1];
        assert_eq!(state.carrying().len(), if depth == 1 { 16 } else { 32 }, "type {depth}");
        for (k, foot) in state.feet.iter().enumerate() {
            let of_foot: Vec<_> =
                state.carrying().iter().filter(|c| (c.place[1] - foot[1]).abs() < 0.1).collect();
            let most = |axis: usize| {
                let own = |c: &&messages::ContactPoint| c.place[axis] - foot[axis];
                of_foot.iter().map(own).fold(f64::MIN, f64::max)
            };
            assert!((most(0) - front).abs() < 2e-3, "type {depth}, foot {k}: {} {front}", most(0));
            assert!((most(1) - side).abs() < 2e-3, "type {depth}, foot {k}: {} {side}", most(1));
            let upright = |n: [f64; 3]| n[0].hypot(n[1]) < 1e-9 && (n[2] - 1.0).abs() < 1e-9;
            assert!(of_foot.iter().all(|c| c.place[2].abs() < 2e-4 && upright(c.normal)), "type {depth}");
        }
    }
    let hanging = Setup::load(&root(None), "startup").unwrap();
    let sim = SimBackend::new(&hanging.robot, &hanging.scene).unwrap();
    assert_eq!((sim.state().contacts, sim.state().contact[0].normal), (0, [0.0; 3]));
}
