//! Subscribers: pages and viewers that are there, each with a queue of its own; one that does not read loses frames, and nobody
//! waits for it.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use axum::body::Bytes;
use axum::extract::ws::{CloseFrame, Message, Utf8Bytes};
use realtime::clock::SECOND;
use tokio::sync::mpsc::error::TrySendError;
use tokio::sync::{Notify, mpsc};

/// Messages that wait for one page at most.
pub const ROOM: usize = 160;
/// Of them, those that no frame takes: texts must not be lost.
const FOR_TEXT: usize = 128;
/// Time in which a page may lose frames until it is left alone \[ns\].
pub const PATIENCE: u64 = 2 * SECOND;
/// Bytes in front of every frame.
const HEAD: usize = 16;

/// Kinds of frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum FrameKind {
    /// State of the robot.
    State = 1,
    /// Samples of plotted fields.
    Samples = 2,
    /// State of the other log of a replay.
    OtherState = 3,
    /// Samples of the other log.
    OtherSamples = 4,
}

/// The way to one page: its queue, and what it has lost.
#[derive(Clone, Debug)]
pub struct Outbox {
    queue: mpsc::Sender<Message>,
    lost: Arc<AtomicU32>,
    end: Arc<Notify>,
}

impl Outbox {
    /// A queue, and its end from which a socket is fed.
    pub fn new() -> (Self, mpsc::Receiver<Message>) {
        Self::with_room(ROOM)
    }

    /// The same for so many messages, more than the texts that have their places among them.
    pub fn with_room(room: usize) -> (Self, mpsc::Receiver<Message>) {
        let (queue, fed) = mpsc::channel(room);
        (Self { queue, lost: Arc::default(), end: Arc::default() }, fed)
    }

    /// Puts a text into the queue; false: it is full, or the page is gone.
    pub fn text(&self, text: impl Into<Utf8Bytes>) -> bool {
        self.queue.try_send(Message::Text(text.into())).is_ok()
    }

    /// The last message: why the connection ends; false: there is no room.
    pub fn close(&self, why: CloseFrame) -> bool {
        self.queue.try_send(Message::Close(Some(why))).is_ok()
    }

    /// Until the observer has let go of this page.
    pub async fn ended(&self) {
        self.end.notified().await;
    }

    /// Bytes of a frame.
    fn frame(&self, kind: FrameKind, tick: u64, content: &[u8]) -> Vec<u8> {
        let lost = self.lost.load(Relaxed);
        let mut bytes = Vec::with_capacity(HEAD + content.len());
        bytes.extend([kind as u8, 0, 0, 0]);
        bytes.extend(lost.to_le_bytes());
        bytes.extend(tick.to_le_bytes());
        bytes.extend(content);
        bytes
    }

    /// Puts a message of bytes into the queue; false: there is no room, and it is counted.
    fn bytes(&self, bytes: Vec<u8>) -> bool {
        let sent = self.queue.capacity() > FOR_TEXT
            && self.queue.try_send(Message::Binary(Bytes::from(bytes))).is_ok();
        if !sent {
            self.lost.fetch_add(1, Relaxed);
        }
        sent
    }
}

/// A page or viewer as the thread that serves it sees it.
#[derive(Debug)]
pub struct Subscriber<P> {
    /// Number of the page.
    pub number: u64,
    outbox: Outbox,
    /// Since when it loses frames \[ns\]; none: it does not.
    losing: Option<u64>,
    gone: bool,
    /// Its plot.
    pub plot: P,
}

impl<P: Default> Subscriber<P> {
    /// A page that has just come.
    pub fn new(number: u64, outbox: Outbox) -> Self {
        Self { number, outbox, losing: None, gone: false, plot: P::default() }
    }

    /// A text for it; a page that has no room for one is not served any more.
    pub fn text(&mut self, text: &Utf8Bytes) {
        // One that misses a text shows something wrong for ever: it comes again and asks anew.
        self.gone |= !self.outbox.text(text.clone());
    }

    /// A frame for it, if it has room.
    pub fn frame(&mut self, kind: FrameKind, tick: u64, content: &[u8], now: u64) {
        self.bytes(self.outbox.frame(kind, tick, content), now);
    }

    /// A message of bytes for it, if it has room; false: it is lost.
    pub fn bytes(&mut self, bytes: Vec<u8>, now: u64) -> bool {
        let sent = self.outbox.bytes(bytes);
        if sent {
            self.losing = None;
        } else {
            let since = *self.losing.get_or_insert(now);
            self.gone |= now > since + PATIENCE;
        }
        sent
    }

    /// True if it has room for some frames: who sends no faster than that loses none.
    pub fn has_room(&self) -> bool {
        self.outbox.queue.capacity() > FOR_TEXT + (ROOM - FOR_TEXT) / 2
    }

    /// True if it is left alone: its connection ends.
    pub fn is_gone(&self) -> bool {
        self.gone || matches!(self.outbox.queue.try_reserve(), Err(TrySendError::Closed(())))
    }
}

impl<P> Drop for Subscriber<P> {
    fn drop(&mut self) {
        // Kept for a socket that does not listen yet.
        self.outbox.end.notify_one();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A page that reads is told what it has lost; one that does not is left after its time; one without room for text at once.
    #[test]
    fn who_does_not_read_loses_frames_and_then_its_connection() {
        let (outbox, mut fed) = Outbox::new();
        let mut subscriber: Subscriber<()> = Subscriber::new(1, outbox);
        for _ in 0..ROOM - FOR_TEXT + 3 {
            subscriber.frame(FrameKind::State, 7, &[9], 1000);
        }
        assert!(!subscriber.is_gone(), "it may be slow for a while");
        subscriber.frame(FrameKind::State, 7, &[9], 1000 + PATIENCE);
        assert!(!subscriber.is_gone());
        let Ok(Message::Binary(first)) = fed.try_recv() else { panic!("a frame") };
        assert_eq!(first[..], [1, 0, 0, 0, 0, 0, 0, 0, 7, 0, 0, 0, 0, 0, 0, 0, 9]);
        while fed.try_recv().is_ok() {}
        subscriber.frame(FrameKind::Samples, 8, &[], 1001 + PATIENCE);
        let Ok(Message::Binary(next)) = fed.try_recv() else { panic!("a frame") };
        assert_eq!((next[0], next[4]), (2, 4), "kind, and frames lost until now");
        for now in [0, PATIENCE, PATIENCE + 1] {
            (0..ROOM).for_each(|_| subscriber.frame(FrameKind::State, 9, &[], 5000 + now));
        }
        assert!(subscriber.is_gone());
        // Texts are never left out.
        let (outbox, _fed) = Outbox::new();
        let mut full: Subscriber<()> = Subscriber::new(2, outbox);
        (0..ROOM).for_each(|_| full.text(&"news".into()));
        assert!(!full.is_gone() || ROOM == 0);
        full.text(&"one too many".into());
        assert!(full.is_gone());
    }

    #[test]
    fn a_page_that_is_closed_is_gone() {
        let (outbox, fed) = Outbox::new();
        let subscriber: Subscriber<()> = Subscriber::new(1, outbox);
        assert!(!subscriber.is_gone());
        drop(fed);
        assert!(subscriber.is_gone());
    }
}
