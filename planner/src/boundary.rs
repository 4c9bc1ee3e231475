//! Boundary value problems `u.. = om2(t) u + f(t)` of the centre of gravity, and what their ends must meet (thesis 4.6.2,
//! 4.6.5). How they are solved is the matter of `cog_method`.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | om2 | (z_b.. + g) / z_b | 1/s^2 |
//! | f | columns: r_x, r_y of the reference, q_0, q_1 of the modifications (4.49) | m/s^2 |
//! | u | columns: the same, then unit value at the left end, unit value at the right end | m |
//! | a, b | slopes of u at the left and at the right end | 1/s |
//! | gamma | amplitudes of the modifications (4.49) | m |
//! | w, xi | sqrt(om2) at the right end, divergent component r + v/w | 1/s, m |

use crate::pose::{PlanarPose, rotate};
use crate::verdict::PlanVerdict;
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
pub struct PlanarState {
    /// \[m\]
    pub r: [f64; 2],
    /// \[m/s\]
    pub v: [f64; 2],
}

impl PlanarState {
    /// The horizontal part of a motion.
    pub fn of(s: &Sample<3>) -> Self {
        Self { r: [s.position[0], s.position[1]], v: [s.velocity[0], s.velocity[1]] }
    }
}

/// A boundary value problem on knots.
#[derive(Clone)]
pub struct BoundaryProblem {
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
}

impl Default for BoundaryProblem {
    fn default() -> Self {
        Self::new()
    }
}

impl BoundaryProblem {
    /// Room for a problem.
    pub fn new() -> Self {
        Self {
            n: 0,
            t: [0.0; MAX_KNOTS],
            om2: [0.0; MAX_KNOTS],
            f: [[0.0; F]; MAX_KNOTS],
            half: [[0.0; F]; MAX_KNOTS],
        }
    }
}

/// Solver of a boundary value problem that it holds.
pub trait BoundarySolver {
    /// The problem.
    fn problem(&self) -> &BoundaryProblem;

    /// The problem, to be written before it is solved.
    fn problem_mut(&mut self) -> &mut BoundaryProblem;

    /// Solves for all columns. Anything but [`PlanVerdict::Sound`]: there is no solution, or not by this method.
    fn solve(&mut self) -> PlanVerdict;

    /// Slopes of all columns at both ends.
    fn ends(&self) -> EndSlopes;

    /// Position, velocity and acceleration in the plane at knot `i` between given ends.
    fn motion(&self, i: usize, ends: &EndConditions) -> [[f64; 2]; 3];
}

/// Selection of one solution: positions at both ends and amplitudes, per axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EndConditions {
    /// \[m\]
    pub begin: [f64; 2],
    /// \[m\]
    pub end: [f64; 2],
    /// \[m\] gamma_0, gamma_1.
    pub gamma: [[f64; 2]; 2],
}

impl EndConditions {
    pub(crate) fn value(&self, u: &[f64; U]) -> [f64; 2] {
        [0, 1].map(|d| {
            u[d] + self.gamma[0][d] * u[2]
                + self.gamma[1][d] * u[3]
                + self.begin[d] * u[LEFT]
                + self.end[d] * u[RIGHT]
        })
    }

    pub(crate) fn load(&self, f: &[f64; F]) -> [f64; 2] {
        [0, 1].map(|d| f[d] + self.gamma[0][d] * f[2] + self.gamma[1][d] * f[3])
    }
}

/// Slopes of all columns at both ends of a solved problem: all that the conditions at the ends need.
#[derive(Clone, Copy, Debug)]
pub struct EndSlopes {
    /// a, b
    pub slopes: [[f64; U]; 2],
    /// w \[1/s\]
    pub w: f64,
}

impl EndSlopes {
    /// The start state of the periodic solution whose end is its start, moved as `from` is moved to `to`
    /// ((4.31), errata 2.9). Complex numbers stand for vectors in the plane: x + i y.
    pub fn periodic_state(&self, from: &PlanarPose, to: &PlanarPose) -> PlanarState {
        let [a, b] = &self.slopes;
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
        PlanarState { r: r_a, v: [0, 1].map(|k| a[l] * r_a[k] + a[r] * (turned[k] + d[k]) + a[k]) }
    }

    /// Amplitudes gamma_0, gamma_1 per axis that meet position and velocity at both ends (4.51)-(4.54).
    pub fn amplitudes(&self, begin: &PlanarState, end: &PlanarState) -> [[f64; 2]; 2] {
        let [a, b] = &self.slopes;
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
    pub fn divergent_ends(&self, begin: &PlanarState, target: &PlanarState) -> EndConditions {
        let [a, b] = &self.slopes;
        let w = self.w;
        let left = b[RIGHT] + w; // v_n + w r_n = xi w, solved for r_n, and that put into the slope at the begin
        let by = a[RIGHT] / left;
        let c = [a[2] - by * b[2], a[3] - by * b[3]];
        let square = c[0] * c[0] + c[1] * c[1];
        let mut ends = EndConditions { begin: begin.r, end: [0.0; 2], gamma: [[0.0; 2]; 2] };
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
