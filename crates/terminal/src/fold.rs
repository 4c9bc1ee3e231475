//! The same line again and again: told a few times, then counted.
//!
//! Lines are the same if they differ in digits only (a connection's number, a tick). Within a second the first [`PLAIN`] of
//! them are shown; the others are counted and told when the second is over. All kinds together may show [`MOST`] lines a
//! second, so that somebody who varies his text cannot flood the terminal either.

use std::collections::HashMap;

/// Lines of one kind, and of all kinds, shown per second.
const PLAIN: u32 = 5;
const MOST: u32 = 100;
/// Kinds told apart; further ones are counted together.
const KINDS: usize = 64;
/// Length of the window \[ns\].
const WINDOW: u64 = 1_000_000_000;

/// Events of one kind in this window.
#[derive(Clone, Debug)]
struct RepeatedEvent {
    example: String,
    seen: u32,
    hidden: u32,
}

/// Decides which lines are shown. Pure: time is an argument.
#[derive(Clone, Debug, Default)]
pub struct Fold {
    begun: u64,
    shown: u32,
    kinds: HashMap<String, RepeatedEvent>,
    others: u32,
}

impl Fold {
    /// Whether this line is shown.
    pub fn admit(&mut self, line: &str) -> bool {
        let key: String = line.chars().filter(|c| !c.is_ascii_digit()).collect();
        if self.kinds.len() >= KINDS && !self.kinds.contains_key(&key) {
            self.others += 1;
            return false;
        }
        let new = || RepeatedEvent { example: line.into(), seen: 0, hidden: 0 };
        let kind = self.kinds.entry(key).or_insert_with(new);
        kind.seen += 1;
        let shown = kind.seen <= PLAIN && self.shown < MOST;
        kind.hidden += u32::from(!shown);
        self.shown += u32::from(shown);
        shown
    }

    /// At the end of a window, what was hidden in it; to be called often. `last`: the window ends now.
    pub fn summary(&mut self, now_ns: u64, last: bool) -> Vec<String> {
        if !last && now_ns < self.begun + WINDOW {
            return Vec::new();
        }
        (self.begun, self.shown) = (now_ns, 0);
        let mut hidden: Vec<RepeatedEvent> =
            self.kinds.drain().map(|(_, kind)| kind).filter(|k| k.hidden > 0).collect();
        hidden.sort_by(|a, b| a.example.cmp(&b.example));
        let mut lines: Vec<String> = hidden
            .iter()
            .map(|k| format!("{} ... {} more like it", k.example.trim_end(), k.hidden))
            .collect();
        let others = std::mem::take(&mut self.others);
        if others > 0 {
            lines.push(format!("... {others} other lines"));
        }
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_differ_in_numbers_are_told_once_with_their_number() {
        let mut fold = Fold::default();
        let shown =
            (0..497).filter(|n| fold.admit(&format!("connection closed: garbage connection={n}"))).count();
        assert_eq!(shown, PLAIN as usize);
        assert!(fold.admit("tick 17  watchdog: PowerOff"));
        assert!(fold.summary(WINDOW - 1, false).is_empty());
        assert_eq!(
            fold.summary(WINDOW, false),
            ["connection closed: garbage connection=0 ... 492 more like it"]
        );
        assert!(fold.admit("connection closed: garbage connection=1"), "a new second shows it again");
        assert!(fold.summary(2 * WINDOW, false).is_empty(), "nothing was hidden");
    }

    #[test]
    fn varied_lines_are_bounded_too() {
        let mut fold = Fold::default();
        let line = |n: u32| (0..n).map(|_| 'x').collect::<String>();
        let shown = (0..1000).filter(|&n| fold.admit(&line(n % 300))).count();
        assert!(shown <= MOST as usize, "{shown}");
        let told = fold.summary(0, true);
        assert!(told.len() <= KINDS + 1 && told.last().unwrap().contains("other lines"), "{told:?}");
    }
}
