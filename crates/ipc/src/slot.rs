//! Layout of a topic in shared memory.
//!
//! A topic has [`writers`] slots; each is one blackboard with the entries
//!
//! | key | content |
//! |---|---|
//! | 0 … depth-1 | ring: record number n lies in entry n mod depth |
//! | [`HEAD`] | (epoch of the writer, records written so far) |
//!
//! A writer takes the first slot whose head it can lock and keeps it. A writer that is killed never unlocks
//! (iceoryx2 #2008); its slot stays as it was, to be read, and the next writer takes the next slot with a higher
//! epoch. Each slot is a service of its own because a blackboard admits one writer port, dead or alive.

use crate::error::{IpcError, because};
use iceoryx2::port::reader::EntryHandle;
use iceoryx2::prelude::*;
use iceoryx2::service::builder::blackboard::BlackboardOpenError;
use iceoryx2::service::port_factory::blackboard::PortFactory;
use messages::topics::schema_hash;
use messages::{Process, Record, Topic};

/// Writers that each topic of a process can have in the life of a space, killed ones included: broker and logger are started again
/// while the robot goes on, the death of another process ends the run.
pub const fn writers(process: Process) -> usize {
    match process {
        Process::Broker | Process::Logger => 16,
        _ => 4,
    }
}

/// Key of the head entry.
pub(crate) const HEAD: u64 = u64::MAX;
/// Ports of one slot.
const MAX_READERS: usize = 64;
const MAX_NODES: usize = 64;
/// Name of the attribute that carries the layout.
const SCHEMA: &str = "schema";

pub(crate) type RealTime = ipc::Service;
pub(crate) type SlotService = PortFactory<RealTime, u64>;

/// A record on its way through shared memory.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct Numbered<T> {
    /// Which record of its slot this is, from 1.
    pub(crate) number: u64,
    pub(crate) record: T,
}

// SAFETY: `Record`s are declared by `messages::record!` only: `#[repr(C)]`, `Copy`, 'static, made of numbers and arrays
// of numbers. They hold no pointer, reference or handle, so their bytes mean the same in every process.
unsafe impl<T: Record> ZeroCopySend for Numbered<T> {}

/// Progress of a slot.
#[derive(Clone, Copy, Debug, ZeroCopySend)]
#[repr(C)]
pub(crate) struct SlotHead {
    /// Which writer of the topic this is, from 1; 0: the slot was never written.
    pub(crate) epoch: u64,
    /// Records written into the slot so far.
    pub(crate) count: u64,
}

pub(crate) type ReaderPort = iceoryx2::port::reader::Reader<RealTime, u64>;
pub(crate) type RingEntry<T> = EntryHandle<RealTime, u64, Numbered<T>>;
pub(crate) type HeadEntry = EntryHandle<RealTime, u64, SlotHead>;

fn name(topic: &Topic, slot: usize) -> Result<ServiceName, IpcError> {
    format!("topic/{}/{slot}", topic.name).as_str().try_into().map_err(|e| because(topic.name, e))
}

/// Name, size and layout of the record: what two programs must agree on.
pub(crate) fn schema<T: Record>(topic: &Topic) -> String {
    format!("{} {:016x} depth {}", T::NAME, schema_hash::<T>(), topic.depth)
}

/// Size of all slots of a topic in shared memory \[B\], rounded up.
pub(crate) fn bytes<T: Record>(topic: &Topic) -> u64 {
    (writers(topic.writer) * (topic.depth * (2 * size_of::<Numbered<T>>() + 256) + 16384)) as u64
}

/// Makes slot `slot` of a topic.
pub(crate) fn create<T: Record>(
    node: &Node<RealTime>,
    topic: &Topic,
    slot: usize,
) -> Result<SlotService, IpcError> {
    let what = || format!("topic {}", topic.name);
    let attributes = AttributeSpecifier::new()
        .define(&SCHEMA.try_into().map_err(|e| because(what(), e))?, &attribute(&schema::<T>(topic))?)
        .map_err(|e| because(what(), e))?;
    let mut creator = node
        .service_builder(&name(topic, slot)?)
        .blackboard_creator::<u64>()
        .max_readers(MAX_READERS)
        .max_nodes(MAX_NODES)
        .add(HEAD, SlotHead { epoch: 0, count: 0 });
    for k in 0..topic.depth as u64 {
        creator = creator.add(k, Numbered { number: 0, record: T::empty() });
    }
    creator.create_with_attributes(&attributes).map_err(|e| because(what(), e))
}

/// Opens slot `slot` of a topic, if its record looks here (`schema`) as it looked to who made it.
///
/// Without a type parameter, as whatever else can be: what is generic is compiled again in each program that uses it, and much
/// of iceoryx2 with it.
pub(crate) fn open(
    node: &Node<RealTime>,
    topic: &Topic,
    schema: &str,
    slot: usize,
) -> Result<SlotService, IpcError> {
    let what = || format!("topic {}", topic.name);
    let required = AttributeVerifier::new()
        .require(&SCHEMA.try_into().map_err(|e| because(what(), e))?, &attribute(schema)?)
        .map_err(|e| because(what(), e))?;
    node.service_builder(&name(topic, slot)?).blackboard_opener::<u64>().open_with_attributes(&required).map_err(
        |e| match e {
            BlackboardOpenError::IncompatibleAttributes => IpcError::Schema { topic: topic.name.into(), here: schema.into() },
            BlackboardOpenError::DoesNotExist => IpcError::Other(format!(
                "topic {} does not exist in this run: start the supervisor (gangwerk run) first, from this same build",
                topic.name
            )),
            e => because(what(), e),
        },
    )
}

/// Opens slot `slot` of a topic to be read: its port and its head.
pub(crate) fn open_to_read(
    node: &Node<RealTime>,
    topic: &Topic,
    schema: &str,
    slot: usize,
) -> Result<(SlotService, ReaderPort, HeadEntry), IpcError> {
    let what = || format!("reader of topic {}", topic.name);
    let service = open(node, topic, schema, slot)?;
    let port = service.reader_builder().create().map_err(|e| because(what(), e))?;
    let head = port.entry::<SlotHead>(&HEAD).map_err(|e| because(what(), e))?;
    Ok((service, port, head))
}

fn attribute(text: &str) -> Result<iceoryx2::service::attribute::AttributeValue, IpcError> {
    text.try_into().map_err(|e| because(text, e))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::place::RunPlace;
    use messages::topics::EVENTS_PLANNER;
    use messages::{Event, Header};

    messages::record! {
        /// As `Event`, with two fields of the same size exchanged.
        record Swapped {
            /// When.
            header: Header,
            /// \[1\] First there, second here.
            detail: u64,
            /// \[1\] Second there, first here.
            code: u64,
        }
    }

    #[test]
    fn another_layout_of_the_same_size_is_refused() {
        let dir = std::env::temp_dir().join(format!("gangwerk-ipc-{}-schema", std::process::id()));
        std::fs::create_dir_all(&dir).unwrap();
        let place = RunPlace::of(&dir).unwrap();
        place.make_root().unwrap();
        let node = crate::space::node::<RealTime>(&place, "test").unwrap();
        let made = create::<Event>(&node, &EVENTS_PLANNER, 0).unwrap();
        assert_eq!(size_of::<Event>(), size_of::<Swapped>());
        let open = |schema: String| open(&node, &EVENTS_PLANNER, &schema, 0);
        assert!(open(schema::<Event>(&EVENTS_PLANNER)).is_ok());
        let error = open(schema::<Swapped>(&EVENTS_PLANNER)).err().unwrap();
        assert!(matches!(&error, IpcError::Schema { topic, .. } if topic == "events/planner"), "{error}");
        assert!(error.to_string().contains("start all processes from one build"));
        drop((made, node));
        place.wipe().unwrap();
        std::fs::remove_dir_all(dir).unwrap();
    }
}
