//! Back-off of restarts: soon, then later and later, and not for ever. Pure: time is an argument.
//!
//! A process that died too often in a row is left dead, and so is one that died so often that its topics have no slot for
//! another writer ([`ipc::writers`]): each that is killed takes its place with it.

use realtime::clock::SECOND;

/// The first pause, and the longest \[ns\].
const FIRST: u64 = SECOND / 5;
const LONGEST: u64 = 10 * SECOND;
/// Lifetime after which a process begins with the first pause again.
const HEALTHY: u64 = 60 * SECOND;
/// Starts in a row after which it is left dead.
const MOST: u32 = 8;

/// The restarts of one process.
#[derive(Clone, Copy, Debug)]
pub(super) struct Backoff {
    /// Starts that the run still has room for.
    left: usize,
    /// Starts in a row.
    starts: u32,
    started: u64,
    due: Option<u64>,
}

impl Backoff {
    /// Of a process that is started for the first time, and as often as its topics have room for `writers`.
    pub(super) fn new(writers: usize) -> Self {
        Self { left: writers.saturating_sub(1), starts: 0, started: 0, due: None }
    }

    /// It died; in how many nanoseconds it is started again, none: not any more.
    pub(super) fn died(&mut self, now: u64) -> Option<u64> {
        if now > self.started + HEALTHY {
            self.starts = 0;
        }
        let pause = (FIRST << self.starts.min(16)).min(LONGEST);
        self.due = (self.starts < MOST && self.left > 0).then_some(now + pause);
        self.due.map(|_| pause)
    }

    /// Whether it is to be started now; once per death.
    pub(super) fn is_due(&mut self, now: u64) -> bool {
        let due = self.due.is_some_and(|due| now >= due);
        if due {
            (self.left, self.starts, self.started, self.due) = (self.left - 1, self.starts + 1, now, None);
        }
        due
    }
}

#[cfg(test)]
mod tests {
    use messages::Process;

    use super::*;

    #[test]
    fn a_process_that_dies_again_and_again_waits_longer_and_is_then_left_alone() {
        let (mut backoff, mut now, mut pauses) = (Backoff::new(16), 0, Vec::new());
        while let Some(pause) = backoff.died(now) {
            pauses.push(pause * 10 / SECOND);
            assert!(!backoff.is_due(now + pause - 1));
            now += pause;
            assert!(backoff.is_due(now) && !backoff.is_due(now));
        }
        assert_eq!(pauses, [2, 4, 8, 16, 32, 64, 100, 100]);
        assert_eq!(backoff.died(now + 2 * HEALTHY), Some(FIRST));
    }

    /// The fifth broker of a run found no room for its topics, the sixth neither: each was announced.
    #[test]
    fn nobody_is_started_whose_topics_have_no_room() {
        for process in [Process::Broker, Process::Logger] {
            let mut backoff = Backoff::new(ipc::writers(process));
            let healthy = |n: u64| n * 2 * HEALTHY;
            let starts = (1..)
                .take_while(|&n| backoff.died(healthy(n)).is_some() && backoff.is_due(healthy(n) + FIRST));
            assert_eq!(1 + starts.count(), ipc::writers(process));
            assert!(ipc::writers(process) > MOST as usize, "in a row it is given up before");
        }
    }
}
