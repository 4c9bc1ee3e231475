//! The one writer of a topic.

use crate::error::{IpcError, because};
use crate::slot::{self, HEAD, Numbered, RealTime, SlotHead, SlotService, writers};
use iceoryx2::port::writer::{EntryHandleMut, EntryHandleMutError, Writer as Port, WriterCreateError};
use iceoryx2::prelude::*;
use messages::{Record, Topic};

type WriterPort = Port<RealTime, u64>;
type Head = EntryHandleMut<RealTime, u64, SlotHead>;

/// A slot that is free, its head locked.
struct Free {
    slot: SlotService,
    port: WriterPort,
    head: Head,
    /// Of the writer that it is for.
    epoch: u64,
    /// Records in it already.
    count: u64,
}

/// The first slot that no dead or living writer has.
fn free_slot(node: &Node<RealTime>, topic: &Topic, schema: &str) -> Result<Free, IpcError> {
    let mut free = None;
    let mut newest = 0;
    let slots = writers(topic.writer);
    for k in 0..slots {
        let (slot, _, head) = slot::open_to_read(node, topic, schema, k)?;
        let SlotHead { epoch, count } = *head.get();
        newest = newest.max(epoch);
        if free.is_none() {
            let locked = lock(&slot).map_err(|e| because(format!("writer of topic {}", topic.name), e))?;
            free = locked.map(|(port, head)| Free { slot, port, head, epoch: 0, count });
        }
    }
    let free = free.ok_or_else(|| IpcError::SlotsUsedUp { topic: topic.name.into(), slots })?;
    Ok(Free { epoch: newest + 1, ..free })
}

/// Locks a slot; none if a dead or living writer has it.
fn lock(slot: &SlotService) -> Result<Option<(WriterPort, Head)>, Box<dyn std::error::Error>> {
    // The only writer port is counted until a killed node is cleared away, the entries for ever.
    let port = match slot.writer_builder().create() {
        Ok(port) => port,
        Err(WriterCreateError::ExceedsMaxSupportedWriters) => return Ok(None),
        Err(e) => return Err(e.into()),
    };
    match port.entry::<SlotHead>(&HEAD) {
        Ok(head) => Ok(Some((port, head))),
        Err(EntryHandleMutError::HandleAlreadyExists) => Ok(None),
        Err(e) => Err(e.into()),
    }
}

/// Writes the records of one topic. The process must be the topic's writer and has one `Writer` for it.
///
/// If the process is killed between any two instructions, readers still see whole records, and the next process that
/// opens a writer goes on in a slot of its own.
pub struct Writer<T: Record> {
    // Dropped in this order: the head unlocks last, so that a slot with a free head has a free ring.
    ring: Vec<EntryHandleMut<RealTime, u64, Numbered<T>>>,
    head: Head,
    epoch: u64,
    count: u64,
    _slot: SlotService,
}

impl<T: Record> Writer<T> {
    pub(crate) fn new(node: &Node<RealTime>, topic: &Topic) -> Result<Self, IpcError> {
        let Free { slot, port, head, epoch, count } = free_slot(node, topic, &slot::schema::<T>(topic))?;
        let ring = (0..topic.depth as u64)
            .map(|k| port.entry::<Numbered<T>>(&k))
            .collect::<Result<Vec<_>, _>>()
            .map_err(|e| because(format!("writer of topic {}", topic.name), e))?;
        Ok(Self { ring, head, epoch, count, _slot: slot })
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
