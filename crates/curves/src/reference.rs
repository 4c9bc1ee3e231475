//! Reference, which only tests call: natural cubic splines and their gradients in the control points (thesis appendix E, errata 2.15).
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | t_i, h_i | knots and intervals between them | s |
//! | p_i | control points: the values at the knots | any |
//! | M_i | second derivatives at the knots, zero at both ends | p/s^2 |
//! | a, b, c, d | coefficients of a piece: `a tau^3 + b tau^2 + c tau + d` | |
//!
//! The spline is linear in its control points: `s(t) = (grad s(t)) p`, which is what collocation needs (4.45)-(4.47).
//! Thesis (E.8), (E.9), (E.12) and (E.16) are wrong as printed; the forms here are those of the errata.

/// Value, slope and curvature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplineSample {
    /// s(t)
    pub value: f64,
    /// s'(t)
    pub slope: f64,
    /// s''(t)
    pub curvature: f64,
}

/// Gradients of value, slope and curvature in the control points; entries beyond the last control point are zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gradient<const N: usize> {
    /// Gradient of s(t).
    pub value: [f64; N],
    /// Gradient of s'(t).
    pub slope: [f64; N],
    /// Gradient of s''(t).
    pub curvature: [f64; N],
}

/// The knots of natural cubic splines, with everything that does not depend on the control points.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline<const N: usize> {
    n: usize,
    t: [f64; N],
    /// Eliminated upper diagonal and inverse pivots of the system for M (E.8).
    upper: [f64; N],
    pivot: [f64; N],
}

impl<const N: usize> Spline<N> {
    /// Splines with these knots \[s\]. `None` if there are fewer than two or more than `N`, or if they do not ascend
    /// (a knot that is not a number does not).
    pub fn new(knots: &[f64]) -> Option<Self> {
        let n = knots.len();
        let ascending = knots.windows(2).all(|w| w[1] > w[0]) && knots.iter().all(|t| t.is_finite());
        if !(2..=N).contains(&n) || !ascending {
            return None;
        }
        let mut s = Self { n, t: [0.0; N], upper: [0.0; N], pivot: [0.0; N] };
        s.t[..n].copy_from_slice(knots);
        for i in 1..n - 1 {
            let (a, c) = (s.h(i - 1), s.h(i));
            s.pivot[i] = 1.0 / (2.0 * (a + c) - a * s.upper[i - 1]);
            s.upper[i] = c * s.pivot[i];
        }
        Some(s)
    }

    /// The knots \[s\].
    pub fn knots(&self) -> &[f64] {
        &self.t[..self.n]
    }

    fn h(&self, i: usize) -> f64 {
        self.t[i + 1] - self.t[i]
    }

    /// Second derivatives M at the knots for the control points `p`, one for each knot: a tridiagonal system (E.8).
    pub fn curvatures(&self, p: &[f64]) -> [f64; N] {
        let mut m = [0.0; N];
        let n = self.n;
        if p.len() < n {
            return [f64::NAN; N];
        }
        for i in 1..n - 1 {
            let (a, c) = (self.h(i - 1), self.h(i));
            let rhs = 6.0 * (p[i + 1] - p[i]) / c - 6.0 * (p[i] - p[i - 1]) / a; // (E.8), signs of the errata
            m[i] = (rhs - a * m[i - 1]) * self.pivot[i];
        }
        for i in (1..n - 1).rev() {
            m[i] -= self.upper[i] * m[i + 1];
        }
        m
    }

    /// Coefficients (a, b, c, d) of piece `i` (E.7), (E.10)-(E.12).
    pub fn coefficients(&self, i: usize, p: &[f64], m: &[f64; N]) -> [f64; 4] {
        let h = self.h(i);
        [
            (m[i + 1] - m[i]) / (6.0 * h),
            m[i] / 2.0,
            (p[i + 1] - p[i]) / h - h * (2.0 * m[i] + m[i + 1]) / 6.0, // (E.12): h/3 and h/6, not 1/(3h), 1/(6h)
            p[i],
        ]
    }

    /// Piece that holds `t`; the first or last one beyond the ends.
    fn piece(&self, t: f64) -> usize {
        self.t[1..self.n - 1].partition_point(|&knot| knot <= t)
    }

    /// The spline with control points `p` and their curvatures `m` at `t`; beyond its ends the outer pieces go on.
    pub fn sample(&self, p: &[f64], m: &[f64; N], t: f64) -> SplineSample {
        let i = self.piece(t);
        let [a, b, c, d] = self.coefficients(i, p, m);
        let tau = t - self.t[i];
        SplineSample {
            value: d + tau * (c + tau * (b + tau * a)),
            slope: c + tau * (2.0 * b + tau * 3.0 * a),
            curvature: 2.0 * b + 6.0 * a * tau,
        }
    }

    /// Gradients at `t` in the control points (4.45)-(4.47), (E.13)-(E.21).
    ///
    /// The piece needs M_i and M_{i+1} only, so two rows of the inverse of the system are enough: O(n).
    pub fn gradient(&self, t: f64) -> Gradient<N> {
        let i = self.piece(t);
        let (h, tau) = (self.h(i), t - self.t[i]);
        let (mi, mj) = (self.curvature_gradient(i), self.curvature_gradient(i + 1));
        let mut g = Gradient { value: [0.0; N], slope: [0.0; N], curvature: [0.0; N] };
        for k in 0..self.n {
            let at = |j: usize| if k == j { 1.0 } else { 0.0 };
            let a = (mj[k] - mi[k]) / (6.0 * h);
            let b = mi[k] / 2.0;
            let c = (at(i + 1) - at(i)) / h - h * (2.0 * mi[k] + mj[k]) / 6.0;
            g.value[k] = at(i) + tau * (c + tau * (b + tau * a));
            g.slope[k] = c + tau * (2.0 * b + tau * 3.0 * a);
            g.curvature[k] = 2.0 * b + 6.0 * a * tau;
        }
        g
    }

    /// Gradient of M_i in the control points: a row of the inverse (the system is symmetric) times (E.16).
    fn curvature_gradient(&self, i: usize) -> [f64; N] {
        let n = self.n;
        let mut row = [0.0; N];
        let mut g = [0.0; N];
        if i == 0 || i + 1 >= n {
            return g;
        }
        for k in i..n - 1 {
            let unit = if k == i { 1.0 } else { 0.0 };
            row[k] = (unit - self.h(k - 1) * row[k - 1]) * self.pivot[k];
        }
        for k in (1..n - 1).rev() {
            row[k] -= self.upper[k] * row[k + 1];
        }
        for k in 1..n - 1 {
            let (a, c) = (6.0 / self.h(k - 1), 6.0 / self.h(k));
            g[k - 1] += a * row[k]; // (E.16)
            g[k] -= (a + c) * row[k];
            g[k + 1] += c * row[k];
        }
        g
    }
}
