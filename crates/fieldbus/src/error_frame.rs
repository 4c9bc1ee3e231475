//! Error frames as SocketCAN reports them: a frame that no wire carries, by which a bus controller tells its state.
//!
//! Identifier: the flag [`ERROR_FLAG`] and classes; payload of 8 bytes: `[1]` state of the controller, `[2]` and `[3]` kind and
//! place of a violation of the protocol, `[6]` and `[7]` error counters (`linux/can/error.h`).

use messages::{ERROR_FLAG, Frame};

/// Class: problem of a controller, in `data[1]`.
const CONTROLLER: u32 = 0x004;
/// Class: violation of the protocol, in `data[2]` and `data[3]`.
const PROTOCOL: u32 = 0x008;
/// Class: nobody acknowledged.
const NO_ACKNOWLEDGE: u32 = 0x020;
/// Class: the controller is off the bus.
const BUS_OFF: u32 = 0x040;
/// Class: error on the bus.
const BUS_ERROR: u32 = 0x080;
/// Class: the controller was started again.
const RESTARTED: u32 = 0x100;
/// Class: `data[6]` and `data[7]` are the error counters.
const COUNTERS: u32 = 0x200;

/// In `data[1]`: warning (receiving, sending), passive (receiving, sending), active again.
const STATES: [(u8, ErrorState); 3] =
    [(0x30, ErrorState::Passive), (0x0c, ErrorState::Warning), (0x40, ErrorState::Active)];

/// State of a bus controller, from good to bad.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum ErrorState {
    /// All is well.
    #[default]
    Active,
    /// A counter has reached 96.
    Warning,
    /// A counter has reached 128: the controller may no longer destroy frames it holds for wrong.
    Passive,
    /// The counter of errors in sending has reached 256: the controller neither sends nor receives.
    Off,
}

/// Content of an error frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ErrorFrame {
    /// The controller's state, if it is told.
    pub state: Option<ErrorState>,
    /// The controller was started again after it had been off.
    pub restarted: bool,
    /// Nobody acknowledged a frame.
    pub no_acknowledge: bool,
    /// A frame was destroyed: bit error, stuffing, checksum, form.
    pub bus_error: bool,
    /// Error counters of sending and receiving, 255 at most.
    pub counters: Option<[u8; 2]>,
}

impl ErrorFrame {
    /// Content of an error frame; none for any other frame.
    pub fn read(frame: &Frame) -> Option<Self> {
        let is = |class: u32| frame.id & class != 0;
        if !is(ERROR_FLAG) {
            return None;
        }
        let told = STATES.iter().find(|(bits, _)| is(CONTROLLER) && frame.data[1] & bits != 0);
        let state = if is(BUS_OFF) { Some(ErrorState::Off) } else { told.map(|(_, state)| *state) };
        Some(Self {
            state,
            restarted: is(RESTARTED),
            no_acknowledge: is(NO_ACKNOWLEDGE),
            bus_error: is(BUS_ERROR) || is(PROTOCOL),
            counters: is(COUNTERS).then(|| [frame.data[6], frame.data[7]]),
        })
    }

    /// The frame that says it: identifier and payload.
    pub fn encode(&self) -> (u32, [u8; 8]) {
        let (mut id, mut data) = (ERROR_FLAG, [0; 8]);
        let mut class = |holds: bool, class: u32| id |= if holds { class } else { 0 };
        class(self.restarted, RESTARTED);
        class(self.no_acknowledge, NO_ACKNOWLEDGE);
        class(self.bus_error, BUS_ERROR | PROTOCOL);
        class(self.state == Some(ErrorState::Off), BUS_OFF);
        class(self.counters.is_some(), COUNTERS);
        if let Some((bits, _)) = STATES.iter().find(|(_, state)| Some(*state) == self.state) {
            class(true, CONTROLLER);
            data[1] = *bits;
        }
        if let Some(counters) = self.counters {
            [data[6], data[7]] = counters;
        }
        (id, data)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(id: u32, data: &[u8]) -> Frame {
        let mut frame = Frame { id, len: 8, ..Frame::default() };
        frame.data[..data.len()].copy_from_slice(data);
        frame
    }

    /// As the kernel's drivers write them.
    #[test]
    fn frames_of_the_kernel_are_understood() {
        let off = ErrorFrame::read(&frame(0x2000_0040, &[0; 8])).unwrap();
        assert_eq!(off, ErrorFrame { state: Some(ErrorState::Off), ..ErrorFrame::default() });
        let warning = ErrorFrame::read(&frame(0x2000_0204, &[0, 0x08, 0, 0, 0, 0, 96, 3])).unwrap();
        assert_eq!((warning.state, warning.counters), (Some(ErrorState::Warning), Some([96, 3])));
        let passive = ErrorFrame::read(&frame(0x2000_0024, &[0, 0x20])).unwrap();
        assert!(passive.state == Some(ErrorState::Passive) && passive.no_acknowledge);
        let again = ErrorFrame::read(&frame(0x2000_0100, &[0; 8])).unwrap();
        assert!(again.restarted && again.state.is_none());
        assert_eq!(ErrorFrame::read(&frame(0x040, &[0; 8])), None, "an ordinary frame");
    }

    #[test]
    fn what_is_written_is_read() {
        for state in [ErrorState::Active, ErrorState::Warning, ErrorState::Passive, ErrorState::Off] {
            let said = ErrorFrame {
                state: Some(state),
                restarted: state == ErrorState::Active,
                no_acknowledge: state == ErrorState::Warning,
                bus_error: state == ErrorState::Off,
                counters: Some([7, 255]),
            };
            let (id, data) = said.encode();
            assert_eq!(ErrorFrame::read(&frame(id, &data)), Some(said));
        }
    }
}
