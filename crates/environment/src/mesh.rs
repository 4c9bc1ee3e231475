//! The surface of a solid as triangles (2.51), (2.52), and the signed distance to it.
//!
//! The sign of the distance is that of `n . (p - p_min)` with n the normal of the face, or the pseudo-normal of the edge
//! or corner p_min lies on: normals of the adjacent faces, at a corner weighted by the angle there (Baerentzen and
//! Aanaes 2005). With the normal of any one of those faces, as in algorithm 2 of the thesis, points beside an acute edge
//! would count as inside. It needs a closed surface with all normals outward, which [`Mesh::new`] makes sure of.
//!
//! | symbol | name | unit | frame |
//! |---|---|---|---|
//! | p | the point asked for | m | mesh |
//! | p_min | nearest point of the surface | m | mesh |
//! | n | outward unit normal | 1 | mesh |
//! | g | signed distance, negative inside | m | |

use nalgebra::Vector3;

use crate::MeshError;
use crate::bounds::Bounds;
use crate::hierarchy::Hierarchy;
use crate::point_triangle::{self, Feature};
use crate::topology;

/// A closed surface with outward normals. Never changes after construction.
#[derive(Clone, Debug)]
pub struct Mesh {
    triangles: Vec<Triangle>,
    hierarchy: Hierarchy,
    bounds: Bounds,
    report: Report,
}

/// What was put right while the mesh was built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Triangles without area that were left out.
    pub degenerate: usize,
    /// All triangles were wound the other way round, and were turned.
    pub inside_out: bool,
}

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

impl Mesh {
    /// The mesh of `triangles`, given as numbers of `vertices` \[m\], each counter-clockwise seen from outside.
    pub fn new(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<Self, MeshError> {
        let solid = topology::solid(vertices, triangles)?;
        let (triangles, report) = (solid.triangles, solid.report);
        let hierarchy = Hierarchy::new(&triangles);
        let bounds = Bounds::of(triangles.iter().flat_map(|t| t.corners));
        Ok(Self { triangles, hierarchy, bounds, report })
    }

    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Never: a closed surface has at least four triangles.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// What was put right.
    pub fn report(&self) -> Report {
        self.report
    }

    /// \[m\] The box around all corners.
    pub fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// \[m\] Corners of each triangle, counter-clockwise seen from outside.
    pub fn faces(&self) -> impl Iterator<Item = [Vector3<f64>; 3]> {
        self.triangles.iter().map(|t| t.corners)
    }

    pub(crate) fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// The nearest point of the surface to `p` \[m\].
    pub fn nearest(&self, p: &Vector3<f64>) -> Option<Nearest> {
        self.nearest_of(p, f64::INFINITY, |_| true)
    }

    /// The nearest point nearer than `within` \[m\], among the triangles that are `wanted`.
    pub(crate) fn nearest_of(
        &self,
        p: &Vector3<f64>,
        within: f64,
        wanted: impl Fn(usize) -> bool,
    ) -> Option<Nearest> {
        let (triangle, point, feature) = self.hierarchy.nearest(&self.triangles, p, within, wanted)?;
        Some(self.triangles[triangle].signed(p, point, feature, triangle))
    }

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

impl Triangle {
    /// \[m\] How far `p` lies above the plane of the face.
    pub(crate) fn height(&self, p: &Vector3<f64>) -> f64 {
        self.normal.dot(&(p - self.corners[0]))
    }

    fn signed(&self, p: &Vector3<f64>, point: Vector3<f64>, feature: Feature, triangle: usize) -> Nearest {
        let normal = match feature {
            Feature::Face => {
                return Nearest { gap: self.height(p), normal: self.normal, point, triangle };
            }
            Feature::Edge(k) => self.edge_normals[usize::from(k)],
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
