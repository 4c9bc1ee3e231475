//! Support rectangles: where a foot can carry, and how far a point is from leaving it (4.40).

use crate::pose::PlanarPose;

/// Share of a sole's half length that a zero-moment point may use while steps lead neither forward nor back.
const AT_REST: f64 = 0.25;

/// Rectangle of a foot in its sole frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sole {
    /// \[m\] Middle of the rectangle in the sole frame: p_fc of (4.3).
    pub center: [f64; 2],
    /// \[m\] Half length and half width.
    pub half: [f64; 2],
}

impl Sole {
    /// From `config::robot::Foot::support`: x back, x front, y right, y left \[m\].
    pub fn new([back, front, right, left]: [f64; 4]) -> Self {
        Self {
            center: [(back + front) / 2.0, (right + left) / 2.0],
            half: [(front - back) / 2.0, (left - right) / 2.0],
        }
    }

    /// The rectangle with its edges drawn in by `margin` \[m\], but never by more than 0.9 of its half extent (gap 9).
    pub fn shrunk(&self, margin: f64) -> Self {
        Self { center: self.center, half: self.half.map(|h| (h - margin).max(0.1 * h)) }
    }

    /// The part of this sole at `pose` that a zero-moment point may use between steps from and to soles at `others`: lengthwise
    /// about its middle, a quarter of it and as far as the farther one of those is ahead or behind.
    ///
    /// A reference is as short as it can be, and on a circle whose centre lies ahead of the feet or behind them the shortest
    /// way leads through tips or heels, at the inner edge. Slow steps would stand in a corner of the sole for all of their
    /// single support, for a gain of millimetres.
    pub fn between(&self, pose: &PlanarPose, others: [&PlanarPose; 2]) -> Self {
        let ahead = others.map(|other| (pose.local(self.middle(other))[0] - self.center[0]).abs());
        let length = AT_REST * self.half[0] + ahead[0].max(ahead[1]);
        Self { center: self.center, half: [self.half[0].min(length), self.half[1]] }
    }

    /// The point of the rectangle at `pose` that is nearest to `p`.
    pub fn nearest(&self, pose: &PlanarPose, p: [f64; 2]) -> [f64; 2] {
        let q = pose.local(p);
        let inside = [0, 1].map(|d| q[d].clamp(self.center[d] - self.half[d], self.center[d] + self.half[d]));
        if inside == q { p } else { pose.point(inside) }
    }

    /// Middle of the rectangle at `pose`.
    pub fn middle(&self, pose: &PlanarPose) -> [f64; 2] {
        pose.point(self.center)
    }

    /// Distance \[m\] of `p` from the edge of the rectangle at `pose`: positive inside.
    pub fn margin(&self, pose: &PlanarPose, p: [f64; 2]) -> f64 {
        let q = pose.local(p);
        (0..2).map(|d| self.half[d] - (q[d] - self.center[d]).abs()).fold(f64::INFINITY, f64::min)
    }

    /// Corners at `pose`, counter-clockwise.
    pub fn corners(&self, pose: &PlanarPose) -> [[f64; 2]; 4] {
        [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)]
            .map(|(a, b)| pose.point([self.center[0] + a * self.half[0], self.center[1] + b * self.half[1]]))
    }
}

/// Convex hull of two soles: the support polygon of a double support.
#[derive(Clone, Copy, Debug)]
pub struct Hull {
    count: usize,
    /// Inward normal and distance from the origin of each edge.
    edges: [([f64; 2], f64); 8],
}

impl Hull {
    /// Hull of the soles `a` and `b`, each at its pose, by gift wrapping.
    pub fn of(a: (&Sole, &PlanarPose), b: (&Sole, &PlanarPose)) -> Self {
        let (ca, cb) = (a.0.corners(a.1), b.0.corners(b.1));
        let corners = [ca[0], ca[1], ca[2], ca[3], cb[0], cb[1], cb[2], cb[3]];
        let lower = |p: &[f64; 2], q: &[f64; 2]| p[1] < q[1] || (p[1] == q[1] && p[0] < q[0]);
        let start = corners.into_iter().reduce(|p, q| if lower(&q, &p) { q } else { p }).unwrap_or_default();
        let mut hull = Self { count: 0, edges: [([0.0; 2], 0.0); 8] };
        let mut from = start;
        while hull.count < hull.edges.len() {
            let mut to = from;
            let mut e = [0.0; 2];
            for q in corners {
                let v = [q[0] - from[0], q[1] - from[1]];
                let (square, longest) = (v[0] * v[0] + v[1] * v[1], e[0] * e[0] + e[1] * e[1]);
                let left = e[0] * v[1] - e[1] * v[0];
                // Everything lies to the left of an edge; of points in line the farthest ends it.
                let outer = left < 0.0 || (left == 0.0 && square > longest);
                if square > 1e-18 && (longest == 0.0 || outer) {
                    (to, e) = (q, v);
                }
            }
            // Inward: to the left of an edge, counter-clockwise.
            let by = 1.0 / (e[0] * e[0] + e[1] * e[1]).sqrt();
            let normal = [-e[1] * by, e[0] * by];
            hull.edges[hull.count] = (normal, normal[0] * from[0] + normal[1] * from[1]);
            hull.count += 1;
            if to == start {
                break;
            }
            from = to;
        }
        hull
    }

    /// Distance \[m\] of `p` from the edge: positive inside.
    pub fn margin(&self, p: [f64; 2]) -> f64 {
        self.edges[..self.count]
            .iter()
            .map(|(n, d)| n[0] * p[0] + n[1] * p[1] - d)
            .fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// On the spot the reference stays about the middle of the sole; steps that lead on leave it all of the length.
    #[test]
    fn a_zero_moment_point_between_soles_stays_out_of_their_corners() {
        let sole = Sole::new([-0.1, 0.16, -0.05, 0.05]);
        let (here, beside) = (PlanarPose::new(0.0, 0.0, 0.0), PlanarPose::new(0.0, 0.21, 0.0));
        let still = sole.between(&here, [&beside, &beside]);
        let corner = [0.16, 0.05];
        let [x, y] = still.nearest(&here, corner);
        assert!(x < sole.center[0] + 0.3 * sole.half[0] && y == corner[1], "{x}, {y}");
        // Inside of both it stays where it is, wherever the feet stand and head.
        let at = PlanarPose::new(1.0, -2.0, 0.7);
        let near = at.point([sole.center[0] + 0.2 * sole.half[0], 0.04]);
        let turned = sole.between(&at, [&at.compose(&beside), &at.compose(&beside)]);
        assert_eq!(turned.nearest(&at, near), near);
        // Steps forward: all of the sole, its corner included.
        let ahead = PlanarPose::new(0.3, 0.21, 0.0);
        assert_eq!(sole.between(&here, [&ahead, &ahead]), sole);
        assert_eq!(sole.between(&here, [&beside, &ahead]).nearest(&here, corner), corner);
    }
}
