//! Load factors: share of each foot in the contact forces (thesis 4.8, (4.62); gap 15).
//!
//! Linear over a double support, with corners smoothed by quintics, and moved with the zero-moment point where that
//! leaves its straight way. By (4.64) both feet share what is left of the moment about the weighted middle of their
//! sole frames, so the point `e = p - (1 - rho) r_0 - rho r_1` must lie in both soles, each seen in its own heading.
//! Corners are as soft as that allows. Where feet are turned against each other and it cannot be, the stabilizer lets one
//! foot take what the other one cannot carry; what both can carry together is `(1 - rho) S_0 + rho S_1`, a sum of
//! rectangles, and a plan whose zero-moment point leaves that cannot be walked.

use crate::pose::PlanarPose;
use crate::segment::{Horizon, standing_shape};
use crate::sole::Sole;
use curves::{Path, Polyline, Sample};
use messages::LEFT;

/// Load factor rho of the left foot over time.
pub(crate) type LoadPath = Path<1, 40>;

/// Shares of a piece that its corners may take, softest first.
const CORNERS: [f64; 5] = [0.3, 0.2, 0.15, 0.1, 0.05];

/// \[m\] Distance of the point e from the edges that is enough.
const ENOUGH: f64 = 0.002;
/// Instants of a double support at which the distance is looked at.
const PROBES: usize = 24;

/// A double support: zero-moment point at its kinks, feet (right, left) and load of the left foot at both ends.
pub(crate) struct DoubleSupport<'a> {
    /// Times \[s\] and zero-moment points \[m\], ascending; at most four.
    pub kinks: &'a [(f64, [f64; 2])],
    /// Sole frames: right, left.
    pub feet: [PlanarPose; 2],
    /// Soles: right, left.
    pub soles: &'a [Sole; 2],
    /// Load factor of the left foot at the begin and at the end.
    pub ends: [f64; 2],
}

impl DoubleSupport<'_> {
    /// Load at the kinks: linear in time, plus what the zero-moment point leaves its straight way towards a foot.
    fn corners(&self) -> [(f64, f64); 4] {
        let n = self.kinks.len();
        let (first, last) = (self.kinks[0], self.kinks[n - 1]);
        let d = [self.feet[1].x - self.feet[0].x, self.feet[1].y - self.feet[0].y];
        let square = (d[0] * d[0] + d[1] * d[1]).max(1e-6);
        std::array::from_fn(|k| {
            let (t, p) = self.kinks[k.min(n - 1)];
            let s = (t - first.0) / (last.0 - first.0);
            let off = [0, 1].map(|j| p[j] - first.1[j] - s * (last.1[j] - first.1[j]));
            let rho =
                self.ends[0] + s * (self.ends[1] - self.ends[0]) + (off[0] * d[0] + off[1] * d[1]) / square;
            (t, rho.clamp(0.0, 1.0))
        })
    }

    /// Distance of the zero-moment point at `t` from the edges: of the soles for the point e, and of what both soles can
    /// carry together, if the left foot carries `rho`.
    fn margins(&self, t: f64, rho: f64, axes: &[[f64; 2]; 2]) -> [f64; 2] {
        let k = self.kinks.iter().position(|k| t < k.0).unwrap_or(self.kinks.len() - 1).max(1);
        let (a, b) = (self.kinks[k - 1], self.kinks[k]);
        let s = (t - a.0) / (b.0 - a.0);
        let shares = [1.0 - rho, rho];
        let e = [0, 1].map(|d| {
            a.1[d] + s * (b.1[d] - a.1[d])
                - shares[0] * self.feet[0].array()[d]
                - shares[1] * self.feet[1].array()[d]
        });
        // The point e in each sole, as far as the sole reaches.
        let along = |[c, s]: [f64; 2], v: [f64; 2]| [c * v[0] + s * v[1], c * v[1] - s * v[0]];
        let mut shared = f64::INFINITY;
        let mut off = e; // from the middle of what both can carry
        for i in 0..2 {
            let (sole, [c, s]) = (&self.soles[i], axes[i]);
            let (q, m) = (along(axes[i], e), sole.center);
            for d in 0..2 {
                shared = shared.min(sole.half[d] - (q[d] - m[d]).abs());
            }
            off[0] -= shares[i] * (c * m[0] - s * m[1]);
            off[1] -= shares[i] * (s * m[0] + c * m[1]);
        }
        // The sum of two rectangles has their edges; along a normal, extents add up.
        let mut together = f64::INFINITY;
        for i in 0..2 {
            let turned = along(axes[i], axes[1 - i]).map(f64::abs);
            let (own, other) = (self.soles[i].half, self.soles[1 - i].half);
            let q = along(axes[i], off);
            for d in 0..2 {
                let reach = other[d] * turned[0] + other[1 - d] * turned[1];
                together = together.min(shares[i] * own[d] + shares[1 - i] * reach - q[d].abs());
            }
        }
        [shared, together]
    }

    /// Appends the load over this double support to `path`; returns the least distance \[m\] of the zero-moment point
    /// from the edge of what both soles can carry together.
    pub(crate) fn lay(&self, path: &mut LoadPath) -> f64 {
        let n = self.kinks.len();
        if !(2..=4).contains(&n) {
            return f64::NAN;
        }
        let corners = self.corners();
        let corners = &corners[..n];
        let begun = path.pieces;
        let (mut best, mut best_share) = ([f64::NEG_INFINITY; 2], CORNERS[0]);
        for share in CORNERS {
            path.pieces = begun;
            smooth(path, corners, share);
            let margins = self.least_margins(path);
            if margins[0] > ENOUGH {
                return margins[1];
            }
            if margins[0] > best[0] + 1e-3 {
                (best, best_share) = (margins, share);
            }
        }
        // Soles of different heading cannot both hold the point; sharp corners would not help.
        path.pieces = begun;
        smooth(path, corners, best_share);
        best[1]
    }

    fn least_margins(&self, path: &LoadPath) -> [f64; 2] {
        let (begin, end) = (self.kinks[0].0, self.kinks[self.kinks.len() - 1].0);
        let axes = [0, 1].map(|i| {
            let (s, c) = self.feet[i].heading.sin_cos();
            [c, s]
        });
        let mut load = path.cursor();
        (1..PROBES).fold([f64::INFINITY; 2], |least, k| {
            let t = begin + (end - begin) * k as f64 / PROBES as f64;
            let m = self.margins(t, load.sample(t).position[0], &axes);
            [least[0].min(m[0]), least[1].min(m[1])]
        })
    }
}

/// Writes the load factors over the steps of a plan, with its zero-moment point `zmp` (thesis 4.8). Returns the least distance
/// \[m\] of the zero-moment point from the edge of what both soles can carry.
pub(crate) fn lay<const N: usize>(
    soles: &[Sole; 2],
    horizon: &Horizon<'_>,
    zmp: &Polyline<2, N>,
    path: &mut LoadPath,
) -> f64 {
    let mut load = horizon.from.load_left;
    path.restart(0.0, [load]);
    let mut least = f64::INFINITY;
    // A step that is running has handed its load over.
    let running = usize::from(horizon.from.swinging().is_some());
    if running > 0 {
        hold(path, load, horizon.strides[0].end);
    }
    let mut lay = |begin: f64, end: f64, until: f64, feet: [PlanarPose; 2], to: f64| {
        // Kinks of a modification in the double support, left out where there is none.
        let times = standing_shape(begin, end).corners();
        let kinks = times.map(|t| (t, zmp.sample(t).0));
        let straight = [kinks[0], kinks[3]];
        let leaves = |k: usize| {
            let s = (kinks[k].0 - begin) / (end - begin);
            (0..2).any(|d| (kinks[k].1[d] - (1.0 - s) * kinks[0].1[d] - s * kinks[3].1[d]).abs() > 1e-9)
        };
        let kinks = if leaves(1) || leaves(2) { &kinks[..] } else { &straight[..] };
        let support = DoubleSupport { kinks, feet, soles, ends: [load, to] };
        least = least.min(support.lay(path));
        hold(path, to, until);
        load = to;
    };
    // Each step begins with a double support, and the last one is followed by that in which the robot comes to rest.
    for s in &horizon.strides[running..] {
        let mut feet = [s.foothold; 2];
        feet[1 - s.stance] = s.takeoff;
        lay(s.begin, s.lift, s.end, feet, if s.stance == LEFT { 1.0 } else { 0.0 });
    }
    let last = horizon.last();
    let mut feet = [last.foothold; 2];
    feet[1 - last.stance] = last.landing;
    lay(last.end, horizon.end, horizon.end, feet, 0.5);
    least
}

/// Lines through the corners, each corner replaced by a quintic that takes `share` of the shorter piece beside it.
fn smooth(path: &mut LoadPath, corners: &[(f64, f64)], share: f64) {
    let n = corners.len();
    let half = |k: usize| 0.5 * share * (corners[k + 1].0 - corners[k].0);
    // The first and last line begin and end inside, so that the path rests at both ends.
    let begin = |k: usize| (corners[k].0 + if k == 0 { half(0) } else { 0.0 }, corners[k].1);
    let end = |k: usize| (corners[k + 1].0 - if k + 2 == n { half(n - 2) } else { 0.0 }, corners[k + 1].1);
    let line = |k: usize, t: f64| {
        let (a, b) = (begin(k), end(k));
        let slope = (b.1 - a.1) / (b.0 - a.0);
        Sample { position: [a.1 + slope * (t - a.0)], velocity: [slope], acceleration: [0.0] }
    };
    // A corner's quintic takes as much of the line before it as of the line after it.
    let mut last = Sample::rest([corners[0].1]);
    for k in 0..n - 1 {
        let radius = if k == 0 { 0.0 } else { half(k - 1).min(half(k)) };
        let from = if k == 0 { corners[0].0 + 2.0 * half(0) } else { corners[k].0 + radius };
        let to = if k + 2 == n {
            corners[n - 1].0 - 2.0 * half(n - 2)
        } else {
            corners[k + 1].0 - half(k).min(half(k + 1))
        };
        path.push(&last, &line(k, from), from);
        path.push(&line(k, from), &line(k, to), to);
        last = line(k, to);
    }
    path.push(&last, &Sample::rest([corners[n - 1].1]), corners[n - 1].0);
}

/// Appends a rest at `load` until `end`.
pub fn hold(path: &mut LoadPath, load: f64, end: f64) {
    let rest = Sample::rest([load]);
    path.push(&rest, &rest, end);
}
