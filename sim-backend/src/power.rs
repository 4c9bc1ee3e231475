//! The relay of the motor supply at the robot's end: closed only while the watchdog's toggle moves, and once per arming.

use messages::Power;

/// State of the relay.
#[derive(Clone, Copy, Debug)]
pub struct PowerLine {
    /// Cycles of silence after which it falls.
    limit: u64,
    toggle: u64,
    quiet: u64,
    closed: bool,
    /// Epoch and arming number that it is closed for, or was: it does not close for them again, nor for older ones.
    spent: (u64, u64),
}

impl PowerLine {
    /// Open; falls after so many cycles without a moving toggle.
    pub fn falling_after(limit: u32) -> Self {
        Self { limit: u64::from(limit), toggle: 0, quiet: 0, closed: false, spent: (0, 0) }
    }

    /// Closed: the motors have power.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// State besides being closed: cycles of silence, the toggle, the arming that is used up.
    pub fn state(&self) -> (u64, u64, (u64, u64)) {
        (self.quiet.min(self.limit), self.toggle, self.spent)
    }

    /// One bus cycle with the newest record; whether the motors have power.
    pub fn step(&mut self, power: Option<&Power>) -> bool {
        let moved = power.is_some_and(|p| p.toggle != self.toggle);
        self.quiet = if moved { 0 } else { self.quiet.saturating_add(1) };
        let Some(p) = power else {
            self.closed = false;
            return false;
        };
        self.toggle = p.toggle;
        let arming = (p.header.epoch, p.arming);
        if self.closed {
            self.closed = p.on == 1 && self.quiet < self.limit && arming == self.spent;
        } else if moved && p.on == 1 && arming > self.spent {
            self.closed = true;
        }
        // What it saw while it was closed, or fell by, is used up.
        if self.closed || p.on == 1 {
            self.spent = self.spent.max(arming);
        }
        self.closed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on(toggle: u64, arming: u64) -> Power {
        Power { toggle, on: 1, arming, ..Power::default() }
    }

    #[test]
    fn falls_after_its_cycles_of_silence_and_closes_again_only_for_another_arming() {
        let mut line = PowerLine::falling_after(3);
        assert!(!line.step(None));
        assert!(line.step(Some(&on(1, 1))));
        assert!(line.step(Some(&on(1, 1))) && line.step(Some(&on(1, 1))));
        assert!(!line.step(Some(&on(1, 1))), "a dead watchdog is a switched-off robot");
        for toggle in 2..100 {
            assert!(!line.step(Some(&on(toggle, 1))), "a watchdog that goes on was not asked to");
        }
        assert!(line.step(Some(&on(100, 2))));
    }

    #[test]
    fn an_off_record_acts_at_once_and_for_good() {
        let mut line = PowerLine::falling_after(3);
        line.step(Some(&on(1, 1)));
        assert!(!line.step(Some(&Power { toggle: 2, arming: 1, ..Power::default() })));
        assert!(!line.step(Some(&on(3, 1))));
    }

    #[test]
    fn an_arming_seen_while_closed_opens_it_and_is_used_up() {
        let mut line = PowerLine::falling_after(3);
        assert!(line.step(Some(&on(1, 1))));
        assert!(!line.step(Some(&on(2, 2))), "the record that said off was lost");
        assert!(!line.step(Some(&on(3, 2))));
        assert!(line.step(Some(&on(4, 3))));
    }

    #[test]
    fn a_watchdog_that_was_started_again_counts_from_the_start() {
        let of = |epoch: u64, mut power: Power| {
            power.header.epoch = epoch;
            power
        };
        let mut line = PowerLine::falling_after(3);
        assert!(line.step(Some(&of(1, on(1, 7)))));
        assert!(!line.step(Some(&of(2, Power::default()))));
        assert!(!line.step(Some(&of(1, on(2, 7)))), "the one before is not believed any more");
        assert!(line.step(Some(&of(2, on(1, 1)))));
    }
}
