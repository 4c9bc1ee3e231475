//! Which local controller a recorded frame belongs to.
//!
//! A recording knows interfaces, a layout knows nodes. Most identifiers are used on one line only and tell the node by
//! themselves, so it does not matter what the interfaces are called and whether nodes share one. Identifiers that
//! several nodes use (one SYNC for all) belong to those nodes whose other frames were seen on the same interface.

use crate::capture::{Capture, Captured};
use codec::layout::{BusMessage, FrameLayout};

/// The nodes behind each interface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Owners {
    /// By line of the recording: a bit for each node.
    nodes: Vec<u32>,
}

impl Owners {
    /// Learnt from a whole recording.
    pub fn of(layout: &FrameLayout, capture: &Capture) -> Self {
        let mut owners = Self::default();
        capture.frames.iter().for_each(|frame| owners.learn(layout, frame));
        owners
    }

    /// Learns from one more frame.
    pub fn learn(&mut self, layout: &FrameLayout, frame: &Captured) {
        let line = frame.line as usize;
        if self.nodes.len() <= line {
            self.nodes.resize(line + 1, 0);
        }
        if let Some(node) = layout.line_of(frame.id) {
            self.nodes[line] |= 1 << node;
        }
    }

    /// The nodes behind an interface, as far as they are known.
    pub fn behind(&self, line: u32) -> impl Iterator<Item = usize> + use<> {
        let nodes = self.nodes.get(line as usize).copied().unwrap_or(0);
        (0..u32::BITS as usize).filter(move |node| nodes >> node & 1 == 1)
    }

    /// The nodes that a frame with this identifier belongs to: one for most, none if the layout does not know it.
    pub fn nodes<'l>(
        &self,
        layout: &'l FrameLayout,
        line: u32,
        id: u32,
    ) -> impl Iterator<Item = usize> + use<'l> {
        let known = self.nodes.get(line as usize).copied().unwrap_or(0);
        let may = move |node: &usize| known == 0 || known >> node & 1 == 1;
        (0..layout.nodes.len()).filter(may).filter(move |node| layout.find(*node as u32, id).is_some())
    }

    /// The message of a frame; none if the layout does not know it.
    pub fn message<'l>(&self, layout: &'l FrameLayout, frame: &Captured) -> Option<&'l BusMessage> {
        let node = self.nodes(layout, frame.line, frame.id).next()?;
        layout.find(node as u32, frame.id).map(|i| &layout.messages[i])
    }
}
