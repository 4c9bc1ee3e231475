//! Topology seen from the master: closed ring, broken ring, line; and how a ring is closed again.
//!
//! | port 1 gets | port 2 gets | |
//! |---|---|---|
//! | S | P | ring |
//! | P | S | broken between two slaves: two lines |
//! | P | nothing, or P | line at port 1 |
//! | nothing, or S | S | line at port 2 |
//! | nothing | nothing | no telegrams |
//!
//! Ends of lines say so in their device status. When the idle port of every end has seen the telegrams of the other side
//! for [`STABLE`] cycles, the cable is back, and the ends are commanded to let telegrams through. A slave that does not obey
//! within [`PATIENCE`] cycles is commanded back.

use crate::device::{DeviceControl, Idle, Status, Topology};

/// Cycles in which the topology must not change before it counts.
pub(crate) const STABLE: u32 = 100;
/// Cycles for a slave to obey a command to change the topology.
pub(crate) const PATIENCE: u32 = 12;

/// Shape of the network.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RingShape {
    /// Every telegram comes back at the other port.
    Ring,
    /// Telegrams of one direction come back at the other port, those of the other do not.
    Defect,
    /// Two lines.
    Broken,
    /// All at port 1.
    LineP,
    /// All at port 2.
    LineS,
    /// No telegram comes back.
    Nothing,
}

/// Which telegrams a port of the master got in a cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReceivedTelegrams {
    /// Primary ones.
    pub p: bool,
    /// Secondary ones.
    pub s: bool,
}

impl RingShape {
    /// By the telegrams that came back at port 1 and port 2.
    pub fn of(first: ReceivedTelegrams, second: ReceivedTelegrams) -> Self {
        match (first.p, first.s, second.p, second.s) {
            (false, true, true, false) => Self::Ring,
            (true, _, _, true) => Self::Broken,
            (true, false, _, false) => Self::LineP,
            (false, _, false, true) => Self::LineS,
            (false, false, false, false) => Self::Nothing,
            _ => Self::Defect,
        }
    }
}

enum RingState {
    Watch,
    /// Cycles in which all ends saw the other side.
    Repaired(u32),
    /// Cycles since the ends were commanded to let telegrams through.
    Commanded(u32),
}

/// Closes a ring again.
pub(crate) struct Repair {
    state: RingState,
    /// States of the stations before the command, to go back to.
    before: Vec<Topology>,
}

impl Repair {
    /// For so many stations.
    pub(crate) fn new(stations: usize) -> Self {
        Self { state: RingState::Watch, before: vec![Topology::Through; stations] }
    }

    /// Begins anew.
    pub(crate) fn reset(&mut self) {
        self.state = RingState::Watch;
    }

    /// One cycle: looks at the device states, and commands. The stations are those that answered.
    pub(crate) fn step(&mut self, states: &[Option<Status>], controls: &mut [DeviceControl]) {
        match self.state {
            RingState::Watch => {
                if all_ends_see(states) {
                    self.state = RingState::Repaired(1);
                }
            }
            RingState::Repaired(_) if !all_ends_see(states) => self.state = RingState::Watch,
            RingState::Repaired(cycles) if cycles < STABLE => self.state = RingState::Repaired(cycles + 1),
            RingState::Repaired(_) => self.command(states, controls),
            RingState::Commanded(cycles) => self.supervise(cycles, states, controls),
        }
    }

    fn command(&mut self, states: &[Option<Status>], controls: &mut [DeviceControl]) {
        for ((state, control), before) in states.iter().zip(controls).zip(&mut self.before) {
            *before = state.and_then(Status::topology).unwrap_or(Topology::Through);
            if *before != Topology::Through {
                *control = control.command(Topology::Through);
            }
        }
        self.state = RingState::Commanded(0);
    }

    /// Waits until nobody is an end any more, or takes the command back.
    fn supervise(&mut self, cycles: u32, states: &[Option<Status>], controls: &mut [DeviceControl]) {
        let through = |s: &Option<Status>| s.is_some_and(|s| s.topology() == Some(Topology::Through));
        if states.iter().all(through) {
            self.state = RingState::Watch;
        } else if cycles < PATIENCE {
            self.state = RingState::Commanded(cycles + 1);
        } else {
            for ((state, control), before) in states.iter().zip(controls).zip(&self.before) {
                if *before != Topology::Through && through(state) {
                    *control = control.command(*before);
                }
            }
            self.state = RingState::Watch;
        }
    }
}

/// Whether there are ends, and the idle port of each of them sees the telegrams of the other side.
fn all_ends_see(states: &[Option<Status>]) -> bool {
    let mut ends = 0;
    for state in states {
        let Some(state) = state else {
            return false;
        };
        match (state.topology(), state.idle()) {
            (Some(Topology::Through), _) => {}
            (Some(Topology::LoopP), Idle::S) | (Some(Topology::LoopS), Idle::P) => ends += 1,
            _ => return false,
        }
    }
    ends > 0
}
