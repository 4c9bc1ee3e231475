//! Recorded traffic by bus cycle: what each local controller was told and what it answered.
//!
//! A cycle ends with SYNC: what was sent to a node since the last one belongs to it, and what the node sends until the
//! next one is its answer. SYNC carries the low bits of the tick only; the recording must hold the begin of the run.

use crate::capture::{Capture, Captured};
use crate::owners::Owners;
use codec::layout::{BusMessage, FrameLayout};
use messages::{BusFrames, Header};
use std::collections::BTreeMap;

/// Frames of one node in one cycle: indices in [`Capture::frames`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct NodeExchange {
    /// To the drives, SYNC last.
    pub told: Vec<u32>,
    /// From the drives.
    pub answered: Vec<u32>,
}

/// A recording by node and tick.
#[derive(Clone, Debug, Default)]
pub struct Cycles {
    /// By node, then by tick.
    nodes: Vec<BTreeMap<u64, NodeExchange>>,
    /// Frames to drives behind the last SYNC.
    pub unfinished: usize,
    /// Frames that the layout does not know; they stand among the answers.
    pub unknown: usize,
}

/// A tick from its low bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unwrapped {
    tick: Option<u64>,
}

impl Unwrapped {
    /// The tick whose low `bits` bits are `counter`: the first one as it is, the others forward from the last one.
    pub fn next(&mut self, counter: u64, bits: u32) -> u64 {
        let mask = (1 << bits) - 1;
        let tick = self.tick.map_or(counter & mask, |last| last + (counter.wrapping_sub(last) & mask));
        self.tick = Some(tick);
        tick
    }
}

/// Counter of a frame, and its bits.
pub fn counter(message: &BusMessage, frame: &Captured) -> Option<(u64, u32)> {
    let signal = message.counter()?;
    (u32::from(frame.len) == message.len).then(|| (signal.get(&frame.data) as u64, signal.bits))
}

impl Cycles {
    /// Sorts a recording.
    pub fn of(layout: &FrameLayout, owners: &Owners, capture: &Capture) -> Self {
        let mut sorter = vec![Sorter::default(); layout.nodes.len()];
        let mut unknown = 0;
        for (i, frame) in capture.frames.iter().enumerate() {
            let mut known = false;
            for node in owners.nodes(layout, frame.line, frame.id) {
                if let Some(m) = layout.find(node as u32, frame.id) {
                    sorter[node].take(&layout.messages[m], frame, i as u32);
                    known = true;
                }
            }
            if !known {
                unknown += usize::from(!frame.is_error());
                // Lowlevel hears it, too, and counts it.
                if let Some(node) = owners.behind(frame.line).next() {
                    sorter[node].answered(i as u32);
                }
            }
        }
        let unfinished = sorter.iter().map(|s| s.told.len()).sum();
        Self { nodes: sorter.into_iter().map(|s| s.finish(capture)).collect(), unfinished, unknown }
    }

    /// Number of ticks, from 0.
    pub fn ticks(&self) -> u64 {
        self.nodes.iter().filter_map(|ticks| ticks.keys().next_back()).max().map_or(0, |last| last + 1)
    }

    /// The first tick of which something was told or answered.
    pub fn first(&self) -> u64 {
        self.nodes.iter().filter_map(|ticks| ticks.keys().next()).min().copied().unwrap_or(0)
    }

    /// Frames of a node in a cycle.
    pub fn exchange(&self, node: usize, tick: u64) -> Option<&NodeExchange> {
        self.nodes.get(node)?.get(&tick)
    }

    /// All answers to a cycle, as lowlevel receives them; what does not fit is left out.
    pub fn answers(&self, capture: &Capture, tick: u64) -> BusFrames {
        self.frames(capture, tick, |exchange| &exchange.answered)
    }

    /// All that the drives were told in a cycle.
    pub fn told(&self, capture: &Capture, tick: u64) -> BusFrames {
        self.frames(capture, tick, |exchange| &exchange.told)
    }

    fn frames(&self, capture: &Capture, tick: u64, which: impl Fn(&NodeExchange) -> &Vec<u32>) -> BusFrames {
        let mut frames = BusFrames { header: Header { tick, ..Header::default() }, ..BusFrames::default() };
        for node in 0..self.nodes.len() {
            for i in self.exchange(node, tick).map_or(&[][..], |exchange| which(exchange)) {
                frames.push(&capture.frames[*i as usize].frame(node as u32));
            }
        }
        frames
    }
}

/// Sorts the frames of one node.
#[derive(Clone, Debug, Default)]
struct Sorter {
    tick: Unwrapped,
    /// Tick of the cycle whose answers come now; none before the first SYNC.
    open: Option<u64>,
    told: Vec<u32>,
    /// Answers before the first SYNC.
    early: Vec<u32>,
    ticks: BTreeMap<u64, NodeExchange>,
}

impl Sorter {
    fn take(&mut self, message: &BusMessage, frame: &Captured, i: u32) {
        if !message.to_drives {
            return self.answered(i);
        }
        self.told.push(i);
        if let Some((counter, bits)) = message.is_sync().then(|| counter(message, frame)).flatten() {
            let tick = self.tick.next(counter, bits);
            self.sync(tick);
        }
    }

    fn sync(&mut self, tick: u64) {
        self.ticks.entry(tick).or_default().told.append(&mut self.told);
        if self.open.is_none() && !self.early.is_empty() {
            let before = self.ticks.entry(tick.saturating_sub(1)).or_default();
            before.answered.append(&mut self.early);
        }
        self.open = Some(tick);
    }

    fn answered(&mut self, i: u32) {
        match self.open {
            Some(tick) => self.ticks.entry(tick).or_default().answered.push(i),
            None => self.early.push(i),
        }
    }

    /// The first cycle may be asked for and answered more than once, until both ends are there: repetitions count once.
    fn finish(mut self, capture: &Capture) -> BTreeMap<u64, NodeExchange> {
        if let Some(mut first) = self.ticks.first_entry() {
            let content = |i: u32| {
                let frame = &capture.frames[i as usize];
                (frame.id, frame.len, frame.data)
            };
            let mut once: Vec<u32> = Vec::new();
            for i in first.get().answered.iter().copied() {
                if !once.iter().any(|other| content(*other) == content(i)) {
                    once.push(i);
                }
            }
            first.get_mut().answered = once;
        }
        self.ticks
    }
}
