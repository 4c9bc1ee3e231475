//! Environment of a robot: a plane, z = 0 unless it is lower or tilted, and rigid objects on it (thesis 2.3.2), and the distance
//! of a point to them.
//!
//! - [`Environment`]: ground and objects; [`Environment::query`] answers with gap, normal and what was hit, [`Environment::ray`]
//!   with the way to what is met first.
//! - [`Object`]: a [`Mesh`] with a pose; it may appear, move and vanish while nothing touches it.
//! - [`Mesh`]: the surface of a solid, from triangles, from a file ([`Mesh::read`]: STL, OBJ, glTF, VRML 97) or a box.
//!
//! Lengths in m, z up. Everything is allocated in `new`; queries and [`Environment::advance`] allocate nothing and
//! answer every input: where a point is NaN or infinite, the answer is [`Surface::Far`].

mod advance;
mod bounds;
mod error;
mod hierarchy;
mod mesh;
mod object;
mod point_triangle;
mod pose;
mod query;
mod ray;
mod read;
mod reference;
mod schedule;
mod shapes;
mod topology;
mod triangle;

pub use bounds::Bounds;
pub use error::MeshError;
pub use mesh::Mesh;
pub use object::Object;
pub use point_triangle::{Feature, closest};
pub use pose::Pose;
pub use query::{Environment, Hit, ObjectEvent, REACH, Surface};
pub use read::ReadError;
pub use schedule::Schedule;
pub use topology::MeshRepairs;
pub use triangle::Nearest;
