//! Records of an [`IndexedLog`] at an instant. Time is the tick of `sensors`, which is the clock of all others.

use messages::topics::SENSORS;
use messages::{Record, Topic};

use crate::cdr::decode;
use crate::error::RecordingError;
use crate::index::IndexedLog;

/// Chunks that are looked through for the newest record of a topic: some seconds of a walk, of topics that are written when
/// there is something to say as many as hold one.
const BACK: usize = 64;

impl IndexedLog {
    /// First and last tick of `sensors`; none: there are no such records.
    ///
    /// # Errors
    /// The file is damaged.
    pub fn span(&mut self) -> Result<Option<(u64, u64)>, RecordingError> {
        let clock: Vec<usize> = (0..self.len()).filter(|&chunk| self.holds(chunk, &SENSORS)).collect();
        let mut ends = [None; 2];
        for &chunk in &clock {
            ends[0] = self.chunk(chunk)?.payloads(&SENSORS).map(|(tick, _)| tick).min();
            if ends[0].is_some() {
                break;
            }
        }
        for &chunk in clock.iter().rev() {
            ends[1] = self.chunk(chunk)?.payloads(&SENSORS).map(|(tick, _)| tick).max();
            if ends[1].is_some() {
                break;
            }
        }
        Ok(ends[0].zip(ends[1]))
    }

    /// The chunk in which the cycle of `tick` begins: the last one whose first tick is not later, else the first one.
    pub fn chunk_at(&mut self, tick: u64) -> usize {
        let (mut low, mut high) = (0, self.len());
        // Invariant: what is before `low` begins at `tick` or earlier, what is from `high` on later.
        while low < high {
            let middle = low.midpoint(high);
            // A chunk without the clock goes with the next one that has it.
            let with = (middle..high).find_map(|chunk| Some((chunk, self.first_tick(chunk)?)));
            match with {
                Some((chunk, first)) if first <= tick => low = chunk + 1,
                _ => high = middle,
            }
        }
        low.saturating_sub(1)
    }

    /// First tick of a chunk; none: it has no clock, or cannot be read, which is told to who wants to see it and not to who is
    /// looking for another one.
    fn first_tick(&mut self, chunk: usize) -> Option<u64> {
        if !self.holds(chunk, &SENSORS) {
            return None;
        }
        if let Some(first) = self.firsts.get(&chunk) {
            return *first;
        }
        let read = self.chunk(chunk).ok();
        let first = read.and_then(|chunk| chunk.payloads(&SENSORS).next().map(|(tick, _)| tick));
        self.firsts.insert(chunk, first);
        first
    }

    /// Newest record of a topic that `fits` and is not later than `tick`; none: there is none near it.
    ///
    /// # Errors
    /// The file is damaged.
    pub fn newest<T: Record>(
        &mut self,
        topic: &Topic,
        tick: u64,
        fits: impl Fn(&T) -> bool,
    ) -> Result<Option<T>, RecordingError> {
        // What belongs to the last cycle of a chunk may stand in the next one.
        let last = (self.chunk_at(tick) + 1).min(self.len().saturating_sub(1));
        let with: Vec<usize> =
            (0..=last).rev().filter(|&chunk| self.holds(chunk, topic)).take(BACK).collect();
        for chunk in with {
            let chunk = self.chunk(chunk)?;
            let mut known = chunk.payloads(topic).rev().filter(|(other, _)| *other <= tick);
            if let Some(record) = known.find_map(|(_, payload)| decode::<T>(payload).filter(&fits)) {
                return Ok(Some(record));
            }
        }
        Ok(None)
    }
}
