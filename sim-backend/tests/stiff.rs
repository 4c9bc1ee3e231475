//! The adaptive stiff method: accuracy against exact solutions and against LSODA on the same problems
//! (tests/peers/lsoda.py prints LSODA's calls and errors), and its guard.

use std::f64::consts::TAU;

use sim_backend::stiff::{Effort, GaveUp, GiveUpReason, Stiff, StiffLimits};

/// Advances in one call, with as many evaluations as it takes.
fn advance(
    limits: StiffLimits,
    end: f64,
    x: &mut [f64],
    mut rate: impl FnMut(f64, &[f64], &mut [f64]),
) -> Result<Effort, GaveUp> {
    Stiff::new(limits).advance(0.0, end, x, &mut rate)
}

/// Robertson's reaction: rates from 0.04 to 3e7; y_1(40) as in Hairer and Wanner, Solving ODEs II.
#[test]
fn robertson() {
    let mut y = [1.0, 0.0, 0.0];
    let limits = StiffLimits { tolerance: 1e-9, ..StiffLimits::of_tolerance(1e-9) };
    let effort = advance(limits, 40.0, &mut y, |_, y, dy| {
        let (a, b, c) = (0.04 * y[0], 1e4 * y[1] * y[2], 3e7 * y[1] * y[1]);
        (dy[0], dy[1], dy[2]) = (b - a, a - b - c, c);
    });
    assert!((y[0] - 0.715_827_068_7).abs() < 1e-6, "{y:?}");
    assert!((y.iter().sum::<f64>() - 1.0).abs() < 1e-9);
    assert!(effort.unwrap().calls < 1500, "{effort:?}");
}

/// Motor of a joint: L/R = 0.4 ms beside a mechanical time of a second; the fast current costs no steps.
#[test]
fn steps_do_not_follow_a_fast_mode_that_has_decayed() {
    let rate = |k: f64| move |t: f64, x: &[f64], dx: &mut [f64]| dx[0] = -k * (x[0] - t.cos()) - t.sin();
    let steps = [1e3, 1e6].map(|k| {
        let mut x = [1.0];
        let effort = advance(StiffLimits::of_tolerance(1e-6), 1.0, &mut x, rate(k)).unwrap();
        assert!((x[0] - 1f64.cos()).abs() < 1e-5, "{x:?}");
        effort.steps
    });
    assert!(steps[1] <= steps[0] + 5, "{steps:?}");
}

#[test]
fn errors_follow_the_tolerance() {
    for tolerance in [1e-4, 1e-6, 1e-8] {
        let mut x = [1.0, 0.0];
        let oscillate = |_: f64, x: &[f64], dx: &mut [f64]| (dx[0], dx[1]) = (x[1], -x[0]);
        advance(StiffLimits::of_tolerance(tolerance), TAU, &mut x, oscillate).unwrap();
        let error = (x[0] - 1.0).hypot(x[1]);
        assert!((0.1 * tolerance..100.0 * tolerance).contains(&error), "{tolerance:e}: {error:e}");
    }
}

/// J of one call serves the next: after the first of a hundred cycles none needs one of its own.
#[test]
fn the_jacobian_is_kept_from_call_to_call() {
    let (mut stiff, mut x, n) = (Stiff::new(StiffLimits::of_tolerance(1e-6)), vec![1.0; 40], 40);
    let mut rate = |t: f64, x: &[f64], dx: &mut [f64]| {
        for i in 0..n {
            dx[i] = -(1.0 + 100.0 * i as f64) * (x[i] - t.sin());
        }
    };
    let mut calls = Vec::new();
    for k in 0..100 {
        calls.push(stiff.advance(f64::from(k) * 1e-3, 1e-3, &mut x, &mut rate).unwrap().calls);
    }
    assert!(calls[0] > 41 && calls[1..].iter().all(|c| *c < calls[0] - 40), "{calls:?}");
}

/// Order and step outlive a call, also where the rate has a kink in between. With a new beginning each time it was 2610
/// evaluations in a hundred calls.
#[test]
fn order_and_step_are_kept_from_call_to_call() {
    // A stiff follower, 1 ms behind a reference of straight pieces between points 10 ms apart on a cosine.
    let point = |k: i32| (0.01 * f64::from(k)).cos();
    let (mut stiff, mut x) = (Stiff::new(StiffLimits::of_tolerance(1e-6)), [1.0, 0.0, 1.0]);
    let mut calls = 0;
    for k in 0..100 {
        let [from, to] = [point(k), point(k + 1)];
        let mut rate = |t: f64, x: &[f64], dx: &mut [f64]| {
            let reference = from + (to - from) * t / 0.01;
            (dx[0], dx[1], dx[2]) = (x[1], -x[0], 1e3 * (reference - x[2]));
        };
        calls += stiff.advance(0.0, 0.01, &mut x, &mut rate).unwrap().calls;
    }
    let behind = point(100) - 1e-3 * (point(100) - point(99)) / 0.01;
    assert!((x[0] - 1f64.cos()).abs() < 2e-5 && (x[2] - behind).abs() < 2e-5, "{x:?}");
    println!("{calls} evaluations");
    assert!(calls < 1300, "{calls}");
}

/// What came before does not count where the caller puts the state elsewhere, and a rate that jumps is followed.
#[test]
fn a_state_that_was_changed_and_a_rate_that_jumps_are_followed() {
    let (mut stiff, mut x) = (Stiff::new(StiffLimits::of_tolerance(1e-6)), [0.0]);
    for k in 0..50 {
        let to = if k % 2 == 0 { 1.0 } else { -1.0 };
        stiff.advance(0.0, 0.01, &mut x, &mut |_, _, dx| dx[0] = to).unwrap();
        // No more than a step may err, in each call.
        let exact = if k % 2 == 0 { 0.01 } else { 0.0 };
        assert!((x[0] - exact).abs() < 2e-6 * f64::from(k + 1), "{k}: {x:?}");
    }
    x[0] = 3.0;
    stiff.advance(0.0, 0.01, &mut x, &mut |_, x, dx| dx[0] = -x[0]).unwrap();
    assert!((x[0] - 3.0 * (-0.01f64).exp()).abs() < 2e-5, "{x:?}");
}

// ------------------------------------------------------------------------------------------------- jumps and chatter

/// The joint of tests/peers/lsoda.py: J = 1, T_0 = 10.4, load 20 sin(2 pi t); exact angle at 2 s from there.
fn joint(friction: impl Fn(f64) -> f64) -> impl FnMut(f64, &[f64], &mut [f64]) {
    move |t, x, dx| (dx[0], dx[1]) = (x[1], 20.0 * (TAU * t).sin() - friction(x[1]))
}

fn sign(w: f64) -> f64 {
    10.4 * (f64::from(w > 0.0) - f64::from(w < 0.0))
}

#[test]
fn the_guard_stops_chatter_and_names_the_speed() {
    let limits = |tolerance| StiffLimits { most_calls: 20_000, ..StiffLimits::of_tolerance(tolerance) };
    let mut x = [0.0, 0.0];
    let gave_up = advance(limits(1e-6), 2.0, &mut x, joint(sign)).unwrap_err();
    assert_eq!((gave_up.state, gave_up.effort.calls), (1, 20_000), "{gave_up}");
    assert_eq!(gave_up.why, GiveUpReason::Calls);
    assert!(x.iter().all(|x| x.is_finite()) && gave_up.time < 2.0);
    // A smooth law gets through.
    let mut x = [0.0, 0.0];
    let effort = advance(limits(1e-8), 2.0, &mut x, joint(|w| 10.4 * (w / 1e-3).tanh())).unwrap();
    assert!(effort.calls < 6000, "{effort:?}");
    // LSODA: error 1.5e-3 on the way, 1140 calls.
    assert!((x[0] - 0.090_910_085_184).abs() < 1.6e-3, "{x:?}");
}

/// 60 kg fall 10 mm onto a massless layer: the force jumps by B v, and the method survives.
#[test]
fn touchdown_costs_small_steps_and_nothing_else() {
    let rate = |_: f64, x: &[f64], dx: &mut [f64]| {
        let force = if x[0] <= 0.0 { (-2e5 * x[0] - 2e3 * x[1]).max(0.0) } else { 0.0 };
        (dx[0], dx[1]) = (x[1], force / 60.0 - 9.81);
    };
    let mut x = [0.01, 0.0];
    let effort = advance(StiffLimits::of_tolerance(1e-8), 0.5, &mut x, rate).unwrap();
    // LSODA: 503 calls, smallest step 4.5e-10 s, error 5.6e-9 m.
    assert!((x[0] + 0.002_941_534_701_743).abs() < 5e-8, "{x:?}");
    assert!(effort.calls < 5000 && effort.smallest < 1e-6, "{effort:?}");
}

#[test]
fn a_rate_that_is_no_number_is_named() {
    let mut x = [0.0, 1.0];
    let broken = |t: f64, _: &[f64], dx: &mut [f64]| (dx[0], dx[1]) = (1.0, (0.3 - t).sqrt());
    let gave_up = advance(StiffLimits::of_tolerance(1e-6), 1.0, &mut x, broken).unwrap_err();
    assert_eq!((gave_up.state, gave_up.why), (1, GiveUpReason::NotFinite));
    assert!(gave_up.time <= 0.3 && x.iter().all(|x| x.is_finite()));
}

/// A jump looked like a slope of 1e9 and Newton's method like converged, where the joint slid on without its load: loose
/// tolerances ended soon, far away and without a word.
#[test]
fn a_jump_does_not_pass_for_a_slope() {
    for tolerance in [1e-2, 1e-3] {
        let limits = StiffLimits { most_calls: 1_000_000, ..StiffLimits::of_tolerance(tolerance) };
        let (mut stiff, mut x) = (Stiff::new(limits), [0.0, 0.0]);
        for k in 0..200 {
            let arrived = stiff.advance(f64::from(k) * 0.01, 0.01, &mut x, &mut joint(sign));
            if let Err(gave_up) = arrived {
                assert_eq!(gave_up.state, 1, "{gave_up}");
                return;
            }
        }
        // LSODA, which does not begin anew every 10 ms: 0.04 and 0.0044.
        assert!((x[0] - 0.090_910_085_184).abs() < 20.0 * tolerance, "{tolerance:e}: {x:?}");
    }
}
