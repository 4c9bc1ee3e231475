//! Curves of time: piecewise quintics, natural cubic splines, piecewise linear functions.
//!
//! Everything here is a plain value of fixed capacity: it can live in shared memory, is copied without an
//! allocation and is evaluated without one.

mod least;
mod path;
mod polyline;
mod spline;

pub use least::{hessian, least_acceleration};
pub use path::{Cursor, Path, Sample, quintic};
pub use polyline::Polyline;
pub use spline::{Gradient, Spline, SplineSample};
