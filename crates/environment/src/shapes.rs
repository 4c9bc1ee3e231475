//! Meshes that need no file.

use crate::{Mesh, MeshError};

impl Mesh {
    /// A box of this size \[m\], centred at the origin: 12 triangles.
    pub fn cuboid(size: [f64; 3]) -> Result<Self, MeshError> {
        let corner = |i: usize| std::array::from_fn(|k| if i >> k & 1 == 1 { 0.5 } else { -0.5 } * size[k]);
        let vertices: [[f64; 3]; 8] = std::array::from_fn(corner);
        // Each face as its four corners, counter-clockwise seen from outside.
        let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let triangles: Vec<[u32; 3]> =
            faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
        Self::new(&vertices, &triangles)
    }
}
