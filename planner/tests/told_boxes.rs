//! Boxes that come and go while she walks, with a controller that follows perfectly.

use crate::robot::checks::*;
use crate::robot::{self, CYCLE, Random, Robot};
use messages::command::{BoxCommand, GoneCommand, MAX_BOXES, VelocityCommand};
use messages::{Command, EventCode, GaitState, Plan, Reason};

const SLOW: Command = Command::Velocity(VelocityCommand { forward: 1.0 / 3.6, left: 0.0, turn: 0.0 });
const BAR: BoxCommand =
    BoxCommand { id: 1, base: [1.5, 0.0, 0.0], yaw: 0.0, size: [0.06, 2.0, 0.1], lifetime: 60.0 };
/// Too high to be stepped over.
const WALL: BoxCommand = BoxCommand { size: [0.06, 2.0, 0.5], ..BAR };

/// A robot that stands.
fn standing() -> Robot {
    let mut r = Robot::new(&robot::gait());
    r.stand();
    r
}

fn gait(r: &Robot) -> GaitState {
    if r.time() > r.active.end() { GaitState::Standing } else { GaitState::from(r.active.state) }
}

/// Answer of the planner to a command.
fn answer(r: &mut Robot, command: Command) -> Result<(), Reason> {
    r.tick += 1;
    r.planner.step(r.tick, CYCLE, Some(&r.state), &[command]).answers[0]
}

/// x in I_0 of the foremost sole.
fn front(r: &Robot) -> f64 {
    let x = |i: usize| outer(r.active.origin, [r.state.feet[i][0], r.state.feet[i][1]])[0];
    x(0).max(x(1))
}

/// Plans are continuous, balanced, and end standing.
fn check(plans: &[Box<Plan>]) {
    let gait = robot::gait();
    for p in plans {
        assert!(zmp_margin(p) > -1e-6, "plan {}: {}", p.id, zmp_margin(p));
        assert!(unrest(p, &gait) < 1e-9, "plan {} does not end standing", p.id);
    }
    for pair in plans.windows(2) {
        let seam = seam(&pair[0], &pair[1]);
        assert!(seam < 1e-9, "plans {} and {} differ by {seam}", pair[0].id, pair[1].id);
    }
}

/// The step that is under way when a box appears stays as it is; the next plan begins at its end and is another one.
#[test]
fn a_box_is_planned_with_from_the_next_step_boundary_on() {
    let mut r = standing();
    r.step(&[SLOW]);
    r.run(3.0);
    let (plan, at, count) = (r.active.id, front(&r), r.plans.len());
    // Where the next foot lands, and too high for it.
    r.step(&[Command::Box(BoxCommand { base: [at + 0.3, 0.0, 0.0], ..WALL })]);
    let end = r.active.start_tick + (r.active.steps[0].end / CYCLE).round() as u64;
    while r.active.id == plan {
        r.step(&[]);
    }
    assert_eq!(r.active.start_tick, end, "the step that was under way was left");
    assert_eq!(GaitState::from(r.active.state), GaitState::Stopping);
    assert!(r.events.iter().any(|e| e.1 == EventCode::ObstacleTooHigh), "{:?}", r.events);
    r.run(6.0);
    check(&r.plans[count - 1..]);
    assert_eq!(gait(&r), GaitState::Standing);
}

#[test]
fn a_box_vanishes_by_itself_or_when_it_is_told() {
    for (lifetime, told) in [(60.0, None), (2.0, None), (60.0, Some(5000)), (2.0, Some(1500))] {
        let mut r = standing();
        r.step(&[Command::Box(BoxCommand { lifetime, ..WALL })]);
        let begun = r.tick;
        // As a vision system that repeats its velocity ten times a second.
        for k in 1..=20_000u64 {
            let gone = told == Some(k);
            let commands = [Command::Gone(GoneCommand { id: WALL.id }), SLOW];
            let (from, to) = (usize::from(!gone), 1 + usize::from(k % 100 == 0));
            r.step(commands.get(from..to).unwrap_or(&[]));
            assert!(r.tick > begun);
        }
        let stays = (lifetime, told) == (60.0, None);
        assert_eq!(front(&r) < 1.47, stays, "lifetime {lifetime} s, told {told:?}: at {} m", front(&r));
    }
}

/// Told again in time it stays, and is where it was told last.
#[test]
fn a_box_that_is_told_again_lives_on_and_moves() {
    let mut r = standing();
    for k in 0..20_000u64 {
        let x = if k < 4000 { 1.5 } else { 2.5 };
        let seen = Command::Box(BoxCommand { base: [x, 0.0, 0.0], lifetime: 0.5, ..WALL });
        match k % 400 {
            0 => r.step(&[seen, SLOW]),
            _ => r.step(&[]),
        }
    }
    let at = front(&r);
    assert!(at > 1.5 && at < 2.47, "{at} m");
}

#[test]
fn a_number_out_of_its_range_is_refused_by_name() {
    let mut r = standing();
    let wrong = [
        (BoxCommand { id: 0, ..BAR }, "id = 0 : at least 1"),
        (BoxCommand { id: MAX_BOXES as u32 + 1, ..BAR }, "id = 33 : at most 32"),
        (BoxCommand { base: [f64::NAN, 0.0, 0.0], ..BAR }, "x = NaN m: must lie in [-1000, 1000]"),
        (BoxCommand { base: [0.0, f64::INFINITY, 0.0], ..BAR }, "y = inf m: at most 1000"),
        (BoxCommand { size: [0.0, 1.0, 1.0], ..BAR }, "length = 0 m: at least 0.001"),
        (BoxCommand { lifetime: 61.0, ..BAR }, "lifetime = 61 s: at most 60"),
        (BoxCommand { lifetime: 0.0, ..BAR }, "lifetime = 0 s: at least 0.1"),
    ];
    for (told, words) in wrong {
        let command = Command::Box(told);
        assert_eq!(answer(&mut r, command).unwrap_err().text(&command), words);
    }
    let gone = Command::Gone(GoneCommand { id: 33 });
    assert_eq!(answer(&mut r, gone).unwrap_err().text(&gone), "id = 33 : at most 32");
    assert_eq!(answer(&mut r, Command::Gone(GoneCommand { id: 32 })), Ok(()), "it need not have been there");
    // All places taken: none is one too many, and each can be told again.
    for id in (1..=MAX_BOXES as u32).chain(1..=MAX_BOXES as u32) {
        assert_eq!(answer(&mut r, Command::Box(BoxCommand { id, ..BAR })), Ok(()), "{id}");
    }
    // A gait that steps over nothing says so.
    let mut gait = robot::gait();
    gait.obstacles = None;
    let mut r = Robot::new(&gait);
    let text = answer(&mut r, Command::Box(BAR)).unwrap_err().text(&Command::Box(BAR));
    assert!(text.contains("no [obstacles]"), "{text}");
}

/// Boxes anywhere, under her feet too, at any time: whatever plan there is can be walked.
#[test]
fn boxes_at_random_never_make_a_plan_that_falls() {
    let (mut stopped, mut walked) = (0, 0.0f64);
    for seed in 0..20 {
        let (mut random, mut r) = (Random::new(seed), standing());
        for _ in 0..150 {
            let id = 1 + random.below(6) as u32;
            let at = [0.3 + front(&r) + random.range([-0.8, 1.5]), random.range([-0.6, 0.6]), 0.0];
            let size = [random.range([0.02, 0.3]), random.range([0.02, 1.0]), random.range([0.01, 0.3])];
            let (yaw, lifetime) = (random.range([-3.2, 3.2]), random.range([0.1, 4.0]));
            let told = Command::Box(BoxCommand { id, base: at, yaw, size, lifetime });
            let go = |turn: f64| Command::Velocity(VelocityCommand { forward: 0.3, left: 0.0, turn });
            match random.below(4) {
                0 => r.step(&[told]),
                1 => r.step(&[Command::Gone(GoneCommand { id })]),
                _ => r.step(&[go(random.range([-0.1, 0.1]))]),
            }
            r.run(random.range([0.0, 0.4]));
        }
        r.step(&[Command::Stop]);
        r.run(8.0);
        assert_eq!(gait(&r), GaitState::Standing, "seed {seed}");
        check(&r.plans);
        stopped += r.events.iter().filter(|e| e.1 == EventCode::ObstacleTooHigh).count();
        walked += front(&r);
    }
    assert!(stopped > 20 && walked > 20.0, "{stopped} stops, {walked} m: nothing was tried");
}
