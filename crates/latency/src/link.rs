//! What a way between two processes is. Every way carries the same number of bytes, those of a bus record; the first eight are
//! the stamp.

use std::time::Duration;

use messages::BusFrames;
use realtime::clock;

/// Bytes of one message.
pub const SIZE: usize = size_of::<BusFrames>();
/// Timeout for the other end.
pub const LIMIT: Duration = Duration::from_secs(2);

/// Which of the two processes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LinkEnd {
    /// It makes the way, asks, and measures.
    Near,
    /// It answers.
    Far,
}

/// One end of a way in both directions.
pub trait Link {
    /// Hands over a message with this stamp.
    ///
    /// # Errors
    /// The way is closed.
    fn send(&mut self, stamp: u64) -> Result<(), String>;
    /// Waits for the next message from the other end: its stamp.
    ///
    /// # Errors
    /// Nothing came in time, or the way is closed.
    fn receive(&mut self) -> Result<u64, String>;
}

/// A way, or why it is not to be had.
pub type Opened = Result<Box<dyn Link>, String>;

/// `e` as text.
pub(crate) fn text(e: impl std::fmt::Display) -> String {
    e.to_string()
}

/// A message with this stamp.
pub(crate) fn message(stamp: u64) -> [u8; SIZE] {
    let mut bytes = [0; SIZE];
    bytes[..8].copy_from_slice(&stamp.to_le_bytes());
    bytes
}

/// The stamp of a message.
pub(crate) fn stamp(bytes: &[u8]) -> u64 {
    bytes.first_chunk().map_or(0, |b| u64::from_le_bytes(*b))
}

/// Looks until there is something.
///
/// # Errors
/// There was nothing for 2 s.
pub fn spin<T>(mut look: impl FnMut() -> Option<T>) -> Result<T, String> {
    let until = clock::now() + LIMIT.as_nanos() as u64;
    loop {
        if let Some(found) = look() {
            return Ok(found);
        }
        if clock::now() > until {
            return Err(silent());
        }
    }
}

pub(crate) fn silent() -> String {
    format!("the other process was silent for {} s", LIMIT.as_secs())
}
