//! A grid of wake-ups, and the policy for cycles that take too long.
//!
//! The late cycle is finished; the wake-ups it slept through are skipped whole, so that the phase is kept and no burst
//! of catch-up cycles follows; they are counted, and fill a bucket that every punctual cycle empties by one. A full
//! bucket is the end of patience: the process asks for a controlled stop. No clock in here: time is an argument.

/// Result of a finished cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CycleVerdict {
    /// Finished before the next wake-up.
    InTime,
    /// So many wake-ups were missed and are skipped.
    Overrun {
        /// Whole periods skipped.
        skipped: u64,
    },
    /// As `Overrun`, and the bucket is full.
    TooMany {
        /// Whole periods skipped.
        skipped: u64,
    },
}

impl CycleVerdict {
    /// Whole periods skipped.
    pub const fn skipped(self) -> u64 {
        match self {
            Self::InTime => 0,
            Self::Overrun { skipped } | Self::TooMany { skipped } => skipped,
        }
    }
}

/// Wake-ups at `start + k * period`.
#[derive(Clone, Debug)]
pub struct Period {
    period_ns: u64,
    planned_ns: u64,
    limit: u64,
    bucket: u64,
    overruns: u64,
    skipped: u64,
}

impl Period {
    /// First wake-up at `start_ns`; the bucket holds `limit` missed wake-ups.
    ///
    /// # Panics
    /// If the period is 0.
    pub fn new(start_ns: u64, period_ns: u64, limit: u32) -> Self {
        assert!(period_ns > 0, "a period of 0 ns");
        Self { period_ns, planned_ns: start_ns, limit: u64::from(limit), bucket: 0, overruns: 0, skipped: 0 }
    }

    /// The next wake-up \[ns\].
    pub fn planned(&self) -> u64 {
        self.planned_ns
    }

    /// The cycle that began at [`Period::planned`] has finished at `now_ns`: plans the next wake-up.
    pub fn finish(&mut self, now_ns: u64) -> CycleVerdict {
        let next = self.planned_ns.saturating_add(self.period_ns);
        let skipped = now_ns.saturating_sub(next).div_ceil(self.period_ns);
        self.planned_ns = next.saturating_add(skipped * self.period_ns);
        if skipped == 0 {
            self.bucket = self.bucket.saturating_sub(1);
            return CycleVerdict::InTime;
        }
        self.overruns += 1;
        self.skipped += skipped;
        self.bucket = (self.bucket + skipped).min(self.limit);
        if self.bucket == self.limit {
            CycleVerdict::TooMany { skipped }
        } else {
            CycleVerdict::Overrun { skipped }
        }
    }

    /// Cycles that did not finish before the next wake-up.
    pub fn overruns(&self) -> u64 {
        self.overruns
    }

    /// Wake-ups skipped because of them.
    pub fn skipped(&self) -> u64 {
        self.skipped
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: u64 = 1_000_000;

    /// Runs cycles of the given lengths (in periods) against a mock clock; returns (wake-ups, verdicts).
    fn run(start: u64, lengths: &[f64]) -> (Vec<u64>, Vec<CycleVerdict>, Period) {
        let mut period = Period::new(start, MS, 8);
        let (mut wakes, mut verdicts) = (Vec::new(), Vec::new());
        let mut now = start;
        for length in lengths {
            now = now.max(period.planned());
            wakes.push(period.planned() - start);
            now += (length * MS as f64) as u64;
            verdicts.push(period.finish(now));
        }
        wakes.push(period.planned() - start);
        (wakes, verdicts, period)
    }

    #[test]
    fn half_a_period_is_in_time() {
        let (wakes, verdicts, period) = run(12_345, &[0.5; 3]);
        assert_eq!(wakes, [0, MS, 2 * MS, 3 * MS]);
        assert_eq!(verdicts, [CycleVerdict::InTime; 3]);
        assert_eq!((period.overruns(), period.skipped()), (0, 0));
    }

    #[test]
    fn a_whole_period_is_just_in_time() {
        let (wakes, verdicts, _) = run(0, &[1.0, 1.0]);
        assert_eq!(wakes, [0, MS, 2 * MS]);
        assert_eq!(verdicts, [CycleVerdict::InTime; 2]);
    }

    #[test]
    fn one_and_a_half_periods_skip_one() {
        let (wakes, verdicts, period) = run(777, &[1.5, 0.5]);
        assert_eq!(wakes, [0, 2 * MS, 3 * MS]);
        assert_eq!(verdicts, [CycleVerdict::Overrun { skipped: 1 }, CycleVerdict::InTime]);
        assert_eq!((period.overruns(), period.skipped()), (1, 1));
    }

    #[test]
    fn three_point_two_periods_skip_three() {
        let (wakes, verdicts, period) = run(0, &[3.2, 0.1, 0.1]);
        assert_eq!(wakes, [0, 4 * MS, 5 * MS, 6 * MS]);
        assert_eq!(verdicts[0], CycleVerdict::Overrun { skipped: 3 });
        assert_eq!((period.overruns(), period.skipped()), (1, 3));
    }

    #[test]
    fn a_stall_of_ten_seconds_is_one_skip_and_no_burst() {
        let (wakes, verdicts, period) = run(5, &[10_000.4, 0.1, 0.1]);
        assert_eq!(wakes, [0, 10_001 * MS, 10_002 * MS, 10_003 * MS]);
        assert_eq!(verdicts[0], CycleVerdict::TooMany { skipped: 10_000 });
        assert_eq!((period.overruns(), period.skipped()), (1, 10_000));
    }

    #[test]
    fn the_bucket_fills_with_misses_and_empties_with_good_cycles() {
        // Every other cycle late: +1 -1, never full.
        let (_, verdicts, _) = run(0, &[1.5, 0.5].repeat(100));
        assert!(verdicts.iter().all(|v| !matches!(v, CycleVerdict::TooMany { .. })));
        // Two late ones for each good one: full at the limit of 8.
        let (_, verdicts, _) = run(0, &[1.5, 1.5, 0.5].repeat(10));
        let full = verdicts.iter().position(|v| matches!(v, CycleVerdict::TooMany { .. }));
        assert_eq!(full, Some(19), "1 2 1 | 2 3 2 | 3 4 3 | 4 5 4 | 5 6 5 | 6 7 6 | 7 8");
        // All late.
        let (_, verdicts, _) = run(0, &[1.5; 8]);
        assert_eq!(verdicts[7], CycleVerdict::TooMany { skipped: 1 });
        assert_eq!(verdicts[6], CycleVerdict::Overrun { skipped: 1 });
    }

    #[test]
    fn a_clock_at_its_end_does_not_overflow() {
        let mut period = Period::new(u64::MAX - MS / 2, MS, 8);
        period.finish(u64::MAX);
        assert_eq!(period.planned(), u64::MAX);
    }
}
