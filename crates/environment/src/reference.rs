//! Reference algorithm, which only tests and benchmarks call: distance by looking at every triangle.

use nalgebra::Vector3;

use crate::mesh::Mesh;
use crate::point_triangle;
use crate::triangle::Nearest;

impl Mesh {
    /// As [`Mesh::nearest`], looking at every triangle: what algorithm 2 of the thesis does.
    pub fn nearest_by_search(&self, p: &Vector3<f64>) -> Option<Nearest> {
        let mut best = None;
        let mut nearest = f64::INFINITY;
        for (i, triangle) in self.triangles.iter().enumerate() {
            let (point, feature) = point_triangle::closest(p, &triangle.corners);
            let d = (p - point).norm_squared();
            if d < nearest {
                (best, nearest) = (Some((i, point, feature)), d);
            }
        }
        best.map(|(i, point, feature)| self.triangles[i].signed(p, point, feature, i))
    }
}
