//! Simulated slaves in their order, with the cables between them: what is plugged into the master's ports.
//!
//! ```text
//! master port 1 ── cable 0 ── slave 0 ── cable 1 ── slave 1 ── … ── slave n-1 ── cable n ── master port 2
//! ```
//!
//! A telegram that enters at one end goes through all slaves at once. In CP4 the ATs may be held back until the
//! simulated robot has answered the commands of the same cycle; hardware fills them with what it has.

use crate::header::{CommunicationPhase, TelegramHeader, TelegramKind};
use crate::slave::{PortSide, Slave};
use crate::telegram::Telegram;

/// ATs that can wait: four of each channel.
const HELD: usize = 8;
/// Copies of a telegram at once that idle ports send.
const WAYS: usize = 4;

/// All slaves.
pub struct SlaveChain {
    slaves: Vec<Slave>,
    cables: Vec<bool>,
    hold: bool,
    held: [(PortSide, Telegram); HELD],
    waiting: usize,
    current: Telegram,
    ways: Box<[PendingTelegram; WAYS]>,
}

/// A telegram that still has to leave this slave on this side.
#[derive(Clone, Copy)]
struct PendingTelegram {
    slave: usize,
    leaves: PortSide,
    telegram: Telegram,
}

impl SlaveChain {
    /// These slaves, all cables plugged. With `hold`, ATs of CP4 wait for [`SlaveChain::release`].
    pub fn new(slaves: Vec<Slave>, hold: bool) -> Self {
        let cables = vec![true; slaves.len() + 1];
        let way = PendingTelegram { slave: 0, leaves: PortSide::Left, telegram: Telegram::EMPTY };
        Self {
            slaves,
            cables,
            hold,
            held: [(PortSide::Left, Telegram::EMPTY); HELD],
            waiting: 0,
            current: Telegram::EMPTY,
            ways: Box::new([way; WAYS]),
        }
    }

    /// The slaves, in their order.
    pub fn slaves(&self) -> &[Slave] {
        &self.slaves
    }

    /// The slaves, in their order.
    pub fn slaves_mut(&mut self) -> &mut [Slave] {
        &mut self.slaves
    }

    /// Plugs or pulls cable `i`, 0 to the number of slaves; both of its ends notice, as hardware does.
    pub fn set_cable(&mut self, i: usize, plugged: bool) {
        if self.cables[i] == plugged {
            return;
        }
        self.cables[i] = plugged;
        if let Some(slave) = self.slaves.get_mut(i) {
            slave.set_link(PortSide::Left, plugged);
        }
        if i > 0 {
            self.slaves[i - 1].set_link(PortSide::Right, plugged);
        }
    }

    /// A cycle time went by without a beat.
    pub fn silence(&mut self) {
        self.slaves.iter_mut().for_each(Slave::silence);
    }

    /// A frame came in at this end; `out` takes what leaves the chain.
    pub fn take(&mut self, end: PortSide, frame: &[u8], out: &mut impl FnMut(PortSide, &[u8])) {
        let header = TelegramHeader::read(frame);
        if let Ok(header) = header
            && self.hold
            && header.phase == CommunicationPhase::Cp4
            && header.kind == TelegramKind::At
            && !header.switching
            && self.waiting < HELD
        {
            self.held[self.waiting].0 = end;
            self.held[self.waiting].1.copy_from(frame);
            self.waiting += 1;
            return;
        }
        if header.is_ok_and(|h| h.is_beat()) && self.is_stale(frame) {
            self.release(out); // nobody answered: with what there is, as hardware would
        }
        self.run(end, frame, out);
    }

    /// Whether the ATs that wait are of another cycle than this beat.
    fn is_stale(&self, beat: &[u8]) -> bool {
        let cycle = |frame: &[u8]| TelegramHeader::read(frame).ok().and_then(|h| h.cycle);
        self.waiting > 0 && cycle(self.held[0].1.bytes()) != cycle(beat)
    }

    /// The slaves have answered: lets the ATs go.
    pub fn release(&mut self, out: &mut impl FnMut(PortSide, &[u8])) {
        for i in 0..std::mem::take(&mut self.waiting) {
            let (end, telegram) = self.held[i]; // a copy: the slaves write into their own
            self.run(end, telegram.bytes(), out);
        }
    }

    fn run(&mut self, end: PortSide, frame: &[u8], out: &mut impl FnMut(PortSide, &[u8])) {
        let (mut slave, cable) = match end {
            PortSide::Left => (0, 0),
            PortSide::Right => (self.slaves.len() - 1, self.slaves.len()),
        };
        if !self.cables[cable] {
            return;
        }
        let (mut from, mut open) = (end, 0);
        self.current.copy_from(frame);
        // Nothing circles: a telegram is turned round at most once, and an idle port swallows it.
        for _ in 0..4 * self.slaves.len() * WAYS {
            let exits = self.slaves[slave].pass(from, self.current.bytes_mut());
            let mut leaves = match (exits.left, exits.right) {
                (true, true) => {
                    if let Some(way) = self.ways.get_mut(open) {
                        *way = PendingTelegram { slave, leaves: from.other(), telegram: self.current };
                        open += 1;
                    }
                    Some(from)
                }
                (true, false) => Some(PortSide::Left),
                (false, true) => Some(PortSide::Right),
                (false, false) => None,
            };
            loop {
                match leaves.map(|side| (side, self.neighbour(slave, side))) {
                    Some((side, Some(next))) => {
                        (slave, from) = (next, side.other());
                        break;
                    }
                    Some((side, None)) => {
                        out(side, self.current.bytes());
                        leaves = None;
                    }
                    None if open == 0 => return,
                    None => {
                        open -= 1;
                        self.current = self.ways[open].telegram;
                        (slave, leaves) = (self.ways[open].slave, Some(self.ways[open].leaves));
                    }
                }
            }
        }
    }

    fn neighbour(&self, slave: usize, side: PortSide) -> Option<usize> {
        match side {
            PortSide::Left => slave.checked_sub(1),
            PortSide::Right => Some(slave + 1).filter(|next| *next < self.slaves.len()),
        }
    }
}
