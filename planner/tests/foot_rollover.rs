//! Feet that roll: toe joints, heel strike (thesis 4.5, (4.29), (4.30)).

use crate::robot::{self, Robot, TOES, checks};
use config::Gait;
use config::gait::Bend;
use curves::{Path, Sample};
use messages::command::StepCommand;
use messages::{Command, LEFT, Plan, RIGHT};

fn rolling() -> Gait {
    let bend = |angle: f64| Some(Bend { angle, length: [0.3, 0.6] });
    Gait { toes: bend(0.6), heel_strike: bend(0.1), ..robot::gait() }
}

/// Walks with steps of that kind and stops.
fn walk(gait: &Gait, length: f64, turn: f64) -> Robot {
    let mut r = Robot::new(gait);
    r.stand();
    r.step(&[Command::Step(StepCommand { length, side: 0.0, turn, duration: 0.9 }), Command::Start]);
    r.run(10.0);
    r.step(&[Command::Stop]);
    r.run(8.0);
    assert!(r.events.is_empty(), "{:?}", r.events);
    r
}

fn knots<const N: usize>(path: &Path<1, N>) -> &[f64] {
    &path.ends[..path.pieces as usize]
}

/// Largest jump of value, slope and second derivative at the knots of a path.
fn jump<const N: usize>(path: &Path<1, N>) -> f64 {
    let gap = |a: Sample<1>, b: Sample<1>| {
        let d = |a: [f64; 1], b: [f64; 1]| (a[0] - b[0]).abs();
        // Over 2e-9 s a smooth second derivative changes by its slope.
        d(a.position, b.position)
            .max(d(a.velocity, b.velocity) * 1e-1)
            .max(d(a.acceleration, b.acceleration) * 1e-3)
    };
    let around = |t: &f64| gap(path.sample(t - 1e-9), path.sample(t + 1e-9));
    knots(path).iter().map(around).fold(0.0, f64::max)
}

fn highest(r: &Robot, angle: impl Fn(&Plan, f64) -> f64) -> f64 {
    let of = |p: &Plan| (0..2000).map(|k| angle(p, f64::from(k) * 2e-3)).fold(0.0, f64::max);
    r.plans.iter().map(|p| of(p)).fold(0.0, f64::max)
}

#[test]
fn angles_grow_with_the_step_and_are_clamped() {
    // Errata 2.5.
    let bend = Bend { angle: 50f64.to_radians(), length: [0.28, 0.6] };
    assert!((bend.at(0.5) - 0.599956930373).abs() < 1e-12);
    assert_eq!([bend.at(0.28), bend.at(0.1), bend.at(-0.4)], [0.0; 3]);
    assert_eq!(bend.at(0.66), bend.angle);
}

#[test]
fn paths_are_smooth_and_plans_join() {
    for (length, turn) in [(0.5, 0.0), (0.37, 0.14), (0.5, -0.08), (0.4, 0.0)] {
        let r = walk(&rolling(), length, turn);
        for p in &r.plans {
            for i in 0..2 {
                assert!(jump(&p.toes[i]) < 1e-8 && jump(&p.pitch[i]) < 1e-8, "plan {} foot {i}", p.id);
                let end = p.end() + 1.0;
                assert!(p.toes[i].sample(end).position[0].abs() < 1e-12);
                assert!(p.pitch[i].sample(end).position[0].abs() < 1e-12);
            }
        }
        for pair in r.plans.windows(2) {
            let seam = checks::seam(&pair[0], &pair[1]);
            assert!(seam < 1e-9, "plans {} and {} differ by {seam}", pair[0].id, pair[1].id);
        }
    }
}

/// The ground can be felt with the toe segment or an edge alone only while the foot hands its load over, or takes it.
#[test]
fn a_foot_that_carries_alone_lies_flat() {
    let r = walk(&rolling(), 0.49, 0.08);
    for p in &r.plans {
        for s in &p.steps[..p.step_count as usize] {
            let stance = s.stance as usize;
            for k in 0..=50 {
                let t = s.lift + (s.end - s.lift) * f64::from(k) / 50.0;
                assert!(p.toes[stance].sample(t).position[0].abs() < 1e-12);
                assert!(p.pitch[stance].sample(t).position[0].abs() < 1e-12);
            }
        }
    }
}

/// An edge rolls without slipping if the footprint rests while the foot is pitched on the ground.
#[test]
fn a_footprint_rests_while_the_foot_rolls_on_it() {
    let r = walk(&rolling(), 0.55, 0.0);
    for p in &r.plans {
        for s in &p.steps[..p.step_count as usize] {
            for k in 0..=20 {
                let t = s.begin + (s.lift - s.begin) * f64::from(k) / 20.0;
                for foot in [RIGHT, LEFT] {
                    let f = p.feet[foot].sample(t);
                    assert!(f.velocity.iter().all(|v| v.abs() < 1e-9) && f.position[2].abs() < 1e-9);
                }
            }
        }
    }
}

#[test]
fn peaks_are_where_and_as_high_as_they_should_be() {
    let gait = rolling();
    let r = walk(&gait, 0.5, 0.0);
    let plan = r.plans.iter().rev().find(|p| p.state == messages::GaitState::Walking as u64).expect("walks");
    let s = plan.steps[0];
    let swing = 1 - s.stance as usize;
    let t = s.lift + (s.end - s.lift) / 6.0; // the middle of the initial swing
    let share = (0.5 - 0.3) / 0.3;
    let side = if swing == RIGHT { -1.0 } else { 1.0 };
    assert!((plan.toes[swing].sample(t).position[0] - side * 0.6 * share).abs() < 1e-9);
    assert_eq!(plan.pitch[swing].sample(t).position[0], 0.0, "it leaves the ground flat");
    assert!((plan.pitch[swing].sample(s.end).position[0] + 0.1 * share).abs() < 1e-9);
}

#[test]
fn toe_joints_stay_in_their_range_whatever_is_asked_for() {
    let mut gait = rolling();
    gait.toes = Some(Bend { angle: 1.4, length: [0.2, 0.3] });
    let r = walk(&gait, 0.6, 0.0);
    for p in &r.plans {
        for (i, range) in TOES.iter().enumerate() {
            let [low, high] = range.expect("Lola has toes");
            for k in 0..3000 {
                let angle = p.toes[i].sample(f64::from(k) * 1e-3).position[0];
                assert!(angle > low && angle < high, "{angle} of {low} .. {high}");
            }
        }
    }
    assert!(highest(&r, |p, t| p.toes[LEFT].sample(t).position[0]) > 0.72, "and use it");
}

#[test]
fn backwards_and_with_short_steps_nothing_rolls() {
    for length in [-0.2, 0.2, 0.29] {
        let r = walk(&rolling(), length, 0.0);
        let flat = |p: &Plan, t: f64| {
            (0..2)
                .map(|i| p.toes[i].sample(t).position[0].abs() + p.pitch[i].sample(t).position[0].abs())
                .sum()
        };
        assert_eq!(highest(&r, flat), 0.0);
    }
    // Nor does anything on a robot without toes whose gait does not say so.
    let r = walk(&robot::gait(), 0.5, 0.0);
    assert!(r.plans.iter().all(|p| (0..2).all(|i| p.toes[i].pieces == 0 && p.pitch[i].pieces == 0)));
}
