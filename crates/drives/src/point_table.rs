//! Tables of points at equal times, and the cubics that a drive plays between them (thesis 6.1.1, PT mode of Elmo's drives).
//!
//! From point i to i + 1 the cubic Hermite polynomial of both positions and speeds; the speed at a point is the central
//! difference v_i = (p_{i+1} - p_{i-1}) / 2 T. A cyclic table has the last point before the first one. At the ends of
//! another one the neighbour that is missing counts as the end itself.
//!
//! | symbol | here | unit |
//! |---|---|---|
//! | p_i | positions | count |
//! | T = m T_s | time from point to point | the unit of time here |
//! | u | share of the way between two points | 1 |

/// Room for points in a drive: `QP[1]` to `QP[1024]`.
pub const MOST_POINTS: usize = 1024;
/// Most samples from point to point: m.
pub const MOST_SPACING: u32 = 256;

/// Polynomial of third order from one point to the next one, in u from 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cubic {
    /// Coefficients of the position \[count\], constant term first.
    pub c: [f64; 4],
}

/// Largest values that a [`Cubic`] takes between its ends, both included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    /// \[count\] Lowest and highest position.
    pub position: [f64; 2],
    /// \[count/T\] Largest magnitude of the speed.
    pub speed: f64,
    /// \[count/T^2\] Largest magnitude of the acceleration.
    pub acceleration: f64,
}

impl Cubic {
    /// From position and speed \[count, count/T\] to position and speed.
    pub fn between([p0, v0]: [f64; 2], [p1, v1]: [f64; 2]) -> Self {
        let way = p1 - p0;
        Self { c: [p0, v0, 3.0 * way - 2.0 * v0 - v1, v0 + v1 - 2.0 * way] }
    }

    /// Position \[count\], speed \[count/T\] and acceleration \[count/T^2\] at u.
    pub fn at(&self, u: f64) -> [f64; 3] {
        let c = &self.c;
        [
            c[0] + u * (c[1] + u * (c[2] + u * c[3])),
            c[1] + u * (2.0 * c[2] + u * 3.0 * c[3]),
            2.0 * c[2] + u * 6.0 * c[3],
        ]
    }

    /// Extremes, exactly: at the ends, and where a derivative passes zero between them.
    pub fn extremes(&self) -> Extremes {
        let [first, last] = [0.0, 1.0].map(|u| self.at(u));
        let mut e = Extremes {
            position: [first[0].min(last[0]), first[0].max(last[0])],
            speed: first[1].abs().max(last[1].abs()),
            acceleration: first[2].abs().max(last[2].abs()), // linear in u
        };
        let inside = |u: &f64| *u > 0.0 && *u < 1.0; // false for NaN: no such place
        // Speed a u^2 + b u + c = 0, by the formula that cancels nothing.
        let [_, c, c2, c3] = self.c;
        let (a, b) = (3.0 * c3, 2.0 * c2);
        let q = -0.5 * (b + (b * b - 4.0 * a * c).sqrt().copysign(b));
        for u in [q / a, c / q].into_iter().filter(inside) {
            let p = self.at(u)[0];
            e.position = [e.position[0].min(p), e.position[1].max(p)];
        }
        if let Some(u) = Some(-b / (2.0 * a)).filter(inside) {
            e.speed = e.speed.max(self.at(u)[1].abs());
        }
        e
    }
}

/// \[count/T\] Speed at point `i` of a table.
pub fn speed(points: &[i32], i: usize, cyclic: bool) -> f64 {
    let last = points.len() - 1;
    let (before, after) = match (i, cyclic) {
        (0, true) => (last, 1.min(last)),
        (i, true) if i == last => (last - 1, 0),
        (i, _) => (i.saturating_sub(1), (i + 1).min(last)),
    };
    0.5 * (f64::from(points[after]) - f64::from(points[before]))
}

/// Cubic from point `i` of a table to the next one; from the last one of a cyclic table to the first one.
pub fn cubic(points: &[i32], i: usize, cyclic: bool) -> Cubic {
    let next = (i + 1) % points.len();
    let end = |i: usize| [f64::from(points[i]), speed(points, i, cyclic)];
    Cubic::between(end(i), end(next))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_cubic_meets_both_ends_with_their_speeds() {
        let c = Cubic::between([10.0, -3.0], [25.0, 7.0]);
        let [a, b] = [c.at(0.0), c.at(1.0)];
        assert_eq!((a[0], a[1], b[0], b[1]), (10.0, -3.0, 25.0, 7.0));
    }

    /// A parabola sampled at the points is met exactly between them: central differences are its derivative.
    #[test]
    fn a_parabola_is_played_exactly() {
        let points: Vec<i32> = (0..10).map(|i| 3 * i * i - 20 * i + 5).collect();
        for i in 1..8 {
            for k in 0..=10 {
                let (u, c) = (f64::from(k) / 10.0, cubic(&points, i, false));
                let x = i as f64 + u;
                assert!((c.at(u)[0] - (3.0 * x * x - 20.0 * x + 5.0)).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn the_neighbours_of_the_ends() {
        let points = [0, 10, 40, 20];
        assert_eq!([0, 1, 3].map(|i| speed(&points, i, true)), [-5.0, 20.0, -20.0]);
        assert_eq!([0, 1, 3].map(|i| speed(&points, i, false)), [5.0, 20.0, -10.0]);
        assert_eq!(cubic(&points, 3, true).at(1.0)[..2], [0.0, -5.0], "from the last one to the first");
        assert_eq!(speed(&[7], 0, true), 0.0);
    }

    proptest! {
        /// Against ten thousand samples: nothing is beyond the extremes, and they are reached.
        #[test]
        fn extremes_are_those_of_a_fine_grid(p0 in -1e4..1e4f64, v0 in -3e4..3e4f64, p1 in -1e4..1e4f64, v1 in -3e4..3e4f64) {
            let c = Cubic::between([p0, v0], [p1, v1]);
            let e = c.extremes();
            let (mut low, mut high, mut fast, mut hard) = (f64::INFINITY, f64::NEG_INFINITY, 0.0f64, 0.0f64);
            for k in 0..=10_000 {
                let [p, v, a] = c.at(f64::from(k) / 1e4);
                (low, high, fast, hard) = (low.min(p), high.max(p), fast.max(v.abs()), hard.max(a.abs()));
            }
            // A grid of 1e-4 misses an extreme by at most its curvature times (0.5e-4)^2 / 2.
            let (near, near_v) = (e.acceleration * 1.25e-9 + 1e-7, 6.0 * c.c[3].abs() * 1.25e-9 + 1e-7);
            prop_assert!(e.position[0] <= low + 1e-9 && low - e.position[0] <= near, "{e:?} {low}");
            prop_assert!(e.position[1] >= high - 1e-9 && e.position[1] - high <= near, "{e:?} {high}");
            prop_assert!(e.speed >= fast - 1e-9 && e.speed - fast <= near_v, "{e:?} {fast}");
            prop_assert!((e.acceleration - hard).abs() <= 1e-9 * hard.max(1.0), "{e:?} {hard}");
        }
    }

    #[test]
    fn extremes_of_lines_and_parabolas() {
        assert_eq!(Cubic { c: [5.0, 0.0, 0.0, 0.0] }.extremes().position, [5.0, 5.0]);
        assert_eq!(
            Cubic { c: [0.0, 2.0, 0.0, 0.0] }.extremes(),
            Extremes { position: [0.0, 2.0], speed: 2.0, acceleration: 0.0 }
        );
        // 4 u (1 - u): highest in the middle.
        assert_eq!(
            Cubic { c: [0.0, 4.0, -4.0, 0.0] }.extremes(),
            Extremes { position: [0.0, 1.0], speed: 4.0, acceleration: 8.0 }
        );
        // b = 0: u^3 - 0.75 u, lowest at one half.
        assert_eq!(Cubic { c: [0.0, -0.75, 0.0, 1.0] }.extremes().position, [-0.25, 0.25]);
    }
}
