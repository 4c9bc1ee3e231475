//! The motor power line at the robot's end: on only while the watchdog's toggle moves.

use messages::Power;

/// State of the line.
#[derive(Clone, Copy, Debug, Default)]
pub struct PowerLine {
    toggle: u64,
    quiet: u32,
    on: bool,
}

/// Cycles without a moving toggle after which the relay falls.
const QUIET_CYCLES: u32 = 3;

impl PowerLine {
    /// One bus cycle with the newest record; whether the motors have power.
    pub fn step(&mut self, power: Option<&Power>) -> bool {
        match power {
            Some(p) if p.toggle != self.toggle => {
                self.toggle = p.toggle;
                self.quiet = 0;
                self.on = p.on == 1;
            }
            _ => self.quiet = self.quiet.saturating_add(1),
        }
        if self.quiet >= QUIET_CYCLES || power.is_none_or(|p| p.on != 1) {
            self.on = false;
        }
        self.on
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on(toggle: u64) -> Power {
        Power { toggle, on: 1, ..Power::default() }
    }

    #[test]
    fn falls_with_the_third_cycle_of_silence_and_needs_a_moving_toggle_to_return() {
        let mut line = PowerLine::default();
        assert!(!line.step(None));
        assert!(line.step(Some(&on(1))));
        assert!(line.step(Some(&on(1))) && line.step(Some(&on(1))));
        assert!(!line.step(Some(&on(1))), "a dead watchdog is a switched-off robot");
        assert!(!line.step(Some(&on(1))));
        assert!(line.step(Some(&on(2))));
    }

    #[test]
    fn an_off_record_acts_at_once() {
        let mut line = PowerLine::default();
        line.step(Some(&on(1)));
        assert!(!line.step(Some(&Power { toggle: 2, ..Power::default() })));
    }
}
