//! The joint loop: joint targets to the field bus, sensor data from it, and the last word on every command.
//!
//! | stage | where |
//! |---|---|
//! | frames of the bus → sensor data, time stamp | [`JointLoop::receive`] |
//! | bus heard? readings that can be? | `line_guard.rs`, `reading.rs` |
//! | finite? fresh? in range? slow enough? following? | [`JointLoop::send`], [`limits`] |
//! | targets that come again after a pause | `rejoin.rs` |
//! | controlled stop when targets stay away | [`braking`] |
//! | targets → frames of the bus; watchdog reset | [`JointLoop::send`] |
//! | power, references, drives, force sensors: until the robot stands | [`start_up`] |
//!
//! What is at the far end of the bus is behind the trait [`Fieldbus`]: shared memory or CAN lines to a simulated
//! robot, or a robot.

pub mod braking;
mod can_bus;
pub mod daemon;
pub mod fieldbus;
pub mod joint_loop;
pub mod limits;
mod line_guard;
mod reading;
mod rejoin;
mod sercos_bus;
mod simulated_bus;
pub mod start_up;

pub use fieldbus::Fieldbus;
pub use joint_loop::JointLoop;
