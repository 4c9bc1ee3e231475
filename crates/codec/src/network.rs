//! Network management of CANopen (CiA 301, 7.2.8): commands to drives, and the state that a drive says in its heartbeat.
//!
//! A command is the frame with identifier 0: what is to be done, and the node that is to do it, 0 for all on the line. A heartbeat has the
//! identifier 0x700 + n and one byte; the first one after a drive has started says so.

/// Command to drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum NetworkCommand {
    /// Become operational.
    Start = 1,
    /// Heartbeats only.
    Stop = 2,
    /// No process data.
    PreOperational = 0x80,
    /// Start anew, with an empty memory.
    Reset = 0x81,
}

/// State of a drive on the network.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum NetworkState {
    /// It has just started; pre-operational from then on.
    BootUp = 0,
    /// It hears network management only.
    Stopped = 4,
    /// Process data both ways.
    #[default]
    Operational = 5,
    /// It waits for [`NetworkCommand::Start`].
    PreOperational = 0x7F,
}

impl NetworkCommand {
    /// The command of this number.
    pub fn of(number: u8) -> Option<Self> {
        [Self::Start, Self::Stop, Self::PreOperational, Self::Reset].into_iter().find(|c| *c as u8 == number)
    }
}

impl NetworkState {
    /// The state of this number.
    pub fn of(number: u8) -> Option<Self> {
        [Self::BootUp, Self::Stopped, Self::Operational, Self::PreOperational]
            .into_iter()
            .find(|state| *state as u8 == number)
    }
}
