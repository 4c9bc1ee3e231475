//! Centre of gravity in closed form: one mass at constant height (thesis 4.6.5, (4.44); errata 2.6).
//!
//! `u.. = w^2 (u - p)` with p linear between knots falls apart into what converges, `zeta = u - u./w`, and what diverges,
//! `xi = u + u./w`. Forwards and backwards, with decaying exponentials only, both are one line per piece: no system of
//! equations, no horizon that is too long. Each knows its value at one end; what the positions at both ends ask of these
//! two values is found from a first pass, because all is linear in them. In a piece of length h this is
//! `u = a e^{-w (h - tau)} + b e^{-w tau} + p_i + s_i tau` (4.44), with the signs of the errata: `a` is half of what xi, at its
//! end, is beyond `p + s/w`, `b` half of what zeta, at its begin, is beyond `p - s/w`.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | w | sqrt(om2) = sqrt(g / z) | 1/s |
//! | p, s | -f / w^2, zero-moment point T/(m g) of a column, and its rate in a piece over w | m |
//! | e | e^{-w h} of all pieces together | 1 |

use crate::boundary::{
    BoundaryProblem, BoundarySolver, EndConditions, EndSlopes, F, LEFT, MAX_KNOTS, RIGHT, U,
};
use crate::verdict::PlanVerdict;

/// Share by which om2 and the middle of a piece may be off and still count as constant and as straight.
const STRAIGHT: f64 = 1e-6;

/// A problem and its solution.
#[derive(Clone)]
pub struct ClosedForm {
    /// The problem.
    pub problem: BoundaryProblem,
    w: f64,
    /// e^{-w h} of the piece after a knot.
    decay: [f64; MAX_KNOTS],
    /// zeta and xi of all columns at the knots.
    zeta: [[f64; U]; MAX_KNOTS],
    xi: [[f64; U]; MAX_KNOTS],
}

impl Default for ClosedForm {
    fn default() -> Self {
        Self::new()
    }
}

impl ClosedForm {
    /// Room for a problem.
    pub fn new() -> Self {
        Self {
            problem: BoundaryProblem::new(),
            w: 0.0,
            decay: [0.0; MAX_KNOTS],
            zeta: [[0.0; U]; MAX_KNOTS],
            xi: [[0.0; U]; MAX_KNOTS],
        }
    }

    /// Verdict on the problem before it is solved.
    fn posed(&self) -> PlanVerdict {
        let BoundaryProblem { n, t, om2, f, half } = &self.problem;
        let n = *n;
        if !(3..=MAX_KNOTS).contains(&n) {
            return PlanVerdict::Degenerate;
        }
        let numbers = om2[..n].iter().chain(f[..n].iter().chain(&half[..n - 1]).flatten());
        if !t[..n].iter().chain(numbers).all(|x| x.is_finite()) {
            return PlanVerdict::NotFinite;
        }
        if om2[..n].iter().any(|x| *x <= 0.0) {
            return PlanVerdict::Falling;
        }
        if t[..n].windows(2).any(|t| t[1] <= t[0]) {
            return PlanVerdict::Degenerate;
        }
        // Heights that change show in om2, legs that swing in loads that are no straight lines.
        let level = om2[..n].iter().all(|x| (x - om2[0]).abs() <= STRAIGHT * om2[0]);
        let straight = (1..n).all(|i| {
            (0..F).all(|k| (half[i - 1][k] - 0.5 * (f[i - 1][k] + f[i][k])).abs() <= STRAIGHT * om2[0])
        });
        if level && straight { PlanVerdict::Sound } else { PlanVerdict::NotOneMass }
    }

    /// p of column `k` at knot `i`; the columns of unit ends have none.
    fn p(&self, i: usize, k: usize) -> f64 {
        if k < F { -self.problem.f[i][k] / (self.w * self.w) } else { 0.0 }
    }

    /// zeta of all knots from the one at the begin, xi from the one at the end, of column `k`.
    fn sweep(&mut self, k: usize, zeta: f64, xi: f64) {
        let n = self.problem.n;
        (self.zeta[0][k], self.xi[n - 1][k]) = (zeta, xi);
        let rate = |this: &Self, i: usize| {
            let h = this.problem.t[i + 1] - this.problem.t[i];
            (this.p(i + 1, k) - this.p(i, k)) / h / this.w
        };
        for i in 0..n - 1 {
            let s = rate(self, i);
            self.zeta[i + 1][k] = self.p(i + 1, k) - s + (self.zeta[i][k] - self.p(i, k) + s) * self.decay[i];
        }
        for i in (0..n - 1).rev() {
            let s = rate(self, i);
            self.xi[i][k] = self.p(i, k) + s + (self.xi[i + 1][k] - self.p(i + 1, k) - s) * self.decay[i];
        }
    }

    fn value(&self, i: usize) -> [f64; U] {
        std::array::from_fn(|k| 0.5 * (self.zeta[i][k] + self.xi[i][k]))
    }

    fn slope(&self, i: usize) -> [f64; U] {
        std::array::from_fn(|k| 0.5 * self.w * (self.xi[i][k] - self.zeta[i][k]))
    }
}

impl BoundarySolver for ClosedForm {
    fn problem(&self) -> &BoundaryProblem {
        &self.problem
    }

    fn problem_mut(&mut self) -> &mut BoundaryProblem {
        &mut self.problem
    }

    fn solve(&mut self) -> PlanVerdict {
        let verdict = self.posed();
        if verdict != PlanVerdict::Sound {
            return verdict;
        }
        let n = self.problem.n;
        self.w = self.problem.om2[0].sqrt();
        for i in 0..n - 1 {
            self.decay[i] = (-self.w * (self.problem.t[i + 1] - self.problem.t[i])).exp();
        }
        let e = self.decay[..n - 1].iter().product::<f64>();
        for k in 0..U {
            // What reaches the other end from nothing, and with it the values for u_0 and u_n: zeta + xi = 2 u.
            self.sweep(k, 0.0, 0.0);
            let (zeta, xi) = (self.zeta[n - 1][k], self.xi[0][k]);
            let [begin, end] = [LEFT, RIGHT].map(|column| if k == column { 2.0 } else { 0.0 });
            let first = (begin - xi - e * (end - zeta)) / (1.0 - e * e);
            self.sweep(k, first, end - zeta - e * first);
        }
        let ends = self.zeta[n - 1].iter().chain(&self.xi[0]);
        if ends.copied().all(f64::is_finite) { PlanVerdict::Sound } else { PlanVerdict::NotFinite }
    }

    fn ends(&self) -> EndSlopes {
        EndSlopes { slopes: [self.slope(0), self.slope(self.problem.n - 1)], w: self.w }
    }

    fn motion(&self, i: usize, ends: &EndConditions) -> [[f64; 2]; 3] {
        let (r, f) = (ends.value(&self.value(i)), ends.load(&self.problem.f[i]));
        let v = ends.value(&self.slope(i));
        [r, v, [0, 1].map(|d| self.problem.om2[i] * r[d] + f[d])]
    }
}
