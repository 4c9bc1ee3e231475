//! Random commands at random times: whatever is asked, plans join, keep the robot on its feet and end standing.

mod robot;

use messages::command::{StepCommand, VelocityCommand};
use messages::{Command, EventCode};
use robot::checks::*;
use robot::{Random, Robot};

const RUNS: u64 = 500;

fn command(random: &mut Random, limits: &config::gait::Limits) -> Command {
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

#[test]
fn random_commands_are_walked() {
    let gait = robot::gait();
    let (mut plans, mut flagged) = (0u32, 0u32);
    for seed in 0..RUNS {
        let mut random = Random::new(seed);
        let mut r = Robot::new(&gait);
        r.stand();
        r.step(&[Command::Start]);
        for _ in 0..8 {
            let c = command(&mut random, &gait.limits);
            r.step(&[c]);
            let pause = random.range([0.1, 3.0]);
            r.run(pause);
        }
        r.step(&[Command::Stop]);
        r.run(13.0);
        assert!(r.time() > r.active.end(), "run {seed} does not come to rest");
        for p in &r.plans {
            let warned = r.events.iter().any(|e| e.1 == EventCode::ControlLimited && e.2 == p.id);
            plans += 1;
            flagged += u32::from(warned);
            let margin = zmp_margin(p);
            assert!(warned || margin > -1e-9, "run {seed}, plan {}: margin {margin} without a warning", p.id);
            assert!(unrest(p, &gait) < 1e-9, "run {seed}, plan {} does not end standing", p.id);
            let gap = feet_gap(p);
            assert!(gap > gait.step.width_min - 0.1 - 2e-3, "run {seed}, plan {}: feet {gap} m apart", p.id);
        }
        for pair in r.plans.windows(2) {
            let seam = seam(&pair[0], &pair[1]);
            assert!(seam < 1e-9, "run {seed}: plans {} and {} differ by {seam}", pair[0].id, pair[1].id);
        }
    }
    println!("{plans} plans in {RUNS} runs, {flagged} with the zero-moment point outside of the support");
    assert!(plans > 10 * RUNS as u32);
    // Limits of length, side, turn and duration are commanded together and reversed from step to step.
    assert!(flagged * 100 < plans, "{flagged} of {plans} plans leave the support");
}
