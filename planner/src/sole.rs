//! Support rectangles: where a foot can carry, and how far a point is from leaving it (4.40).

use crate::pose::Pose;

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

    /// The point of the rectangle at `pose` that is nearest to `p`.
    pub fn nearest(&self, pose: &Pose, p: [f64; 2]) -> [f64; 2] {
        let q = pose.local(p);
        let inside = [0, 1].map(|d| q[d].clamp(self.center[d] - self.half[d], self.center[d] + self.half[d]));
        if inside == q { p } else { pose.point(inside) }
    }

    /// Middle of the rectangle at `pose`.
    pub fn middle(&self, pose: &Pose) -> [f64; 2] {
        pose.point(self.center)
    }

    /// Distance \[m\] of `p` from the edge of the rectangle at `pose`: positive inside.
    pub fn margin(&self, pose: &Pose, p: [f64; 2]) -> f64 {
        let q = pose.local(p);
        (0..2).map(|d| self.half[d] - (q[d] - self.center[d]).abs()).fold(f64::INFINITY, f64::min)
    }

    /// Corners at `pose`, counter-clockwise.
    pub fn corners(&self, pose: &Pose) -> [[f64; 2]; 4] {
        [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)]
            .map(|(a, b)| pose.point([self.center[0] + a * self.half[0], self.center[1] + b * self.half[1]]))
    }
}

/// Distance \[m\] of `p` from the edge of the convex hull of two soles: positive inside.
pub fn double_support_margin(a: (&Sole, &Pose), b: (&Sole, &Pose), p: [f64; 2]) -> f64 {
    let (ca, cb) = (a.0.corners(a.1), b.0.corners(b.1));
    let corner = |i: usize| if i < 4 { ca[i] } else { cb[i - 4] };
    let mut margin = f64::INFINITY;
    // An edge of the hull is a pair of corners with all others to its left.
    for i in 0..8 {
        for j in 0..8 {
            let (u, v) = (corner(i), corner(j));
            let (dx, dy) = (v[0] - u[0], v[1] - u[1]);
            let length = dx.hypot(dy);
            if length < 1e-9 {
                continue;
            }
            let left_of = |q: [f64; 2]| (dx * (q[1] - u[1]) - dy * (q[0] - u[0])) / length;
            if (0..8).all(|k| left_of(corner(k)) > -1e-9) {
                margin = margin.min(left_of(p));
            }
        }
    }
    margin
}
