//! A limit on log lines that others can provoke: a flood of refusals must not fill a terminal, a pipe or a disk.

use realtime::clock::SECOND;

/// Lines per second, and as many at once.
const RATE: u64 = 5;

/// Counts lines, and those that were left out.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LogGate {
    window: u64,
    lines: u64,
    folded: u64,
}

impl LogGate {
    /// Number of lines left out since the last one, if one may be written now; none: leave this one out, too.
    pub(crate) fn admit(&mut self, now_ns: u64) -> Option<u64> {
        if now_ns / SECOND != self.window {
            (self.window, self.lines) = (now_ns / SECOND, 0);
        }
        self.lines += 1;
        if self.lines > RATE {
            self.folded += 1;
            return None;
        }
        Some(std::mem::take(&mut self.folded))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flood_is_folded_and_counted() {
        let mut gate = LogGate::default();
        let lines = (0..100_000u64).filter_map(|n| gate.admit(10 * SECOND + n)).count() as u64;
        assert_eq!(lines, RATE);
        assert_eq!(gate.admit(11 * SECOND), Some(100_000 - RATE));
        assert_eq!(gate.admit(11 * SECOND), Some(0));
    }
}
