//! Curves of time: piecewise quintics, piecewise linear functions; natural cubic splines as a reference.
//!
//! Everything here is a plain value of fixed capacity: it can live in shared memory, is copied without an
//! allocation and is evaluated without one.

mod least;
mod path;
mod polyline;
pub mod reference;

pub use least::{hessian, least_acceleration};
pub use path::{Cursor, Path, Sample, quintic};
pub use polyline::Polyline;
