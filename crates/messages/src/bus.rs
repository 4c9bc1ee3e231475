//! `bus_tx` and `bus_rx`: the frames of one cycle on the field bus.

use crate::{Header, record};

/// Room for frames in one cycle.
pub const MAX_FRAMES: usize = 128;
/// In an identifier, as in Linux's `can_id`: the frame tells of an error on its line.
pub const ERROR_FLAG: u32 = 0x2000_0000;

record! {
    /// One frame, as on CAN FD.
    part Frame {
        /// \[1\] Line it is on: index of a local controller.
        line: u32,
        /// \[1\] Identifier with flags, as in Linux's `can_id`.
        id: u32,
        /// \[1\] @range 0..64 Number of bytes in use.
        len: u32,
        /// Payload.
        data: [u8; 64],
    }
}

record! {
    /// All frames that one side of the bus sent in one cycle.
    record BusFrames {
        /// Tick of the cycle.
        header: Header,
        /// \[1\] Number of frames in use.
        count: u64,
        /// The frames, in the order they were sent.
        frames: [Frame; MAX_FRAMES],
    }
}

impl BusFrames {
    /// The frames in use.
    pub fn as_slice(&self) -> &[Frame] {
        &self.frames[..(self.count as usize).min(MAX_FRAMES)]
    }

    /// Appends a frame; `false` if the cycle is full.
    pub fn push(&mut self, frame: &Frame) -> bool {
        match self.append() {
            Some(room) => {
                *room = *frame;
                true
            }
            None => false,
        }
    }

    /// Room for one more frame; none if the cycle is full.
    pub fn append(&mut self) -> Option<&mut Frame> {
        let room = self.frames.get_mut(self.count as usize)?;
        self.count += 1;
        Some(room)
    }
}
