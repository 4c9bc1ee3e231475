//! One topic on its way into the log.

use crate::output::LogOutput;
use messages::{Header, Record, Topic};

/// Source of the records of a topic, in order.
pub trait Source<T> {
    /// The next record in the order of writing, and its number; none if there is no more yet.
    fn follow(&mut self) -> Option<(u64, &T)>;

    /// Records overwritten before they were handed out, since the beginning.
    fn lost(&self) -> u64;
}

impl<T: Record> Source<T> for ipc::Reader<T> {
    fn follow(&mut self) -> Option<(u64, &T)> {
        ipc::Reader::follow(self)?;
        Some((self.number(), self.held()?))
    }
    fn lost(&self) -> u64 {
        ipc::Reader::lost(self)
    }
}

/// A topic with its source.
pub struct Follower<T, S> {
    topic: &'static Topic,
    source: S,
    record: std::marker::PhantomData<fn() -> T>,
}

impl<T: Record, S: Source<T>> Follower<T, S> {
    /// Follows `source`.
    pub fn new(topic: &'static Topic, source: S) -> Self {
        Self { topic, source, record: std::marker::PhantomData }
    }
}

/// A [`Follower`] whose record type does not matter any more.
pub(crate) trait Follow {
    /// The topic.
    fn topic(&self) -> &'static Topic;
    /// Writes up to `most` records; returns how many, and the header of the last one.
    fn write_some(&mut self, output: &mut LogOutput, most: usize) -> (usize, Option<Header>);
    /// See [`Source::lost`].
    fn lost(&self) -> u64;
}

impl<T: Record, S: Source<T>> Follow for Follower<T, S> {
    fn topic(&self) -> &'static Topic {
        self.topic
    }

    fn write_some(&mut self, output: &mut LogOutput, most: usize) -> (usize, Option<Header>) {
        let (mut count, mut last) = (0, None);
        while count < most {
            let Some((number, record)) = self.source.follow() else { break };
            output.write(self.topic, record, number as u32);
            (count, last) = (count + 1, Some(*record.header()));
        }
        (count, last)
    }

    fn lost(&self) -> u64 {
        self.source.lost()
    }
}
