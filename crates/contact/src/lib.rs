//! Contact of the feet with the ground (thesis 2.3.1): massless viscoelastic layers on unilateral constraints with
//! Coulomb friction.
//!
//! | part | where |
//! |---|---|
//! | independent points, closed form | [`point`] |
//! | one node with any damping | [`node`] |
//! | bricks, their mesh, the matrices of a pad | [`hexahedron`], [`mesh`], [`layer`], [`coupling`] |
//! | a pad on a segment | [`pad`] |
//! | its solvers: over forces (algorithm 1), over velocities | [`solver`]: `prox`, `velocity` |

pub mod coupling;
pub mod frame;
pub mod hexahedron;
pub mod law;
pub mod layer;
pub mod memory;
pub mod mesh;
pub mod node;
pub mod pad;
pub mod point;
mod prox;
pub mod solver;
mod velocity;

pub use law::{CouplingMethod, Settings, SolverReport, TOUCHING};
pub use layer::{Layer, Material};
pub use memory::Memory;
pub use pad::{Ground, Pad, PadLoad, SegmentMotion};
