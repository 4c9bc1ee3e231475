//! The simulated field bus: frames through shared memory.

use daemon::Daemon;
use ipc::{IpcError, Mode, Reader, Waiter, Writer};
use messages::BusFrames;
use messages::topics::{BUS_RX, BUS_TX};

use crate::Fieldbus;

/// The bus whose far end is the process sim-backend.
pub(crate) struct SimulatedBus {
    tx: Writer<BusFrames>,
    rx: Reader<BusFrames>,
    new: bool,
}

impl SimulatedBus {
    /// Opens both directions.
    pub(crate) fn new(d: &Daemon) -> Result<Self, IpcError> {
        Ok(Self { tx: d.space.writer(&BUS_TX)?, rx: d.space.reader(&BUS_RX)?, new: false })
    }
}

impl Fieldbus for SimulatedBus {
    fn send(&mut self, frames: &BusFrames) {
        self.tx.write(frames);
    }

    fn receive(&mut self) -> Option<&BusFrames> {
        let new = self.rx.refresh() | std::mem::take(&mut self.new);
        self.rx.held().filter(|_| new)
    }

    fn wait(&mut self, d: &Daemon, waiter: &Waiter, tick: u64) -> Result<bool, Box<dyn std::error::Error>> {
        debug_assert!(d.mode == Mode::Lockstep);
        let rx = &mut self.rx;
        let answered =
            d.wait(waiter, "sim-backend", || rx.latest().is_some_and(|f| f.header.tick == tick))?;
        self.new = answered;
        Ok(answered)
    }
}
