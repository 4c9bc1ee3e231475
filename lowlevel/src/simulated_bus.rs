//! Simulated field bus: frames through shared memory.

use std::error::Error;

use ipc::{IpcError, Reader, Space, Writer};
use messages::BusFrames;
use messages::topics::{BUS_RX, BUS_TX};

use crate::fieldbus::{Fieldbus, RunControl};

/// The bus whose far end is the process sim-backend.
pub(crate) struct SimulatedBus {
    tx: Writer<BusFrames>,
    rx: Reader<BusFrames>,
    new: bool,
}

impl SimulatedBus {
    /// Opens both directions.
    pub(crate) fn new(space: &Space) -> Result<Self, IpcError> {
        Ok(Self { tx: space.writer(&BUS_TX)?, rx: space.reader(&BUS_RX)?, new: false })
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

    fn wait(&mut self, run: &dyn RunControl, tick: u64) -> Result<bool, Box<dyn Error>> {
        let rx = &mut self.rx;
        let answered =
            run.wait_for("sim-backend", &mut || rx.latest().is_some_and(|f| f.header.tick == tick))?;
        self.new = answered;
        Ok(answered)
    }
}
