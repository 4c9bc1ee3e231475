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
use crate::topology::{self, MeshRepairs};
use crate::triangle::{Nearest, Triangle};

/// A closed surface with outward normals. Never changes after construction.
#[derive(Clone, Debug)]
pub struct Mesh {
    pub(crate) triangles: Vec<Triangle>,
    pub(crate) hierarchy: Hierarchy,
    bounds: Bounds,
    repairs: MeshRepairs,
}

impl Mesh {
    /// The mesh of `triangles`, given as numbers of `vertices` \[m\], each counter-clockwise seen from outside.
    pub fn new(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<Self, MeshError> {
        let solid = topology::solid(vertices, triangles)?;
        let (triangles, repairs) = (solid.triangles, solid.repairs);
        let hierarchy = Hierarchy::new(&triangles);
        let bounds = Bounds::of(triangles.iter().flat_map(|t| t.corners));
        Ok(Self { triangles, hierarchy, bounds, repairs })
    }

    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Never: a closed surface has at least four triangles.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Repairs while it was built.
    pub fn repairs(&self) -> MeshRepairs {
        self.repairs
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
}
