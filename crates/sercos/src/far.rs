//! Simulated slaves on real interfaces: a chain whose ends are the far ends of the master's cables.

use crate::chain::SlaveChain;
use crate::header::{MAX_FRAME, TelegramHeader};
use crate::slave::{PortSide, Slave};
use crate::socket::{Socket, SocketError};

const ROOM: usize = MAX_FRAME + 8;
const BURST: usize = 64;
/// Beats at the other end after which an end without any is taken for unplugged: Linux may tell of a lost link a second late.
const SILENT: u32 = 2;

/// A chain of slaves with its two ends.
pub struct Far {
    chain: SlaveChain,
    ends: [Option<Socket>; 2],
    buffer: Box<[u8; ROOM]>,
    /// For each end: beats at the other one since its own last beat.
    silent: [u32; 2],
}

impl Far {
    /// Slaves between these interfaces; without a second one they are a line. With `hold`, ATs of CP4 wait for
    /// [`Far::answer`].
    ///
    /// # Errors
    /// An interface that cannot be used.
    pub fn open(
        first: &str,
        second: Option<&str>,
        slaves: Vec<Slave>,
        hold: bool,
    ) -> Result<Self, SocketError> {
        let ends = [Some(Socket::open(first)?), second.map(Socket::open).transpose()?];
        let mut far =
            Self { chain: SlaveChain::new(slaves, hold), ends, buffer: Box::new([0; ROOM]), silent: [0; 2] };
        far.look_at_links();
        Ok(far)
    }

    /// The slaves.
    pub fn chain(&self) -> &SlaveChain {
        &self.chain
    }

    /// The slaves.
    pub fn chain_mut(&mut self) -> &mut SlaveChain {
        &mut self.chain
    }

    /// A cable at an end of the chain is pulled, or its far side switched off: the slave there notices.
    fn look_at_links(&mut self) {
        let last = self.chain.slaves().len();
        for (cable, end) in [(0, 0), (last, 1)] {
            let linked = self.ends[end].as_ref().is_some_and(Socket::has_link);
            self.chain.set_cable(cable, linked && self.silent[end] <= SILENT);
        }
    }

    /// Passes on all telegrams that have come in.
    pub fn pass(&mut self) {
        self.look_at_links();
        // Turn by turn: the telegrams of both channels go round at the same time.
        for _ in 0..BURST {
            let mut any = false;
            for (end, side) in [(0, PortSide::Left), (1, PortSide::Right)] {
                let Some(socket) = &self.ends[end] else { continue };
                let Some(frame) = socket.receive(&mut self.buffer[..]) else { continue };
                any = true;
                if TelegramHeader::read(frame).is_ok_and(|h| h.is_beat()) {
                    self.silent[end] = 0;
                    self.silent[1 - end] += 1;
                }
                let (ends, chain) = (&self.ends, &mut self.chain);
                chain.take(side, frame, &mut |side, frame| send(ends, side, frame));
            }
            if !any {
                break;
            }
        }
    }

    /// The slaves have their new data: lets the ATs go that wait for them.
    pub fn answer(&mut self) {
        let ends = &self.ends;
        self.chain.release(&mut |side, frame| send(ends, side, frame));
    }

    /// Waits for telegrams, for at most so long \[ns\]; whether there are any.
    pub fn await_telegrams(&self, nanoseconds: u64) -> bool {
        Socket::wait(self.ends.each_ref().map(Option::as_ref), nanoseconds)
    }

    /// Waits for telegrams, for at most so long \[ns\], and passes them on; whether there were any.
    pub fn wait(&mut self, nanoseconds: u64) -> bool {
        let any = self.await_telegrams(nanoseconds);
        self.pass();
        any
    }
}

/// Frames that the kernel does not take are lost, as on a pulled cable: the master counts them.
fn send(ends: &[Option<Socket>; 2], side: PortSide, frame: &[u8]) {
    if let Some(socket) = &ends[side as usize] {
        socket.send(frame);
    }
}
