//! The topics of this system.

use std::path::Path;

use ipc::{Bell, Reader, Space, Waiter, Woken, Writer};
use messages::topics::{BUS_RX, BUS_TX};
use messages::{BusFrames, Process};

use crate::link::{LIMIT, Link, LinkEnd, Opened, silent, spin, text};

/// The topics of the field bus, with or without their bells.
struct Topics {
    output: Writer<BusFrames>,
    input: Reader<BusFrames>,
    bell: Bell,
    waiter: Waiter,
    rings: bool,
    record: BusFrames,
    _space: [Option<Space>; 2],
}

/// Topics as the joint loop and the robot have them.
pub fn open(dir: &Path, end: LinkEnd, rings: bool) -> Opened {
    let (process, out, back) = match end {
        LinkEnd::Near => (Process::Lowlevel, &BUS_TX, &BUS_RX),
        LinkEnd::Far => (Process::SimBackend, &BUS_RX, &BUS_TX),
    };
    let made = (end == LinkEnd::Near).then(|| Space::create(dir)).transpose().map_err(text)?;
    let space = Space::open(dir, process).map_err(text)?;
    Ok(Box::new(Topics {
        output: space.writer(out).map_err(text)?,
        input: space.reader(back).map_err(text)?,
        bell: space.bell(out).map_err(text)?,
        waiter: space.waiter(process).map_err(text)?,
        rings,
        record: BusFrames::default(),
        _space: [Some(space), made],
    }))
}

impl Link for Topics {
    fn send(&mut self, stamp: u64) -> Result<(), String> {
        self.record.header.stamp_ns = stamp;
        self.output.write(&self.record);
        if self.rings {
            self.bell.ring();
        }
        Ok(())
    }

    fn receive(&mut self) -> Result<u64, String> {
        let input = &mut self.input;
        if !self.rings {
            return spin(|| input.newer().map(|frames| frames.header.stamp_ns));
        }
        let came = self.waiter.wait_until(LIMIT, || false, || input.refresh());
        let frames = input.held().filter(|_| came == Woken::Ready).ok_or_else(silent)?;
        Ok(frames.header.stamp_ns)
    }
}
