//! Boxes in boxes over the triangles of a mesh, so that a query looks at few of them.
//!
//! A node's box is nearer than the best triangle so far, or the node is passed over. The tree is built once by halving
//! the triangles along the longest extent of their centres, which bounds its depth by the logarithm of their number; the
//! nodes still to be visited fit a stack of fixed size.

use nalgebra::Vector3;

use crate::bounds::Bounds;
use crate::point_triangle::{self, Feature};
use crate::triangle::Triangle;

/// Triangles below which a node is not divided further (measured: `benches/queries.rs`).
const LEAF: usize = 4;
/// Levels of a tree over 2^32 triangles, and one to spare.
const DEPTH: usize = 33;

/// A node: two children one after the other, or a run of triangles.
#[derive(Clone, Debug)]
struct TreeNode {
    bounds: Bounds,
    /// First child, or first place in `order`.
    first: u32,
    /// Number of triangles; 0 for an inner node.
    count: u32,
}

/// The tree over the triangles of one mesh.
#[derive(Clone, Debug)]
pub(crate) struct Hierarchy {
    nodes: Vec<TreeNode>,
    order: Vec<u32>,
}

impl Hierarchy {
    pub(crate) fn new(triangles: &[Triangle]) -> Self {
        let boxes: Vec<Bounds> = triangles.iter().map(|t| Bounds::of(t.corners)).collect();
        let mut tree = Self { nodes: Vec::new(), order: (0..triangles.len() as u32).collect() };
        let (mut order, count) = (std::mem::take(&mut tree.order), triangles.len());
        tree.nodes.push(TreeNode { bounds: Bounds::NOTHING, first: 0, count: 0 });
        tree.divide(0, &boxes, &mut order, 0, count);
        tree.order = order;
        tree
    }

    /// Makes node `n` over the places `from..to` of `order`.
    fn divide(&mut self, n: usize, boxes: &[Bounds], order: &mut [u32], from: usize, to: usize) {
        let run = &mut order[from..to];
        let bounds = run.iter().fold(Bounds::NOTHING, |b, i| b.with(&boxes[*i as usize]));
        if run.len() <= LEAF {
            self.nodes[n] = TreeNode { bounds, first: from as u32, count: run.len() as u32 };
            return;
        }
        let centre = |i: &u32| (boxes[*i as usize].lo + boxes[*i as usize].hi) / 2.0;
        let axis = Bounds::of(run.iter().map(centre)).size().imax();
        let half = run.len() / 2;
        run.select_nth_unstable_by(half, |a, b| centre(a)[axis].total_cmp(&centre(b)[axis]));
        let first = self.nodes.len();
        self.nodes[n] = TreeNode { bounds, first: first as u32, count: 0 };
        let empty = TreeNode { bounds: Bounds::NOTHING, first: 0, count: 0 };
        self.nodes.extend([empty.clone(), empty]);
        self.divide(first, boxes, order, from, from + half);
        self.divide(first + 1, boxes, order, from + half, to);
    }

    /// The triangle nearest to `p` \[m\] that is nearer than `within` \[m\] and `wanted`, with the point on it.
    pub(crate) fn nearest(
        &self,
        triangles: &[Triangle],
        p: &Vector3<f64>,
        within: f64,
        wanted: impl Fn(usize) -> bool,
    ) -> Option<(usize, Vector3<f64>, Feature)> {
        let mut best = None;
        let mut nearest = within * within;
        let mut waiting = [(0u32, 0.0); DEPTH];
        let mut open = 1;
        waiting[0] = (0, self.nodes[0].bounds.distance_squared(p));
        while open > 0 {
            open -= 1;
            let (n, distance) = waiting[open];
            if distance >= nearest {
                continue;
            }
            let node = &self.nodes[n as usize];
            let first = node.first as usize;
            for &i in &self.order[first..first + node.count as usize] {
                let (point, feature) = point_triangle::closest(p, &triangles[i as usize].corners);
                let d = (p - point).norm_squared();
                if d < nearest && wanted(i as usize) {
                    (best, nearest) = (Some((i as usize, point, feature)), d);
                }
            }
            if node.count == 0 {
                let [a, b] = [first, first + 1]
                    .map(|child| (child as u32, self.nodes[child].bounds.distance_squared(p)));
                // The nearer one on top: it is visited first and shortens the rest.
                let (far, near) = if a.1 < b.1 { (b, a) } else { (a, b) };
                for child in [far, near] {
                    if child.1 < nearest {
                        waiting[open] = child;
                        open += 1;
                    }
                }
            }
        }
        best
    }
}
