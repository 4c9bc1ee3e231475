//! Mesh of a pad: a block of bricks between its sole and the segment it is bonded to.
//!
//! Frame of the mesh: axes of the segment, origin in the middle of the sole. Nodes run along x, then y, then up, so the
//! first ones are those of the sole, which can touch the ground, and the last ones those on top, which are bonded.

use nalgebra::Vector3;

/// Nodes and bricks of a block.
#[derive(Clone, Debug)]
pub struct BrickMesh {
    /// \[m\]
    pub nodes: Vec<Vector3<f64>>,
    /// Nodes of each brick, in the order of [`crate::hexahedron::CORNERS`].
    pub bricks: Vec<[usize; 8]>,
    /// Number of nodes of the sole, and of the top: a layer.
    pub layer: usize,
}

impl BrickMesh {
    /// A block of `size` \[m\] with so many bricks along x, y and z.
    pub fn block(size: [f64; 3], count: [usize; 3]) -> Self {
        let [nx, ny, nz] = count.map(|n| n + 1);
        let place = |k: usize, axis: usize| size[axis] * k as f64 / count[axis] as f64;
        let node = |k: usize| {
            let at = Vector3::new(place(k % nx, 0), place(k / nx % ny, 1), place(k / (nx * ny), 2));
            at - Vector3::new(size[0], size[1], 0.0) / 2.0
        };
        let corner = |x: usize, y: usize, z: usize| x + nx * (y + ny * z);
        let brick = |k: usize| {
            let (x, y, z) = (k % count[0], k / count[0] % count[1], k / (count[0] * count[1]));
            let ring =
                |z| [corner(x, y, z), corner(x + 1, y, z), corner(x + 1, y + 1, z), corner(x, y + 1, z)];
            let ([a, b, c, d], [e, f, g, h]) = (ring(z), ring(z + 1));
            [a, b, c, d, e, f, g, h]
        };
        Self {
            nodes: (0..nx * ny * nz).map(node).collect(),
            bricks: (0..count.iter().product()).map(brick).collect(),
            layer: nx * ny,
        }
    }

    /// Number of nodes that are not bonded.
    pub fn free(&self) -> usize {
        self.nodes.len() - self.layer
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Thesis 2.6.1: 72 nodes per element, 36 of them bonded, 108 degrees of freedom left.
    #[test]
    fn a_pad_of_lola_has_the_nodes_of_the_thesis() {
        let mesh = BrickMesh::block([0.06, 0.03, 0.012], [5, 5, 1]);
        assert_eq!((mesh.nodes.len(), mesh.layer, 3 * mesh.free(), mesh.bricks.len()), (72, 36, 108, 25));
        assert_eq!(mesh.nodes[0], Vector3::new(-0.03, -0.015, 0.0));
        assert_eq!(mesh.nodes[71], Vector3::new(0.03, 0.015, 0.012));
        let used = |k| mesh.bricks.iter().filter(|b| b.contains(&k)).count();
        assert_eq!((used(0), used(1), used(7)), (1, 2, 4));
    }
}
