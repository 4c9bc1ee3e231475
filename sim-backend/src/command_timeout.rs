//! Command timeout per node of the bus: extrapolate, then report a heartbeat fault.
//!
//! A node that misses a cycle carries its joints on at their last speed. After [`TIMEOUT_CYCLES`] of them it has timed out:
//! its drives have a fault. They bring their joints to rest by themselves, and only a reset leads back: whoever was silent
//! for so long does not get a joint back in mid-motion.

use codec::frames::Received;
use codec::layout::{Carries, FrameLayout, MAX_NODES};
use messages::MAX_JOINTS;

/// Cycles without targets after which the drives of a local controller have a fault.
pub const TIMEOUT_CYCLES: u32 = 20;

/// \[rad\] A target further from where the joint was to be than this ...
const JUMP: f64 = 0.05;
/// \[1\] ... plus its speed limit times this and the time since its node received the last one, is a bent bit, not a target.
const JUMP_SPEED: f64 = 2.0;

/// Motion of a joint in this cycle, as its local controller chooses it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Follows {
    /// The new target.
    Target,
    /// Nothing new: its last speed.
    LastSpeed,
}

/// Cycles without commands, node by node.
#[derive(Clone, Debug)]
pub(crate) struct CommandTimeout {
    node_of: [usize; MAX_JOINTS],
    nodes: usize,
    /// Cycles since each node received its targets.
    silent: [u32; MAX_NODES],
    /// The same before this cycle.
    before: [u32; MAX_NODES],
}

impl CommandTimeout {
    /// Of a robot with this layout.
    pub(crate) fn new(layout: &FrameLayout) -> Self {
        let mut node_of = [0; MAX_JOINTS];
        for message in layout.messages.iter().filter(|m| m.to_drives) {
            for signal in &message.signals {
                if let Carries::Target(j) | Carries::Interpreter(j) = signal.carries {
                    node_of[j] = message.node;
                }
            }
        }
        Self { node_of, nodes: layout.nodes.len(), silent: [0; MAX_NODES], before: [0; MAX_NODES] }
    }

    /// One cycle with the frames received, if any; true if some node has its targets.
    pub(crate) fn step(&mut self, received: Option<&Received>) -> bool {
        let mut any = false;
        for i in 0..self.nodes {
            let complete = received.is_some_and(|received| received.complete(i));
            any |= complete;
            self.before[i] = self.silent[i];
            self.silent[i] = if complete { 0 } else { self.silent[i].saturating_add(1) };
        }
        any
    }

    /// Motion of a joint whose new target is so far \[rad\] away; `reach` \[rad\] is how far the joint gets in one cycle.
    pub(crate) fn follows(&self, joint: usize, away: f64, reach: f64) -> Follows {
        let node = self.node_of[joint];
        let cycles = f64::from(self.before[node] + 1);
        match self.silent[node] {
            0 if away.abs() <= JUMP + JUMP_SPEED * reach * cycles => Follows::Target,
            _ => Follows::LastSpeed,
        }
    }

    /// True if the local controller of a joint has received everything in this cycle.
    pub(crate) fn hears(&self, joint: usize) -> bool {
        self.silent[self.node_of[joint]] == 0
    }

    /// True if the local controller of a joint has received nothing for too long.
    pub(crate) fn is_timed_out(&self, joint: usize) -> bool {
        self.silent[self.node_of[joint]] > TIMEOUT_CYCLES
    }

    /// The local controller of a joint.
    pub(crate) fn node_of(&self, joint: usize) -> usize {
        self.node_of[joint]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use codec::layout::{BusMessage, BusSignal};

    fn layout() -> FrameLayout {
        let message = |node: usize| BusMessage {
            name: format!("m{node}"),
            id: 0x100 + node as u32,
            len: 8,
            node,
            to_drives: true,
            cyclic: true,
            signals: vec![BusSignal {
                name: "target".into(),
                start: 0,
                bits: 32,
                signed: true,
                scale: 1e-9,
                offset: 0.0,
                carries: Carries::Target(node),
            }],
        };
        FrameLayout::new(vec!["a".into(), "b".into()], vec![message(0), message(1)])
    }

    /// Only the node `missing` did not receive all.
    fn received(missing: usize) -> Received {
        let mut received = Received::default();
        if missing < 2 {
            received.missing[missing] = 1;
        }
        received
    }

    /// With a target that is near.
    fn follows(h: &CommandTimeout, joint: usize) -> Follows {
        h.follows(joint, 0.001, 0.008)
    }

    #[test]
    fn a_target_that_no_joint_can_reach_is_none() {
        let mut h = CommandTimeout::new(&layout());
        h.step(Some(&received(9)));
        assert_eq!(h.follows(0, 0.06, 0.008), Follows::Target);
        assert_eq!([0.07, -0.07, f64::NAN].map(|away| h.follows(0, away, 0.008)), [Follows::LastSpeed; 3]);
        for _ in 0..3 {
            h.step(None);
        }
        h.step(Some(&received(9)));
        assert_eq!(h.follows(0, 0.11, 0.008), Follows::Target, "further away after a gap");
    }

    #[test]
    fn a_node_alone_carries_on_then_it_times_out_until_it_receives() {
        let mut h = CommandTimeout::new(&layout());
        assert!(h.step(Some(&received(9))));
        for cycle in 1..=50 {
            assert!(h.step(Some(&received(1))), "the other one receives");
            assert_eq!((follows(&h, 0), follows(&h, 1)), (Follows::Target, Follows::LastSpeed));
            assert_eq!(
                [h.is_timed_out(0), h.is_timed_out(1)],
                [false, cycle > TIMEOUT_CYCLES],
                "cycle {cycle}"
            );
        }
        h.step(Some(&received(9)));
        assert_eq!((follows(&h, 1), h.is_timed_out(1)), (Follows::Target, false));
    }

    #[test]
    fn nothing_at_all_is_received_by_nobody() {
        let mut h = CommandTimeout::new(&layout());
        h.step(Some(&received(9)));
        assert!(!h.step(None));
        assert_eq!([follows(&h, 0), follows(&h, 1)], [Follows::LastSpeed; 2]);
    }
}
