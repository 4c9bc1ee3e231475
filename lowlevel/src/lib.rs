//! The joint loop: joint targets to the field bus, sensor data from it, and the last word on every command.
//!
//! | stage | where |
//! |---|---|
//! | frames of the bus → sensor data, time stamp | [`JointLoop::receive`] |
//! | frames missing? readings that can be? | `line_guard.rs`, `reading.rs` |
//! | age of the targets, state of the loop | `target_age.rs`, [`JointLoop::send`] |
//! | finite? in range? slow enough? | `setpoints.rs`, [`limits`] |
//! | targets that come again after a pause | `rejoin.rs` |
//! | controlled stop when targets stay away | [`braking`] |
//! | tables that the drives play by themselves: admitted, loaded, begun | [`table_master`], `table_admission.rs`, `telegram_exchange.rs` |
//! | following? lines? | [`JointLoop::send`] |
//! | events | `reports.rs` |
//! | targets → frames of the bus; watchdog reset | [`JointLoop::send`] |
//! | power, references, drives, force sensors: until the robot stands | [`start_up`] |
//!
//! The far end of the bus is behind the trait [`Fieldbus`]: shared memory, CAN lines or a Sercos ring to a
//! simulated robot, or a robot. Which one a run uses: `bus.rs`.

pub mod braking;
mod bus;
mod can_bus;
pub mod daemon;
pub mod fieldbus;
pub mod joint_loop;
pub mod limits;
mod line_guard;
mod reading;
mod rejoin;
mod reports;
mod sercos_bus;
mod setpoints;
mod simulated_bus;
pub mod start_up;
mod table_admission;
pub mod table_master;
mod target_age;
mod telegram_exchange;

pub use fieldbus::{BusSettings, Fieldbus, RunControl};
pub use joint_loop::JointLoop;
