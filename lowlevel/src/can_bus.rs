//! Near end of the CAN lines.

use std::error::Error;
use std::time::Duration;

use codec::frames::{self, DriveCommand, Received, encode_targets};
use codec::network::NetworkCommand;
use fieldbus::{BusEnd, BusLines};
use messages::{BusFrames, MAX_FRAMES};
use realtime::clock;

use crate::fieldbus::{BusSettings, Fieldbus, RunControl};

/// In lockstep: between two looks whether to end.
const LOOK: Duration = Duration::from_millis(20);
/// In lockstep: the drives of a line that is broken do not answer; nothing has come for this long \[ns\].
const GRACE: u64 = clock::SECOND;
/// The drives are asked for their first answer so often \[ns\].
const ASK: u64 = clock::SECOND / 4;

/// CAN lines whose far end is a robot, a simulated one, or a recording.
pub(crate) struct CanBus {
    lines: BusLines,
    settings: BusSettings,
    /// Frames since the last cycle.
    rx: BusFrames,
    /// Cycle that is to be answered.
    asked: u64,
    /// In lockstep: nodes (bits) that are waited for.
    alive: u32,
}

impl CanBus {
    /// Opens all lines.
    pub(crate) fn new(
        settings: BusSettings,
        fd: bool,
        interfaces: &[String],
    ) -> Result<Self, Box<dyn Error>> {
        let lines = BusLines::open(interfaces, &settings.layout, fd, BusEnd::Near)?;
        let alive = ((1u64 << settings.layout.nodes.len()) - 1) as u32;
        Ok(Self { lines, settings, rx: BusFrames::default(), asked: 0, alive })
    }

    /// Starts the drives and asks them for their positions: no targets, no torque.
    fn ask(&mut self) {
        let mut nothing = BusFrames::default();
        let start = DriveCommand { network: Some(NetworkCommand::Start), ..DriveCommand::default() };
        encode_targets(&self.settings.layout, &start, &mut nothing);
        self.lines.send(&nothing);
    }

    /// True if the cycle is answered as far as it will be, after so many nanoseconds without a frame. A node that let one
    /// pass is not waited for until it speaks again.
    fn answered(&mut self, received: &Received, quiet_ns: u64) -> bool {
        let nodes = (0..self.settings.layout.nodes.len()).filter(|&node| received.complete(node));
        let complete = nodes.fold(0u32, |bits, node| bits | 1 << node);
        let all = complete & self.alive == self.alive;
        if all {
            self.alive |= complete;
        } else if complete != 0 && quiet_ns > GRACE {
            self.alive = complete;
        }
        all || quiet_ns > GRACE && complete != 0
    }
}

impl Fieldbus for CanBus {
    fn send(&mut self, frames: &BusFrames) {
        self.asked = frames.header.tick;
        self.rx.count = 0;
        self.lines.send(frames);
    }

    fn receive(&mut self) -> Option<&BusFrames> {
        if !self.settings.lockstep {
            self.lines.receive(&mut self.rx);
        }
        self.rx.header.tick = self.asked;
        (self.asked > 0 || self.rx.count > 0).then_some(&self.rx)
    }

    fn wait(&mut self, run: &dyn RunControl, tick: u64) -> Result<bool, Box<dyn Error>> {
        let begun = clock::now();
        let (mut asked, mut last) = (None, begun);
        self.rx.header.tick = tick;
        let mut received = frames::look(&self.settings.layout, false, &self.rx);
        while !run.is_ending() {
            let now = clock::now();
            // Before the first cycle nothing was sent that the drives could answer.
            if tick == 0 && asked.is_none_or(|at| now - at > ASK) {
                asked = Some(now);
                self.ask();
            }
            // No more than what is missing: a recording that is played back does not wait for us.
            let came = self.lines.receive_missing(&received.missing, &mut self.rx) > 0;
            if came {
                last = now;
                received = frames::look(&self.settings.layout, false, &self.rx);
            }
            if self.answered(&received, now - last) {
                return Ok(true);
            }
            if now - begun > self.settings.patience_ns && self.settings.simulated_robot {
                let down = self.lines.take_trouble().down;
                let why = if down == 0 { "" } else { "; an interface is down, see `ip link`" };
                let seconds = self.settings.patience_ns as f64 * 1e-9;
                return Err(
                    format!("lowlevel: nobody answers on the CAN lines within {seconds} s{why}").into()
                );
            }
            if self.rx.as_slice().len() == MAX_FRAMES {
                frames::keep_current(&self.settings.layout, false, &mut self.rx); // else there is no room for the rest
            }
            if !came {
                // Lines are answered in their order: the last one that is missing is worth waking up for.
                let missing = |&node: &usize| self.alive >> node & 1 == 1 && !received.complete(node);
                self.lines.wait((0..self.settings.layout.nodes.len()).rfind(missing), LOOK);
            }
        }
        Ok(false)
    }
}
