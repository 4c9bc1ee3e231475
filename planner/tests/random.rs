//! Random commands at random times: whatever is asked, plans can be walked, join, and end standing.

use crate::robot::checks::*;
use crate::robot::feasible::{Worst, jumps};
use crate::robot::{self, Random, Robot};
use messages::command::{StepCommand, VelocityCommand};
use messages::{Command, EventCode};

fn command(random: &mut Random, limits: &config::gait::CommandLimits) -> Command {
    match random.below(10) {
        0 => Command::Stop,
        1 => Command::Start,
        2..=4 => Command::Velocity(VelocityCommand {
            forward: random.range([-0.2, 0.8]),
            left: random.range([-0.15, 0.15]),
            turn: random.range([-0.3, 0.3]),
        }),
        5 => Command::Velocity(VelocityCommand { forward: f64::NAN, left: 0.0, turn: 0.0 }),
        _ => Command::Step(StepCommand {
            length: random.range(limits.length),
            side: random.range(limits.side),
            turn: random.range(limits.turn),
            duration: random.range(limits.duration),
        }),
    }
}

/// What happened to plans.
#[derive(Clone, Copy)]
struct Tally {
    plans: u32,
    kept: u32,
    worst: Worst,
}

/// One sequence of commands, within the limits of 4.6.1 and all together, reversed from step to step if it happens.
fn sequence(seed: u64, gait: &config::Gait, cycle: f64, commands: u64, dense: bool) -> Tally {
    let mut random = Random::new(seed);
    let mut r = Robot::with_cycle(gait, cycle);
    r.stand();
    r.step(&[Command::Start]);
    for _ in 0..commands {
        let c = command(&mut random, &gait.limits);
        r.step(&[c]);
        let pause = random.range([0.1, 3.0]);
        r.run(pause);
    }
    r.step(&[Command::Stop]);
    while r.time() <= r.active.end() || r.next.is_some() {
        assert!(r.tick as f64 * cycle < 60.0, "run {seed} does not come to rest");
        r.step(&[]);
    }
    let mut worst = Worst::NONE;
    for p in &r.plans {
        let of = Worst::of(p);
        assert!(of.zmp > -1e-9, "run {seed}, plan {}: the zero-moment point is {} m outside", p.id, -of.zmp);
        assert!(of.force > 0.0, "run {seed}, plan {}: the ground pulls", p.id);
        assert!(
            of.friction < 1.01 * gait.model.friction,
            "run {seed}, plan {}: friction {}",
            p.id,
            of.friction
        );
        assert!(of.jump < 1e-9, "run {seed}, plan {}: jumps by {}", p.id, of.jump);
        worst = worst.and(of);
        assert!(unrest(p, gait) < 1e-9, "run {seed}, plan {} does not end standing", p.id);
        if dense {
            let margin = zmp_margin(p);
            assert!(margin > -1e-9, "run {seed}, plan {}: margin {margin}", p.id);
            let gap = feet_gap(p);
            assert!(gap > gait.step.width_min - 0.1 - 2e-3, "run {seed}, plan {}: feet {gap} m apart", p.id);
        }
    }
    for pair in r.plans.windows(2) {
        let seam = seam_of(&pair[0], &pair[1], cycle);
        assert!(seam < 1e-9, "run {seed}: plans {} and {} differ by {seam}", pair[0].id, pair[1].id);
    }
    let kept = r.events.iter().filter(|e| e.1 == EventCode::PlanKept).count() as u32;
    Tally { plans: r.plans.len() as u32, kept, worst }
}

/// Sequences side by side on as many threads as there are cores.
fn sequences(runs: u64, cycle: f64, commands: u64, dense: bool) -> Tally {
    let gait = robot::gait();
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get() as u64);
    let add = |a: Tally, b: Tally| Tally {
        plans: a.plans + b.plans,
        kept: a.kept + b.kept,
        worst: a.worst.and(b.worst),
    };
    let none = Tally { plans: 0, kept: 0, worst: Worst::NONE };
    let tally = std::thread::scope(|scope| {
        let of = |k| {
            let gait = &gait;
            let seeds = (0..runs).filter(move |seed| seed % threads == k);
            move || seeds.map(|seed| sequence(seed, gait, cycle, commands, dense)).fold(none, add)
        };
        let all: Vec<_> = (0..threads).map(|k| scope.spawn(of(k))).collect();
        all.into_iter().map(|t| t.join().expect("a run failed")).fold(none, add)
    });
    println!(
        "{} plans in {runs} runs, {} times none could be walked; worst: {:?}",
        tally.plans, tally.kept, tally.worst
    );
    tally
}

/// A NaN anywhere in a plan is seen, in whichever of its nine paths it stands.
#[test]
fn a_nan_in_any_path_is_a_jump() {
    let mut r = Robot::with_cycle(&robot::gait(), robot::CYCLE);
    r.stand();
    r.step(&[Command::Start]);
    r.run(2.0);
    let sound = r.plans.last().expect("she walks").clone();
    assert!(jumps(&sound) < 1e-9);
    for path in 0..9 {
        let mut plan = sound.clone();
        let last = match path {
            0 => plan.body.coefficients[0][2].last_mut(),
            1 => plan.torso.coefficients[0][0].last_mut(),
            2 => plan.load_left.coefficients[0][0].last_mut(),
            3 | 4 => plan.feet[path - 3].coefficients[0][2].last_mut(),
            // Of soles that stay flat, and toes that stay straight: their paths have no pieces.
            5 | 6 => plan.pitch[path - 5].origin.last_mut(),
            _ => plan.toes[path - 7].origin.last_mut(),
        };
        *last.expect("a number") = f64::NAN;
        assert!(jumps(&plan).is_infinite(), "path {path}");
    }
}

#[test]
fn random_commands_are_walked() {
    let tally = sequences(200, robot::CYCLE, 8, true);
    assert!(tally.plans > 10 * 200);
}

/// Ten thousand sequences find no plan that cannot be walked, none that jumps, and no NaN. Cycles are
/// long, because nothing happens in most of them.
#[test]
fn ten_thousand_sequences_are_walked() {
    let tally = sequences(10_000, 0.01, 4, false);
    assert!(tally.plans > 50_000);
    assert!(
        tally.kept * 100 < tally.plans,
        "{} of {} times nothing could be walked",
        tally.kept,
        tally.plans
    );
}
