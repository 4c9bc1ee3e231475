//! Detection of hung processes: alive, but no longer writing. Pure: time is an argument.
//!
//! In real time every process writes something in every cycle. One that does not for [`HANG`] hangs; if several do, the first one
//! in the order in which they drive each other is named: those that it drives have nothing to write about.

use messages::Process;
use realtime::clock::SECOND;

/// Silence that is no delay any more. A stall that the robot survives is shorter, and nobody is blamed for it.
pub(super) const HANG: u64 = 2 * SECOND;
/// A look later than this after the last one: the supervisor itself was stopped, and its own time says nothing of others.
const OWN_STALL: u64 = SECOND / 5;

/// Watched processes, in the order of blame. The joint loop drives all behind it; watchdog and broker stand alone.
const ORDER: [Process; 7] = [
    Process::Broker,
    Process::Watchdog,
    Process::Lowlevel,
    Process::SimBackend,
    Process::Planner,
    Process::Controller,
    Process::Logger,
];
const ALONE: usize = 2;

/// Time of each process's last record.
#[derive(Clone, Debug, Default)]
pub(super) struct Pulse {
    heard: [Option<u64>; ORDER.len()],
    looked: u64,
}

impl Pulse {
    /// Sets aside what was heard of a process, which is to be started again: it counts from its next record.
    pub(super) fn forget(&mut self, process: Process) {
        if let Some(i) = ORDER.iter().position(|p| *p == process) {
            self.heard[i] = None;
        }
    }

    /// One look; `fresh` says who wrote something since the last one. Returns who hangs, and for how long.
    pub(super) fn look(&mut self, now: u64, fresh: impl Fn(Process) -> bool) -> Option<(Process, u64)> {
        let gap = now - self.looked.min(now);
        self.looked = now;
        for (heard, process) in self.heard.iter_mut().zip(ORDER) {
            if fresh(process) {
                *heard = Some(now);
            } else if gap > OWN_STALL {
                *heard = heard.map(|at| at + gap);
            }
        }
        let silent = |i: usize| self.heard[i].map(|at| now.saturating_sub(at)).filter(|&ns| ns > HANG);
        // A joint loop that is about to be silent for too long is the reason why others are.
        let driven = ORDER.len() - ALONE;
        let driver = self.heard[ALONE].is_none_or(|at| now.saturating_sub(at) > HANG / 2);
        let watched = if driver { ALONE + 1 } else { ALONE + driven };
        (0..watched).find_map(|i| silent(i).map(|ns| (ORDER[i], ns)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Everybody writes for a second, then all but `silent` for `seconds`; who is named, and when.
    fn blamed(silent: &[Process], seconds: u64) -> Option<(Process, u64)> {
        let mut pulse = Pulse::default();
        for ms in 0..1000 + 1000 * seconds {
            let fresh = |p: Process| ms < 1000 || !silent.contains(&p);
            if let Some((process, _)) = pulse.look(ms * 1_000_000, fresh) {
                return Some((process, ms));
            }
        }
        None
    }

    #[test]
    fn each_is_named_after_two_seconds_and_not_before() {
        for process in ORDER {
            assert_eq!(blamed(&[process], 10), Some((process, 3000)), "{process:?}");
            assert_eq!(blamed(&[process], 2), None);
        }
    }

    #[test]
    fn who_is_driven_by_a_silent_joint_loop_is_not_blamed() {
        use Process::{Controller, Logger, Lowlevel, Planner, SimBackend};
        let silent = [SimBackend, Planner, Controller, Logger, Lowlevel];
        assert_eq!(blamed(&silent, 10), Some((Lowlevel, 3000)));
    }

    #[test]
    fn the_supervisors_own_stall_is_nobodys_fault() {
        let mut pulse = Pulse::default();
        for ms in 0..100 {
            pulse.look(ms * 1_000_000, |_| true);
        }
        assert_eq!(pulse.look(60 * SECOND, |_| false), None);
        assert_eq!(pulse.look(60 * SECOND + 1_000_000, |_| true), None);
    }

    #[test]
    fn who_was_never_heard_or_starts_again_is_not_blamed() {
        let mut pulse = Pulse::default();
        for ms in 0..10_000 {
            if ms == 500 {
                pulse.forget(Process::Broker);
            }
            let hung =
                pulse.look(ms * 1_000_000, |p| p != Process::Logger && (p != Process::Broker || ms < 500));
            assert_eq!(hung, None);
        }
    }
}
