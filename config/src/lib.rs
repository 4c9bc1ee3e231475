//! Configuration, checked once: after loading, every number is finite, in its range and fits the others.
//!
//! - [`robot::Robot`]: `robots/NAME/robot.toml` and the URDF beside it.
//! - [`gait::Gait`]: `gaits/NAME.toml`: how the robot walks and how it is stabilized.
//! - [`scene::Scene`]: `scenes/NAME.toml`: what is simulated.
//! - [`joystick::Joystick`]: `joystick.toml`: what the sticks and buttons of a gamepad do.
//! - [`sweep::Sweep`]: a file of your own: which numbers of a scene and its gait are varied, and how.
//! - [`system::System`]: `system.toml`: processes, cores, priorities, deadlines, limits of the run-time system.
//!
//! [`registry`] lists the parameters of all processes; those of [`parameters`] may be changed while the robot runs.
//!
//! [`Setup`] reads scene, robot, gait and system for a scene, checks what they say about each other, and hashes them.
//!
//! [`keys`] lists the keys of all files, for the reference.
//!
//! Only this crate names TOML.

mod acceleration;
pub mod brake;
mod bus_address;
pub mod bus_fault;
pub mod components;
pub mod crane;
pub mod database;
pub mod dbc;
mod dbc_words;
pub mod dbc_writer;
pub mod drive;
pub mod edit;
pub mod efficiency;
mod error;
mod file;
pub mod gait;
mod joint;
mod joint_control;
pub mod joystick;
mod key_meaning;
mod key_words;
pub mod keys;
mod known_obstacles;
pub mod leg;
pub mod limbs;
pub mod method;
pub mod parameters;
pub mod pattern;
mod plan_legs;
pub mod plant_mismatch;
pub mod protection;
mod questions;
pub mod registry;
pub mod robot;
pub mod scene;
pub mod scenes;
mod search;
mod section;
pub mod sensors;
mod setup;
mod snapshot;
pub mod sweep;
pub mod system;
pub mod tables;
pub mod terrain;
pub mod timeline;
pub mod tolerance;
mod urdf;
mod velocity;

pub use acceleration::WITH_LOAD;
pub use bus_address::{BusAddress, interface_names};
pub use components::Components;
pub use error::{ConfigError, Problem};
pub use file::{BUILT_IN, Embedded, embed};
pub use gait::Gait;
pub use joystick::Joystick;
pub use known_obstacles::Triangle;
pub use leg::{Leg, LegError};
pub use robot::Robot;
pub use scene::Scene;
pub use search::{ConfigDirectory, find, root};
pub use sensors::SensorErrors;
pub use setup::{Setup, SetupFiles, SetupNumbers, gait_path};
pub use snapshot::snapshot;
pub use sweep::Sweep;
pub use system::System;
pub use tables::TableDrives;
pub use timeline::Timeline;
pub use velocity::VELOCITY_STEPS;
