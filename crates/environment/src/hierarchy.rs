//! Boxes in boxes over the triangles of a mesh, so that a query looks at few of them.
//!
//! A node has four children, nodes or triangles. Those whose boxes are nearer than the best triangle so far wait on a
//! stack, the nearest on top. The tree is built once by halving the triangles twice per node; that bounds its depth by
//! the logarithm of their number, and the stack has a fixed size.

use nalgebra::Vector3;

use crate::bounds::Bounds;
use crate::point_triangle::{self, Feature};
use crate::triangle::Triangle;

/// Marks a child that is a triangle, not a node.
pub(crate) const TRIANGLE: u32 = 1 << 31;
/// Children waiting at most: three at each of the 16 levels of a tree over 2^31 triangles, and the one on top.
pub(crate) const WAITING: usize = 3 * 16 + 1;

/// A node: its children and the boxes around them. The box around nothing is at no finite distance.
pub(crate) type TreeNode = [(Bounds, u32); 4];

/// The tree over the triangles of one mesh; its root is the first node.
#[derive(Clone, Debug)]
pub(crate) struct Hierarchy(pub(crate) Vec<TreeNode>);

impl Hierarchy {
    pub(crate) fn new(triangles: &[Triangle]) -> Self {
        let boxes: Vec<Bounds> = triangles.iter().map(|t| Bounds::of(t.corners)).collect();
        let mut tree = Self(Vec::new());
        tree.add(&boxes, &mut (0..triangles.len() as u32).collect::<Vec<_>>());
        tree
    }

    /// Adds the node over the triangles of `run`, and those below it.
    fn add(&mut self, boxes: &[Bounds], run: &mut [u32]) -> u32 {
        let n = self.0.len();
        self.0.push([(Bounds::NOTHING, 0); 4]);
        let (left, right) = halve(boxes, run);
        let ((a, b), (c, d)) = (halve(boxes, left), halve(boxes, right));
        self.0[n] = [a, b, c, d].map(|part| match part {
            [] => (Bounds::NOTHING, 0),
            [one] => (boxes[*one as usize], TRIANGLE | *one),
            more => (around(boxes, more), self.add(boxes, more)),
        });
        n as u32
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
        let mut waiting = [(0u32, 0.0); WAITING];
        let mut open = 1;
        while open > 0 {
            open -= 1;
            let (child, distance) = waiting[open];
            if distance >= nearest {
                continue;
            }
            if child >= TRIANGLE {
                let i = (child - TRIANGLE) as usize;
                let (point, feature) = point_triangle::closest_of_face(p, &triangles[i].corners);
                let d = (p - point).norm_squared();
                if d < nearest && wanted(i) {
                    (best, nearest) = (Some((i, point, feature)), d);
                }
                continue;
            }
            let bottom = open;
            for (bounds, child) in &self.0[child as usize] {
                let d = bounds.distance_squared(p);
                if d < nearest {
                    // The nearest one on top: it is visited first and shortens the rest.
                    let mut at = open;
                    while at > bottom && waiting[at - 1].1 < d {
                        waiting[at] = waiting[at - 1];
                        at -= 1;
                    }
                    waiting[at] = (*child, d);
                    open += 1;
                }
            }
        }
        best
    }
}

fn around(boxes: &[Bounds], run: &[u32]) -> Bounds {
    run.iter().fold(Bounds::NOTHING, |b, i| b.with(&boxes[*i as usize]))
}

/// Halves `run` along the axis that leaves the two boxes with the least surface: halved along the longest axis, the large
/// triangles of a floor's bottom would stay among the small ones of its top.
fn halve<'a>(boxes: &[Bounds], run: &'a mut [u32]) -> (&'a mut [u32], &'a mut [u32]) {
    let half = run.len().div_ceil(2);
    if run.len() > 2 {
        let centre = |i: &u32| boxes[*i as usize].lo + boxes[*i as usize].hi;
        let mut divide = |axis: usize| {
            run.select_nth_unstable_by(half, |a, b| centre(a)[axis].total_cmp(&centre(b)[axis]));
            let [a, b] = [&run[..half], &run[half..]].map(|part| around(boxes, part).size());
            a.dot(&a.yzx()) + b.dot(&b.yzx())
        };
        let surfaces = Vector3::from([0, 1, 2].map(&mut divide));
        divide(surfaces.imin());
    }
    run.split_at_mut(half)
}
