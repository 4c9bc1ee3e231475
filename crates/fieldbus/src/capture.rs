//! Recorded traffic: what was on which line, and when.

use crate::clock_steps::{ClockStep, ClockSteps};
use messages::Frame;

/// Bit of an identifier: 29 bits long (CAN_EFF_FLAG of SocketCAN).
pub const EXTENDED: u32 = 0x8000_0000;
/// Bit of an identifier: a request without data (CAN_RTR_FLAG).
pub const REMOTE: u32 = 0x4000_0000;
/// Bit of an identifier: not a frame but what a controller reports about its line (CAN_ERR_FLAG).
pub const ERROR: u32 = 0x2000_0000;
/// The 29 bits of an extended identifier, or the classes of an error frame.
pub const EXTENDED_BITS: u32 = 0x1fff_ffff;
/// The 11 bits of a base identifier.
pub const BASE_BITS: u32 = 0x7ff;
/// Flag of a CAN FD frame: its data went at the higher bit rate (CANFD_BRS).
pub(crate) const BIT_RATE_SWITCH: u8 = 1;

/// Longest payload of a classic frame \[B\].
pub(crate) const CLASSIC_BYTES: usize = 8;
/// Lengths that a CAN FD frame can have \[B\].
pub const FD_LENGTHS: [usize; 16] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64];

/// Form of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameType {
    /// CAN 2.0: up to 8 bytes. `code`: the length code on the wire if it was above 8 (9 to 15), else 0.
    Classic {
        /// Raw length code.
        code: u8,
    },
    /// CAN FD: up to 64 bytes, with its flags (bit 0 bit rate switch, bit 1 error state, bit 2 FD).
    Fd {
        /// `canfd_frame.flags`.
        flags: u8,
    },
}

impl FrameType {
    /// An ordinary classic frame.
    pub const CLASSIC: Self = Self::Classic { code: 0 };
}

/// Which way a frame went through the interface that recorded it, if the recording says so (`candump -x`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CaptureDirection {
    /// Came from the line.
    Received,
    /// Went to the line.
    Sent,
}

/// One frame, and when it was on its line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Captured {
    /// \[ns\] Since 1970 if a clock stamped it, since the start of the run if it comes from simulated time.
    pub time_ns: u64,
    /// Index in [`Capture::lines`].
    pub line: u32,
    /// Identifier with [`EXTENDED`], [`REMOTE`] and [`ERROR`], as SocketCAN's `can_id`.
    pub id: u32,
    /// \[B\] Bytes of payload; of a [`REMOTE`] frame the bytes it asks for.
    pub len: u8,
    /// Payload, zeros behind its end.
    pub data: [u8; 64],
    /// Classic or FD.
    pub form: FrameType,
    /// Its way, if known.
    pub way: Option<CaptureDirection>,
}

impl Captured {
    /// A frame of a bus cycle: classic or with the flags of CAN FD.
    pub fn of(frame: &Frame, time_ns: u64, form: FrameType) -> Self {
        let len = frame.len.min(64) as u8;
        Self { time_ns, line: frame.line, id: frame.id, len, data: frame.data, form, way: None }
    }

    /// The same as a frame of a bus cycle, on line `line`.
    pub fn frame(&self, line: u32) -> Frame {
        Frame { line, id: self.id, len: self.len.into(), data: self.data }
    }

    /// The payload; empty for a remote frame.
    pub fn payload(&self) -> &[u8] {
        if self.id & (REMOTE | ERROR) == REMOTE { &[] } else { &self.data[..usize::from(self.len).min(64)] }
    }

    /// Whether it is a report of a controller.
    pub fn is_error(&self) -> bool {
        self.id & ERROR != 0
    }
}

/// A recording.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Capture {
    /// Names of the interfaces; [`Captured::line`] counts them.
    pub lines: Vec<String>,
    /// In the order of time, but for [`Capture::steps`].
    pub frames: Vec<Captured>,
    /// Places at which the clock was put back.
    pub steps: Vec<ClockStep>,
}

impl Capture {
    /// Index of an interface; a new one is appended.
    pub fn line(&mut self, name: &str) -> u32 {
        let known = self.lines.iter().position(|line| line == name);
        known.unwrap_or_else(|| {
            self.lines.push(name.to_owned());
            self.lines.len() - 1
        }) as u32
    }

    /// Puts the frames in the order of time; frames of one instant stay as they are. A recorder of several interfaces
    /// reads one after the other, so what it writes is in order within each interface only. Where the time of an interface
    /// goes back, its clock was: there the order of the file counts, and [`Capture::steps`] says where.
    pub fn sort(&mut self) {
        let mut clock = ClockSteps::default();
        let mut keyed: Vec<(usize, Captured)> =
            self.frames.drain(..).map(|frame| (clock.stretch(frame.line, frame.time_ns), frame)).collect();
        keyed.sort_by_key(|(stretch, frame)| (*stretch, frame.time_ns));
        let step = |at: usize| ClockStep {
            at,
            back_ns: keyed[at - 1].1.time_ns.saturating_sub(keyed[at].1.time_ns),
        };
        self.steps = (1..keyed.len()).filter(|&i| keyed[i].0 != keyed[i - 1].0).map(step).collect();
        self.frames.extend(keyed.into_iter().map(|(_, frame)| frame));
    }

    /// \[ns\] Time of each frame since the first one. Across a step of the clock no time is known to have passed, and none
    /// is counted.
    pub fn elapsed(&self) -> impl Iterator<Item = u64> {
        let mut steps = self.steps.iter().map(|step| step.at).peekable();
        let (mut before, mut elapsed) = (self.frames.first().map_or(0, |first| first.time_ns), 0);
        self.frames.iter().enumerate().map(move |(i, frame)| {
            if steps.next_if_eq(&i).is_none() {
                elapsed += frame.time_ns.saturating_sub(before);
            }
            before = frame.time_ns;
            elapsed
        })
    }
}
