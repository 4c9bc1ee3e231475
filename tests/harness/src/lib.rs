//! What tests of the executable `gangwerk` stand on: a place of its own for each, and processes that end with the test.

mod place;
mod running;

pub use place::{Site, root};
pub use running::{Running, Said, doze};
