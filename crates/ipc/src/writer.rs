//! The one writer of a topic.

use crate::error::{IpcError, because};
use crate::slot::{self, HEAD, Numbered, RealTime, SLOTS, SlotHead, SlotService};
use iceoryx2::port::writer::{EntryHandleMut, EntryHandleMutError, WriterCreateError};
use iceoryx2::prelude::*;
use messages::{Record, Topic};

/// Writes the records of one topic. The process must be the topic's writer and has one `Writer` for it.
///
/// If the process is killed between any two instructions, readers still see whole records, and the next process that
/// opens a writer goes on in a slot of its own.
pub struct Writer<T: Record> {
    // Dropped in this order: the head unlocks last, so that a slot with a free head has a free ring.
    ring: Vec<EntryHandleMut<RealTime, u64, Numbered<T>>>,
    head: EntryHandleMut<RealTime, u64, SlotHead>,
    epoch: u64,
    count: u64,
    _slot: SlotService,
}

impl<T: Record> Writer<T> {
    pub(crate) fn new(node: &Node<RealTime>, topic: &Topic) -> Result<Self, IpcError> {
        let what = || format!("writer of topic {}", topic.name);
        let mut free = None;
        let mut epoch = 0;
        for k in 0..SLOTS {
            let service = slot::open::<T>(node, topic, k)?;
            let reader = service.reader_builder().create().map_err(|e| because(what(), e))?;
            let seen = *reader.entry::<SlotHead>(&HEAD).map_err(|e| because(what(), e))?.get();
            epoch = epoch.max(seen.epoch);
            if free.is_none() {
                free = Self::lock(service, topic, seen.count)?;
            }
        }
        let mut writer =
            free.ok_or_else(|| IpcError::SlotsUsedUp { topic: topic.name.into(), slots: SLOTS })?;
        writer.epoch = epoch + 1;
        Ok(writer)
    }

    /// Locks a slot; none if a dead or living writer has it.
    fn lock(slot: SlotService, topic: &Topic, count: u64) -> Result<Option<Self>, IpcError> {
        let what = || format!("writer of topic {}", topic.name);
        // The only writer port is counted until a killed node is cleared away, the entries for ever.
        let port = match slot.writer_builder().create() {
            Ok(port) => port,
            Err(WriterCreateError::ExceedsMaxSupportedWriters) => return Ok(None),
            Err(e) => return Err(because(what(), e)),
        };
        let head = match port.entry::<SlotHead>(&HEAD) {
            Ok(head) => head,
            Err(EntryHandleMutError::HandleAlreadyExists) => return Ok(None),
            Err(e) => return Err(because(what(), e)),
        };
        let ring = (0..topic.depth as u64)
            .map(|k| port.entry::<Numbered<T>>(&k))
            .collect::<Result<Vec<_>, _>>()
            .map_err(|e| because(what(), e))?;
        Ok(Some(Self { ring, head, epoch: 0, count, _slot: slot }))
    }

    /// Which writer of this topic it is, counted from 1 in the life of the space.
    pub fn epoch(&self) -> u64 {
        self.epoch
    }

    /// Publishes a record; fills in its epoch.
    pub fn write(&mut self, record: &T) {
        self.count += 1;
        let mut numbered = Numbered { number: self.count, record: *record };
        numbered.record.header_mut().epoch = self.epoch;
        self.ring[(self.count % self.ring.len() as u64) as usize].update_with_copy(numbered);
        self.head.update_with_copy(SlotHead { epoch: self.epoch, count: self.count });
    }
}
