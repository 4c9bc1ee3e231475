//! Writes every logged topic to a file, outside of the control processes, and never holds anybody up.
//!
//! - [`Logging`]: follows sources and writes what they give; the pure part.
//! - [`LogOutput`]: the file: goes on counting when the disk is full, and begins a new part when it no longer is.
//! - [`recorder`], [`composer`], [`Kinematics`]: a log of a configured robot, with the poses of its links, or its messages alone;
//!   also for a simulation in one process.
//! - [`daemon`]: the process.
//!
//! The rings of the topics in shared memory are the memory of the last moments: they outlive a killed process, and
//! the logger saves what it wrote last.

pub mod daemon;
mod follow;
mod kinematics;
mod logging;
mod output;
mod robot;

pub use follow::{Follower, Source};
pub use kinematics::Kinematics;
pub use logging::{Logging, Pass};
pub use output::{LogOutput, Open, Parts};
pub use robot::{CONFIG, Origin, composer, recorder, robot_info};
