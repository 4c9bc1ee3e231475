//! One triangle of a surface, and the sign of the distance to it: see [`crate::mesh`].

use nalgebra::Vector3;

use crate::point_triangle::Feature;

/// One triangle with its normals.
#[derive(Clone, Debug)]
pub(crate) struct Triangle {
    /// \[m\] v0, v1, v2
    pub(crate) corners: [Vector3<f64>; 3],
    /// \[1\] of the face
    pub(crate) normal: Vector3<f64>,
    /// \[1\] of the edges k to k + 1
    pub(crate) edge_normals: [Vector3<f64>; 3],
    /// \[1\] of the corners
    pub(crate) vertex_normals: [Vector3<f64>; 3],
}

/// The nearest point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// \[m\] g, negative inside.
    pub gap: f64,
    /// \[1\] Gradient of g.
    pub normal: Vector3<f64>,
    /// \[m\] p_min
    pub point: Vector3<f64>,
    /// Number of the triangle p_min was found on.
    pub triangle: usize,
}

/// Below this distance \[m\] the direction to p_min is rounding, and the (pseudo-)normal is taken.
const ON_SURFACE: f64 = 1e-12;

impl Triangle {
    /// \[m\] How far `p` lies above the plane of the face.
    pub(crate) fn height(&self, p: &Vector3<f64>) -> f64 {
        self.normal.dot(&(p - self.corners[0]))
    }

    pub(crate) fn signed(
        &self,
        p: &Vector3<f64>,
        point: Vector3<f64>,
        feature: Feature,
        triangle: usize,
    ) -> Nearest {
        let normal = match feature {
            // An edge within a plane is no edge, and r would give the normal with its rounding over the distance.
            Feature::Edge(k) if self.edge_normals[usize::from(k)] != self.normal => {
                self.edge_normals[usize::from(k)]
            }
            Feature::Face | Feature::Edge(_) => {
                return Nearest { gap: self.height(p), normal: self.normal, point, triangle };
            }
            Feature::Vertex(k) => self.vertex_normals[usize::from(k)],
        };
        let r = p - point;
        let (d, side) = (r.norm(), normal.dot(&r));
        if d < ON_SURFACE {
            return Nearest { gap: side, normal, point, triangle };
        }
        let sign = if side < 0.0 { -1.0 } else { 1.0 };
        Nearest { gap: sign * d, normal: r * (sign / d), point, triangle }
    }
}
