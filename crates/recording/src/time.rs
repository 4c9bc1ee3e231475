//! Time of a log: wall time of a run in real time, simulated time otherwise.

use crate::robot::WallClock;

/// Times of the messages of one run.
#[derive(Clone, Debug, Default)]
pub struct LogTime {
    clock: Option<WallClock>,
    /// \[ns\] Newest stamp; 0: no cycle so far.
    newest: u64,
    /// \[ns\] Time of the newest message of each channel: none overtakes another one.
    last: Vec<u64>,
}

impl LogTime {
    /// Of a run with this clock; none: in simulated time.
    pub fn new(clock: Option<WallClock>) -> Self {
        Self { clock, ..Self::default() }
    }

    /// Time \[ns\] at a stamp: in simulated time the stamp, otherwise that of the clock on the wall; without a stamp the start
    /// of the run.
    pub fn at(&self, stamp_ns: u64) -> u64 {
        match &self.clock {
            None => stamp_ns,
            Some(clock) if stamp_ns == 0 => clock.unix_ns,
            Some(clock) => clock.unix_ns(stamp_ns),
        }
    }

    /// Hears of a stamp \[ns\] of any channel.
    pub fn hear(&mut self, stamp_ns: u64) {
        self.newest = self.newest.max(stamp_ns);
    }

    /// Time \[ns\] of the newest stamp.
    pub fn newest(&self) -> u64 {
        self.at(self.newest)
    }

    /// False in real time before the first cycle: nobody knows yet when messages without a stamp were.
    pub(crate) fn has_begun(&self) -> bool {
        self.clock.is_none() || self.newest > 0
    }

    /// Time \[ns\] of the next message of a channel. In real time one without a stamp is of the newest cycle.
    pub fn next(&mut self, channel: usize, stamp_ns: u64) -> u64 {
        let is_timeless = stamp_ns == 0 && self.clock.is_some();
        let time = self.at(if is_timeless { self.newest } else { stamp_ns });
        self.last.resize(self.last.len().max(channel + 1), 0);
        let last = &mut self.last[channel];
        *last = time.max(*last);
        *last
    }
}
