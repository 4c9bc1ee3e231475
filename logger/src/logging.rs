//! All topics on their way into one log.

use crate::follow::{Follow, Follower, Source};
use crate::output::LogOutput;
use messages::topics::{EVENTS_LOGGER, SENSORS};
use messages::{Detail, Event, EventCode, Header, Record};

/// Records of one topic in a row: small, so that the file stays roughly in the order of time.
const IN_A_ROW: usize = 8;

/// Rounds over all topics after which a pass ends even if writers are faster than the log: an eighth of a second, in which a logger
/// with a tenth of the time that it needs still shows within 2 s that it lives.
const MOST_ROUNDS: usize = 16;

/// Outcome of a pass over all topics.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pass {
    /// Records handled.
    pub records: u64,
    /// The log holds everything up to this header of `sensors`; none if the pass ended before the rings were empty, or
    /// nothing was measured yet.
    pub caught_up: Option<Header>,
    /// The newest `sensors` in the log, whether or not more of them wait.
    pub newest: Option<Header>,
    /// Losses noticed in this pass, as written to the log.
    pub lost: Option<Event>,
}

/// Follows every source and writes it all to one output.
pub struct Logging {
    followers: Vec<Box<dyn Follow>>,
    output: LogOutput,
    newest: Option<Header>,
    lost: u64,
}

impl Logging {
    /// Nothing to follow yet.
    pub fn new(output: LogOutput) -> Self {
        Self { followers: Vec::new(), output, newest: None, lost: 0 }
    }

    /// Also follows this topic.
    pub fn follow<T: Record, S: Source<T> + 'static>(&mut self, follower: Follower<T, S>) {
        self.followers.push(Box::new(follower));
    }

    /// The log.
    pub fn output(&mut self) -> &mut LogOutput {
        &mut self.output
    }

    /// Records lost since the beginning: overwritten before they were read, or not written because the disk failed.
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// Records that are missing from the log at this moment, told in it or not.
    pub fn missing(&self) -> u64 {
        self.followers.iter().map(|f| f.lost()).sum::<u64>() + self.output.dropped()
    }

    /// Writes what has come since the last pass.
    pub fn pass(&mut self) -> Pass {
        let mut pass = Pass::default();
        let mut empty = false;
        for _ in 0..MOST_ROUNDS {
            let records = self.round();
            pass.records += records;
            empty = records == 0;
            if empty {
                break;
            }
        }
        pass.newest = self.newest;
        pass.caught_up = self.newest.filter(|_| empty);
        pass.lost = self.note_losses();
        pass
    }

    /// A few records of every topic; returns how many.
    fn round(&mut self) -> u64 {
        let mut records = 0;
        for follower in &mut self.followers {
            let (count, last) = follower.write_some(&mut self.output, IN_A_ROW);
            records += count as u64;
            if follower.topic().name == SENSORS.name {
                self.newest = last.or(self.newest);
            }
        }
        records
    }

    /// Writes how many records were lost since the last time, if any were.
    fn note_losses(&mut self) -> Option<Event> {
        let lost = self.missing();
        // While there is no file the loss goes on: it is noted when writing works again.
        if lost == self.lost || !self.output.is_writing() {
            return None;
        }
        let header = self.newest.unwrap_or(Event::default().header);
        let event = Event::new(header, EventCode::LogDropped, Detail::Count(lost - self.lost));
        self.lost = lost;
        self.output.write(&EVENTS_LOGGER, &event, 0);
        Some(event)
    }
}
