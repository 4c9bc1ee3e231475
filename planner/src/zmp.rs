//! ZMP reference: the slowest way of the zero-moment point through the support polygons (4.41)-(4.43), and the shapes
//! by which it may be modified (4.49).
//!
//! ```text
//! Variables    p_k   zero-moment point at the k-th phase boundary            [m]  I
//! Objective    1/2 sum |p_{k+1} - p_k|^2 / h_k                               (4.42), errata on (4.43)
//! Constraints  p_k in the shrunk rectangle of the foot that carries alone next to t_k (4.40)
//! ```
//! At a phase boundary the polygons of both phases hold; their intersection is the single-support one (errata 2.10).
//! Projected Gauss-Seidel, both components together: the Hessian block is isotropic, so the Euclidean projection
//! finds the optimum.

use crate::pose::Pose;
use crate::sole::Sole;

/// Most phase boundaries of one chain.
pub const MAX_NODES: usize = 20;
const SWEEPS: usize = 300;
const TOLERANCE: f64 = 1e-9;

/// One phase boundary.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// \[s\]
    pub time: f64,
    /// \[m\]
    pub p: [f64; 2],
    /// The shrunk sole that holds the point; none: the point is given.
    pub hold: Option<(Sole, Pose)>,
}

/// Phase boundaries in the order of time.
#[derive(Clone, Copy, Debug)]
pub struct Chain {
    len: usize,
    nodes: [Node; MAX_NODES],
}

impl Default for Chain {
    fn default() -> Self {
        Self::new()
    }
}

impl Chain {
    /// No boundaries yet.
    pub const fn new() -> Self {
        Self { len: 0, nodes: [Node { time: 0.0, p: [0.0; 2], hold: None }; MAX_NODES] }
    }

    /// Removes all boundaries.
    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// Appends a given point.
    pub fn fix(&mut self, time: f64, p: [f64; 2]) {
        self.push(Node { time, p, hold: None });
    }

    /// Appends a point that a sole holds.
    pub fn hold(&mut self, time: f64, sole: &Sole, at: &Pose) {
        self.push(Node { time, p: sole.middle(at), hold: Some((*sole, *at)) });
    }

    fn push(&mut self, node: Node) {
        if self.len < MAX_NODES {
            self.nodes[self.len] = node;
            self.len += 1;
        }
    }

    /// The boundaries.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes[..self.len]
    }

    /// Solves (4.42) between given ends.
    pub fn solve(&mut self) {
        for _ in 0..SWEEPS {
            if self.sweep() <= TOLERANCE {
                break;
            }
        }
    }

    /// One sweep of [`Chain::solve`]; how far \[m\] a point moved at most.
    pub fn sweep(&mut self) -> f64 {
        let mut change = 0.0f64;
        for k in 1..self.len.saturating_sub(1) {
            let (before, after) = (self.nodes[k - 1], self.nodes[k + 1]);
            change = change.max(self.nodes[k].relax((before.time, before.p), (after.time, after.p)));
        }
        change
    }

    /// Solves (4.42) for a chain whose last point is the first one moved by the rigid motion that takes the pose
    /// `from` to `to` (gap 12).
    pub fn solve_periodic(&mut self, from: &Pose, to: &Pose) {
        let n = self.len;
        if n < 3 {
            return;
        }
        let period = self.nodes[n - 1].time - self.nodes[0].time;
        for _ in 0..SWEEPS {
            let last = self.nodes[n - 2];
            let before = (last.time - period, from.point(to.local(last.p)));
            let after = self.nodes[1];
            let mut change = self.nodes[0].relax(before, (after.time, after.p));
            self.nodes[n - 1].p = to.point(from.local(self.nodes[0].p));
            for k in 1..n - 1 {
                let (before, after) = (self.nodes[k - 1], self.nodes[k + 1]);
                change = change.max(self.nodes[k].relax((before.time, before.p), (after.time, after.p)));
            }
            if change <= TOLERANCE {
                break;
            }
        }
    }

    /// The reference at `t`: linear between boundaries.
    pub fn at(&self, t: f64) -> [f64; 2] {
        let i = self.nodes().iter().position(|n| t < n.time).unwrap_or(self.len);
        if i == 0 {
            return self.nodes[0].p;
        }
        if i == self.len {
            return self.nodes[i - 1].p;
        }
        let (a, b) = (&self.nodes[i - 1], &self.nodes[i]);
        let s = (t - a.time) / (b.time - a.time);
        [a.p[0] + s * (b.p[0] - a.p[0]), a.p[1] + s * (b.p[1] - a.p[1])]
    }
}

impl Node {
    /// One Gauss-Seidel update; returns how far the point moved.
    fn relax(&mut self, before: (f64, [f64; 2]), after: (f64, [f64; 2])) -> f64 {
        let Some((sole, at)) = &self.hold else { return 0.0 };
        let (a, b) = (1.0 / (self.time - before.0), 1.0 / (after.0 - self.time));
        let q = [0, 1].map(|d| (a * before.1[d] + b * after.1[d]) / (a + b));
        let q = sole.nearest(at, q);
        let moved = (q[0] - self.p[0]).hypot(q[1] - self.p[1]);
        self.p = q;
        moved
    }
}

/// A trapezoid of unit height (4.49): zero until `rise.0` and after `fall.1`.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// \[s\] Begin and end of the rise.
    pub rise: (f64, f64),
    /// \[s\] Begin and end of the fall.
    pub fall: (f64, f64),
}

impl Shape {
    /// Value at `t`.
    pub fn at(&self, t: f64) -> f64 {
        let up = (t - self.rise.0) / (self.rise.1 - self.rise.0);
        let down = (self.fall.1 - t) / (self.fall.1 - self.fall.0);
        up.min(down).clamp(0.0, 1.0)
    }

    /// Its four corners \[s\].
    pub fn corners(&self) -> [f64; 4] {
        [self.rise.0, self.rise.1, self.fall.0, self.fall.1]
    }
}
