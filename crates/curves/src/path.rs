//! A piecewise quintic in `D` dimensions with room for `N` pieces (thesis eq. (4.22)).

/// Position, velocity and acceleration of a `D`-dimensional curve at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<const D: usize> {
    /// Value, in the unit of the curve.
    pub position: [f64; D],
    /// First derivative, per second.
    pub velocity: [f64; D],
    /// Second derivative, per second squared.
    pub acceleration: [f64; D],
}

impl<const D: usize> Sample<D> {
    /// A point at rest.
    pub const fn rest(position: [f64; D]) -> Self {
        Self { position, velocity: [0.0; D], acceleration: [0.0; D] }
    }
}

/// A piecewise quintic polynomial: piece `i` covers `[knots[i], knots[i + 1])` in local time `t - knots[i]`.
///
/// Outside of its knots a path rests at its first or last position: a path that ends at rest can be held for ever.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Path<const D: usize, const N: usize> {
    /// Number of pieces in use; 0 until the first [`Path::push`].
    pub pieces: u64,
    /// Start of the first piece \[s\].
    pub start: f64,
    /// Point at which the path rests before its first piece.
    pub origin: [f64; D],
    /// End of each piece \[s\], ascending.
    pub ends: [f64; N],
    /// Coefficients of each piece, one row per dimension, constant term first (4.22).
    pub coefficients: [[[f64; 6]; D]; N],
}

impl<const D: usize, const N: usize> Path<D, N> {
    /// A path without pieces: rests at `position` at all times.
    pub const fn resting(start: f64, position: [f64; D]) -> Self {
        Self { pieces: 0, start, origin: position, ends: [0.0; N], coefficients: [[[0.0; 6]; D]; N] }
    }

    /// Removes all pieces: rests at `position` at all times, until the next [`Path::push`].
    pub fn restart(&mut self, start: f64, position: [f64; D]) {
        self.pieces = 0;
        self.start = start;
        self.origin = position;
    }

    /// End of the last piece \[s\].
    pub fn end(&self) -> f64 {
        if self.pieces == 0 { self.start } else { self.ends[self.pieces as usize - 1] }
    }

    /// Appends the quintic that meets both ends, (4.23)-(4.28) with the corrections of errata 2.5; `false` if the
    /// path is full or `end` does not lie after the present end.
    pub fn push(&mut self, from: &Sample<D>, to: &Sample<D>, end: f64) -> bool {
        let i = self.pieces as usize;
        let h = end - self.end();
        if i >= N || !(h > 0.0) {
            return false;
        }
        for d in 0..D {
            self.coefficients[i][d] = quintic(
                (from.position[d], from.velocity[d], from.acceleration[d]),
                (to.position[d], to.velocity[d], to.acceleration[d]),
                h,
            );
        }
        if i == 0 {
            self.origin = from.position;
        }
        self.ends[i] = end;
        self.pieces += 1;
        true
    }

    /// A reader for ascending times, which does not look for its piece each time.
    pub fn cursor(&self) -> Cursor<'_, D, N> {
        Cursor { path: self, piece: None, still: false }
    }

    /// Value and derivatives at `t` \[s\].
    pub fn sample(&self, t: f64) -> Sample<D> {
        let n = self.pieces as usize;
        if n == 0 || t < self.start {
            return Sample::rest(self.origin);
        }
        // Few pieces and mostly the first ones: a scan beats a bisection.
        let i = self.ends[..n].iter().position(|&end| t < end).unwrap_or(n - 1);
        let begin = if i == 0 { self.start } else { self.ends[i - 1] };
        let mut s = self.at(i, t.min(self.ends[n - 1]) - begin);
        if t >= self.ends[n - 1] {
            s = Sample::rest(s.position);
        }
        s
    }

    /// Piece `i` after `tau` \[s\].
    fn at(&self, i: usize, tau: f64) -> Sample<D> {
        let mut s = Sample::rest([0.0; D]);
        for d in 0..D {
            let c = &self.coefficients[i][d];
            s.position[d] = c[0] + tau * (c[1] + tau * (c[2] + tau * (c[3] + tau * (c[4] + tau * c[5]))));
            s.velocity[d] =
                c[1] + tau * (2.0 * c[2] + tau * (3.0 * c[3] + tau * (4.0 * c[4] + tau * 5.0 * c[5])));
            s.acceleration[d] = 2.0 * c[2] + tau * (6.0 * c[3] + tau * (12.0 * c[4] + tau * 20.0 * c[5]));
        }
        s
    }
}

/// Reads a path at ascending times: the same values as [`Path::sample`].
#[derive(Clone, Debug)]
pub struct Cursor<'a, const D: usize, const N: usize> {
    path: &'a Path<D, N>,
    piece: Option<usize>,
    /// The piece does not move.
    still: bool,
}

impl<const D: usize, const N: usize> Cursor<'_, D, N> {
    /// Value and derivatives at `t` \[s\], which must not lie before the last one asked for.
    pub fn sample(&mut self, t: f64) -> Sample<D> {
        let path = self.path;
        let n = path.pieces as usize;
        if n == 0 || !(t >= path.start) || t >= path.ends[n - 1] {
            return path.sample(t);
        }
        let mut i = self.piece.unwrap_or(0);
        while t >= path.ends[i] {
            i += 1;
        }
        if self.piece != Some(i) {
            self.piece = Some(i);
            self.still = path.coefficients[i].iter().all(|c| c[1..] == [0.0; 5]);
        }
        if self.still {
            return Sample::rest(path.coefficients[i].map(|c| c[0]));
        }
        path.at(i, t - if i == 0 { path.start } else { path.ends[i - 1] })
    }
}

/// Coefficients of the quintic through (position, velocity, acceleration) at both ends of an interval of
/// length `h` \[s\] (errata 2.5).
pub fn quintic((p0, v0, a0): (f64, f64, f64), (p1, v1, a1): (f64, f64, f64), h: f64) -> [f64; 6] {
    let dp = p1 - p0 - v0 * h - a0 * h * h / 2.0;
    let dv = v1 - v0 - a0 * h;
    let da = a1 - a0;
    let (h2, by_h) = (h * h, 1.0 / h);
    let by_h3 = by_h * by_h * by_h;
    [
        p0,
        v0,
        a0 / 2.0,
        (10.0 * dp - 4.0 * dv * h + da * h2 / 2.0) * by_h3,
        (-15.0 * dp + 7.0 * dv * h - da * h2) * by_h3 * by_h,
        (6.0 * dp - 3.0 * dv * h + da * h2 / 2.0) * by_h3 * by_h * by_h,
    ]
}
