//! Which local controllers heard their targets, and what they do when they did not.
//!
//! A node that misses a cycle carries its joints on at their last speed. After [`UNHEARD_CYCLES`] of them it is deaf: its
//! drives have a fault. They bring their joints to rest by themselves, and only a reset leads back: whoever was silent for
//! so long does not get a joint back in mid-motion.

use messages::MAX_JOINTS;
use messages::frames::Received;
use messages::layout::{Carries, Layout, MAX_NODES};

/// Cycles without targets after which the drives of a local controller have a fault.
pub const UNHEARD_CYCLES: u32 = 20;

/// \[rad\] A target further from where the joint was to be than this ...
const JUMP: f64 = 0.05;
/// \[1\] ... plus its speed limit times this and the time since it heard the last one, is a bent bit, not a target.
const JUMP_SPEED: f64 = 2.0;

/// What a local controller does with a joint in this cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Follows {
    /// The new target.
    Target,
    /// Nothing new: its last speed.
    LastSpeed,
}

/// What the nodes of a robot heard.
#[derive(Clone, Debug)]
pub struct Hearing {
    node_of: [usize; MAX_JOINTS],
    nodes: usize,
    /// Cycles since each node heard its targets.
    unheard: [u32; MAX_NODES],
    /// Cycles since each node heard its targets, before this one.
    before: [u32; MAX_NODES],
}

impl Hearing {
    /// Of a robot with this layout.
    pub fn new(layout: &Layout) -> Self {
        let mut node_of = [0; MAX_JOINTS];
        for message in layout.sent(true) {
            for signal in &message.signals {
                if let Carries::Target(j) = signal.carries {
                    node_of[j] = message.node;
                }
            }
        }
        Self { node_of, nodes: layout.nodes.len(), unheard: [0; MAX_NODES], before: [0; MAX_NODES] }
    }

    /// One cycle: what came of it, none if nothing did; true if some node heard.
    pub fn step(&mut self, received: Option<&Received>) -> bool {
        let mut any = false;
        for i in 0..self.nodes {
            let heard = received.is_some_and(|received| received.complete(i));
            any |= heard;
            self.before[i] = self.unheard[i];
            self.unheard[i] = if heard { 0 } else { self.unheard[i].saturating_add(1) };
        }
        any
    }

    /// What the local controller of a joint does with it, if its new target is so far \[rad\] away; `reach` \[rad\] is
    /// how far the joint gets in one cycle.
    pub fn follows(&self, joint: usize, away: f64, reach: f64) -> Follows {
        let node = self.node_of[joint];
        let cycles = f64::from(self.before[node] + 1);
        match self.unheard[node] {
            0 if away.abs() <= JUMP + JUMP_SPEED * reach * cycles => Follows::Target,
            _ => Follows::LastSpeed,
        }
    }

    /// Whether the local controller of a joint has heard nothing for too long.
    pub fn is_deaf(&self, joint: usize) -> bool {
        self.unheard[self.node_of[joint]] > UNHEARD_CYCLES
    }

    /// The local controller of a joint.
    pub fn node_of(&self, joint: usize) -> usize {
        self.node_of[joint]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::layout::{Message, Signal};

    fn layout() -> Layout {
        let message = |node: usize| Message {
            name: format!("m{node}"),
            id: 0x100 + node as u32,
            len: 8,
            node,
            to_drives: true,
            signals: vec![Signal {
                name: "target".into(),
                start: 0,
                bits: 32,
                signed: true,
                scale: 1e-9,
                offset: 0.0,
                carries: Carries::Target(node),
            }],
        };
        Layout::new(vec!["a".into(), "b".into()], vec![message(0), message(1)])
    }

    /// Only the node `missing` did not hear all.
    fn received(missing: usize) -> Received {
        let mut received = Received::default();
        if missing < 2 {
            received.missing[missing] = 1;
        }
        received
    }

    /// With a target that is near.
    fn follows(h: &Hearing, joint: usize) -> Follows {
        h.follows(joint, 0.001, 0.008)
    }

    #[test]
    fn a_target_that_no_joint_can_reach_is_none() {
        let mut h = Hearing::new(&layout());
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
    fn a_node_alone_carries_on_then_it_is_deaf_until_it_hears() {
        let mut h = Hearing::new(&layout());
        assert!(h.step(Some(&received(9))));
        for cycle in 1..=50 {
            assert!(h.step(Some(&received(1))), "the other one hears");
            assert_eq!((follows(&h, 0), follows(&h, 1)), (Follows::Target, Follows::LastSpeed));
            assert_eq!([h.is_deaf(0), h.is_deaf(1)], [false, cycle > UNHEARD_CYCLES], "cycle {cycle}");
        }
        h.step(Some(&received(9)));
        assert_eq!((follows(&h, 1), h.is_deaf(1)), (Follows::Target, false));
    }

    #[test]
    fn nothing_at_all_is_heard_by_nobody() {
        let mut h = Hearing::new(&layout());
        h.step(Some(&received(9)));
        assert!(!h.step(None));
        assert_eq!([follows(&h, 0), follows(&h, 1)], [Follows::LastSpeed; 2]);
    }
}
