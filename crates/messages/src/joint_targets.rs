//! `joint_targets`: what the joints shall do, once per cycle.

use crate::{Header, Joints, record};

/// Mode of the joint loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum JointMode {
    /// No torque.
    Off = 0,
    /// Stay where you are.
    Hold = 1,
    /// Follow the targets.
    Track = 2,
    /// Come to rest as fast as the joints allow, then stay: the controlled stop.
    Stop = 3,
    /// Joints that do not know their angles find them out.
    Home = 4,
}

impl From<u64> for JointMode {
    /// A number that names no mode is a stop.
    fn from(n: u64) -> Self {
        match n {
            0 => Self::Off,
            1 => Self::Hold,
            2 => Self::Track,
            4 => Self::Home,
            _ => Self::Stop,
        }
    }
}

record! {
    /// Targets of all joints. Written by controller.
    record JointTargets {
        /// Tick of the sensor data the targets were made from.
        header: Header,
        /// \[1\] A [`JointMode`].
        mode: u64,
        /// \[rad\] @range the joint's software range
        angle: Joints,
        /// \[rad/s\] @range the joint's speed limit
        speed: Joints,
    }
}
