//! Memory of a pad from call to call, and its scratch: nothing allocates after [`Memory::new`].
//!
//! | symbol | name | unit | frame |
//! |---|---|---|---|
//! | f | force of the ground on each contact node; the warm start (errata 1, section 4.9: not lambda, whose frame turns) | N | segment |
//! | y | d' + d/alpha of each contact node | m/s | segment |
//! | c | u = y + c: velocity of each node relative to the ground, less the part that recovers penetration | m/s | segment |
//! | E | contact frame of each node | 1 | segment |

use nalgebra::{Matrix3, Vector3};

use crate::coupling::Coupling;
use crate::point::PointState;

/// State of the solver of one pad.
#[derive(Clone, Debug)]
pub struct Memory {
    pub(crate) f: Vec<Vector3<f64>>,
    pub(crate) y: Vec<[f64; 4]>,
    pub(crate) c: Vec<Vector3<f64>>,
    pub(crate) states: Vec<PointState>,
    pub(crate) normals: Vec<Vector3<f64>>,
    pub(crate) frames: Vec<Matrix3<f64>>,
    /// True if frame and mobility of a node are those of this call; few nodes need them when most stick.
    pub(crate) framed: Vec<bool>,
    /// S_ii^-1 in the contact frame.
    pub(crate) mobilities: Vec<Matrix3<f64>>,
    pub(crate) factors: Vec<(f64, f64)>,
    /// Nodes at the ground, in order.
    pub(crate) active: Vec<usize>,
    pub(crate) touching: Vec<bool>,
    /// Nodes whose neighbours have moved since they were looked at.
    pub(crate) stale: Vec<bool>,
    /// W of the active nodes, gathered for `gathered`.
    pub(crate) w: Vec<f64>,
    pub(crate) gathered: Vec<usize>,
    /// y of the active nodes; lambda of one Jacobi sweep.
    pub(crate) rate: Vec<f64>,
    pub(crate) change: Vec<Vector3<f64>>,
}

impl Memory {
    /// For a pad with this coupling; allocates everything.
    pub fn new(coupling: &Coupling) -> Self {
        let n = coupling.nodes();
        Self {
            f: vec![Vector3::zeros(); n],
            y: vec![[0.0; 4]; n],
            c: vec![Vector3::zeros(); n],
            states: vec![PointState::Open; n],
            normals: vec![Vector3::z(); n],
            frames: vec![Matrix3::identity(); n],
            framed: vec![false; n],
            mobilities: vec![Matrix3::identity(); n],
            factors: vec![(1.0, 1.0); n],
            active: Vec::with_capacity(n),
            touching: vec![false; n],
            stale: vec![true; n],
            w: vec![0.0; 9 * n * n],
            gathered: Vec::with_capacity(n),
            rate: vec![0.0; 3 * n],
            change: vec![Vector3::zeros(); n],
        }
    }

    /// Forgets the last call, as after a jump of the state: the next call starts cold.
    pub fn clear(&mut self) {
        self.f.fill(Vector3::zeros());
        self.y.fill([0.0; 4]);
        self.states.fill(PointState::Open);
    }

    /// Begins a new problem: no node touches yet.
    pub fn begin(&mut self) {
        self.active.clear();
    }

    /// Next node of the problem, in ascending order: its c \[m/s\], and the normal of the ground if it touches.
    pub fn set(&mut self, node: usize, c: Vector3<f64>, normal: Option<Vector3<f64>>) {
        self.c[node] = c;
        self.touching[node] = normal.is_some();
        match normal {
            Some(normal) => {
                self.normals[node] = normal;
                self.active.push(node);
            }
            None => self.f[node] = Vector3::zeros(),
        }
    }

    /// \[m/s\] y of a node.
    pub fn rate(&self, node: usize) -> Vector3<f64> {
        Vector3::new(self.y[node][0], self.y[node][1], self.y[node][2])
    }

    /// \[N\] Force of the ground on each contact node, in the axes of the segment.
    pub fn forces(&self) -> &[Vector3<f64>] {
        &self.f
    }

    /// State of each contact node.
    pub fn states(&self) -> &[PointState] {
        &self.states
    }
}
