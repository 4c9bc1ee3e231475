//! Cuts the motor supply when the joint loop stops resetting it, when a process asks, or when it dies itself.
//!
//! The watchdog shares no cycle with the processes it guards. [`Watchdog::step`] is all it knows; [`daemon`] is the
//! process around it.

pub mod daemon;
pub mod estop;
pub mod stop_request;
mod supply;

pub use supply::{Inputs, PAUSE, Supply, SupplyState, Watchdog, supply_event, verdict};
