//! The CAN side of the field bus, for both of its ends and for the tools that listen: sockets, recordings, faults.
//!
//! Layouts of frames are data: `config/robots/NAME/can/*.dbc`, read by `config`, used by [`messages::frames`].
//!
//! - [`capture`]: recorded traffic. [`candump`]: the files of can-utils. [`bits`]: how long a frame occupies its line.

pub mod bits;
pub mod candump;
pub mod candump_line;
pub mod capture;

pub use capture::{Capture, Captured, Form, Way};
