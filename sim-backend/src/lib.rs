//! The simulated robot at the far end of the bus.
//!
//! | part | where |
//! |---|---|
//! | bus, in shared memory, on CAN lines or Sercos | `far_end.rs` and its ends, `bus.rs` |
//! | one cycle: frames from the bus → motion → frames for the bus | [`SimBackend::step`] |
//! | the same by another simulator, behind a socket | [`external_plant`] |
//! | motor power line | [`power`] |
//! | commands of each joint → references; who has torque | `joints.rs` |
//! | nodes without commands | [`command_timeout`]; faults of the bus: [`fieldbus::injector`] |
//! | states of the drives, their references and protection | `drive_electronics.rs` |
//! | joint references | [`drive`]; of drives that play tables `table_drives.rs` |
//! | pushes, and the crane that holds the robot at the start | `loads.rs`, `crane.rs` |
//! | equations of motion, their state and time steps in a cycle | `body.rs` |
//! | equations of motion | [`plant`]; components, types 1 to 5 of the thesis: [`config::components`] |
//! | their states | [`layout`] |
//! | their inputs | [`inputs`], [`external_forces`] |
//! | their drives: shafts, controllers | [`train`], [`shaft`], `local_control.rs` |
//! | the drives in an implicit step, one and all | `implicit.rs`, `train_step.rs` |
//! | counts and look-up tables of these controllers | `resolution.rs` |
//! | controllers with a clock of their own; steps and cycles that miss it | `servo.rs`, `sample_grid.rs` |
//! | their contact, and what they stand on | `ground.rs`, [`feet`], [`terrain`] |
//! | time steps; the adaptive ones; the longest stable ones | [`integrate`], [`stiff`] with `sparse_lu.rs`, [`step_limit`] |
//! | steps that are too long; fall | `chatter.rs`, `fall.rs` |
//! | a depth camera in its head, for programs beside it | [`eye`] |
//! | readings and truth | `instruments.rs`, [`sensors`] |

mod body;
mod bus;
mod can_end;
mod chatter;
pub mod command_timeout;
mod crane;
pub mod daemon;
pub mod drive;
mod drive_electronics;
pub mod external_forces;
pub mod external_plant;
pub mod eye;
mod fall;
mod far_end;
pub mod feet;
mod ground;
mod implicit;
pub mod inputs;
mod instruments;
pub mod integrate;
mod joints;
pub mod layout;
mod loads;
mod local_control;
mod masses;
pub mod plant;
pub mod power;
mod resolution;
mod robot;
mod sample_grid;
pub mod sensors;
mod sercos_end;
mod servo;
pub mod shaft;
mod shared_end;
mod sparse_lu;
pub mod step_limit;
pub mod stiff;
mod table_drives;
pub mod terrain;
pub mod train;
mod train_step;

pub use crane::Rope;
pub use robot::SimBackend;
