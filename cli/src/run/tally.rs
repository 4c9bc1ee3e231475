//! Events that come again and again: told when they are new, then at the 10th, 100th ... time, and once more with their
//! number at the end.

use std::collections::BTreeMap;

use messages::Process;

/// Number of events of each kind. Kinds differ in more than their digits.
#[derive(Clone, Debug, Default)]
pub(super) struct Tally(BTreeMap<(&'static str, String), u64>);

impl Tally {
    /// The sentence of an event if it is to be told now, with how often it came if that is not the first time.
    pub(super) fn tell(&mut self, process: Process, sentence: &str) -> Option<String> {
        let kind: String = sentence.chars().filter(|c| !c.is_ascii_digit()).collect();
        let count = self.0.entry((process.name(), kind)).or_default();
        *count += 1;
        match *count {
            1 => Some(sentence.to_owned()),
            n if n.ilog10() > (n - 1).ilog10() => Some(format!("{sentence} ({n} times by now)")),
            _ => None,
        }
    }

    /// Repeated events, with their counts.
    pub(super) fn summary(&self) -> impl Iterator<Item = String> {
        let often = self.0.iter().filter(|(_, count)| **count > 1);
        // What to do was told with the first of them.
        often.map(|((process, kind), count)| {
            let what = kind.split([':', ';']).next().unwrap_or_default();
            format!("{process}: {what}, {count} times")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 83 lines of events in 5 s, 51 of them `Overrun (1)`.
    #[test]
    fn repeated_events_are_folded() {
        let mut tally = Tally::default();
        let late = |n| format!("a cycle ended too late: {n} periods skipped; `gangwerk doctor` says why");
        let told: Vec<String> = (0..51).filter_map(|n| tally.tell(Process::Lowlevel, &late(n))).collect();
        assert_eq!(told.len(), 2, "{told:?}");
        assert!(told[1].ends_with("(10 times by now)"), "{told:?}");
        assert!(tally.tell(Process::Planner, &late(1)).is_some(), "another process");
        assert!(tally.tell(Process::Lowlevel, "motor supply on").is_some(), "another event");
        let summary: Vec<String> = tally.summary().collect();
        assert_eq!(summary, ["lowlevel: a cycle ended too late, 51 times"]);
    }
}
