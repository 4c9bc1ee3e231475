//! Rays: how far away is what a camera or a range finder meets first?

use nalgebra::Vector3;

use crate::bounds::Bounds;
use crate::hierarchy::{Hierarchy, TRIANGLE, WAITING};
use crate::mesh::Mesh;
use crate::object::Object;
use crate::query::Environment;
use crate::triangle::Triangle;

/// \[1\] A ray that runs along a face this exactly does not meet it.
const ALONG: f64 = 1e-12;

impl Environment {
    /// \[m\] Way from `from` \[m\] @world in the direction of the unit vector `along` to the first surface, ground or object, nearer
    /// than `within`.
    pub fn ray(&self, from: &Vector3<f64>, along: &Vector3<f64>, within: f64) -> Option<f64> {
        let up = self.up.map_or(Vector3::z(), Vector3::from);
        let (height, sinks) = (up.dot(from) - up.z * self.height, -up.dot(along));
        let ground = if sinks > ALONG { height / sinks } else { f64::INFINITY };
        let mut first = if ground >= 0.0 { within.min(ground) } else { within };
        for object in self.objects.iter().filter(|o| o.present) {
            first = object.ray(from, along, first).unwrap_or(first);
        }
        (first < within).then_some(first)
    }
}

impl Object {
    fn ray(&self, from: &Vector3<f64>, along: &Vector3<f64>, within: f64) -> Option<f64> {
        self.bounds().ray(from, along, within)?;
        let inverse = self.pose().rotation.inverse();
        self.mesh().ray(&(inverse * (from - self.pose().position)), &(inverse * along), within)
    }
}

impl Mesh {
    /// \[m\] Way from `from` \[m\] in the direction of the unit vector `along` to the first triangle nearer than `within`, seen from
    /// either side.
    pub fn ray(&self, from: &Vector3<f64>, along: &Vector3<f64>, within: f64) -> Option<f64> {
        // NaN would be inside of every box.
        let is_number = from.iter().chain(along).all(|x| x.is_finite());
        if is_number { self.hierarchy.ray(self.triangles(), from, along, within) } else { None }
    }
}

impl Hierarchy {
    fn ray(
        &self,
        triangles: &[Triangle],
        from: &Vector3<f64>,
        along: &Vector3<f64>,
        within: f64,
    ) -> Option<f64> {
        let mut first = within;
        let mut waiting = [(0u32, 0.0); WAITING];
        let mut open = 1;
        while open > 0 {
            open -= 1;
            let (child, enters) = waiting[open];
            if enters >= first {
                continue;
            }
            if child >= TRIANGLE {
                let way = triangles[(child - TRIANGLE) as usize].ray(from, along);
                first = way.map_or(first, |way| first.min(way));
                continue;
            }
            let bottom = open;
            for (bounds, child) in &self.0[child as usize] {
                let Some(enters) = bounds.ray(from, along, first) else { continue };
                // The nearest one on top: it is visited first and shortens the rest.
                let mut at = open;
                while at > bottom && waiting[at - 1].1 < enters {
                    waiting[at] = waiting[at - 1];
                    at -= 1;
                }
                waiting[at] = (*child, enters);
                open += 1;
            }
        }
        (first < within).then_some(first)
    }
}

impl Bounds {
    /// \[m\] Way to the box, 0 inside of it; none if it is not nearer than `within` or the ray passes it.
    fn ray(&self, from: &Vector3<f64>, along: &Vector3<f64>, within: f64) -> Option<f64> {
        let (mut enters, mut leaves) = (0.0_f64, within);
        for i in 0..3 {
            if along[i] == 0.0 {
                // Parallel to two of the faces, and 0/0 in the plane of one.
                if from[i] < self.lo[i] || from[i] > self.hi[i] {
                    return None;
                }
                continue;
            }
            // The nearer face first; around nothing, whose faces are in the wrong order, no ray is inside.
            let [near, far] =
                if along[i] > 0.0 { [self.lo[i], self.hi[i]] } else { [self.hi[i], self.lo[i]] };
            enters = enters.max((near - from[i]) / along[i]);
            leaves = leaves.min((far - from[i]) / along[i]);
        }
        (enters <= leaves && enters < within).then_some(enters)
    }
}

impl Triangle {
    /// \[m\] Way to the triangle (Möller and Trumbore 1997).
    fn ray(&self, from: &Vector3<f64>, along: &Vector3<f64>) -> Option<f64> {
        let [a, b, c] = self.corners;
        let (ab, ac, p) = (b - a, c - a, from - a);
        let across = along.cross(&ac);
        let volume = ab.dot(&across);
        if volume.abs() < ALONG * ab.norm() * ac.norm() {
            return None;
        }
        let (u, q) = (p.dot(&across) / volume, p.cross(&ab));
        let (v, way) = (along.dot(&q) / volume, ac.dot(&q) / volume);
        // A ray through an edge meets one of its triangles, if not both.
        (u >= -ALONG && v >= -ALONG && u + v <= 1.0 + ALONG && way >= 0.0).then_some(way)
    }
}
