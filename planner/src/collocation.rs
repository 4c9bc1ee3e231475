//! Boundary value problems of the centre of gravity by spline collocation in O(n) (thesis 4.6.5; errata 2.8).
//!
//! Solves `u.. = om2(t) u + f(t)` with given ends. The unknowns are the values at the knots; the equation of a knot
//! weighs the right-hand side with the hat function of the knot, so the matrix is tridiagonal. `om2 u` is smooth and
//! interpolated by a parabola through three knots; `f` may have kinks at knots and is taken at knots and midpoints.
//! The error is O(h^4). All right-hand sides share one factorization, which needs no pivoting while h < sqrt(6 / om2).
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | om2 | (z_b.. + g) / z_b | 1/s^2 |
//! | f | columns: r_x, r_y of the reference, q_0, q_1 of the modifications (4.49) | m/s^2 |
//! | u | columns: the same, then unit value at the left end, unit value at the right end | m |
//! | a, c | lengths of the intervals before and after a knot | s |

use crate::boundary::{
    BoundaryProblem, BoundarySolver, EndConditions, EndSlopes, F, LEFT, MAX_KNOTS, RIGHT, U,
};
use crate::verdict::PlanVerdict;

/// A problem and its solution.
#[derive(Clone)]
pub struct Collocation {
    /// The problem.
    pub problem: BoundaryProblem,
    /// Solutions at the knots.
    pub u: [[f64; U]; MAX_KNOTS],
    /// Eliminated upper diagonal.
    upper: [f64; MAX_KNOTS],
}

impl Default for Collocation {
    fn default() -> Self {
        Self::new()
    }
}

impl Collocation {
    /// Room for a problem.
    pub fn new() -> Self {
        Self { problem: BoundaryProblem::new(), u: [[0.0; U]; MAX_KNOTS], upper: [0.0; MAX_KNOTS] }
    }

    /// Slope of every column at knot `i` \[1/s\].
    pub fn slope(&self, i: usize) -> [f64; U] {
        let (from, to, third, weights) = self.slope_at(i);
        let middle = &self.problem.half[from.min(to)];
        std::array::from_fn(|k| {
            let f = if k < F { [self.problem.f[from][k], middle[k]] } else { [0.0; 2] };
            weights.apply([self.u[from][k], self.u[to][k], self.u[third][k]], f)
        })
    }

    /// Knots that the slope at knot `i` is made of, and their weights.
    fn slope_at(&self, i: usize) -> (usize, usize, usize, SlopeWeights) {
        // The last knot has no interval after it: mirror the one before it.
        let (from, to, third, sign) = if i + 1 == self.problem.n {
            (i, i - 1, i.wrapping_sub(2), -1.0)
        } else if i == 0 {
            (0, 1, 2, 1.0)
        } else {
            (i, i + 1, i - 1, 1.0)
        };
        let h = (self.problem.t[to] - self.problem.t[from]).abs();
        let x = (self.problem.t[third] - self.problem.t[from]) * sign;
        let om2 = [from, to, third].map(|k| self.problem.om2[k]);
        (from, to, third, SlopeWeights::new(h, x, om2, sign))
    }
}

impl BoundarySolver for Collocation {
    fn problem(&self) -> &BoundaryProblem {
        &self.problem
    }

    fn problem_mut(&mut self) -> &mut BoundaryProblem {
        &mut self.problem
    }

    fn solve(&mut self) -> PlanVerdict {
        let BoundaryProblem { n, t, om2, f, half } = &self.problem;
        let n = *n;
        if !(3..=MAX_KNOTS).contains(&n) {
            return PlanVerdict::Degenerate;
        }
        self.u[0] = [0.0; U];
        self.u[n - 1] = [0.0; U];
        self.u[0][LEFT] = 1.0;
        self.u[n - 1][RIGHT] = 1.0;
        self.upper[0] = 0.0;
        // Elimination forwards: one tridiagonal matrix for all columns.
        let mut a = t[1] - t[0];
        let mut by_a = 1.0 / a;
        let mut falling = om2[0] <= 0.0 || om2[n - 1] <= 0.0;
        let mut degenerate = a <= 0.0;
        for i in 1..n - 1 {
            let c = t[i + 1] - t[i];
            let by_c = 1.0 / c;
            let [w_m, w_0, w_p] = hat_weights(a, c, by_a, by_c);
            let lower = w_m * om2[i - 1] - by_a;
            let diagonal = w_0 * om2[i] + by_a + by_c;
            let upper = w_p * om2[i + 1] - by_c;
            let pivot = diagonal - lower * self.upper[i - 1];
            falling |= om2[i] <= 0.0;
            degenerate |= c <= 0.0 || pivot <= 0.0;
            let pivot = 1.0 / pivot;
            self.upper[i] = upper * pivot;
            // The load, weighed with the hat function of the knot by Simpson's rule.
            let (a6, c6) = (a / 6.0, c / 6.0);
            let (before, at, after) = (&half[i - 1], &f[i], &half[i]);
            let last = self.u[i - 1];
            let next = &mut self.u[i];
            for k in 0..F {
                let load = a6 * (2.0 * before[k] + at[k]) + c6 * (at[k] + 2.0 * after[k]);
                next[k] = (-load - lower * last[k]) * pivot;
            }
            for k in F..U {
                next[k] = -lower * last[k] * pivot;
            }
            (a, by_a) = (c, by_c);
        }
        // Substitution backwards.
        for i in (1..n - 1).rev() {
            let next = self.u[i + 1];
            let upper = self.upper[i];
            for (u, v) in self.u[i].iter_mut().zip(next) {
                *u -= upper * v;
            }
        }
        // A NaN spreads to both ends; the loads there are in slopes only.
        let ends = f[0].iter().chain(&f[n - 1]).chain(&self.u[1]).chain(&self.u[n - 2]);
        let finite = ends.copied().all(f64::is_finite);
        match (falling, degenerate, finite) {
            (true, ..) => PlanVerdict::Falling,
            (_, true, _) => PlanVerdict::Degenerate,
            (.., false) => PlanVerdict::NotFinite,
            _ => PlanVerdict::Sound,
        }
    }

    fn ends(&self) -> EndSlopes {
        let last = self.problem.n - 1;
        EndSlopes { slopes: [self.slope(0), self.slope(last)], w: self.problem.om2[last].sqrt() }
    }

    fn motion(&self, i: usize, ends: &EndConditions) -> [[f64; 2]; 3] {
        let (from, to, third, weights) = self.slope_at(i);
        let middle = &self.problem.half[from.min(to)];
        let (a, b, c) = (ends.value(&self.u[from]), ends.value(&self.u[to]), ends.value(&self.u[third]));
        let (f, m) = (ends.load(&self.problem.f[from]), ends.load(middle));
        [
            a,
            [0, 1].map(|d| weights.apply([a[d], b[d], c[d]], [f[d], m[d]])),
            [0, 1].map(|d| self.problem.om2[i] * a[d] + f[d]),
        ]
    }
}

/// Slope at a knot: difference to the next knot less the integral of (h - s) times the right-hand side.
struct SlopeWeights {
    values: [f64; 3],
    load: f64,
}

impl SlopeWeights {
    /// For the knots at 0, `h` and `x`, seen in the direction `sign`.
    fn new(h: f64, x: f64, om2: [f64; 3], sign: f64) -> Self {
        let by_h = sign / h;
        let [w_0, w_1, w_2] = slope_weights(h, x);
        Self {
            values: [-by_h * (1.0 + w_0 * om2[0]), by_h * (1.0 - w_1 * om2[1]), -by_h * w_2 * om2[2]],
            load: -sign * h / 6.0,
        }
    }

    fn apply(&self, u: [f64; 3], [f, middle]: [f64; 2]) -> f64 {
        let v = &self.values;
        v[0] * u[0] + v[1] * u[1] + v[2] * u[2] + self.load * (f + 2.0 * middle)
    }
}

/// Integral of the hat function of a knot times the parabola through (-a, 0, c): weights of the three values.
fn hat_weights(a: f64, c: f64, by_a: f64, by_c: f64) -> [f64; 3] {
    let (sum, by_sum) = (a + c, 1.0 / (a + c));
    let m1 = (c - a) * sum / 6.0;
    let m2 = (a * a * a + c * c * c) / 12.0;
    let plus = (m2 + a * m1) * by_c * by_sum;
    let minus = (m2 - c * m1) * by_a * by_sum;
    [minus, sum / 2.0 - plus - minus, plus]
}

/// Integral of (h - s) times the parabola through (0, h, x) over [0, h]: weights of the three values.
fn slope_weights(h: f64, x: f64) -> [f64; 3] {
    let (m0, m1, m2) = (h * h / 2.0, h * h * h / 6.0, h * h * h * h / 12.0);
    let by = 1.0 / (h * x * (h - x));
    let one = (m2 - x * m1) * x * by;
    let other = (h * m1 - m2) * h * by;
    [m0 - one - other, one, other]
}
