//! Far end of the bus in shared memory.

use std::error::Error;
use std::time::Duration;

use daemon::Daemon;
use ipc::{IpcError, Reader, Waiter, Writer};
use messages::BusFrames;
use messages::topics::{BUS_RX, BUS_TX, Process};

use crate::far_end::FarEnd;

/// Cycles of the bus behind which the simulated robot was stopped, and catches up on what it missed: a robot would not
/// have been.
const STALL: u64 = 3;

/// Frames through shared memory.
pub(crate) struct SharedEnd {
    tx: Reader<BusFrames>,
    rx: Writer<BusFrames>,
    bell: usize,
    waiter: Waiter,
}

impl SharedEnd {
    /// Opens both directions.
    pub(crate) fn new(d: &mut Daemon) -> Result<Self, IpcError> {
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
