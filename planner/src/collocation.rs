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

use crate::pose::{Pose, rotate};
use curves::Sample;

/// Most knots of one problem.
pub const MAX_KNOTS: usize = 97;
/// Columns of right-hand sides: r_x, r_y, q_0, q_1.
pub const F: usize = 4;
/// Columns of solutions: those of the right-hand sides, left end, right end.
pub const U: usize = 6;
/// Column of the unit value at the left end.
pub const LEFT: usize = 4;
/// Column of the unit value at the right end.
pub const RIGHT: usize = 5;

/// Position and velocity in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// \[m\]
    pub r: [f64; 2],
    /// \[m/s\]
    pub v: [f64; 2],
}

impl State {
    /// The horizontal part of a motion.
    pub fn of(s: &Sample<3>) -> Self {
        Self { r: [s.position[0], s.position[1]], v: [s.velocity[0], s.velocity[1]] }
    }
}

/// A problem and its solution.
pub struct Collocation {
    /// Number of knots.
    pub n: usize,
    /// Knots \[s\].
    pub t: [f64; MAX_KNOTS],
    /// om2 at the knots.
    pub om2: [f64; MAX_KNOTS],
    /// Right-hand sides at the knots.
    pub f: [[f64; F]; MAX_KNOTS],
    /// Right-hand sides in the middle between a knot and the next one.
    pub half: [[f64; F]; MAX_KNOTS],
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
        Self {
            n: 0,
            t: [0.0; MAX_KNOTS],
            om2: [0.0; MAX_KNOTS],
            f: [[0.0; F]; MAX_KNOTS],
            half: [[0.0; F]; MAX_KNOTS],
            u: [[0.0; U]; MAX_KNOTS],
            upper: [0.0; MAX_KNOTS],
        }
    }

    /// Solves for all columns.
    pub fn solve(&mut self) {
        let n = self.n;
        if n < 3 {
            return;
        }
        self.u[0] = [0.0; U];
        self.u[n - 1] = [0.0; U];
        self.u[0][LEFT] = 1.0;
        self.u[n - 1][RIGHT] = 1.0;
        self.upper[0] = 0.0;
        for i in 1..n - 1 {
            let (a, c) = (self.t[i] - self.t[i - 1], self.t[i + 1] - self.t[i]);
            let [w_m, w_0, w_p] = hat_weights(a, c);
            let lower = w_m * self.om2[i - 1] - 1.0 / a;
            let diagonal = w_0 * self.om2[i] + 1.0 / a + 1.0 / c;
            let upper = w_p * self.om2[i + 1] - 1.0 / c;
            let pivot = 1.0 / (diagonal - lower * self.upper[i - 1]);
            self.upper[i] = upper * pivot;
            for k in 0..U {
                let load = if k < F {
                    a / 6.0 * (2.0 * self.half[i - 1][k] + self.f[i][k])
                        + c / 6.0 * (self.f[i][k] + 2.0 * self.half[i][k])
                } else {
                    0.0
                };
                self.u[i][k] = (-load - lower * self.u[i - 1][k]) * pivot;
            }
        }
        for i in (1..n - 1).rev() {
            for k in 0..U {
                self.u[i][k] -= self.upper[i] * self.u[i + 1][k];
            }
        }
    }

    /// Slope of every column at knot `i` \[1/s\].
    pub fn slope(&self, i: usize) -> [f64; U] {
        let n = self.n;
        // The last knot has no interval after it: mirror the one before it.
        let (from, to, third, sign) = if i + 1 == n {
            (i, i - 1, i.wrapping_sub(2), -1.0)
        } else if i == 0 {
            (0, 1, 2, 1.0)
        } else {
            (i, i + 1, i - 1, 1.0)
        };
        let h = (self.t[to] - self.t[from]).abs();
        let third_at = (self.t[third] - self.t[from]) * sign;
        let [w_0, w_1, w_2] = slope_weights(h, third_at);
        let middle = &self.half[from.min(to)];
        std::array::from_fn(|k| {
            let (u0, u1, u2) = (self.u[from][k], self.u[to][k], self.u[third][k]);
            let g = w_0 * self.om2[from] * u0 + w_1 * self.om2[to] * u1 + w_2 * self.om2[third] * u2;
            let f = if k < F { h / 6.0 * (self.f[from][k] + 2.0 * middle[k]) } else { 0.0 };
            sign * ((u1 - u0) / h - g / h - f)
        })
    }

    /// The start state of the periodic solution whose end is its start, moved as `from` is moved to `to`
    /// ((4.31), errata 2.9). Complex numbers stand for vectors in the plane: x + i y.
    pub fn periodic_state(&self, from: &Pose, to: &Pose) -> State {
        let (a, b) = (self.slope(0), self.slope(self.n - 1));
        let angle = to.heading - from.heading;
        let turn = |v: [f64; 2]| rotate(angle, v);
        let moved = turn([from.x, from.y]);
        let d = [to.x - moved[0], to.y - moved[1]]; // r_b = R r_a + d
        // (a_l R + a_r R^2 - b_l - b_r R) r_a = b_r d + P_b - R (a_r d + P_a)
        let (s, c) = angle.sin_cos();
        let (s2, c2) = (2.0 * angle).sin_cos();
        let (l, r) = (LEFT, RIGHT);
        let m = [a[l] * c + a[r] * c2 - b[l] - b[r] * c, a[l] * s + a[r] * s2 - b[r] * s];
        let at_a = turn([0, 1].map(|k| a[r] * d[k] + a[k]));
        let rhs = [0, 1].map(|k| b[r] * d[k] + b[k] - at_a[k]);
        let det = m[0] * m[0] + m[1] * m[1];
        let r_a = [(m[0] * rhs[0] + m[1] * rhs[1]) / det, (m[0] * rhs[1] - m[1] * rhs[0]) / det];
        let turned = turn(r_a);
        State { r: r_a, v: [0, 1].map(|k| a[l] * r_a[k] + a[r] * (turned[k] + d[k]) + a[k]) }
    }

    /// Amplitudes gamma_0, gamma_1 per axis that meet position and velocity at both ends (4.51)-(4.54).
    pub fn amplitudes(&self, begin: &State, end: &State) -> [[f64; 2]; 2] {
        let (a, b) = (self.slope(0), self.slope(self.n - 1));
        let det = a[2] * b[3] - a[3] * b[2];
        let mut gamma = [[0.0; 2]; 2];
        for d in 0..2 {
            let va = begin.v[d] - a[d] - a[LEFT] * begin.r[d] - a[RIGHT] * end.r[d];
            let vb = end.v[d] - b[d] - b[LEFT] * begin.r[d] - b[RIGHT] * end.r[d];
            gamma[0][d] = (va * b[3] - a[3] * vb) / det;
            gamma[1][d] = (a[2] * vb - va * b[2]) / det;
        }
        gamma
    }
}

/// Integral of the hat function of a knot times the parabola through (-a, 0, c): weights of the three values.
fn hat_weights(a: f64, c: f64) -> [f64; 3] {
    let m1 = (c * c - a * a) / 6.0;
    let m2 = (a * a * a + c * c * c) / 12.0;
    let plus = (m2 + a * m1) / (c * (a + c));
    let minus = (m2 - c * m1) / (a * (a + c));
    [minus, (a + c) / 2.0 - plus - minus, plus]
}

/// Integral of (h - s) times the parabola through (0, h, x) over [0, h]: weights of the three values.
fn slope_weights(h: f64, x: f64) -> [f64; 3] {
    let (m0, m1, m2) = (h * h / 2.0, h * h * h / 6.0, h * h * h * h / 12.0);
    let one = (m2 - x * m1) / (h * (h - x));
    let other = (m2 - h * m1) / (x * (x - h));
    [m0 - one - other, one, other]
}
