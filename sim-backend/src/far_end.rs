//! The far end of the bus: where the simulated robot hears what it is told and answers.

use std::error::Error;
use std::time::Duration;

use config::BusAddress;
use daemon::Daemon;
use ipc::{IpcError, Reader, Waiter, Writer};
use messages::BusFrames;
use messages::topics::{BUS_RX, BUS_TX, Process};

use crate::can_end::CanEnd;
use crate::sercos_end::SercosEnd;

/// Cycles of the bus behind which the simulated robot was stopped, and makes good for what it missed: a robot would not
/// have been.
const STALL: u64 = 3;

/// One end of a bus. But for the two that wait, nothing blocks or allocates.
pub(crate) trait FarEnd {
    /// Looks for a whole cycle that was not taken yet.
    fn refresh(&mut self) -> bool;

    /// The frames of the last one; their header says of which tick they are.
    fn held(&self) -> Option<&BusFrames>;

    /// Whether these are of a cycle that was missed, and more of them wait.
    fn is_late(&self) -> bool {
        false
    }

    /// Sends the sensors' frames.
    fn answer(&mut self, d: &Daemon, frames: &BusFrames);

    /// Waits until something may have come, at most that long.
    fn wait(&mut self, at_most: Duration);

    /// In lockstep: waits for the next cycle. `Ok(false)`: asked to end.
    ///
    /// # Errors
    /// Lowlevel fell silent.
    fn next(&mut self, d: &Daemon) -> Result<bool, Box<dyn Error>>;
}

/// The bus of a run.
pub(crate) fn open(d: &mut Daemon) -> Result<Box<dyn FarEnd>, Box<dyn Error>> {
    match d.bus.clone() {
        BusAddress::Shared => Ok(Box::new(SharedEnd::new(d)?)),
        BusAddress::Can { fd, interfaces } => Ok(Box::new(CanEnd::new(d, fd, &interfaces)?)),
        BusAddress::Sercos(place) => Ok(Box::new(SercosEnd::new(d, &place)?)),
    }
}

/// Frames through shared memory.
struct SharedEnd {
    tx: Reader<BusFrames>,
    rx: Writer<BusFrames>,
    bell: usize,
    waiter: Waiter,
}

impl SharedEnd {
    fn new(d: &mut Daemon) -> Result<Self, IpcError> {
        Ok(Self {
            tx: d.space.reader(&BUS_TX)?,
            rx: d.space.writer(&BUS_RX)?,
            bell: d.bell(&BUS_RX)?,
            waiter: d.space.waiter(Process::SimBackend)?,
        })
    }
}

impl FarEnd for SharedEnd {
    fn refresh(&mut self) -> bool {
        self.tx.refresh_in_order(STALL)
    }

    fn held(&self) -> Option<&BusFrames> {
        self.tx.held()
    }

    fn is_late(&self) -> bool {
        self.tx.is_behind()
    }

    fn answer(&mut self, d: &Daemon, frames: &BusFrames) {
        self.rx.write(frames);
        d.ring(self.bell);
    }

    fn wait(&mut self, at_most: Duration) {
        self.waiter.wait(at_most);
    }

    fn next(&mut self, d: &Daemon) -> Result<bool, Box<dyn Error>> {
        let tx = &mut self.tx;
        d.wait(&self.waiter, "lowlevel", || tx.refresh())
    }
}
