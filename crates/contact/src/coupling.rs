//! Coupling of the nodes of a layer: damping and its inverse, for the nodes that can touch the ground.
//!
//! With B = alpha K and y = d' + d/alpha the equation of the layer (2.37) reads B y = f without the elastic term. Nodes
//! that never touch carry no force and are eliminated; what is left couples forces and velocities of the others:
//!
//! ```text
//! f = S y,    y = W f,    W = S^-1
//! ```
//!
//! | symbol | name | unit | shape |
//! |---|---|---|---|
//! | W | contact block of B^-1, columns contiguous | m/(N s) | 3n x 3n |
//! | S | its inverse: B if every free node can touch, else the Schur complement; blocks that are not zero | N s/m | n rows of 3 x 3 |
//! | G | W_ii, 3 x 3 block of a node | m/(N s) | 3 x 3 |

use nalgebra::{DMatrix, Matrix3, Vector3};

/// A 3 x 3 block of S, columns padded to 4.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CouplingBlock {
    pub(crate) node: usize,
    columns: [[f64; 4]; 3],
}

/// The two matrices, prepared once; equal pads share one.
#[derive(Clone, Debug)]
pub struct Coupling {
    nodes: usize,
    w: Vec<f64>,
    diagonal: Vec<Matrix3<f64>>,
    /// Neighbours of each node, itself left out: `blocks[rows[i]..rows[i + 1]]`.
    blocks: Vec<CouplingBlock>,
    rows: Vec<usize>,
    own: Vec<Matrix3<f64>>,
    /// Inverse of `own`.
    yielding: Vec<Matrix3<f64>>,
}

/// Blocks of S smaller than this, relative to the largest, are rounding errors of an inversion.
const NOTHING: f64 = 1e-13;

impl Coupling {
    /// From S \[N s/m\], symmetric positive definite, 3n x 3n; `None` if it is not.
    pub fn new(s: &DMatrix<f64>) -> Option<Self> {
        let nodes = s.nrows() / 3;
        if s.ncols() != s.nrows() || s.nrows() != 3 * nodes || nodes == 0 {
            return None;
        }
        let w = s.clone().cholesky()?.inverse();
        let block = |m: &DMatrix<f64>, i: usize, j: usize| -> Matrix3<f64> {
            m.fixed_view::<3, 3>(3 * i, 3 * j).into()
        };
        // Bricks couple only neighbours: blocks of all others are rounding, and are left out of the sweeps.
        let nothing = NOTHING * s.amax();
        let (mut blocks, mut rows) = (Vec::new(), vec![0]);
        for i in 0..nodes {
            for j in (0..nodes).filter(|&j| j != i) {
                let b = block(s, i, j);
                if b.amax() > nothing {
                    let columns = std::array::from_fn(|k| [b[(0, k)], b[(1, k)], b[(2, k)], 0.0]);
                    blocks.push(CouplingBlock { node: j, columns });
                }
            }
            rows.push(blocks.len());
        }
        let own: Vec<_> = (0..nodes).map(|i| block(s, i, i)).collect();
        let yielding = own.iter().map(|s: &Matrix3<f64>| s.try_inverse()).collect::<Option<_>>()?;
        let diagonal = (0..nodes).map(|i| block(&w, i, i)).collect();
        Some(Self { nodes, w: w.as_slice().to_vec(), diagonal, blocks, rows, own, yielding })
    }

    /// n
    pub fn nodes(&self) -> usize {
        self.nodes
    }

    /// W, column by column.
    pub fn inverse(&self) -> &[f64] {
        &self.w
    }

    /// G of a node: its velocity under its own force when no other node is held.
    pub fn free_mobility(&self, node: usize) -> &Matrix3<f64> {
        &self.diagonal[node]
    }

    /// S_ii^-1: its velocity under its own force when all others are held.
    pub(crate) fn held_mobility(&self, node: usize) -> &Matrix3<f64> {
        &self.yielding[node]
    }

    /// S_ii
    pub fn own(&self, node: usize) -> &Matrix3<f64> {
        &self.own[node]
    }

    /// Neighbours of a node that its force depends on.
    pub(crate) fn neighbours(&self, node: usize) -> &[CouplingBlock] {
        &self.blocks[self.rows[node]..self.rows[node + 1]]
    }

    /// Sum of S_ij y_j over all other nodes.
    #[inline]
    pub(crate) fn pull(&self, node: usize, y: &[[f64; 4]]) -> Vector3<f64> {
        let mut sum = [[0.0; 4]; 3];
        for b in self.neighbours(node) {
            let y = &y[b.node];
            for k in 0..3 {
                for (s, c) in sum[k].iter_mut().zip(&b.columns[k]) {
                    *s += c * y[k];
                }
            }
        }
        Vector3::from_fn(|i, _| sum[0][i] + sum[1][i] + sum[2][i])
    }
}
