//! Back-off of restarts: soon, then later and later, and not for ever. Pure: time is an argument.

use realtime::clock::SECOND;

/// The first pause, and the longest \[ns\].
const FIRST: u64 = SECOND / 5;
const LONGEST: u64 = 10 * SECOND;
/// Lifetime after which a process begins with the first pause again.
const HEALTHY: u64 = 60 * SECOND;
/// Starts in a row after which it is left dead.
const MOST: u32 = 8;

/// The restarts of one process.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Backoff {
    starts: u32,
    started: u64,
    due: Option<u64>,
}

impl Backoff {
    /// It died; in how many nanoseconds it is started again, none: not any more.
    pub(super) fn died(&mut self, now: u64) -> Option<u64> {
        if now > self.started + HEALTHY {
            self.starts = 0;
        }
        let pause = (FIRST << self.starts.min(16)).min(LONGEST);
        self.due = (self.starts < MOST).then_some(now + pause);
        self.due.map(|_| pause)
    }

    /// Whether it is to be started now; once per death.
    pub(super) fn is_due(&mut self, now: u64) -> bool {
        let due = self.due.is_some_and(|due| now >= due);
        if due {
            (self.starts, self.started, self.due) = (self.starts + 1, now, None);
        }
        due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_process_that_dies_again_and_again_waits_longer_and_is_then_left_alone() {
        let (mut backoff, mut now, mut pauses) = (Backoff::default(), 0, Vec::new());
        while let Some(pause) = backoff.died(now) {
            pauses.push(pause * 10 / SECOND);
            assert!(!backoff.is_due(now + pause - 1));
            now += pause;
            assert!(backoff.is_due(now) && !backoff.is_due(now));
        }
        assert_eq!(pauses, [2, 4, 8, 16, 32, 64, 100, 100]);
        assert_eq!(backoff.died(now + 2 * HEALTHY), Some(FIRST));
    }
}
