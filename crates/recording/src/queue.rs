//! Messages on their way into the file, in the order of time: topics are read one after the other, and the file is to be
//! read from its beginning to its end.

use std::collections::BTreeMap;

use crate::robot::WallClock;
use crate::time::LogTime;

/// \[ns\] Tolerated lag of topics behind each other.
const HORIZON: u64 = 100_000_000;

/// One message.
#[derive(Debug)]
pub(crate) struct QueuedMessage {
    /// Index of its channel.
    pub(crate) channel: usize,
    /// Number on its channel.
    pub(crate) sequence: u32,
    /// CDR.
    pub(crate) payload: Vec<u8>,
}

/// Waiting messages.
#[derive(Debug, Default)]
pub(crate) struct MessageQueue {
    time: LogTime,
    /// By time of the log \[ns\], then as they came.
    waiting: BTreeMap<(u64, u64), QueuedMessage>,
    /// Written before the first bus cycle, whose time is theirs.
    early: Vec<QueuedMessage>,
    count: u64,
}

impl MessageQueue {
    pub(crate) fn new(clock: Option<WallClock>) -> Self {
        Self { time: LogTime::new(clock), ..Self::default() }
    }

    /// Adds a message of this stamp. In real time one without a stamp is of the newest cycle, or of the first one to come.
    pub(crate) fn add(&mut self, stamp_ns: u64, message: QueuedMessage) {
        self.time.hear(stamp_ns);
        if !self.time.has_begun() {
            return self.early.push(message);
        }
        self.put_early();
        self.put(stamp_ns, message);
    }

    fn put_early(&mut self) {
        std::mem::take(&mut self.early).into_iter().for_each(|early| self.put(0, early));
    }

    fn put(&mut self, stamp_ns: u64, message: QueuedMessage) {
        let time = self.time.next(message.channel, stamp_ns);
        self.waiting.insert((time, self.count), message);
        self.count += 1;
    }

    /// The next message that none can come before any more, and its time \[ns\].
    pub(crate) fn next(&mut self) -> Option<(u64, QueuedMessage)> {
        let until = self.time.newest().saturating_sub(HORIZON);
        let entry = self.waiting.first_entry()?;
        let time = entry.key().0;
        (time < until).then(|| (time, entry.remove()))
    }

    /// The next message, whatever may still come.
    pub(crate) fn drain(&mut self) -> Option<(u64, QueuedMessage)> {
        self.waiting.pop_first().map(|((time, _), message)| (time, message))
    }

    /// The same at the end of a log, also of a run that never began a cycle.
    pub(crate) fn end(&mut self) -> Option<(u64, QueuedMessage)> {
        self.put_early();
        self.drain()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(channel: usize, sequence: u32) -> QueuedMessage {
        QueuedMessage { channel, sequence, payload: Vec::new() }
    }

    fn all(queue: &mut MessageQueue) -> Vec<(u64, usize, u32)> {
        std::iter::from_fn(|| queue.end()).map(|(time, m)| (time, m.channel, m.sequence)).collect()
    }

    #[test]
    fn messages_come_out_by_time_and_each_channel_in_its_order() {
        let mut queue = MessageQueue::new(None);
        for (channel, stamp) in [(0, 10), (0, 20), (1, 10), (1, 15), (0, 0), (1, 30)] {
            queue.add(stamp, message(channel, stamp as u32));
        }
        let expected = [(10, 0, 10), (10, 1, 10), (15, 1, 15), (20, 0, 20), (20, 0, 0), (30, 1, 30)];
        assert_eq!(all(&mut queue), expected);
    }

    /// Records without a stamp made logs begin in 1970.
    #[test]
    fn in_real_time_no_message_has_the_time_zero() {
        let clock = WallClock { unix_ns: 5000, monotonic_ns: 1000, host: String::new() };
        let mut queue = MessageQueue::new(Some(clock));
        for (channel, stamp) in [(0, 0), (1, 0), (0, 1200), (1, 0), (0, 1300), (1, 0)] {
            queue.add(stamp, message(channel, stamp as u32));
        }
        let times: Vec<u64> = all(&mut queue).iter().map(|m| m.0).collect();
        assert_eq!(times, [5200, 5200, 5200, 5200, 5300, 5300]);
    }

    #[test]
    fn a_message_waits_until_none_can_come_before_it() {
        let mut queue = MessageQueue::new(None);
        queue.add(1, message(0, 1));
        queue.add(HORIZON, message(0, 2));
        assert!(queue.next().is_none());
        queue.add(HORIZON + 2, message(0, 3));
        assert_eq!(queue.next().map(|(time, _)| time), Some(1));
        assert!(queue.next().is_none());
    }
}
