//! Centre of gravity in closed form: one mass at constant height (thesis 4.6.5, (4.44); errata 2.6).
//!
//! `y.. = w^2 (y - p)` with p linear between control points falls apart into what converges, `zeta = y - y./w`, known at
//! the beginning, and what diverges, `xi = y + y./w`, known at the end. Forwards and backwards, with decaying
//! exponentials only, both are one line per piece: no system of equations, no horizon that is too long. The thesis leaves
//! the final velocity free; instead one control point moves, which is found from two passes because all is linear in it.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | w | sqrt(g / z) | 1/s |
//! | p_i, s_i | zero-moment point T/(m g) at control point i and its rate after it | m, m/s |
//! | a_i, b_i | `y = a e^{-w (h - tau)} + b e^{-w tau} + p_i + s_i tau` (4.44), scaled, signs of the errata | m |

use crate::boundary::PlanarState;
use crate::verdict::Verdict;
use crate::zmp::{MAX_NODES, ZmpProblem};
use curves::Sample;

/// Most control points.
pub const MAX_POINTS: usize = MAX_NODES + 1;

/// A zero-moment point by straight lines and the centre of gravity that belongs to it.
#[derive(Clone, Debug)]
pub struct Analytic {
    n: usize,
    /// The control point that moves; 0 for none yet.
    free: usize,
    w: f64,
    t: [f64; MAX_POINTS],
    p: [[f64; 2]; MAX_POINTS],
    a: [[f64; 2]; MAX_POINTS],
    b: [[f64; 2]; MAX_POINTS],
    decay: [f64; MAX_POINTS],
}

impl Analytic {
    /// For a centre of gravity at this height \[m\].
    pub fn new(height: f64) -> Self {
        Self {
            n: 0,
            free: 0,
            w: (crate::com::GRAVITY / height).sqrt(),
            t: [0.0; MAX_POINTS],
            p: [[0.0; 2]; MAX_POINTS],
            a: [[0.0; 2]; MAX_POINTS],
            b: [[0.0; 2]; MAX_POINTS],
            decay: [0.0; MAX_POINTS],
        }
    }

    /// Takes control points \[s\], \[m\]; the one with the index `free` is moved by [`Analytic::solve`].
    pub fn set(&mut self, points: impl IntoIterator<Item = (f64, [f64; 2])>, free: usize) -> Verdict {
        (self.n, self.free) = (0, free);
        for (t, p) in points {
            if self.n == MAX_POINTS {
                return Verdict::TooLong;
            }
            (self.t[self.n], self.p[self.n]) = (t, p);
            self.n += 1;
        }
        let ascending = self.t[..self.n].windows(2).all(|t| t[1] > t[0]);
        let inner = free > 0 && free + 1 < self.n;
        if ascending && inner { Verdict::Sound } else { Verdict::Degenerate }
    }

    /// Takes a reference and lets it move in the middle of its first phase, a double support.
    pub fn follow(&mut self, reference: &ZmpProblem) -> Verdict {
        let nodes = reference.nodes();
        let (Some(first), Some(second)) = (nodes.first(), nodes.get(1)) else { return Verdict::Degenerate };
        let middle = 0.5 * (first.time + second.time);
        let point = |n: &crate::zmp::Node| (n.time, n.p);
        let rest = nodes[1..].iter().map(point);
        self.set([point(first), (middle, reference.at(middle))].into_iter().chain(rest), 1)
    }

    /// Moves the free control point so that the centre of gravity begins with `begin` and ends at `end`.
    pub fn solve(&mut self, begin: &PlanarState, end: [f64; 2]) -> Verdict {
        let (n, w) = (self.n, self.w);
        if n < 3 || self.free == 0 {
            return Verdict::Degenerate;
        }
        for i in 0..n - 1 {
            self.decay[i] = (-w * (self.t[i + 1] - self.t[i])).exp();
        }
        // What begins to diverge if the free point moves by 1: its own forward wave, its echo from the fixed end.
        let unit =
            self.divergence(|i| if i == self.free { [1.0; 2] } else { [0.0; 2] }, [0.0; 2], [0.0; 2]).0[0];
        let begun = [0, 1].map(|d| begin.r[d] - begin.v[d] / w);
        let (xi, _) = self.divergence(|i| self.p[i], begun, end);
        for d in 0..2 {
            self.p[self.free][d] += (begin.r[d] + begin.v[d] / w - xi[d]) / unit;
        }
        self.waves(begun, end);
        let numbers = self.a[0].into_iter().chain(self.b[n - 2]).chain(self.p[self.free]);
        if numbers.into_iter().all(f64::is_finite) { Verdict::Sound } else { Verdict::NotFinite }
    }

    /// xi at the beginning for control points `p`, zeta at the beginning and the position at the end; zeta at the end.
    fn divergence(
        &self,
        p: impl Fn(usize) -> [f64; 2],
        zeta: [f64; 2],
        end: [f64; 2],
    ) -> ([f64; 2], [f64; 2]) {
        let (n, w) = (self.n, self.w);
        let rate = |i: usize, d: usize| (p(i + 1)[d] - p(i)[d]) / (self.t[i + 1] - self.t[i]) / w;
        let mut zeta = zeta;
        for i in 0..n - 1 {
            for (d, z) in zeta.iter_mut().enumerate() {
                let s = rate(i, d);
                *z = p(i + 1)[d] - s + (*z - p(i)[d] + s) * self.decay[i];
            }
        }
        let mut xi = [0, 1].map(|d| 2.0 * end[d] - zeta[d]);
        for i in (0..n - 1).rev() {
            for (d, x) in xi.iter_mut().enumerate() {
                let s = rate(i, d);
                *x = p(i)[d] + s + (*x - p(i + 1)[d] - s) * self.decay[i];
            }
        }
        (xi, zeta)
    }

    /// a and b of all pieces.
    fn waves(&mut self, zeta: [f64; 2], end: [f64; 2]) {
        let n = self.n;
        for d in 0..2 {
            let rate = |i: usize| (self.p[i + 1][d] - self.p[i][d]) / (self.t[i + 1] - self.t[i]) / self.w;
            let mut zeta = zeta[d];
            for i in 0..n - 1 {
                let s = rate(i);
                let b = zeta - self.p[i][d] + s;
                self.b[i][d] = 0.5 * b;
                zeta = self.p[i + 1][d] - s + b * self.decay[i];
            }
            let mut xi = 2.0 * end[d] - zeta;
            for i in (0..n - 1).rev() {
                let s = rate(i);
                let a = xi - self.p[i + 1][d] - s;
                self.a[i][d] = 0.5 * a;
                xi = self.p[i][d] + s + a * self.decay[i];
            }
        }
    }

    /// Control points: time \[s\] and zero-moment point \[m\].
    pub fn points(&self) -> impl Iterator<Item = (f64, [f64; 2])> + '_ {
        self.t[..self.n].iter().copied().zip(self.p[..self.n].iter().copied())
    }

    /// a and b of piece `i` \[m\], per axis.
    pub fn piece(&self, i: usize) -> [[f64; 2]; 2] {
        [self.a[i], self.b[i]]
    }

    /// Centre of gravity at `t` \[s\] (4.44); the outer pieces go on beyond the ends.
    pub fn sample(&self, t: f64) -> Sample<2> {
        let (n, w) = (self.n, self.w);
        let i = self.t[1..n - 1].partition_point(|&end| end <= t);
        let (h, tau) = (self.t[i + 1] - self.t[i], t - self.t[i]);
        let (rising, falling) = ((-w * (h - tau)).exp(), (-w * tau).exp());
        let mut s = Sample::rest([0.0; 2]);
        for d in 0..2 {
            let (a, b) = (self.a[i][d] * rising, self.b[i][d] * falling);
            let rate = (self.p[i + 1][d] - self.p[i][d]) / h;
            s.position[d] = a + b + self.p[i][d] + rate * tau;
            s.velocity[d] = w * (a - b) + rate;
            s.acceleration[d] = w * w * (a + b);
        }
        s
    }
}
