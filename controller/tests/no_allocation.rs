//! Nothing allocates after the controller is made, camera head, arms and tables for drives included.

use config::{Gait, Robot, root};
use controller::Controller;
use curves::{Path, Sample};
use messages::command::{FixateCommand, HeadJointsCommand};
use messages::{Command, EventCode, GaitState, Plan, Sensors};
use realtime::{CountingAllocator, allocations};

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

#[test]
fn a_cycle_works_in_the_memory_made_at_the_start() {
    let robot = Robot::load(&root(None).join("robots/lola")).unwrap();
    let mut gait = Gait::load(&root(None).join("gaits/lola.toml")).unwrap();
    gait.arm_swing = Some(1.0);
    let mut controller = Controller::new(&robot, &gait, 1e-3).unwrap();
    let mut sensors = Sensors { power: 1, ..Sensors::default() };
    sensors.imu.orientation = [0.0, 0.0, 0.0, 1.0];
    sensors.joint_angle[..robot.joints.len()].copy_from_slice(&robot.poses["stand"]);
    for wrench in &mut sensors.foot_wrench {
        wrench.force[2] = 298.6;
    }
    let state = *controller.step(&sensors, None).1;
    // Standing, the stabilizer would learn its inclination from forces that do not move this robot.
    let mut plan =
        Box::new(Plan { id: 1, start_tick: 2, state: GaitState::Walking as u64, ..Plan::default() });
    let to = std::array::from_fn(|d| state.com[d] + [0.02, 0.03, -0.06][d]);
    plan.body = Path::resting(0.0, state.com);
    assert!(plan.body.push(&Sample::rest(state.com), &Sample::rest(to), 1.5));
    plan.torso = Path::resting(0.0, [std::f64::consts::FRAC_PI_2, std::f64::consts::FRAC_PI_2, 0.0]);
    plan.feet = state.feet.map(|f| Path::resting(0.0, f));
    plan.zmp.push(0.0, [state.com[0], state.com[1]]);
    plan.load_left = Path::resting(0.0, [0.5]);

    allocations::arm();
    let (mut saccades, mut refused, mut held) = (0, 0, 0);
    for k in 1..2400u64 {
        let command = match k {
            300 => Some(Command::Fixate(FixateCommand { point: [2.0, 1.0, 1.0] })),
            800 => Some(Command::Fixate(FixateCommand { point: [-2.0, 0.1, 9.0] })),
            1200 => Some(Command::HeadJoints(HeadJointsCommand { pan: 9.0, tilt: 0.0 })),
            2000 => Some(Command::HeadRest),
            _ => None,
        };
        refused += usize::from(command.and_then(|c| controller.command(&c)).is_some());
        sensors.header.tick += 1;
        let targets = controller.step(&sensors, Some(&plan)).0;
        (sensors.joint_angle, sensors.joint_speed) = (targets.angle, targets.speed);
        for (code, _) in controller.events().drain() {
            saccades += usize::from(code == EventCode::Saccade);
            held += usize::from(code == EventCode::GazeHeld);
        }
    }
    let [counted, _] = allocations::counted();
    assert_eq!(counted, 0);
    assert_eq!((saccades, refused, held), (3, 1, 1), "all that was to be looked at happened");

    drop(Box::new(std::hint::black_box(1)));
    assert!(allocations::counted()[0] > 0, "the counter counts");
}

/// A pattern gait whose tables are filled, published and followed.
#[test]
fn tables_are_filled_in_the_memory_made_at_the_start() {
    let setup = config::Setup::load(&root(None), "archie_tables").unwrap();
    let mut controller = Controller::new(&setup.robot, &setup.gait, setup.scene.cycle).unwrap();
    let mut sensors = Sensors { power: 1, ..Sensors::default() };
    sensors.joint_angle[..12].copy_from_slice(&setup.robot.poses["stand"]);
    let state = *controller.step(&sensors, None).1;
    let mut plan =
        Box::new(Plan { id: 1, start_tick: 400, state: GaitState::Standing as u64, ..Plan::default() });
    let from: [f64; 3] = state.torso;
    plan.body = Path::resting(0.0, from);
    let to = [from[0], from[1], from[2] - 0.02];
    assert!(plan.body.push(&Sample::rest(from), &Sample::rest(to), 30.0));
    plan.torso = Path::resting(0.0, [std::f64::consts::FRAC_PI_2, std::f64::consts::FRAC_PI_2, 0.0]);
    plan.feet = state.feet.map(|f| Path::resting(0.0, f));
    plan.load_left = Path::resting(0.0, [0.5]);

    allocations::arm();
    let (mut points, mut active) = (0, false);
    for _ in 1..1000u64 {
        sensors.header.tick += 1;
        let targets = controller.step(&sensors, Some(&plan)).0;
        (sensors.joint_angle, sensors.joint_speed) = (targets.angle, targets.speed);
        points += controller.tables().map_or(0, |tables| tables.points);
        active |= controller.events().drain().any(|(code, _)| code == EventCode::PlanActive);
    }
    let [counted, _] = allocations::counted();
    assert_eq!(
        (counted, points, active),
        (0, 377, true),
        "30 s are 375 times 80 ms, and the last point stands twice"
    );
}
