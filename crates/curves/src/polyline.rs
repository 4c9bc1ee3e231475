//! A piecewise linear function in `D` dimensions with room for `N` points.

/// Points joined by straight lines; rests at its first point before them and at its last point after them.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polyline<const D: usize, const N: usize> {
    /// Number of points in use.
    pub points: u64,
    /// Time of each point \[s\], ascending.
    pub times: [f64; N],
    /// Value at each point.
    pub values: [[f64; D]; N],
}

impl<const D: usize, const N: usize> Polyline<D, N> {
    /// The constant function.
    pub const fn constant(value: [f64; D]) -> Self {
        let mut values = [[0.0; D]; N];
        values[0] = value;
        Self { points: 1, times: [0.0; N], values }
    }

    /// No points yet: the first [`Polyline::push`] sets the beginning.
    pub const fn empty() -> Self {
        Self { points: 0, times: [0.0; N], values: [[0.0; D]; N] }
    }

    /// Removes all points.
    pub fn clear(&mut self) {
        self.points = 0;
    }

    /// Appends a point; `false` if there is no room or `time` does not lie after the last point.
    pub fn push(&mut self, time: f64, value: [f64; D]) -> bool {
        let n = self.points as usize;
        if n >= N || (n > 0 && !(time > self.times[n - 1])) {
            return false;
        }
        self.times[n] = time;
        self.values[n] = value;
        self.points += 1;
        true
    }

    /// Value and rate at `t` \[s\]. A polyline without points is zero.
    pub fn sample(&self, t: f64) -> ([f64; D], [f64; D]) {
        let n = self.points as usize;
        if n == 0 {
            return ([0.0; D], [0.0; D]);
        }
        let i = self.times[..n].iter().position(|&time| t < time).unwrap_or(n);
        if i == 0 {
            return (self.values[0], [0.0; D]);
        }
        if i == n {
            return (self.values[n - 1], [0.0; D]);
        }
        let (h, tau) = (self.times[i] - self.times[i - 1], t - self.times[i - 1]);
        let (a, b) = (&self.values[i - 1], &self.values[i]);
        let rate = std::array::from_fn(|d| (b[d] - a[d]) / h);
        (std::array::from_fn(|d| a[d] + rate[d] * tau), rate)
    }
}
