//! Boundary value problem of the centre of gravity: cubic splines (4.50) and the fourth-order weights that plans use, with
//! knots on the phases and without (errata 2.7, 2.8).

use planner::boundary::{BoundarySolver, U};
use planner::collocation::Collocation;

use super::{Cost, ErrorChart, Point, cost};

const G: f64 = multibody::GRAVITY_ACCELERATION;
/// Phases of two steps \[s\].
const MARKS: [f64; 7] = [0.0, 0.16, 0.64, 0.8, 0.96, 1.44, 1.6];
/// Kinks of the zero-moment point: \[s\], \[m\].
const RAMPS: [(f64, f64); 5] = [(0.0, 0.02), (0.16, 0.1), (0.8, 0.1), (0.96, -0.1), (1.6, -0.1)];
/// Positions at both ends \[m\].
const ENDS: [f64; 2] = [0.02, -0.03];
/// Calls of which the time is taken at once.
const CALLS: usize = 500;

/// Height of the body, 0.9 m with a wave of `wave` per step, gives om2; the reference gives the rest.
fn forces(t: f64, wave: f64) -> (f64, f64) {
    let w = std::f64::consts::TAU / 0.8;
    let z = 0.9 + wave * (w * t).cos();
    let om2 = (G - wave * w * w * (w * t).cos()) / z;
    let k = RAMPS.iter().position(|r| t < r.0).unwrap_or(RAMPS.len() - 1).max(1);
    let (a, b) = (RAMPS[k - 1], RAMPS[k]);
    (om2, -om2 * (a.1 + (b.1 - a.1) * (t - a.0) / (b.0 - a.0)))
}

/// Knots no farther apart than `spacing`, on the phases or all at the same distance.
fn knots(spacing: f64, aligned: bool) -> Vec<f64> {
    let mut knots = vec![0.0];
    let phases: &[f64] = if aligned { &MARKS } else { &[0.0, 1.6] };
    for w in phases.windows(2) {
        let n = ((w[1] - w[0]) / spacing - 1e-9).ceil() as usize;
        knots.extend((1..=n).map(|k| w[0] + (w[1] - w[0]) * k as f64 / n as f64));
    }
    knots
}

fn problem(knots: &[f64], wave: f64) -> Box<Collocation> {
    let mut c = Box::new(Collocation::new());
    c.problem.n = knots.len();
    for (i, &t) in knots.iter().enumerate() {
        let (om2, f) = forces(t, wave);
        (c.problem.t[i], c.problem.om2[i], c.problem.f[i][0]) = (t, om2, f);
        if let Some(next) = knots.get(i + 1) {
            c.problem.half[i][0] = forces(0.5 * (t + next), wave).1;
        }
    }
    c
}

/// Cubic collocation at knots, all columns in one tridiagonal system (errata 2.7).
fn cubic(c: &mut Collocation, upper: &mut [f64]) {
    let n = c.problem.n;
    (c.u[0], c.u[n - 1]) = ([0.0; U], [0.0; U]);
    (c.u[0][4], c.u[n - 1][5]) = (1.0, 1.0);
    upper[0] = 0.0;
    for i in 1..n - 1 {
        let (a, h) = (c.problem.t[i] - c.problem.t[i - 1], c.problem.t[i + 1] - c.problem.t[i]);
        let lower = a / 6.0 * c.problem.om2[i - 1] - 1.0 / a;
        let diagonal = (a + h) / 3.0 * c.problem.om2[i] + 1.0 / a + 1.0 / h;
        let pivot = 1.0 / (diagonal - lower * upper[i - 1]);
        upper[i] = (h / 6.0 * c.problem.om2[i + 1] - 1.0 / h) * pivot;
        for k in 0..U {
            let load = |j: usize| if k < 4 { c.problem.f[j][k] } else { 0.0 };
            let load = a / 6.0 * load(i - 1) + (a + h) / 3.0 * load(i) + h / 6.0 * load(i + 1);
            c.u[i][k] = (-load - lower * c.u[i - 1][k]) * pivot;
        }
    }
    for i in (1..n - 1).rev() {
        for k in 0..U {
            c.u[i][k] -= upper[i] * c.u[i + 1][k];
        }
    }
}

/// The solution at knot `i`.
fn value(c: &Collocation, i: usize) -> f64 {
    c.u[i][0] + ENDS[0] * c.u[i][4] + ENDS[1] * c.u[i][5]
}

/// Largest error at knots, against knots 10 ms apart and the fourth order.
fn error(c: &Collocation, fine: &Collocation) -> f64 {
    let of = |i: usize| {
        let t = c.problem.t[i];
        let k = fine.problem.t[..fine.problem.n].partition_point(|x| *x < t - 1e-9);
        let hit = k < fine.problem.n && (fine.problem.t[k] - t).abs() < 1e-9;
        hit.then(|| (value(c, i) - value(fine, k)).abs())
    };
    (1..c.problem.n - 1).filter_map(of).fold(0.0, f64::max)
}

/// The chart.
pub(super) fn chart() -> ErrorChart {
    let mut chart = ErrorChart::new("boundary", "Collocation: order and knots", "error of the centre of gravity [m]")
        .over(Cost::PerCall)
        .about(
            "Two steps of 0.8 s with the zero-moment point of errata 2.8, ends given; all six right-hand sides solved; \
             reference: fourth order with knots 10 ms apart on the phases.",
        );
    for (scene, wave) in [("height 0.9 m", 0.0), ("height 0.9 m with a wave of 2 cm", 0.02)] {
        let mut fine = problem(&knots(0.01, true), wave);
        fine.solve();
        for spacing in [0.16, 0.08, 0.04, 0.02] {
            for aligned in [true, false] {
                let at = if aligned { "on the phases" } else { "equally spaced" };
                let knots = knots(if aligned { spacing } else { 1.1 * spacing }, aligned);
                let mut c = problem(&knots, wave);
                let mut upper = [0.0; planner::boundary::MAX_KNOTS];
                let mut add = |name: &str, c: &Collocation, seconds: f64, error: f64| {
                    chart.add(Point {
                        scene: scene.into(),
                        method: format!("{name}, knots {at}"),
                        solver: Some(format!("{} knots", c.problem.n)),
                        cpu_us: Some(1e6 * seconds / CALLS as f64),
                        error,
                        ..Point::default()
                    });
                };
                let ((), seconds) = cost::of(|| (0..CALLS).for_each(|_| cubic(&mut c, &mut upper)));
                add("cubic splines", &c, seconds, error(&c, &fine));
                let (_, seconds) = cost::of(|| (0..CALLS).map(|_| c.solve()).last());
                add("fourth order", &c, seconds, error(&c, &fine));
            }
        }
    }
    chart
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With knots on the phases cubic splines are of second order, the other weights of fourth.
    #[test]
    fn orders() {
        for wave in [0.0, 0.02] {
            let mut fine = problem(&knots(0.01, true), wave);
            fine.solve();
            let errors = [0.08, 0.04].map(|spacing| {
                let mut c = problem(&knots(spacing, true), wave);
                let mut upper = [0.0; planner::boundary::MAX_KNOTS];
                cubic(&mut c, &mut upper);
                let second = error(&c, &fine);
                c.solve();
                [second, error(&c, &fine)]
            });
            let order = [0, 1].map(|k| (errors[0][k] / errors[1][k]).log2());
            assert!((order[0] - 2.0).abs() < 0.3 && order[1] > 3.3, "{errors:?}, orders {order:?}");
        }
    }
}
