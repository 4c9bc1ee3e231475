//! A swing foot that meets the ground before its time: the step ends there, and the walk goes on.

use crate::robot::checks::*;
use crate::robot::{self, CYCLE, Robot};
use config::Gait;
use messages::command::StepCommand;
use messages::{Command, EventCode, Plan};

/// A robot that walks in steps of 30 cm, in the middle of the swing of a step.
fn walking(gait: &Gait) -> Robot {
    let mut r = Robot::new(gait);
    r.stand();
    r.step(&[Command::Step(StepCommand { length: 0.3, side: 0.0, turn: 0.0, duration: 1.0 })]);
    r.step(&[Command::Start]);
    r.run(6.0);
    while (r.time() - 0.5).abs() > CYCLE {
        r.step(&[]);
    }
    r
}

fn contacts(r: &Robot) -> usize {
    r.events.iter().filter(|e| e.1 == EventCode::EarlyContact).count()
}

#[test]
fn a_step_on_something_ends_early_at_its_height() {
    let gait = robot::gait();
    let mut r = walking(&gait);
    r.ground = 0.02;
    let (made, step) = (r.plans.len(), r.active.steps[0]);
    while r.plans.len() == made {
        r.step(&[]);
    }
    assert_eq!(contacts(&r), 1, "{:?}", r.events);
    let plan = r.plans[made].clone();
    let begins = (plan.start_tick - r.active.start_tick) as f64 * CYCLE;
    assert!(begins < step.end - 0.03, "{begins} s of {}", step.end);
    let height = plan.height - r.active.height;
    assert!((height - 0.02).abs() < 2e-3, "it stands {height} m higher");
    // The weight takes over when it would have: the foot behind lifts off when it would have.
    let lift = begins + plan.steps[0].lift;
    let planned = step.end + gait.step.double_support * 1.0;
    assert!((lift - planned).abs() < 1.5 * CYCLE, "{lift} s, planned {planned} s");
    assert!(zmp_margin(&plan) > 0.0, "margin {}", zmp_margin(&plan));
    assert!(com_jump(&r.active, &plan, begins) < 1e-9, "jump {}", com_jump(&r.active, &plan, begins));
}

#[test]
fn a_touch_at_the_planned_height_changes_nothing() {
    let gait = robot::gait();
    let mut r = walking(&gait);
    r.ground = 0.004;
    r.run(5.0);
    assert_eq!(contacts(&r), 0);
    assert!(r.plans.iter().all(|p| p.height == 0.0));
}

#[test]
fn contact_in_the_middle_of_a_swing_is_no_landing() {
    let gait = robot::gait();
    let mut r = walking(&gait);
    r.ground = 1.0;
    while r.time() < 0.55 {
        r.step(&[]);
    }
    assert_eq!(contacts(&r), 0);
}

/// Largest difference of the centre of gravity and its velocity \[m, m/s\] at a switch at time `t` of plan `a`.
fn com_jump(a: &Plan, b: &Plan, t: f64) -> f64 {
    let (ca, cb) = (a.body.sample(t), b.body.sample(0.0));
    let heading = b.origin[2] - a.origin[2];
    let (s, c) = heading.sin_cos();
    let turned = |v: &[f64; 3]| [c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]];
    let (sa, ca_) = a.origin[2].sin_cos();
    let d = [b.origin[0] - a.origin[0], b.origin[1] - a.origin[1]];
    let shift = [ca_ * d[0] + sa * d[1], -sa * d[0] + ca_ * d[1], b.height - a.height];
    let (p, v) = (turned(&cb.position), turned(&cb.velocity));
    (0..3)
        .map(|k| (p[k] + shift[k] - ca.position[k]).abs().max((v[k] - ca.velocity[k]).abs()))
        .fold(0.0, f64::max)
}
