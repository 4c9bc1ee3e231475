//! ZMP reference by direct construction for rectangular feet (thesis 4.6.4, last paragraph): (4.42) in O(n) per round.
//!
//! Each boundary's point is free, on an edge or in a corner of its rectangle. For a given choice the optimum solves a
//! tridiagonal system of 2x2 blocks: `(a_k + a_{k+1}) p_k - a_k p_{k-1} - a_{k+1} p_{k+1} = forces of the edges held`.
//! Where the point between its neighbours' pull would lie, seen from the rectangle, says which edges to hold in the
//! next round (primal-dual active set). A choice that repeats itself is the optimum, exactly. Two sweeps of Gauss-Seidel
//! make the first choice.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | a_k | 1 / (t_k - t_{k-1}) | 1/s |
//! | A_k, b_k | the point as seen from the next one: p_k = A_k p_{k+1} + b_k | 1, m |
//! | M | what is left of the diagonal block after elimination | 1/s |

use crate::zmp::{MAX_NODES, ZmpHold, ZmpProblem};

/// Most rounds.
const ROUNDS: usize = 24;
/// \[m\] A point this far outside lies on the edge.
const TOUCH: f64 = 1e-12;

/// Edge that holds a point along each axis of its rectangle: -1, 1, or 0 for none.
type HeldEdges = [i8; 2];
type NodeBlock = [[f64; 2]; 2];

fn times(m: &NodeBlock, v: [f64; 2]) -> [f64; 2] {
    m.map(|row| row[0] * v[0] + row[1] * v[1])
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

impl ZmpProblem {
    /// Solves (4.42) between given ends; `false` if the choice of edges does not settle.
    pub fn solve_directly(&mut self) -> bool {
        let n = self.nodes().len();
        self.sweep(1.0);
        self.sweep(1.0);
        let mut edges = [[i8::MAX; 2]; MAX_NODES]; // none yet: wherever the neighbours pull
        self.choose(&mut edges);
        for _ in 0..ROUNDS {
            self.place(&edges[..n]);
            if !self.choose(&mut edges) {
                return true;
            }
        }
        false
    }

    /// Chooses the edges that hold each point, as its neighbours pull it; `true` if the choice has changed.
    fn choose(&self, edges: &mut [HeldEdges; MAX_NODES]) -> bool {
        let nodes = self.nodes();
        let mut changed = false;
        for k in 1..nodes.len() - 1 {
            let (before, n, after) = (&nodes[k - 1], &nodes[k], &nodes[k + 1]);
            let Some(hold) = &n.hold else { continue };
            let s = (n.time - before.time) / (after.time - before.time);
            let q = hold.local([0, 1].map(|d| before.p[d] + s * (after.p[d] - before.p[d])));
            let at = hold.local(n.p);
            for d in 0..2 {
                // Free points lie between their neighbours; held ones show where they are pulled to.
                let q = if edges[k][d] == 0 { at[d] } else { q[d] };
                let edge = if q.abs() > hold.half[d] + TOUCH { q.signum() as i8 } else { 0 };
                changed |= edge != edges[k][d];
                edges[k][d] = edge;
            }
        }
        changed
    }

    /// Places all points as the edges allow: elimination forwards, substitution backwards.
    fn place(&mut self, edges: &[HeldEdges]) {
        let nodes = self.nodes_mut();
        let last = nodes.len() - 1;
        // p_k = A_k p_{k+1} + b_k, from the first point, which is given, on.
        let mut seen = [([[0.0; 2]; 2], [0.0; 2]); MAX_NODES];
        seen[0].1 = nodes[0].p;
        for k in 1..last {
            let n = &nodes[k];
            let Some(hold) = &n.hold else {
                seen[k].1 = n.p;
                continue;
            };
            let (a, c) = (1.0 / (n.time - nodes[k - 1].time), 1.0 / (nodes[k + 1].time - n.time));
            let (before, b) = seen[k - 1];
            let m = [0, 1].map(|i| [0, 1].map(|j| if i == j { a + c } else { 0.0 } - a * before[i][j]));
            let free = edges[k].map(|e| e == 0);
            let held = [0, 1].map(|d| f64::from(edges[k][d]) * hold.half[d]);
            seen[k] = eliminate(hold, free, held, &m, b.map(|b| a * b), c);
        }
        // Substitution, from the last point, which is given, back.
        for k in (1..last).rev() {
            let (a, b) = &seen[k];
            let next = times(a, nodes[k + 1].p);
            nodes[k].p = [next[0] + b[0], next[1] + b[1]];
        }
    }
}

/// A and b of a point with the block `m`, the load `r` of the points before it and the pull `c` of the next one.
fn eliminate(
    hold: &ZmpHold,
    free: [bool; 2],
    held: [f64; 2],
    m: &NodeBlock,
    r: [f64; 2],
    c: f64,
) -> (NodeBlock, [f64; 2]) {
    // A point on an edge has one unknown, its way along it; in a corner it has none.
    let on_edge = |axis: [f64; 2]| {
        let origin = hold.point(held);
        let by = 1.0 / dot(axis, times(m, axis));
        let along = by * (dot(axis, r) - dot(axis, times(m, origin)));
        let a = axis.map(|x| axis.map(|y| c * by * x * y));
        (a, [origin[0] + along * axis[0], origin[1] + along * axis[1]])
    };
    match free {
        // Free along both axes: the block itself is inverted.
        [true, true] => {
            let by = 1.0 / (m[0][0] * m[1][1] - m[0][1] * m[1][0]);
            let inverse = [[by * m[1][1], -by * m[0][1]], [-by * m[1][0], by * m[0][0]]];
            (inverse.map(|row| row.map(|x| c * x)), times(&inverse, r))
        }
        [true, false] => on_edge(hold.axis),
        [false, true] => on_edge([-hold.axis[1], hold.axis[0]]),
        [false, false] => ([[0.0; 2]; 2], hold.point(held)),
    }
}
