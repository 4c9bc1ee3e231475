//! Way from rest to rest through a point: two quartics that meet there with equal velocity and acceleration.
//!
//! Ten coefficients for ten conditions, in closed form (construction B of the errata to Daniali 2013, chapter 4).

/// Two quartics in one dimension.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TwoQuartics {
    /// \[s\] Begin, middle and end.
    times: [f64; 3],
    /// Values at begin and end.
    ends: [f64; 2],
    /// Coefficients of the third and fourth powers, of the first half and, backwards in time, of the second.
    first: [f64; 2],
    second: [f64; 2],
}

impl TwoQuartics {
    /// From `values[0]` at `times[0]` \[s\], at rest, through `values[1]` at `times[1]`, to rest.
    pub(crate) fn new(times: [f64; 3], values: [f64; 3]) -> Self {
        let [h1, h2] = [times[1] - times[0], times[2] - times[1]];
        let [d1, d2] = [values[1] - values[0], values[2] - values[1]];
        let r = h2 / h1;
        let q = (2.0 * d2 - r * (3.0 + r) * d1) / (r * (r + 1.0));
        let back = r * (3.0 * d1 + q) - 3.0 * d2;
        Self { times, ends: [values[0], values[2]], first: [d1 - q, q], second: [d2 - back, back] }
    }

    /// \[s\] Instant at which the quartics meet.
    pub(crate) fn middle(&self) -> f64 {
        self.times[1]
    }

    /// Value and two derivatives at `t` \[s\].
    pub(crate) fn at(&self, t: f64) -> [f64; 3] {
        let [begin, middle, end] = self.times;
        let half = |[p, q]: [f64; 2], s: f64, h: f64| {
            let (value, rate) = (s * s * s * (p + q * s), s * s * (3.0 * p + 4.0 * q * s) / h);
            [value, rate, s * (6.0 * p + 12.0 * q * s) / (h * h)]
        };
        if t < middle {
            let s = ((t - begin) / (middle - begin)).max(0.0);
            let [value, rate, second] = half(self.first, s, middle - begin);
            [self.ends[0] + value, rate, second]
        } else {
            let s = ((end - t) / (end - middle)).max(0.0);
            let [value, rate, second] = half(self.second, s, end - middle);
            [self.ends[1] - value, rate, -second]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Vector V10 of the errata.
    #[test]
    fn values_are_those_of_the_errata() {
        let curve = TwoQuartics::new([0.0, 0.7, 2.0], [1.0, 5.0, 2.0]);
        for (t, value) in [(0.3, 1.671604780060), (1.1, 4.685887348882), (1.6, 2.421305776608)] {
            assert!((curve.at(t)[0] - value).abs() < 1e-12, "{t}: {}", curve.at(t)[0]);
        }
    }

    /// Derivatives against differences, at rest at both ends, continuous in the middle.
    #[test]
    fn velocity_and_acceleration_are_continuous() {
        let curve = TwoQuartics::new([1.0, 2.5, 3.0], [-1.0, 2.0, 0.5]);
        let h = 1e-5;
        for t in [1.2, 2.2, 2.499, 2.7, 2.99] {
            let [_, rate, second] = curve.at(t);
            let differences = [0, 1].map(|d| (curve.at(t + h)[d] - curve.at(t - h)[d]) / (2.0 * h));
            assert!((rate - differences[0]).abs() < 1e-7 && (second - differences[1]).abs() < 1e-6, "{t}");
        }
        let gap = |t: f64| [0, 1, 2].map(|d| (curve.at(t - 1e-12)[d] - curve.at(t)[d]).abs());
        assert!(gap(2.5).iter().all(|gap| *gap < 1e-9), "{:?}", gap(2.5));
        for (t, value) in [(1.0, -1.0), (3.0, 0.5)] {
            assert_eq!(curve.at(t), [value, 0.0, 0.0]);
        }
        assert!((curve.at(2.5)[0] - 2.0).abs() < 1e-12);
    }
}
