//! Statistics of frames: rate, jitter, share of their line, and missing ones.

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
pub struct IdentifierStatistics {
    /// Frames.
    pub count: u64,
    /// Payload \[B\].
    pub bytes: u64,
    /// Times between two frames that are known: not those across a step of the clock.
    pub periods: u64,
    /// \[s\] Sum of these.
    pub span: f64,
    /// \[s\] Shortest of them; 0 as long as there is none.
    pub shortest: f64,
    /// \[s\] Longest of them.
    pub longest: f64,
    /// Frames that are missing by their counters.
    pub missing: u64,
    /// Frames with the counter of the one before.
    pub repeated: u64,
    /// Of the frame before; none across a step of the clock.
    last_ns: Option<u64>,
    counter: Option<u64>,
}

impl IdentifierStatistics {
    /// \[s\] Mean time between two frames; 0 as long as none is known.
    pub fn mean(&self) -> f64 {
        if self.periods > 0 { self.span / self.periods as f64 } else { 0.0 }
    }

    fn add(&mut self, frame: &Captured, counter: Option<(u64, u32)>) {
        if let Some(last_ns) = self.last_ns.replace(frame.time_ns) {
            let period = frame.time_ns.saturating_sub(last_ns) as f64 * 1e-9;
            self.shortest = if self.periods == 0 { period } else { self.shortest.min(period) };
            self.longest = self.longest.max(period);
            self.span += period;
            self.periods += 1;
        }
        self.count += 1;
        self.bytes += frame.payload().len() as u64;
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

/// Counts.
#[derive(Clone, Debug)]
pub struct Statistics {
    rates: BitRates,
    rows: BTreeMap<(u32, u32), IdentifierStatistics>,
    lines: BTreeMap<u32, LineTotal>,
    /// \[ns\] Time before the last step of the clock.
    before_ns: u64,
    /// First and newest time \[ns\] behind it.
    since: Option<(u64, u64)>,
}

impl Statistics {
    /// Nothing yet.
    pub fn new(rates: BitRates) -> Self {
        Self { rates, rows: BTreeMap::new(), lines: BTreeMap::new(), before_ns: 0, since: None }
    }

    /// One more frame, with the counter in it and the counter's bits if a layout knows them.
    pub fn add(&mut self, frame: &Captured, counter: Option<(u64, u32)>) {
        let (_, newest) = self.since.get_or_insert((frame.time_ns, frame.time_ns));
        *newest = frame.time_ns.max(*newest);
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

    /// The clock was put back before the next frame: how much time passed is not known, and none is counted.
    pub fn clock_was_put_back(&mut self) {
        self.before_ns = self.elapsed_ns();
        self.since = None;
        self.rows.values_mut().for_each(|row| row.last_ns = None);
    }

    /// \[ns\] From the first frame to the newest, as far as it is known.
    pub fn elapsed_ns(&self) -> u64 {
        self.before_ns.saturating_add(self.since.map_or(0, |(first, newest)| newest - first))
    }

    /// \[s\] The same.
    pub fn seconds(&self) -> f64 {
        self.elapsed_ns() as f64 * 1e-9
    }

    /// (line, identifier) and its frames, in this order.
    pub fn rows(&self) -> impl Iterator<Item = (u32, u32, &IdentifierStatistics)> {
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
