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
//! | gamma | amplitudes of the modifications (4.49) | m |
//! | w, xi | sqrt(om2) at the right end, divergent component r + v/w | 1/s, m |

use crate::pose::{Pose, rotate};
use crate::verdict::Verdict;
use curves::Sample;

/// Most knots of one problem.
pub const MAX_KNOTS: usize = 224;
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
#[derive(Clone)]
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

    /// Solves for all columns. Anything but [`Verdict::Sound`]: there is no solution, or not with these knots.
    pub fn solve(&mut self) -> Verdict {
        let n = self.n;
        if !(3..=MAX_KNOTS).contains(&n) {
            return Verdict::Degenerate;
        }
        self.u[0] = [0.0; U];
        self.u[n - 1] = [0.0; U];
        self.u[0][LEFT] = 1.0;
        self.u[n - 1][RIGHT] = 1.0;
        self.upper[0] = 0.0;
        let mut a = self.t[1] - self.t[0];
        let mut by_a = 1.0 / a;
        let mut falling = self.om2[0] <= 0.0 || self.om2[n - 1] <= 0.0;
        let mut degenerate = a <= 0.0;
        for i in 1..n - 1 {
            let c = self.t[i + 1] - self.t[i];
            let by_c = 1.0 / c;
            let [w_m, w_0, w_p] = hat_weights(a, c, by_a, by_c);
            let lower = w_m * self.om2[i - 1] - by_a;
            let diagonal = w_0 * self.om2[i] + by_a + by_c;
            let upper = w_p * self.om2[i + 1] - by_c;
            let pivot = diagonal - lower * self.upper[i - 1];
            falling |= self.om2[i] <= 0.0;
            degenerate |= c <= 0.0 || pivot <= 0.0;
            let pivot = 1.0 / pivot;
            self.upper[i] = upper * pivot;
            let (a6, c6) = (a / 6.0, c / 6.0);
            let (before, at, after) = (&self.half[i - 1], &self.f[i], &self.half[i]);
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
        for i in (1..n - 1).rev() {
            let next = self.u[i + 1];
            let upper = self.upper[i];
            for (u, v) in self.u[i].iter_mut().zip(next) {
                *u -= upper * v;
            }
        }
        // What is not a number spreads to both ends; the loads there are in slopes only.
        let ends = self.f[0].iter().chain(&self.f[n - 1]).chain(&self.u[1]).chain(&self.u[n - 2]);
        let finite = ends.copied().all(f64::is_finite);
        match (falling, degenerate, finite) {
            (true, ..) => Verdict::Falling,
            (_, true, _) => Verdict::Degenerate,
            (.., false) => Verdict::NotFinite,
            _ => Verdict::Sound,
        }
    }

    /// Slope of every column at knot `i` \[1/s\].
    pub fn slope(&self, i: usize) -> [f64; U] {
        let (from, to, third, weights) = self.slope_at(i);
        let middle = &self.half[from.min(to)];
        std::array::from_fn(|k| {
            let f = if k < F { [self.f[from][k], middle[k]] } else { [0.0; 2] };
            weights.apply([self.u[from][k], self.u[to][k], self.u[third][k]], f)
        })
    }

    /// Knots that the slope at knot `i` is made of, and their weights.
    fn slope_at(&self, i: usize) -> (usize, usize, usize, SlopeWeights) {
        // The last knot has no interval after it: mirror the one before it.
        let (from, to, third, sign) = if i + 1 == self.n {
            (i, i - 1, i.wrapping_sub(2), -1.0)
        } else if i == 0 {
            (0, 1, 2, 1.0)
        } else {
            (i, i + 1, i - 1, 1.0)
        };
        let h = (self.t[to] - self.t[from]).abs();
        let x = (self.t[third] - self.t[from]) * sign;
        let om2 = [self.om2[from], self.om2[to], self.om2[third]];
        (from, to, third, SlopeWeights::new(h, x, om2, sign))
    }

    /// Position, velocity and acceleration in the plane at knot `i` between given ends.
    pub fn motion(&self, i: usize, ends: &Ends) -> [[f64; 2]; 3] {
        let (from, to, third, weights) = self.slope_at(i);
        let middle = &self.half[from.min(to)];
        let (a, b, c) = (ends.value(&self.u[from]), ends.value(&self.u[to]), ends.value(&self.u[third]));
        let (f, m) = (ends.load(&self.f[from]), ends.load(middle));
        [
            a,
            [0, 1].map(|d| weights.apply([a[d], b[d], c[d]], [f[d], m[d]])),
            [0, 1].map(|d| self.om2[i] * a[d] + f[d]),
        ]
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

    /// The ends that begin with `begin` and meet only the divergent component of `target` (thesis 4.6.2, Takenaka;
    /// gap 13), by the smallest amplitudes.
    pub fn divergent_ends(&self, begin: &State, target: &State) -> Ends {
        let (a, b) = (self.slope(0), self.slope(self.n - 1));
        let w = self.om2[self.n - 1].sqrt();
        let left = b[RIGHT] + w; // v_n + w r_n = xi w, solved for r_n, and that put into the slope at the begin
        let by = a[RIGHT] / left;
        let c = [a[2] - by * b[2], a[3] - by * b[3]];
        let square = c[0] * c[0] + c[1] * c[1];
        let mut ends = Ends { begin: begin.r, end: [0.0; 2], gamma: [[0.0; 2]; 2] };
        for d in 0..2 {
            let rest = target.v[d] + w * target.r[d] - b[d] - b[LEFT] * begin.r[d];
            let e = begin.v[d] - a[d] - a[LEFT] * begin.r[d] - by * rest;
            let gamma = c.map(|c| c * e / square);
            ends.gamma[0][d] = gamma[0];
            ends.gamma[1][d] = gamma[1];
            ends.end[d] = (rest - b[2] * gamma[0] - b[3] * gamma[1]) / left;
        }
        ends
    }
}

/// What selects one solution: positions at both ends and amplitudes, per axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ends {
    /// \[m\]
    pub begin: [f64; 2],
    /// \[m\]
    pub end: [f64; 2],
    /// \[m\] gamma_0, gamma_1.
    pub gamma: [[f64; 2]; 2],
}

impl Ends {
    fn value(&self, u: &[f64; U]) -> [f64; 2] {
        [0, 1].map(|d| {
            u[d] + self.gamma[0][d] * u[2]
                + self.gamma[1][d] * u[3]
                + self.begin[d] * u[LEFT]
                + self.end[d] * u[RIGHT]
        })
    }

    fn load(&self, f: &[f64; F]) -> [f64; 2] {
        [0, 1].map(|d| f[d] + self.gamma[0][d] * f[2] + self.gamma[1][d] * f[3])
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
