//! The near end of the CAN lines.

use std::error::Error;
use std::time::Duration;

use daemon::Daemon;
use fieldbus::{End, Lines};
use ipc::Waiter;
use messages::frames::{self, DriveCommand, encode_targets};
use messages::layout::Layout;
use messages::{BusFrames, MAX_FRAMES};
use realtime::clock;

use crate::Fieldbus;

/// In lockstep: between two looks whether to end.
const LOOK: Duration = Duration::from_millis(20);
/// In lockstep: the drives of a line that is broken do not answer; the others are not kept waiting longer than this \[ns\].
const GRACE: u64 = clock::SECOND / 10;
/// The drives are asked for their first answer so often \[ns\].
const ASK: u64 = clock::SECOND / 4;

/// CAN lines whose far end is a robot, a simulated one, or a recording.
pub(crate) struct CanBus {
    lines: Lines,
    layout: Layout,
    /// What has come since the last cycle.
    rx: BusFrames,
    /// Cycle that is to be answered.
    asked: u64,
    /// \[ns\] How long the first answer is waited for in lockstep.
    patience: u64,
}

impl CanBus {
    /// Opens all lines.
    pub(crate) fn new(d: &Daemon, fd: bool, interfaces: &[String]) -> Result<Self, Box<dyn Error>> {
        let layout = d.setup.robot.layout.clone();
        let lines = Lines::open(interfaces, &layout, fd, End::Near)?;
        let patience = d.patience().as_nanos() as u64;
        Ok(Self { lines, layout, rx: BusFrames::default(), asked: 0, patience })
    }

    /// Asks the drives for where they are: no targets, no torque.
    fn ask(&mut self) {
        let mut nothing = BusFrames::default();
        encode_targets(&self.layout, &DriveCommand::default(), &mut nothing);
        self.lines.send(&nothing);
    }
}

impl Fieldbus for CanBus {
    fn send(&mut self, frames: &BusFrames) {
        self.asked = frames.header.tick;
        self.rx.count = 0;
        self.lines.send(frames);
    }

    fn receive(&mut self) -> Option<&BusFrames> {
        self.lines.receive(&mut self.rx);
        self.rx.header.tick = self.asked;
        (self.asked > 0 || self.rx.count > 0).then_some(&self.rx)
    }

    fn wait(&mut self, d: &Daemon, _: &Waiter, tick: u64) -> Result<bool, Box<dyn Error>> {
        let begun = clock::now();
        let mut asked = None;
        while !d.stop.asked() {
            let waited = clock::now() - begun;
            if tick == 0 && asked.is_none_or(|at| waited - at > ASK) {
                asked = Some(waited);
                self.ask();
            }
            self.lines.receive(&mut self.rx);
            self.rx.header.tick = tick;
            let received = frames::look(&self.layout, false, &self.rx);
            let some = (0..self.layout.nodes.len()).any(|node| received.complete(node));
            if received.missed() == 0 || some && waited > GRACE {
                return Ok(true);
            }
            if waited > self.patience && d.robot {
                let down = self.lines.take_trouble().down;
                let why = if down == 0 { "" } else { "; an interface is down, see `ip link`" };
                let seconds = self.patience as f64 * 1e-9;
                return Err(
                    format!("lowlevel: nobody answers on the CAN lines within {seconds} s{why}").into()
                );
            }
            if self.rx.as_slice().len() == MAX_FRAMES {
                frames::keep_current(&self.layout, false, &mut self.rx); // else there is no room for the rest
            }
            // Lines are answered in their order: the last one that is missing is worth waking up for.
            let last = (0..self.layout.nodes.len()).rfind(|&node| !received.complete(node));
            self.lines.wait(last, LOOK);
        }
        Ok(false)
    }
}
