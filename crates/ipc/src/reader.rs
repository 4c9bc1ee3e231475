//! Readers of a topic: the newest record, or every one of them.

use crate::error::{IpcError, because};
use crate::slot::{self, HeadEntry, Numbered, RealTime, RingEntry, SlotHead, SlotService, writers};
use iceoryx2::prelude::*;
use messages::{Record, Topic};

/// One slot as a reader sees it.
struct Slot<T: Record> {
    ring: Vec<RingEntry<T>>,
    head: HeadEntry,
    _service: SlotService,
}

impl<T: Record> Slot<T> {
    fn open(node: &Node<RealTime>, topic: &Topic, index: usize) -> Result<Self, IpcError> {
        let (service, port, head) = slot::open_to_read(node, topic, &slot::schema::<T>(topic), index)?;
        let ring = (0..topic.depth as u64)
            .map(|k| port.entry::<Numbered<T>>(&k))
            .collect::<Result<Vec<_>, _>>()
            .map_err(|e| because(format!("reader of topic {}", topic.name), e))?;
        Ok(Self { ring, head, _service: service })
    }

    /// The entry in which record `number` lies, or a later one that took its place.
    fn entry(&self, number: u64) -> &RingEntry<T> {
        &self.ring[(number % self.ring.len() as u64) as usize]
    }
}

/// Reads the records of one topic.
///
/// [`Reader::latest`] and [`Reader::newer`] look at the newest record; [`Reader::follow`] walks through all of them.
/// A reader does one or the other: they share the copy that is handed out.
pub struct Reader<T: Record> {
    slots: Vec<Slot<T>>,
    /// The slot with the highest epoch seen, and that epoch.
    slot: usize,
    epoch: u64,
    /// Number of the last record handed out of that slot.
    number: u64,
    lost: u64,
    /// Records that may still be taken in order before the newest one is taken again.
    missed: u64,
    /// Nothing followed yet.
    fresh: bool,
    held: Box<Numbered<T>>,
}

impl<T: Record> Reader<T> {
    pub(crate) fn new(node: &Node<RealTime>, topic: &Topic) -> Result<Self, IpcError> {
        let slots =
            (0..writers(topic.writer)).map(|k| Slot::open(node, topic, k)).collect::<Result<_, _>>()?;
        let held = Box::new(Numbered { number: 0, record: T::empty() });
        Ok(Self { slots, slot: 0, epoch: 0, number: 0, lost: 0, missed: 0, fresh: true, held })
    }

    /// The newest record; none before the first one was written.
    pub fn latest(&mut self) -> Option<&T> {
        self.refresh();
        self.held()
    }

    /// The newest record if it is another one than last time.
    pub fn newer(&mut self) -> Option<&T> {
        self.refresh().then_some(&self.held.record)
    }

    /// Fetches the newest record; `true` if it is another one than last time. It is then [`Reader::held`].
    pub fn refresh(&mut self) -> bool {
        let Some(count) = self.count_of_newest() else { return false };
        *self.held = *self.slots[self.slot].entry(count).get();
        self.number = self.held.number;
        true
    }

    /// The record fetched last; none before the first one.
    pub fn held(&self) -> Option<&T> {
        (self.held.number > 0).then_some(&self.held.record)
    }

    /// The next record in the order of writing; none if there is no more yet.
    ///
    /// What a reader first sees is the oldest record the ring still holds. Records overwritten before they were read
    /// are counted, see [`Reader::lost`].
    pub fn follow(&mut self) -> Option<&T> {
        let count = self.count_of_newest()?;
        let slot = &self.slots[self.slot];
        let depth = slot.ring.len() as u64;
        let mut next = self.number + 1;
        if count > self.number + depth {
            // Overtaken: go on with the oldest record that is left, and a little ahead of the writer's pen.
            next = count - depth + 1 + depth / 8;
        }
        if self.fresh {
            // What was overwritten before this reader came is not lost.
            (self.number, self.fresh) = (next - 1, false);
        }
        *self.held = *slot.entry(next).get();
        // The writer may have come round again since the head was read.
        let got = self.held.number;
        self.lost += got.saturating_sub(self.number + 1);
        self.number = got;
        Some(&self.held.record)
    }

    /// The record to act on next, once per cycle of the writer: the newest, as [`Reader::refresh`], unless this reader was
    /// stopped for more than `stall` records; then those that it missed in their order, as far as the ring still holds them.
    ///
    /// A reader that is merely too slow is not made slower: what is more than twice as far behind as it was at first is given up.
    pub fn refresh_in_order(&mut self, stall: u64) -> bool {
        let behind = self.count_of_newest().map_or(0, |count| count.saturating_sub(self.number));
        if behind <= 1 {
            self.missed = 0;
            return self.refresh();
        }
        if self.missed == 0 && behind > stall && self.number > 0 {
            self.missed = 2 * behind.min(self.slots[self.slot].ring.len() as u64);
        }
        if self.missed <= 1 {
            self.missed = 0;
            return self.refresh();
        }
        self.missed -= 1;
        self.follow().is_some()
    }

    /// Reading in order: [`Reader::refresh_in_order`] catches up on what was missed, and more waits.
    pub fn is_behind(&self) -> bool {
        self.missed > 0
    }

    /// Number of the record handed out last, from 1 with each slot that is used for the first time.
    pub fn number(&self) -> u64 {
        self.held.number
    }

    /// Records that were overwritten before [`Reader::follow`] came to them.
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// Number of records of the present writer, if it changed. A slot that stands still is left for the
    /// one of a newer writer, if there is one.
    fn count_of_newest(&mut self) -> Option<u64> {
        let count = self.slots[self.slot].head.get().count;
        // The head may still lag behind a record that was read out of the ring already.
        if self.epoch > 0 && count > self.number {
            return Some(count);
        }
        self.find_writer().then(|| self.slots[self.slot].head.get().count)
    }

    /// Goes to the slot of a newer writer that has written something; `false` if there is none.
    fn find_writer(&mut self) -> bool {
        let mut found = false;
        for (k, slot) in self.slots.iter().enumerate() {
            let SlotHead { epoch, count } = *slot.head.get();
            if epoch > self.epoch {
                // A slot that was given back goes on counting, for its new writer too.
                let seen = if k == self.slot { self.number } else { 0 };
                found = count > seen;
                (self.slot, self.epoch, self.number) = (k, epoch, seen);
            }
        }
        found
    }
}
