//! The simulated robot at the far end of the bus.
//!
//! | part | where |
//! |---|---|
//! | frames from the bus → joint targets; sensor data → frames | [`SimBackend::step`] |
//! | motor power line | [`power`] |
//! | drives | [`drive`] |
//! | bodies: reduced model (type 1) | [`plant`] |
//! | time steps | [`integrate`] |

pub mod daemon;
pub mod drive;
pub mod integrate;
pub mod plant;
pub mod power;
mod robot;
pub mod sensors;

pub use robot::SimBackend;
