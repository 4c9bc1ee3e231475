//! Stops and starts in any cycle: what a velocity of zero ends, and what follows standing up.

use crate::robot::{self, Random, Robot};
use config::Gait;
use messages::command::{DistanceCommand, PlatformCommand, StepCommand, VelocityCommand};
use messages::{Command, EventCode, GaitState, Plan};

/// \[s\] Nothing happens in most cycles, so they are long.
const CYCLE: f64 = 0.01;
const ZERO: Command = Command::Velocity(VelocityCommand { forward: 0.0, left: -0.0, turn: 0.0 });
const SLOW: Command = Command::Velocity(VelocityCommand { forward: 0.28, left: 0.0, turn: 0.0 });

fn distance(distance: f64) -> Command {
    Command::Distance(DistanceCommand { distance, speed: 0.25, acceleration: 0.3 })
}

/// Any command that moves her, or changes how.
fn any(random: &mut Random) -> Command {
    match random.below(9) {
        0 => Command::Stand,
        1 => Command::Start,
        2 => Command::Step(StepCommand {
            length: random.range([-0.2, 0.5]),
            side: 0.0,
            turn: random.range([-0.1, 0.1]),
            duration: random.range([0.8, 1.2]),
        }),
        3 | 4 => Command::Velocity(VelocityCommand {
            forward: random.range([-0.1, 0.6]),
            left: random.range([-0.1, 0.1]),
            turn: random.range([-0.2, 0.2]),
        }),
        5 | 6 => distance(random.range([-1.0, 3.0])),
        _ => Command::Platform(PlatformCommand {
            distance: random.range([0.3, 1.5]),
            height: random.range([-0.15, 0.15]),
        }),
    }
}

/// No time, a moment, or some steps.
fn pause(r: &mut Robot, random: &mut Random) {
    let longest = [0.0, 0.3, 6.0][random.below(3) as usize];
    r.run(random.range([0.0, longest]));
}

fn is_still(plan: &Plan) -> bool {
    plan.state == GaitState::Standing as u64 || plan.state == GaitState::Stopping as u64
}

/// Told to stand, then this and that, then to stop; at rest some time later.
fn stopped(seed: u64, gait: &Gait, stop: Command) -> Robot {
    let mut random = Random::new(seed);
    let mut r = Robot::with_cycle(gait, CYCLE);
    r.step(&[Command::Stand]);
    pause(&mut r, &mut random);
    for _ in 0..random.below(4) {
        r.step(&[any(&mut random)]);
        pause(&mut r, &mut random);
    }
    let last = any(&mut random);
    if random.below(3) == 0 {
        r.step(&[last, stop]);
    } else {
        r.step(&[last]);
        pause(&mut r, &mut random);
        r.step(&[stop]);
    }
    let told = r.tick;
    while r.active.id == 0 || r.time() <= r.active.end() || r.next.is_some() {
        assert!(r.tick < told + 2000, "run {seed}: does not come to rest after {stop:?}");
        r.step(&[]);
    }
    r.run(2.0);
    let after = || r.plans.iter().filter(|p| p.header.tick >= told);
    assert!(after().all(|p| is_still(p)), "run {seed}: walks on after {stop:?}");
    assert!(r.time() > r.active.end() && r.next.is_none(), "run {seed}: does not stand after {stop:?}");
    r
}

/// It once ended the steps only: a distance was walked to its end, or begun if it waited.
#[test]
fn a_velocity_of_zero_is_a_stop_whatever_she_does() {
    let gait = robot::gait();
    for seed in 0..200 {
        let [stop, zero] = [Command::Stop, ZERO].map(|stop| stopped(seed, &gait, stop));
        assert!(stop.plans == zero.plans && stop.events == zero.events, "run {seed}: they differ");
    }
}

/// A velocity replaces a distance that still waits for the robot to stand.
#[test]
fn a_velocity_takes_the_place_of_a_waiting_distance() {
    for wait in (0..100).step_by(7) {
        let mut r = Robot::with_cycle(&robot::gait(), CYCLE);
        r.stand();
        r.step(&[SLOW]);
        r.run(4.0);
        r.step(&[distance(0.3)]);
        r.run(wait as f64 * CYCLE);
        r.step(&[SLOW]);
        // Longer than the distance would take.
        r.run(12.0);
        assert_eq!(r.active.state, GaitState::Walking as u64, "{wait} cycles later: walks");
        r.step(&[ZERO]);
        let told = r.tick;
        r.run(10.0);
        assert!(r.time() > r.active.end(), "{wait} cycles later: stands");
        let after = || r.plans.iter().filter(|p| p.header.tick >= told);
        assert!(after().all(|p| is_still(p)), "{wait} cycles later: walks again");
    }
}

/// A distance that comes while the plan of a walk waits for its begin: a stop, the distance, and she stands.
#[test]
fn a_distance_right_behind_a_velocity_is_walked() {
    for wait in 0..40 {
        let mut r = Robot::with_cycle(&robot::gait(), 1e-3);
        r.stand();
        r.step(&[SLOW]);
        r.run(f64::from(wait) * 1e-3);
        r.step(&[distance(0.6)]);
        r.run(20.0);
        assert!(r.time() > r.active.end(), "{wait} ms later: stands");
        assert!(r.active.state == GaitState::Standing as u64 || is_still(&r.active), "{wait} ms later");
        let starts = r.plans.iter().filter(|p| p.state == GaitState::Starting as u64).count();
        assert_eq!(starts, 2, "{wait} ms later: the walk, then the distance");
    }
}

/// Told to stand in the first cycle and the others this many cycles later, in a pose that is measured from a cycle on.
fn crouching(gait: &Gait, told: &[(u64, Command)], measured: u64) -> Robot {
    let mut r = Robot::with_cycle(gait, CYCLE);
    let com = std::mem::replace(&mut r.state.com[0], f64::NAN);
    for cycle in 0..60 {
        if cycle == measured {
            r.state.com[0] = com;
        }
        let stand = (cycle == 0).then_some(Command::Stand);
        let due = told.iter().filter(|(at, _)| *at == cycle).map(|(_, command)| *command);
        let due: Vec<Command> = stand.into_iter().chain(due).collect();
        r.step(&due);
    }
    let refused = r.events.iter().any(|e| e.1 == EventCode::CommandRefused);
    assert!(!refused, "{told:?}, measured from cycle {measured} on: {:?}", r.events);
    r
}

/// Both in one cycle were accepted, and then she did nothing for ever.
#[test]
fn who_is_told_to_stand_and_to_walk_stands_and_walks() {
    let gait = robot::gait();
    for then in [Command::Start, SLOW, distance(0.4)] {
        for measured in [0, 5, 30] {
            for later in 0..14 {
                let case = format!("{then:?} {later} cycles later, measured from cycle {measured} on");
                let mut r = crouching(&gait, &[(later, then)], measured);
                r.run(3.0);
                let begun: Vec<u64> = r.plans.iter().take(2).map(|p| p.state).collect();
                assert_eq!(begun, [GaitState::Standing as u64, GaitState::Starting as u64], "{case}");
                r.run(10.0);
                let walks = r.active.state == GaitState::Walking as u64;
                assert_eq!(walks, !matches!(then, Command::Distance(_)), "{case}");
            }
        }
    }
}

/// A velocity of zero took back the standing, too.
#[test]
fn a_stop_before_she_stands_leaves_the_standing() {
    let gait = robot::gait();
    let mut random = Random::new(3);
    for stop in [Command::Stop, ZERO] {
        for then in [None, Some(Command::Start), Some(SLOW), Some(distance(0.4))] {
            for _ in 0..8 {
                let later = random.below(10);
                let told = [then.map(|then| (later, then)), Some((later + random.below(10), stop))];
                let told: Vec<(u64, Command)> = told.into_iter().flatten().collect();
                let measured = random.below(40);
                let mut r = crouching(&gait, &told, measured);
                r.run(5.0);
                let states: Vec<u64> = r.plans.iter().map(|p| p.state).collect();
                assert_eq!(states, [GaitState::Standing as u64], "{told:?}, measured from {measured} on");
            }
        }
    }
}

/// Regression: of two distances that were accepted one was walked.
#[test]
fn a_distance_that_waits_is_not_replaced() {
    for wait in [0, 1, 50] {
        let mut r = Robot::with_cycle(&robot::gait(), CYCLE);
        r.stand();
        let refused = |r: &Robot| r.events.iter().filter(|e| e.1 == EventCode::CommandRefused).count();
        if wait == 0 {
            r.step(&[distance(0.6), distance(0.2)]);
        } else {
            // One is walked, one waits for its end, and the third is refused.
            r.step(&[distance(0.2)]);
            r.run(3.0);
            r.step(&[distance(0.6)]);
            assert_eq!(refused(&r), 0);
            r.run(wait as f64 * CYCLE);
            r.step(&[distance(0.2)]);
        }
        assert_eq!(refused(&r), 1, "{wait} cycles later");
    }
}

/// Regression: steps that were told during a distance made it a walk without an end.
#[test]
fn other_steps_do_not_end_a_distance_and_a_start_does() {
    let step = Command::Step(StepCommand { length: 0.2, side: 0.0, turn: 0.0, duration: 0.8 });
    for (command, walks) in [(step, false), (Command::Start, true), (SLOW, true)] {
        let mut r = Robot::with_cycle(&robot::gait(), CYCLE);
        r.stand();
        r.step(&[distance(1.0)]);
        r.run(2.0);
        r.step(&[command]);
        r.run(20.0);
        assert_eq!(r.active.state == GaitState::Walking as u64, walks, "{command:?}");
    }
}

/// Regression: a distance faster than the gait was refused for a foothold that was missing on an empty floor.
#[test]
fn a_distance_that_is_too_fast_is_refused_with_the_limit() {
    let gait = robot::gait();
    for (metres, speed) in [(1.0, 3.0), (-1.0, 1.5)] {
        let mut r = Robot::with_cycle(&gait, CYCLE);
        r.stand();
        let command = Command::Distance(DistanceCommand { distance: metres, speed, acceleration: 0.3 });
        let output = r.planner.step(r.tick + 1, CYCLE, Some(&r.state), &[command]);
        let [Err(messages::Reason::Limit { field: 1, low, high })] = output.answers[..] else {
            panic!("{:?}", output.answers);
        };
        assert!(low == 0.0 && high > 0.05 && high < speed, "{high}");
    }
}
