//! The CAN side of the field bus, for both of its ends and for the tools that listen: sockets, recordings, faults.
//!
//! Layouts of frames are data: `config/robots/NAME/can/*.dbc`, read by `config`, used by [`messages::frames`].
//!
//! - [`capture`]: recorded traffic. [`candump`]: the files of can-utils. [`bits`]: how long a frame occupies its line.
//! - [`interface`]: interfaces by name, and what is wrong with them. [`tap`]: listening and playing, for tools.

pub mod bits;
pub mod candump;
pub mod candump_line;
pub mod capture;
pub mod interface;
pub mod tap;

pub use capture::{Capture, Captured, Form, Way};
