//! Logs: MCAP files that ROS 2 tools, Foxglove, PlotJuggler and Rerun open.
//!
//! - [`Recorder`]: writes every logged topic of [`messages::TOPICS`] verbatim, and standard messages made from them.
//! - [`Composer`]: its channels and messages, without a file; also for viewers of a running robot.
//! - [`Log`]: reads a log back into records, also one that was cut off by a crash.
//! - [`IndexedLog`]: reads it at any instant, with bounded memory, also while it is written.
//! - [`repair`]: gives a log its index that was cut off by a crash, and takes out what is damaged.
//! - [`traffic`]: frames of CAN lines.
//! - [`payload_hashes`]: two runs are equal if these are.
//!
//! Design: profile `ros2`, CDR only. One channel of another encoding would break other readers of ROS 2 bags.

pub mod cdr;
mod chunk;
mod claim;
pub mod composer;
pub mod definition;
mod error;
mod hashes;
mod index;
mod instants;
mod lengths;
mod links;
mod log;
mod markers;
pub mod odometry;
pub mod polygon;
mod queue;
mod recorder;
mod rewrite;
mod robot;
mod rosout;
mod salvage;
mod standard;
mod standard_definitions;
mod time;
pub mod traffic;

pub use claim::is_being_written;
pub use composer::{ComposedMessage, Composer, LogChannel, STANDARD_RATE, channel_name};
pub use error::RecordingError;
pub use hashes::payload_hashes;
pub use index::{IndexedLog, LogChunk};
pub use links::{LinkFrame, LinkPoses, RecordedPose};
pub use log::{FrameTree, Log, LogEnd, LogMessage, Transform};
pub use recorder::{Recorder, Sink};
pub use rewrite::{Repaired, repair, rewrite};
pub use robot::{FootInfo, RobotInfo, RunInfo, WallClock};
pub use time::LogTime;
