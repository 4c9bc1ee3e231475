//! The far end of the bus.

use std::error::Error;

use config::BusAddress;
use daemon::Daemon;
use ipc::Waiter;
use messages::{BusFrames, EventCode};

use crate::can_bus::CanBus;
use crate::sercos_bus::SercosBus;
use crate::simulated_bus::SimulatedBus;

/// A field bus that exchanges the frames of one cycle. Implementations neither allocate nor block in [`Fieldbus::send`] and
/// [`Fieldbus::receive`].
pub trait Fieldbus {
    /// Brings the bus into operation, before the first cycle and before anything is armed. `Ok(false)`: asked to end.
    ///
    /// # Errors
    /// Somebody on the bus is missing, or not what the configuration says.
    fn start(&mut self, _: &Daemon) -> Result<bool, Box<dyn Error>> {
        Ok(true)
    }

    /// Something that the bus itself wants in the log.
    fn take_event(&mut self) -> Option<(EventCode, u64)> {
        None
    }

    /// Whether the motor supply is off in this cycle: then nothing depends on the bus, and who left it may be taken back.
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
    fn wait(&mut self, d: &Daemon, waiter: &Waiter, tick: u64) -> Result<bool, Box<dyn Error>>;
}

/// The bus of a run.
pub(crate) fn open(d: &Daemon) -> Result<Box<dyn Fieldbus>, Box<dyn Error>> {
    match &d.bus {
        BusAddress::Shared => Ok(Box::new(SimulatedBus::new(d)?)),
        BusAddress::Can { fd, interfaces } => Ok(Box::new(CanBus::new(d, *fd, interfaces)?)),
        BusAddress::Sercos(place) => Ok(Box::new(SercosBus::new(d, place)?)),
    }
}
