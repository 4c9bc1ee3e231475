//! Minimum-velocity reference of the zero-moment point through the support polygons (4.41)-(4.43), and the shapes by which
//! it may be modified (4.49).
//!
//! ```text
//! Variables    p_k   zero-moment point at the k-th phase boundary            [m]  I
//! Objective    1/2 sum |p_{k+1} - p_k|^2 / h_k                               (4.42), errata on (4.43)
//! Constraints  p_k in the shrunk rectangle of the foot that carries alone next to t_k (4.40)
//! ```
//! At a phase boundary the polygons of both phases hold; their intersection is the single-support one (errata 2.10).
//! Solved directly (`active_set`). Projected Gauss-Seidel is what the thesis does, the reserve if the direct way should
//! not settle, and solves the periodic problem: both components together, because the Hessian block is isotropic and the
//! Euclidean projection finds the optimum.

use crate::pose::PlanarPose;
use crate::sole::Sole;
use crate::verdict::PlanVerdict;

/// Most phase boundaries of one problem.
pub const MAX_NODES: usize = 48;
/// Most sweeps.
pub const SWEEPS: usize = 2000;
const TOLERANCE: f64 = 1e-9;
/// \[m\] Change of a sweep, after all of them, by which a periodic problem may still drift. All points of a walk that turns
/// a little can be shifted along it at next to no cost, and sweeps shift them slowly; the optimum may be at the tip of the
/// sole, but nothing is gained by going there from its middle.
const DRIFT: f64 = 1e-5;
/// Over-relaxation of problems of more than this many boundaries (errata 2.10).
const RELAXATION: (usize, f64) = (12, 1.6);

/// A rectangle that holds a point: a shrunk sole on the ground.
#[derive(Clone, Copy, Debug)]
pub struct ZmpHold {
    /// \[m\] Middle.
    pub center: [f64; 2],
    /// Its longitudinal axis.
    pub axis: [f64; 2],
    /// \[m\] Half length and half width.
    pub half: [f64; 2],
}

impl ZmpHold {
    /// The rectangle of `sole` at the pose `at`.
    pub fn new(sole: &Sole, at: &PlanarPose) -> Self {
        let (s, c) = at.heading.sin_cos();
        Self { center: sole.middle(at), axis: [c, s], half: sole.half }
    }

    /// A point seen from the middle, along the axes.
    pub fn local(&self, p: [f64; 2]) -> [f64; 2] {
        self.along([p[0] - self.center[0], p[1] - self.center[1]])
    }

    /// Components of a vector along the axes.
    pub fn along(&self, v: [f64; 2]) -> [f64; 2] {
        let [c, s] = self.axis;
        [c * v[0] + s * v[1], c * v[1] - s * v[0]]
    }

    /// The inverse of [`ZmpHold::local`].
    pub fn point(&self, q: [f64; 2]) -> [f64; 2] {
        let [c, s] = self.axis;
        [self.center[0] + c * q[0] - s * q[1], self.center[1] + s * q[0] + c * q[1]]
    }

    /// The point of the rectangle that is nearest to `p`.
    pub fn nearest(&self, p: [f64; 2]) -> [f64; 2] {
        let q = self.local(p);
        let inside = [0, 1].map(|d| q[d].clamp(-self.half[d], self.half[d]));
        if inside == q { p } else { self.point(inside) }
    }

    /// Distance \[m\] of `p` from the edge: positive inside.
    pub fn margin(&self, p: [f64; 2]) -> f64 {
        let q = self.local(p);
        (self.half[0] - q[0].abs()).min(self.half[1] - q[1].abs())
    }
}

/// One phase boundary.
#[derive(Clone, Copy, Debug)]
pub struct ZmpNode {
    /// \[s\]
    pub time: f64,
    /// \[m\]
    pub p: [f64; 2],
    /// Rectangle that holds the point; none: the point is given.
    pub hold: Option<ZmpHold>,
}

/// Phase boundaries in the order of time.
#[derive(Clone, Copy, Debug)]
pub struct ZmpProblem {
    len: usize,
    full: bool,
    nodes: [ZmpNode; MAX_NODES],
}

impl Default for ZmpProblem {
    fn default() -> Self {
        Self::new()
    }
}

impl ZmpProblem {
    /// No boundaries yet.
    pub const fn new() -> Self {
        Self { len: 0, full: false, nodes: [ZmpNode { time: 0.0, p: [0.0; 2], hold: None }; MAX_NODES] }
    }

    /// Removes all boundaries.
    pub fn clear(&mut self) {
        (self.len, self.full) = (0, false);
    }

    /// Appends a given point.
    pub fn fix(&mut self, time: f64, p: [f64; 2]) {
        self.push(ZmpNode { time, p, hold: None });
    }

    /// Appends a point that a sole holds.
    pub fn hold(&mut self, time: f64, sole: &Sole, at: &PlanarPose) {
        let hold = ZmpHold::new(sole, at);
        self.push(ZmpNode { time, p: hold.center, hold: Some(hold) });
    }

    fn push(&mut self, node: ZmpNode) {
        self.full |= self.len == MAX_NODES;
        if !self.full {
            self.nodes[self.len] = node;
            self.len += 1;
        }
    }

    /// The boundaries.
    pub fn nodes(&self) -> &[ZmpNode] {
        &self.nodes[..self.len]
    }

    pub(crate) fn nodes_mut(&mut self) -> &mut [ZmpNode] {
        &mut self.nodes[..self.len]
    }

    /// Verdict on the problem before it is solved.
    fn posed(&self) -> PlanVerdict {
        let nodes = self.nodes();
        if self.full {
            return PlanVerdict::TooLong;
        }
        for (k, n) in nodes.iter().enumerate() {
            let numbers = [n.time, n.p[0], n.p[1]];
            if !numbers.iter().chain(n.hold.iter().flat_map(|h| &h.half)).all(|x| x.is_finite()) {
                return PlanVerdict::NotFinite;
            }
            if n.hold.is_some_and(|h| h.half[0] < 0.0 || h.half[1] < 0.0) {
                return PlanVerdict::NoSupport;
            }
            if k > 0 && n.time <= nodes[k - 1].time {
                return PlanVerdict::Degenerate;
            }
        }
        if nodes.len() < 2 { PlanVerdict::Degenerate } else { PlanVerdict::Sound }
    }

    /// Solves (4.42) between given ends.
    pub fn solve(&mut self) -> PlanVerdict {
        match self.posed() {
            PlanVerdict::Sound if self.solve_directly() => PlanVerdict::Sound,
            PlanVerdict::Sound => self.relax(SWEEPS),
            wrong => wrong,
        }
    }

    /// Solves (4.42) by at most so many sweeps of projected Gauss-Seidel.
    pub fn relax(&mut self, sweeps: usize) -> PlanVerdict {
        let wrong = self.posed();
        let omega = if self.len > RELAXATION.0 { RELAXATION.1 } else { 1.0 };
        if wrong != PlanVerdict::Sound || (0..sweeps).any(|_| self.sweep(omega) <= TOLERANCE) {
            return wrong;
        }
        PlanVerdict::Unsettled
    }

    /// One sweep of [`ZmpProblem::relax`]; how far \[m\] a point moved at most.
    pub fn sweep(&mut self, omega: f64) -> f64 {
        let mut change = 0.0f64;
        for k in 1..self.len.saturating_sub(1) {
            let (before, after) = (self.nodes[k - 1], self.nodes[k + 1]);
            change = change.max(self.nodes[k].relax((before.time, before.p), (after.time, after.p), omega));
        }
        change
    }

    /// Solves (4.42) for a problem whose last point is the first one moved by the rigid motion that takes the pose
    /// `from` to `to` (gap 12).
    pub(crate) fn solve_periodic(&mut self, from: &PlanarPose, to: &PlanarPose) -> PlanVerdict {
        let wrong = self.posed();
        let n = self.len;
        if wrong != PlanVerdict::Sound || n < 3 {
            return wrong.and(PlanVerdict::Degenerate);
        }
        let (there, back) = (RigidMotion::new(from, to), RigidMotion::new(to, from));
        let period = self.nodes[n - 1].time - self.nodes[0].time;
        let mut change = f64::INFINITY;
        for _ in 0..SWEEPS {
            // The first point lies between the second one and the last but one, taken back by a period.
            let last = self.nodes[n - 2];
            let before = (last.time - period, back.of(last.p));
            let after = self.nodes[1];
            change = self.nodes[0].relax(before, (after.time, after.p), 1.0);
            self.nodes[n - 1].p = there.of(self.nodes[0].p);
            change = change.max(self.sweep(1.0));
            if change <= TOLERANCE {
                return PlanVerdict::Sound;
            }
        }
        if change <= DRIFT { PlanVerdict::Sound } else { PlanVerdict::Unsettled }
    }

    /// The reference at `t`: linear between boundaries.
    pub fn at(&self, t: f64) -> [f64; 2] {
        self.after(t, &mut 0)
    }

    /// The reference at ascending times: `next` is the boundary from which on it looks, 0 at the beginning.
    pub fn after(&self, t: f64, next: &mut usize) -> [f64; 2] {
        while *next < self.len && t >= self.nodes[*next].time {
            *next += 1;
        }
        let i = *next;
        if i == 0 || i == self.len {
            return self.nodes[i.saturating_sub(1)].p;
        }
        let (a, b) = (&self.nodes[i - 1], &self.nodes[i]);
        let s = (t - a.time) / (b.time - a.time);
        [a.p[0] + s * (b.p[0] - a.p[0]), a.p[1] + s * (b.p[1] - a.p[1])]
    }
}

impl ZmpNode {
    /// One Gauss-Seidel update; returns how far the point moved.
    fn relax(&mut self, before: (f64, [f64; 2]), after: (f64, [f64; 2]), omega: f64) -> f64 {
        let Some(hold) = &self.hold else { return 0.0 };
        let (a, b) = (self.time - before.0, after.0 - self.time);
        let s = a / (a + b);
        let q = [0, 1].map(|d| {
            let q = before.1[d] + s * (after.1[d] - before.1[d]);
            self.p[d] + omega * (q - self.p[d])
        });
        let q = hold.nearest(q);
        let moved = (q[0] - self.p[0]).abs().max((q[1] - self.p[1]).abs());
        self.p = q;
        moved
    }
}

/// The rigid motion that takes one pose to another.
struct RigidMotion {
    turn: [f64; 2],
    shift: [f64; 2],
}

impl RigidMotion {
    fn new(from: &PlanarPose, to: &PlanarPose) -> Self {
        let (s, c) = (to.heading - from.heading).sin_cos();
        let still = Self { turn: [c, s], shift: [0.0; 2] };
        let moved = still.of([from.x, from.y]);
        Self { shift: [to.x - moved[0], to.y - moved[1]], ..still }
    }

    fn of(&self, p: [f64; 2]) -> [f64; 2] {
        let [c, s] = self.turn;
        [c * p[0] - s * p[1] + self.shift[0], s * p[0] + c * p[1] + self.shift[1]]
    }
}

/// A trapezoid of unit height (4.49): zero until `rise.0` and after `fall.1`.
#[derive(Clone, Copy, Debug)]
pub struct Trapezoid {
    /// \[s\] Begin and end of the rise.
    pub rise: (f64, f64),
    /// \[s\] Begin and end of the fall.
    pub fall: (f64, f64),
}

impl Trapezoid {
    /// Value at `t`.
    pub fn at(&self, t: f64) -> f64 {
        if t <= self.rise.0 || t >= self.fall.1 {
            0.0
        } else if t < self.rise.1 {
            (t - self.rise.0) / (self.rise.1 - self.rise.0)
        } else if t > self.fall.0 {
            (self.fall.1 - t) / (self.fall.1 - self.fall.0)
        } else {
            1.0
        }
    }

    /// Its four corners \[s\].
    pub fn corners(&self) -> [f64; 4] {
        [self.rise.0, self.rise.1, self.fall.0, self.fall.1]
    }
}
