//! Messages between the processes.
//!
//! - [`topics`]: the table of topics: name, type, writer, readers, rate, stale-after, logged.
//! - One file per record: fixed-size, `#[repr(C)]`, one writer each; they travel through shared memory.
//! - [`command`]: what an operator may ask for; these travel through the broker, encoded by [`wire`],
//!   with a [`command_stamp`] of who gave them and when, and are answered ([`command_answer`]).
//!
//! Units are SI. Angles in rad. Arrays of joints follow the order of the robot's joint table and are padded with
//! zeros up to [`MAX_JOINTS`].

pub mod bus;
pub mod command;
pub mod command_answer;
pub mod command_stamp;
pub mod command_text;
pub mod controller_state;
pub mod cycle_inputs;
pub mod cycle_stats;
pub mod event;
pub mod event_detail;
pub mod event_queue;
pub mod event_words;
pub mod fields;
mod hash;
pub mod joint_tables;
pub mod joint_targets;
pub mod parameters;
pub mod plan;
pub mod power;
pub mod record;
pub mod sensors;
pub mod sim_state;
mod sole;
pub mod start_up;
pub mod topics;
mod unknown;
pub mod wire;

pub use bus::{BusFrames, ERROR_FLAG, Frame, MAX_FRAMES};
pub use command::Command;
pub use command_answer::{CommandSource, NoCommands, Reason, Verdict};
pub use command_stamp::{Lease, Live, Stamp};
pub use controller_state::ControllerState;
pub use cycle_inputs::{CommandTaken, CycleInputs, Used};
pub use cycle_stats::{BusCounters, CycleStats, FIRST_OCTAVE, OCTAVES};
pub use event::{Event, EventCode};
pub use event_detail::{ControlLimit, Detail, RefusedFrame, TableFault};
pub use event_queue::EventQueue;
pub use event_words::Words;
pub use hash::{FNV1A, fnv1a};
pub use joint_tables::{JointTables, MAX_POINTS};
pub use joint_targets::{JointMode, JointTargets};
pub use parameters::Parameters;
pub use plan::{BodyPoint, GaitState, Phase, Plan, Step};
pub use power::{Power, WatchdogReset};
pub use record::{Field, Header, Read, Record, Visit, Wrench};
pub use sensors::{Imu, Sensors};
pub use sim_state::{ContactPoint, MAX_CONTACTS, MAX_MOVING, SimState};
pub use start_up::StartUp;
pub use topics::{Process, TOPICS, Topic};
pub use unknown::{nearest, unknown};

/// Room for joints in every record.
pub const MAX_JOINTS: usize = 32;

/// One value per joint, in the order of the robot's joint table.
pub type Joints = [f64; MAX_JOINTS];

/// Index of the right foot in every `[_; 2]` of feet (thesis table 4.1: i_s = 0, nu_s = +1).
pub const RIGHT: usize = 0;
/// Index of the left foot (i_s = 1, nu_s = -1).
pub const LEFT: usize = 1;
