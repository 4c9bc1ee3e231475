//! `bus_tx` and `bus_rx`: the frames of one cycle on the field bus.

use crate::record::{Field, Read, Record, Visit};
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

/// All frames that one side of the bus sent in one cycle. In the log it is as long as it has frames.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BusFrames {
    /// Tick of the cycle.
    pub header: Header,
    /// \[1\] Number of frames in use.
    pub count: u64,
    /// The frames, in the order they were sent.
    pub frames: [Frame; MAX_FRAMES],
}

impl Default for BusFrames {
    fn default() -> Self {
        Self { header: Header::default(), count: 0, frames: [Frame::default(); MAX_FRAMES] }
    }
}

impl Record for BusFrames {
    const NAME: &'static str = "BusFrames";
    fn empty() -> Self {
        Self::default()
    }
    fn header(&self) -> &Header {
        &self.header
    }
    fn header_mut(&mut self) -> &mut Header {
        &mut self.header
    }
}

impl Field for BusFrames {
    fn type_name() -> String {
        Self::NAME.into()
    }
    fn describe(define: &mut dyn FnMut(&'static str, Vec<(String, &'static str)>)) {
        Header::describe(define);
        Frame::describe(define);
        let frames = format!("{}[<={MAX_FRAMES}]", Frame::type_name());
        define(Self::NAME, vec![(Header::type_name(), "header"), (frames, "frames")]);
    }
    fn visit(&self, visit: &mut dyn Visit) {
        visit.field("header");
        self.header.visit(visit);
        visit.end();
        visit.field("frames");
        visit.sequence(self.as_slice().len());
        self.as_slice().iter().for_each(|frame| frame.visit(visit));
        visit.end();
        visit.end();
    }
    fn read(read: &mut dyn Read) -> Self {
        let mut value = Self { header: Header::read(read), ..Self::default() };
        // More than there is room for is read as too few: bytes are left over, and the payload is refused.
        for _ in 0..(read.u32() as usize).min(MAX_FRAMES) {
            value.push(&Frame::read(read));
        }
        value
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
