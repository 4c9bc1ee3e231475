//! How often frames come, how regularly, how much of their line they take, and which are missing.

use crate::bits;
use crate::capture::Captured;
use std::collections::BTreeMap;

/// Bit rates of a line \[bit/s\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BitRates {
    /// Of arbitration, and of all of classic CAN.
    pub nominal: f64,
    /// Of the data of CAN FD frames with bit rate switch.
    pub data: f64,
}

/// Frames of one identifier on one line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Row {
    /// Frames.
    pub count: u64,
    /// Payload \[B\].
    pub bytes: u64,
    /// \[s\] From the first frame to the last.
    pub span: f64,
    /// \[s\] Shortest time between two frames; 0 as long as there is but one.
    pub shortest: f64,
    /// \[s\] Longest time between two frames.
    pub longest: f64,
    /// Frames that are missing by their counters.
    pub missing: u64,
    /// Frames with the counter of the one before.
    pub repeated: u64,
    first_ns: u64,
    last_ns: u64,
    counter: Option<u64>,
}

impl Row {
    /// \[s\] Mean time between two frames; 0 as long as there is but one.
    pub fn mean(&self) -> f64 {
        if self.count > 1 { self.span / (self.count - 1) as f64 } else { 0.0 }
    }

    fn add(&mut self, frame: &Captured, counter: Option<(u64, u32)>) {
        if self.count == 0 {
            self.first_ns = frame.time_ns;
        } else {
            let gap = frame.time_ns.saturating_sub(self.last_ns) as f64 * 1e-9;
            self.shortest = if self.count == 1 { gap } else { self.shortest.min(gap) };
            self.longest = self.longest.max(gap);
        }
        self.count += 1;
        self.bytes += frame.payload().len() as u64;
        self.last_ns = frame.time_ns;
        self.span = self.last_ns.saturating_sub(self.first_ns) as f64 * 1e-9;
        if let Some((counter, bits)) = counter {
            let mask = (1 << bits) - 1;
            match self.counter.map(|last| counter.wrapping_sub(last) & mask) {
                Some(0) => self.repeated += 1,
                Some(steps) => self.missing += steps - 1,
                None => {}
            }
            self.counter = Some(counter);
        }
    }
}

/// All frames of one line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineTotal {
    /// Frames, error frames aside.
    pub count: u64,
    /// Payload \[B\].
    pub bytes: u64,
    /// Error frames.
    pub errors: u64,
    /// \[s\] The line was occupied: every bit of every frame, stuff bits as they were sent; error frames are not known.
    pub occupied: f64,
}

/// What was counted.
#[derive(Clone, Debug)]
pub struct Statistics {
    rates: BitRates,
    rows: BTreeMap<(u32, u32), Row>,
    lines: BTreeMap<u32, LineTotal>,
    first_ns: Option<u64>,
    last_ns: u64,
}

impl Statistics {
    /// Nothing yet.
    pub fn new(rates: BitRates) -> Self {
        Self { rates, rows: BTreeMap::new(), lines: BTreeMap::new(), first_ns: None, last_ns: 0 }
    }

    /// One more frame, with the counter in it and the counter's bits if a layout knows them.
    pub fn add(&mut self, frame: &Captured, counter: Option<(u64, u32)>) {
        self.first_ns.get_or_insert(frame.time_ns);
        self.last_ns = self.last_ns.max(frame.time_ns);
        let total = self.lines.entry(frame.line).or_default();
        if frame.is_error() {
            total.errors += 1;
        } else {
            total.count += 1;
            total.bytes += frame.payload().len() as u64;
            total.occupied += bits::of(frame).seconds(self.rates.nominal, self.rates.data);
        }
        self.rows.entry((frame.line, frame.id)).or_default().add(frame, counter);
    }

    /// \[s\] From the first frame to the last.
    pub fn seconds(&self) -> f64 {
        self.first_ns.map_or(0.0, |first| self.last_ns.saturating_sub(first) as f64 * 1e-9)
    }

    /// (line, identifier) and its frames, in this order.
    pub fn rows(&self) -> impl Iterator<Item = (u32, u32, &Row)> {
        self.rows.iter().map(|((line, id), row)| (*line, *id, row))
    }

    /// Lines and all their frames, in order.
    pub fn lines(&self) -> impl Iterator<Item = (u32, &LineTotal)> {
        self.lines.iter().map(|(line, total)| (*line, total))
    }

    /// \[1\] Share of the time in which a line was occupied; not a number for a recording of one instant.
    pub fn load(&self, total: &LineTotal) -> f64 {
        total.occupied / self.seconds()
    }
}
