//! The CAN side of the field bus, for both of its ends and for the tools that listen: sockets, recordings, faults.
//!
//! The layout of its frames is data: [`codec`].
//!
//! - [`capture`]: recorded traffic; [`clock_steps`]: where its clock was put back. [`text_log`]: files of it, as [`candump`],
//!   [`asc`] or [`trc`]. [`bits`]: how long a frame occupies its line.
//! - [`lines`]: one end of all lines of a robot. [`load`]: how full they are;
//!   [`load_course`]: over the time of a recording.
//! - [`owners`], [`cycles`]: recorded frames by local controller and bus cycle. [`statistics`]: how often, how regular.
//! - [`interface`]: interfaces by name, and what is wrong with them. [`tap`]: listening and playing, for tools.
//! - [`injector`]: faults between the two ends; with [`error_counters`] and [`error_frame`], as CAN has them.

pub mod asc;
pub mod bits;
pub mod candump;
pub mod candump_line;
pub mod capture;
pub mod clock_steps;
pub mod cycles;
pub mod error_counters;
pub mod error_frame;
pub mod injector;
pub mod interface;
pub mod lines;
pub mod load;
pub mod load_course;
pub mod owners;
pub mod statistics;
pub mod tap;
pub mod text_log;
pub mod trc;

pub use capture::{Capture, CaptureDirection, Captured, FrameType};
pub use error_counters::ErrorCounters;
pub use error_frame::{ErrorFrame, ErrorState};
pub use injector::Injector;
pub use lines::{BusEnd, BusLines, LineTrouble};
