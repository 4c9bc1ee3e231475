//! Centre of gravity: boundary value problems on a long horizon, where initial values would double their error every 0.21 s,
//! and order of the collocation (F16, F20).
//!
//! u'' = w^2 u + f with f such that u = sin 3t, the linear inverted pendulum of height 0.9 m.

use planner::boundary::BoundarySolver;
use planner::collocation::Collocation;

use crate::search::slope;

use super::LimitRule::Within;
use super::{Bench, Findings, row};

const HEIGHT: f64 = 0.9;
const OMEGA: f64 = 3.0;
/// Knots of the long problem.
const KNOTS: usize = 97;

/// w^2 \[1/s^2\]
fn growth() -> f64 {
    multibody::GRAVITY_ACCELERATION / HEIGHT
}

fn load(t: f64) -> f64 {
    -(OMEGA * OMEGA + growth()) * (OMEGA * t).sin()
}

/// Largest error of the collocation over `halves` half periods with `n` knots.
fn collocate(n: usize, halves: f64) -> f64 {
    let end = halves * std::f64::consts::PI / OMEGA;
    let mut bvp = Box::new(Collocation::new());
    bvp.problem.n = n;
    let at = |k: f64| end * k / (n - 1) as f64;
    for k in 0..n {
        bvp.problem.t[k] = at(k as f64);
        bvp.problem.om2[k] = growth();
        bvp.problem.f[k][0] = load(at(k as f64));
        bvp.problem.half[k][0] = load(at(k as f64 + 0.5));
    }
    bvp.solve();
    let error = |k: usize| (bvp.u[k][0] - (OMEGA * bvp.problem.t[k]).sin()).abs();
    (0..n).map(error).fold(0.0, f64::max)
}

/// F16, F20.
pub(super) fn collocation(_: &Bench) -> Findings {
    let (long, short) = (collocate(KNOTS, 8.0), collocate(KNOTS / 2 + 1, 4.0));
    let points = [13, 25, 49, 97].map(|n| [1.0 / (n - 1) as f64, collocate(n, 4.0)]);
    Ok(vec![
        row("F16", "", Within(1e-4))
            .of("boundary value problem, horizon twice as long: error, times", [1.0, long / short]),
        row("F20", "", Within(0.05)).of("collocation with parabolas, smooth: order", [4.0, slope(&points)]),
    ])
}
