//! iceoryx2 without anything around it, with the same payload.

use std::path::Path;

use iceoryx2::port::listener::Listener;
use iceoryx2::port::notifier::Notifier;
use iceoryx2::port::publisher::Publisher;
use iceoryx2::port::reader::EntryHandle;
use iceoryx2::port::subscriber::Subscriber;
use iceoryx2::port::writer::EntryHandleMut;
use iceoryx2::prelude::*;

use crate::link::{LIMIT, Link, LinkEnd, Opened, SIZE, message, spin, stamp, text};

type Plane = ipc::Service;
type Payload = [u8; SIZE];

/// A node of its own, with its files in `dir`.
fn node(dir: &Path) -> Result<Node<Plane>, String> {
    set_log_level(LogLevel::Error);
    let mut config = Config::default();
    let bytes = |path: &Path| path.as_os_str().as_encoded_bytes().to_owned();
    let name = dir.file_name().map(Path::new).ok_or("a directory with a name")?;
    config.global.set_root_path(&iceoryx2::prelude::Path::new(&bytes(dir)).map_err(text)?);
    config.global.prefix = FileName::new(&bytes(name)).map_err(text)?;
    let builder = NodeBuilder::new().signal_handling_mode(SignalHandlingMode::Disabled);
    builder.config(&config).create::<Plane>().map_err(text)
}

/// Removes what nodes with their files in `dir` left in shared memory, when both ends are gone.
pub fn clear(dir: &Path) {
    let Some(prefix) = dir.file_name().and_then(|name| name.to_str()) else { return };
    for entry in std::fs::read_dir("/dev/shm").into_iter().flatten().flatten() {
        if entry.file_name().to_str().is_some_and(|name| name.starts_with(prefix)) {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

fn name(name: &str) -> Result<ServiceName, String> {
    name.try_into().map_err(text)
}

/// Names of what this end writes and reads.
fn ways(end: LinkEnd) -> [&'static str; 2] {
    if end == LinkEnd::Near { ["out", "back"] } else { ["back", "out"] }
}

struct Blackboard {
    output: EntryHandleMut<Plane, u64, Payload>,
    input: EntryHandle<Plane, u64, Payload>,
    seen: u64,
    _node: Node<Plane>,
}

/// One entry of a blackboard in each direction.
pub fn blackboard(dir: &Path, end: LinkEnd) -> Opened {
    let node = node(dir)?;
    let service = |way: &str| {
        let builder = node.service_builder(&name(way)?);
        if end == LinkEnd::Near {
            return builder.blackboard_creator::<u64>().add(0, message(0)).create().map_err(text);
        }
        builder.blackboard_opener::<u64>().open().map_err(text)
    };
    let [out, back] = ways(end).map(service);
    let output = out?.writer_builder().create().map_err(text)?.entry::<Payload>(&0).map_err(text)?;
    let input = back?.reader_builder().create().map_err(text)?.entry::<Payload>(&0).map_err(text)?;
    Ok(Box::new(Blackboard { output, input, seen: 0, _node: node }))
}

impl Link for Blackboard {
    fn send(&mut self, stamp: u64) -> Result<(), String> {
        self.output.update_with_copy(message(stamp));
        Ok(())
    }

    fn receive(&mut self) -> Result<u64, String> {
        let mut known = self.input.get();
        let Self { input, seen, .. } = self;
        let found = spin(|| {
            let new = stamp(&*known) != *seen;
            if !new && !input.is_up_to_date(&known) {
                known = input.get();
            }
            new.then(|| stamp(&*known))
        })?;
        *seen = found;
        Ok(found)
    }
}

struct RawSamples {
    output: Publisher<Plane, Payload, ()>,
    input: Subscriber<Plane, Payload, ()>,
    bells: Option<(Notifier<Plane>, Listener<Plane>)>,
    _node: Node<Plane>,
}

/// Publish-subscribe in each direction, with an event for the wake-up or without.
pub fn samples(dir: &Path, end: LinkEnd, rings: bool) -> Opened {
    let node = node(dir)?;
    let service = |way: &str| {
        node.service_builder(&name(way)?).publish_subscribe::<Payload>().open_or_create().map_err(text)
    };
    let event = |way: &str| node.service_builder(&name(way)?).event().open_or_create().map_err(text);
    let [out, back] = ways(end);
    let (output, input) = (service(out)?, service(back)?);
    let bells = if rings {
        let notifier = event(out)?.notifier_builder().create().map_err(text)?;
        Some((notifier, event(back)?.listener_builder().create().map_err(text)?))
    } else {
        None
    };
    Ok(Box::new(RawSamples {
        output: output.publisher_builder().create().map_err(text)?,
        input: input.subscriber_builder().create().map_err(text)?,
        bells,
        _node: node,
    }))
}

impl Link for RawSamples {
    fn send(&mut self, stamp: u64) -> Result<(), String> {
        self.output.send_copy(message(stamp)).map_err(text)?;
        self.bells.as_ref().map_or(Ok(()), |(bell, _)| bell.notify().map(drop).map_err(text))
    }

    fn receive(&mut self) -> Result<u64, String> {
        spin(|| {
            let sample = self.input.receive().ok().flatten();
            if let (None, Some((_, ears))) = (&sample, &self.bells) {
                let _ = ears.timed_wait(|_| {}, LIMIT);
            }
            sample.map(|s| stamp(s.payload()))
        })
    }
}
