//! The simulated robot at the far end of the bus.
//!
//! | part | where |
//! |---|---|
//! | the bus, in shared memory or on CAN lines | `far_end.rs`, `can_end.rs` |
//! | frames from the bus → joint targets; sensor data → frames | [`SimBackend::step`] |
//! | motor power line | [`power`] |
//! | who heard what | [`hearing`]; faults of the bus: [`fieldbus::injector`] |
//! | states of the drives, their references and protection | `stages.rs` |
//! | joint references | [`drive`] |
//! | crane that holds the robot at the start | `crane.rs` |
//! | equations of motion, types 1 to 5 of the thesis | [`plant`] |
//! | their states | [`layout`] |
//! | their drives, with their controllers, and both in an implicit step | [`train`], `local_control.rs`, [`implicit`] |
//! | counts and look-up tables of these controllers | `resolution.rs` |
//! | their contact, and what they stand on | [`feet`], [`terrain`] |
//! | time steps; the adaptive ones | [`integrate`], [`stiff`] |
//! | what the sensors make of it | [`sensors`] |

mod can_end;
mod crane;
pub mod daemon;
pub mod drive;
mod far_end;
pub mod feet;
pub mod hearing;
pub mod implicit;
pub mod integrate;
pub mod layout;
mod local_control;
mod outside;
pub mod plant;
pub mod power;
mod resolution;
mod robot;
pub mod sensors;
mod sercos_end;
mod stages;
pub mod stiff;
pub mod terrain;
pub mod train;

pub use crane::Rope;
pub use robot::SimBackend;
