//! Why triangles are no solid.

use std::fmt;

/// Fault of a mesh; lengths in the units and axes of its file.
#[derive(Clone, Debug, PartialEq)]
pub enum MeshError {
    /// No triangle has an area.
    Empty,
    /// A coordinate is NaN, or too large.
    Coordinate {
        /// Number of the vertex, from 0.
        vertex: usize,
        /// Its coordinates.
        at: [f64; 3],
        /// \[m\] Largest coordinate allowed.
        largest: f64,
    },
    /// A triangle names a vertex that is not there.
    Number {
        /// Number of the triangle, from 0.
        triangle: usize,
        /// Vertex that it names.
        vertex: u32,
        /// Number of vertices there are.
        vertices: usize,
    },
    /// More triangles than allowed.
    TooMany {
        /// Number of triangles.
        triangles: usize,
        /// The most that are allowed.
        most: usize,
    },
    /// An edge belongs to one triangle only.
    Open {
        /// One end of the edge.
        from: [f64; 3],
        /// The other end.
        to: [f64; 3],
    },
    /// Two triangles pass an edge in the same direction.
    Orientation {
        /// One end of the edge.
        from: [f64; 3],
        /// The other end.
        to: [f64; 3],
    },
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "it encloses no volume; export a solid with triangles"),
            Self::Coordinate { vertex, at, largest } => write!(
                f,
                "vertex {vertex} is at {at:?}; coordinates are numbers from -{largest} to {largest} m: check the units, \
                 and the scale given with the mesh"
            ),
            Self::Number { triangle, vertex, vertices } => write!(
                f,
                "triangle {triangle} names vertex {vertex}, but there are only {vertices}; export the file again"
            ),
            Self::TooMany { triangles, most } => {
                write!(f, "{triangles} triangles are more than the {most} allowed; export it coarser")
            }
            Self::Open { from, to } => write!(
                f,
                "the edge from {from:?} to {to:?} belongs to one triangle only, so inside and outside are not defined; \
                 close the surface (a floor needs sides and a bottom, too)"
            ),
            Self::Orientation { from, to } => write!(
                f,
                "two triangles pass the edge from {from:?} to {to:?} in the same direction, so their normals disagree, \
                 or more than two triangles meet there; unify the normals and join overlapping solids"
            ),
        }
    }
}

impl std::error::Error for MeshError {}
