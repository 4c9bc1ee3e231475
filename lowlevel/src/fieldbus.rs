//! The far end of the bus.

use messages::BusFrames;

/// A field bus that exchanges the frames of one cycle. Implementations neither allocate nor block in these calls.
pub trait Fieldbus {
    /// Sends the frames of this cycle to the drives.
    fn send(&mut self, frames: &BusFrames);

    /// The newest frames from the drives that were not taken yet.
    fn receive(&mut self) -> Option<&BusFrames>;
}
