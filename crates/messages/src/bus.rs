//! `bus_tx` and `bus_rx`: the frames of one cycle on the simulated field bus.

use crate::{Header, record};

/// Room for frames in one cycle of the simulated bus.
pub const MAX_FRAMES: usize = 32;

record! {
    /// One frame: identifier and up to 64 bytes, as on CAN FD.
    part Frame {
        /// \[1\] Identifier.
        id: u32,
        /// \[1\] @range 0..64 Number of bytes in use.
        len: u32,
        /// Payload.
        data: [u8; 64],
    }
}

record! {
    /// All frames that one side of the simulated bus sent in one cycle.
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

    /// Appends a frame; `false` if the cycle is full or the payload longer than 64 bytes.
    pub fn push(&mut self, id: u32, payload: &[u8]) -> bool {
        let i = self.count as usize;
        if i >= MAX_FRAMES || payload.len() > 64 {
            return false;
        }
        self.frames[i].id = id;
        self.frames[i].len = payload.len() as u32;
        self.frames[i].data[..payload.len()].copy_from_slice(payload);
        self.frames[i].data[payload.len()..].fill(0);
        self.count += 1;
        true
    }
}
