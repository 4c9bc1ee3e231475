//! Curves of time: piecewise quintics, natural cubic splines, piecewise linear functions.
//!
//! Everything here is a plain value of fixed capacity: it can live in shared memory, is copied without an
//! allocation and is evaluated without one.

mod path;
mod polyline;
mod spline;

pub use path::{Path, Sample};
pub use polyline::Polyline;
pub use spline::{Gradient, Spline, SplineSample};
