//! The simulated robot at the far end of the bus.
//!
//! | part | where |
//! |---|---|
//! | frames from the bus → joint targets; sensor data → frames | [`SimBackend::step`] |
//! | motor power line | [`power`] |
//! | joint references | [`drive`] |
//! | equations of motion, types 1 to 5 of the thesis | [`plant`] |
//! | their states | [`layout`] |
//! | their drives, with their controllers, and both in an implicit step | [`train`], `local_control.rs`, [`implicit`] |
//! | their contact, and what they stand on | [`feet`], [`terrain`] |
//! | time steps; the adaptive ones | [`integrate`], [`stiff`] |
//! | what the sensors make of it | [`sensors`] |

pub mod daemon;
pub mod drive;
pub mod feet;
pub mod implicit;
pub mod integrate;
pub mod layout;
mod local_control;
pub mod plant;
pub mod power;
mod robot;
pub mod sensors;
pub mod stiff;
pub mod terrain;
pub mod train;

pub use robot::SimBackend;
