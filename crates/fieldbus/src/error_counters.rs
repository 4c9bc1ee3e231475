//! Error counters of a bus controller, up to bus-off (ISO 11898-1, fault confinement).
//!
//! | event | sending | receiving |
//! |---|---|---|
//! | error in a frame that is sent | + 8 | |
//! | nobody acknowledges, while passive | + 0 | |
//! | error in a frame that is received | | + 1 |
//! | frame sent | - 1 | |
//! | frame received | | - 1; from above 127 to 119 |
//!
//! Warning from 96, passive from 128, off the bus from 256 of sending. Back only when told to, and only after
//! [`RECOVERY_BITS`] recessive bits, with both counters at zero.

use crate::error_frame::ErrorState;

/// Bit times of a free bus that a controller off the bus must have seen: 128 times 11 recessive bits.
pub const RECOVERY_BITS: u32 = 128 * 11;

const WARNING: u16 = 96;
const PASSIVE: u16 = 128;
const OFF: u16 = 256;

/// The counters of one bus controller.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ErrorCounters {
    sending: u16,
    receiving: u16,
}

impl ErrorCounters {
    /// Counters of sending and receiving.
    pub fn values(&self) -> [u16; 2] {
        [self.sending, self.receiving]
    }

    /// The same as an error frame carries them.
    pub fn bytes(&self) -> [u8; 2] {
        self.values().map(|n| n.min(255) as u8)
    }

    /// State of the controller by its counters.
    pub fn state(&self) -> ErrorState {
        match self.sending.max(self.receiving) {
            _ if self.sending >= OFF => ErrorState::Off,
            n if n >= PASSIVE => ErrorState::Passive,
            n if n >= WARNING => ErrorState::Warning,
            _ => ErrorState::Active,
        }
    }

    /// A frame of its own went through.
    pub fn sent(&mut self) {
        if self.state() != ErrorState::Off {
            self.sending = self.sending.saturating_sub(1);
        }
    }

    /// A frame of its own was destroyed.
    pub(crate) fn failed_to_send(&mut self) {
        if self.state() != ErrorState::Off {
            self.sending += 8;
        }
    }

    /// Nobody acknowledged a frame of its own: a controller alone on its line becomes passive and stays that.
    pub(crate) fn not_acknowledged(&mut self) {
        if self.state() < ErrorState::Passive {
            self.failed_to_send();
        }
    }

    /// A frame of another one came.
    pub fn received(&mut self) {
        self.receiving = if self.receiving > 127 { 119 } else { self.receiving.saturating_sub(1) };
    }

    /// A frame of another one was destroyed.
    pub(crate) fn failed_to_receive(&mut self) {
        self.receiving = (self.receiving + 1).min(PASSIVE + 7);
    }

    /// Told to come back, and the bus was free for [`RECOVERY_BITS`].
    pub fn restart(&mut self) {
        *self = Self::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every frame destroyed: 12, 16, 32 attempts to warning, passive, off.
    #[test]
    fn errors_in_a_row_lead_through_all_states() {
        let mut c = ErrorCounters::default();
        let states: Vec<ErrorState> = (0..40)
            .map(|_| {
                c.failed_to_send();
                c.state()
            })
            .collect();
        let first = |state| states.iter().position(|s| *s == state).unwrap() + 1;
        assert_eq!(
            [first(ErrorState::Warning), first(ErrorState::Passive), first(ErrorState::Off)],
            [12, 16, 32]
        );
        assert_eq!(c.values(), [256, 0], "off the bus nothing is counted");
        c.sent();
        assert_eq!(c.state(), ErrorState::Off, "and nothing but a restart leads back");
        c.restart();
        assert_eq!((c.state(), c.values()), (ErrorState::Active, [0, 0]));
    }

    #[test]
    fn a_controller_alone_on_its_line_becomes_passive_and_never_off() {
        let mut c = ErrorCounters::default();
        (0..1000).for_each(|_| c.not_acknowledged());
        assert_eq!((c.state(), c.values()), (ErrorState::Passive, [128, 0]));
    }

    /// One frame of nine destroyed: + 8 and 8 times - 1, the border of growing.
    #[test]
    fn one_error_in_nine_frames_is_the_most_that_is_borne() {
        let mut c = ErrorCounters::default();
        for _ in 0..1000 {
            c.failed_to_send();
            (0..8).for_each(|_| c.sent());
        }
        assert_eq!(c.values(), [0, 0]);
        let mut c = ErrorCounters::default();
        while c.state() != ErrorState::Off {
            c.failed_to_send();
            (0..7).for_each(|_| c.sent());
        }
    }

    #[test]
    fn who_only_receives_is_never_off_and_comes_back_to_119() {
        let mut c = ErrorCounters::default();
        (0..1000).for_each(|_| c.failed_to_receive());
        assert_eq!(c.state(), ErrorState::Passive);
        c.received();
        assert_eq!((c.state(), c.values()), (ErrorState::Warning, [0, 119]));
    }
}
