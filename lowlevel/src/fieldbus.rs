//! Near end of a field bus, as the joint loop needs it.

use std::error::Error;

use codec::layout::FrameLayout;
use messages::{BusFrames, EventQueue};

/// A field bus that exchanges the frames of one cycle. Implementations neither allocate nor block in [`Fieldbus::send`] and
/// [`Fieldbus::receive`].
pub trait Fieldbus {
    /// Brings the bus into operation, before the first cycle and before anything is armed. `Ok(false)`: asked to end.
    ///
    /// # Errors
    /// Somebody on the bus is missing, or not what the configuration says.
    fn start(&mut self, _: &dyn RunControl) -> Result<bool, Box<dyn Error>> {
        Ok(true)
    }

    /// Adds what happened to the bus itself since the last call.
    fn report(&mut self, _: &mut EventQueue) {}

    /// True if the motor supply is off in this cycle: then nothing depends on the bus, and who left it may be taken back.
    fn set_idle(&mut self, _: bool) {}

    /// Sends the frames of this cycle to the drives.
    fn send(&mut self, frames: &BusFrames);

    /// The newest frames from the drives that were not taken yet; their header says to which cycle they should belong.
    fn receive(&mut self) -> Option<&BusFrames>;

    /// Waits for the answer to cycle `tick`, 0 for where the drives are before the first; in lockstep only. `Ok(false)`:
    /// asked to end.
    ///
    /// # Errors
    /// Nobody answers.
    fn wait(&mut self, run: &dyn RunControl, tick: u64) -> Result<bool, Box<dyn Error>>;
}

/// The run around a bus, while the bus waits for somebody.
pub trait RunControl {
    /// True if the process was asked to end.
    fn is_ending(&self) -> bool;

    /// Waits until the process `peer` has made `ready` true. `Ok(false)`: asked to end.
    ///
    /// # Errors
    /// The peer fell silent.
    fn wait_for(&self, peer: &str, ready: &mut dyn FnMut() -> bool) -> Result<bool, Box<dyn Error>>;
}

/// Settings of a bus that has interfaces of its own.
#[derive(Clone, Debug)]
pub struct BusSettings {
    /// Frames of the robot.
    pub layout: FrameLayout,
    /// \[ns\] Bus cycle.
    pub period_ns: u64,
    /// Simulated time: every answer is waited for.
    pub lockstep: bool,
    /// \[ns\] Patience with an answer in lockstep.
    pub patience_ns: u64,
    /// Cycles in a row that may be lost.
    pub losses: u16,
    /// Somebody of this run is at the far end, whose silence is an error; else the robot may be switched on any time.
    pub simulated_robot: bool,
}
