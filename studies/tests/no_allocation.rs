//! Neither the plans of a pattern nor the open loop that walks them allocate after the start, nor do boxes that are told.

use config::{Gait, Robot, root};
use controller::Controller;
use messages::command::{BoxCommand, GoneCommand, MAX_BOXES, VelocityCommand};
use messages::{Command, ControllerState, GaitState, Plan, Sensors};
use planner::Planner;
use realtime::{CountingAllocator, allocations};

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

#[test]
fn a_pattern_is_planned_and_walked_in_the_memory_made_at_the_start() {
    let robot = Robot::load(&root(None).join("robots/archie")).unwrap();
    let gait = Gait::load(&root(None).join("gaits/archie_static.toml")).unwrap();
    let cycle = 0.01;
    let mut planner = Planner::of(&gait, &robot).unwrap();
    let mut controller = Controller::new(&robot, &gait, cycle).unwrap();
    let mut sensors = Sensors { power: 1, ..Sensors::default() };
    sensors.imu.orientation = [0.0, 0.0, 0.0, 1.0];
    sensors.joint_angle[..robot.joints.len()].copy_from_slice(&robot.poses["stand"]);
    let mut plan = Box::new(Plan::default());
    let mut state = ControllerState::default();
    let forward = Command::Velocity(VelocityCommand { forward: 0.0208, left: 0.0, turn: 0.0 });

    allocations::arm();
    let (mut plans, mut walked) = (0, false);
    for tick in 1..6000u64 {
        let command = match tick {
            20 => Some(Command::Stand),
            300 => Some(forward),
            3000 => Some(Command::Stop),
            _ => None,
        };
        sensors.header.tick = tick;
        if let Some(new) = planner.step(tick, cycle, (tick > 1).then_some(&state), command.as_slice()).plan {
            *plan = *new;
            plans += 1;
        }
        let (targets, now) = controller.step(&sensors, (plan.id > 0).then_some(&*plan));
        (sensors.joint_angle, sensors.joint_speed, state) = (targets.angle, targets.speed, *now);
        walked |= GaitState::from(state.gait) == GaitState::Walking;
    }
    let [counted, _] = allocations::counted();
    assert_eq!(counted, 0);
    assert!(walked && plans >= 4, "{plans} plans");

    drop(Box::new(std::hint::black_box(1)));
    assert!(allocations::counted()[0] > 0, "the counter counts");
}

/// All places taken, moved, lapsed and left, refused ones too, while plans are made over them.
#[test]
fn boxes_that_come_and_go_are_planned_with_in_the_memory_made_at_the_start() {
    let robot = Robot::load(&root(None).join("robots/lola")).unwrap();
    let gait = Gait::load(&root(None).join("gaits/lola.toml")).unwrap();
    let cycle = 0.001;
    let mut planner = Planner::of(&gait, &robot).unwrap();
    let mut state = ControllerState { com: [-0.06, 0.0, 0.85], ..ControllerState::default() };
    state.feet = [[0.0, -0.1, 0.0, 0.0], [0.0, 0.1, 0.0, 0.0]];
    let mut plan = Box::new(Plan::default());
    let mut next: Option<u64> = None;

    allocations::arm();
    let (mut plans, mut refused) = (0, 0);
    for tick in 1..16_000u64 {
        // One after the other, 0.2 m apart, across the way of both feet and beside it.
        let id = (tick / 50 % (MAX_BOXES as u64 + 2)) as u32;
        let base = [1.5 + 0.2 * f64::from(id), 0.1 * f64::from(id % 5), 0.0];
        let told = BoxCommand { id, base, yaw: 0.3, size: [0.05, 0.5, 0.06], lifetime: 3.0 };
        let command = match tick {
            20 => Some(Command::Stand),
            2500 => Some(Command::Velocity(VelocityCommand { forward: 0.2, left: 0.0, turn: 0.0 })),
            _ if tick % 50 == 0 => Some(Command::Box(told)),
            _ if tick % 170 == 0 => Some(Command::Gone(GoneCommand { id })),
            _ => None,
        };
        state.header.tick = tick;
        let output = planner.step(tick, cycle, Some(&state), command.as_slice());
        refused += output.answers.iter().filter(|answer| answer.is_err()).count();
        output.events.drain().for_each(drop);
        if let Some(new) = output.plan {
            (*plan, next, plans) = (*new, Some(new.start_tick), plans + 1);
        }
        // A controller that follows perfectly.
        if next.is_some_and(|start| start <= tick) {
            state.plan_id = plan.id;
            state.gait = plan.state;
        }
    }
    assert_eq!(allocations::counted()[0], 0);
    assert!(plans >= 8 && refused >= 10, "{plans} plans, {refused} refused");
}
