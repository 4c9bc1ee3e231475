//! A robot's frames as data of connections: one slave for each local controller, its connection data the payloads of its
//! messages one after the other, in the order of the layout.
//!
//! Nothing of a frame's identifier or length is sent: both sides have the same layout. A controller of which a frame is
//! missing gets no new data in that cycle.

use crate::layout::Station;
use codec::layout::{Carries, FrameLayout};
use messages::{BusFrames, Frame};

/// Longest data of a connection \[B\].
pub const LONGEST: usize = 1024;

/// Frames of one direction to data and back.
pub struct Packing {
    /// For each message of the layout: where its payload is in the data of its node; none: of the other direction.
    places: Vec<Option<usize>>,
    sizes: Vec<usize>,
    messages: Vec<u32>,
    data: Vec<Box<[u8]>>,
    /// Messages of each node that were packed.
    packed: Vec<u32>,
}

/// The slaves of a robot: a local controller has its number, from 1, as its address.
pub fn stations(layout: &FrameLayout) -> Vec<Station> {
    let (command, feedback) = (Packing::new(layout, true), Packing::new(layout, false));
    let station = |node: usize| Station {
        address: node as u16 + 1,
        command: command.sizes[node],
        feedback: feedback.sizes[node],
    };
    (0..layout.nodes.len()).map(station).collect()
}

impl Packing {
    /// For the frames to the drives, or from them.
    pub fn new(layout: &FrameLayout, to_drives: bool) -> Self {
        let nodes = layout.nodes.len();
        let (mut sizes, mut messages) = (vec![0; nodes], vec![0; nodes]);
        let mut places = Vec::with_capacity(layout.messages.len());
        for message in &layout.messages {
            let ours = message.to_drives == to_drives;
            places.push(ours.then_some(sizes[message.node]));
            if ours {
                sizes[message.node] += message.len as usize;
                messages[message.node] += 1;
            }
        }
        let data = sizes.iter().map(|size| vec![0; *size].into()).collect();
        Self { places, sizes, messages, data, packed: vec![0; nodes] }
    }

    /// Packs the frames of a cycle.
    pub fn pack(&mut self, layout: &FrameLayout, frames: &BusFrames) {
        self.packed.fill(0);
        for frame in frames.as_slice() {
            let Some(i) = layout.find(frame.line, frame.id) else { continue };
            let (message, len) = (&layout.messages[i], frame.len as usize);
            let Some(at) = self.places[i].filter(|_| frame.len == message.len) else { continue };
            self.data[message.node][at..at + len].copy_from_slice(&frame.data[..len]);
            self.packed[message.node] += 1;
        }
    }

    /// Data for the connection of a node, if all of its frames were there.
    pub fn data(&self, node: usize) -> Option<&[u8]> {
        (self.packed[node] == self.messages[node]).then_some(&*self.data[node])
    }

    /// Appends the frames of a node that its connection brought.
    pub fn unpack(&self, layout: &FrameLayout, node: usize, data: &[u8], frames: &mut BusFrames) {
        for (message, place) in layout.messages.iter().zip(&self.places) {
            let Some(at) = place.filter(|_| message.node == node) else { continue };
            let len = message.len as usize;
            let Some(payload) = data.get(at..at + len) else { return };
            let mut frame = Frame { line: node as u32, id: message.id, len: message.len, ..Frame::default() };
            frame.data[..len].copy_from_slice(payload);
            frames.push(&frame);
        }
    }
}

/// Low bits of the tick in a frame that synchronizes, and how many bits they are; none in others.
pub fn sync_counter(layout: &FrameLayout, frame: &Frame) -> Option<(u64, u32)> {
    let message = layout.find(frame.line, frame.id).map(|i| &layout.messages[i]).filter(|m| m.is_sync())?;
    let counter = message.signals.iter().find(|s| s.carries == Carries::Counter)?;
    Some((counter.get(&frame.data) as u64, counter.bits))
}

/// Interfaces of a bus `sercos:NEAR/FAR`: one or two each, two for a ring.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Interfaces {
    /// The master's ports.
    pub near: (String, Option<String>),
    /// The ends of the simulated slaves' chain; none: somebody else has the slaves.
    pub far: Option<(String, Option<String>)>,
}

impl std::str::FromStr for Interfaces {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            format!(
                "bus `sercos:{text}`: must be sercos:NEAR, or sercos:NEAR/FAR with the simulated robot's end, where each is \
                 one Ethernet interface, or the two of a ring: sercos:eth1, sercos:near1,near2/far1,far2"
            )
        };
        let side = |text: &str| {
            let mut names = text.split(',').map(str::to_owned);
            let first = names.next().filter(|name| !name.is_empty()).ok_or_else(wrong)?;
            let second = names.next();
            if names.next().is_some() || second.as_ref().is_some_and(|s| s.is_empty() || *s == first) {
                return Err(wrong());
            }
            Ok((first, second))
        };
        let (near, far) = match text.split_once('/') {
            Some((near, far)) => (side(near)?, Some(side(far)?)),
            None => (side(text)?, None),
        };
        if far.as_ref().is_some_and(|far| far.1.is_some() != near.1.is_some()) {
            return Err(wrong());
        }
        Ok(Self { near, far })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use codec::layout::{BusMessage, BusSignal};

    fn message(id: u32, len: u32, node: usize, to_drives: bool) -> BusMessage {
        let signal = |carries| BusSignal {
            name: "n".into(),
            start: 0,
            bits: 16,
            signed: false,
            scale: 1.0,
            offset: 0.0,
            carries,
        };
        let signals = match (to_drives, len) {
            (true, 2) => vec![signal(Carries::Counter)],
            _ => vec![signal(Carries::Counter), signal(Carries::Mode)],
        };
        BusMessage { name: String::new(), id, len, node, to_drives, cyclic: true, signals }
    }

    fn layout() -> FrameLayout {
        let both = |node: usize| {
            let id = 16 * node as u32;
            [
                message(id, 8, node, true),
                message(id + 1, 2, node, true),
                message(id + 2, 12, node, false),
                message(id + 3, 16, node, false),
            ]
        };
        FrameLayout::new(vec!["a".into(), "b".into()], (0..2).flat_map(both).collect())
    }

    fn frames(layout: &FrameLayout, to_drives: bool) -> BusFrames {
        let mut frames = BusFrames::default();
        for message in layout.sent(to_drives) {
            let mut frame =
                Frame { line: message.node as u32, id: message.id, len: message.len, ..Frame::default() };
            frame.data[..message.len as usize].fill(message.id as u8 + 1);
            frames.push(&frame);
        }
        frames
    }

    #[test]
    fn frames_come_back_as_they_went() {
        let layout = layout();
        assert_eq!(stations(&layout)[1], Station { address: 2, command: 10, feedback: 28 });
        for to_drives in [true, false] {
            let (mut packing, sent) = (Packing::new(&layout, to_drives), frames(&layout, to_drives));
            packing.pack(&layout, &sent);
            let mut back = BusFrames::default();
            for node in 0..2 {
                packing.unpack(&layout, node, packing.data(node).unwrap(), &mut back);
            }
            assert_eq!(back, sent);
        }
    }

    #[test]
    fn a_node_without_all_of_its_frames_has_no_new_data() {
        let layout = layout();
        let mut sent = frames(&layout, true);
        sent.count -= 1;
        let mut packing = Packing::new(&layout, true);
        packing.pack(&layout, &sent);
        assert!(packing.data(0).is_some() && packing.data(1).is_none());
    }

    #[test]
    fn the_counter_is_read_from_frames_that_synchronize() {
        let layout = layout();
        let sent = frames(&layout, true);
        assert_eq!(sync_counter(&layout, &sent.frames[1]), Some((0x0202, 16)));
        assert_eq!(sync_counter(&layout, &sent.frames[0]), None);
    }

    #[test]
    fn interfaces_are_read() {
        let pair = |a: &str, b: Option<&str>| (a.to_owned(), b.map(str::to_owned));
        let read = |text: &str| text.parse::<Interfaces>();
        assert_eq!(read("eth1").unwrap(), Interfaces { near: pair("eth1", None), far: None });
        let ring = Interfaces { near: pair("a", Some("b")), far: Some(pair("c", Some("d"))) };
        assert_eq!(read("a,b/c,d").unwrap(), ring);
        for wrong in ["", "a,b,c", "a,b/c", "a/", "a,", "a,a", "/b"] {
            assert!(read(wrong).unwrap_err().contains("must be sercos:NEAR"), "{wrong}");
        }
    }
}
