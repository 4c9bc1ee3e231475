//! The rules beside the world: plain, seen from outside, and sharing nothing with what they judge.

use drives::cia402::ENABLE_OPERATION;
use lowlevel::joint_loop::LoopState;
use messages::{Command, StartUp};

use crate::start_up_explored::robot::{JOINTS, MISSED, NEEDED, NODE};
use crate::start_up_explored::world::{Happens, RESET};

/// Controlword of a quick stop: the drive brakes and holds.
const QUICK_STOP: u16 = 0x02;

/// One cycle of the joint loop, with what is true of the drives in it.
pub(crate) struct Seen {
    pub(crate) happens: Happens,
    pub(crate) before: LoopState,
    pub(crate) after: LoopState,
    /// State as the joint loop reports it.
    pub(crate) start_up: u64,
    pub(crate) powered: bool,
    /// Drives in Operation enabled, and those with torque.
    pub(crate) on: [bool; JOINTS],
    pub(crate) torque: [bool; JOINTS],
    pub(crate) known: [bool; JOINTS],
    pub(crate) carried: bool,
    /// The joints are told to find out their angles.
    pub(crate) home: bool,
    pub(crate) control: [u16; JOINTS],
}

/// Memory of the rules.
#[derive(Clone, Debug, Default, Hash)]
pub(crate) struct Rules {
    closed: bool,
    /// Since the relay closed: drives that were in operation; all were, and those that are needed at once; the feet carried.
    been_on: [bool; JOINTS],
    complete: bool,
    carried: bool,
    /// Since the joint loop last heard that it is open: homing was asked for; a stop was begun.
    home: bool,
    stopped: bool,
    /// Cycles since the last reset, up to one more than it is passed on for.
    reset: Option<u32>,
    /// Cycles in a row in which a drive truly said that it is off; a joint, that it does not know its angle, or that it does.
    off: [u32; JOINTS],
    unknown: [u32; JOINTS],
    sure: [u32; JOINTS],
    /// Drives that truly said last that they are in operation.
    on: [bool; JOINTS],
    /// Cycles in a row in which nothing was heard of a joint's local controller.
    unheard: [u32; JOINTS],
}

impl Rules {
    /// Commands of a cycle.
    pub(crate) fn hear(&mut self, commands: &[Command]) {
        self.reset = self.reset.map(|cycles| cycles + 1).filter(|cycles| *cycles <= RESET);
        if commands.contains(&Command::Reset) {
            self.reset = Some(0);
        }
        self.home |= commands.contains(&Command::Home);
    }

    /// True while the relay is closed.
    pub(crate) fn relay(&mut self, closed: bool) {
        if !closed {
            (self.been_on, self.complete, self.carried) = Default::default();
        }
        self.closed = closed;
    }

    /// One cycle of the joint loop.
    pub(crate) fn judge(&mut self, seen: &Seen) -> Result<(), &'static str> {
        let follows = seen.after == LoopState::Track;
        let stands = seen.start_up == StartUp::Standing as u64;
        for j in 0..JOINTS {
            let heard = match seen.happens {
                Happens::AllLost => false,
                Happens::Lost(node) => NODE[j] != node,
                _ => true,
            };
            let bent = matches!(seen.happens, Happens::Bent(k, _) if k == j)
                || matches!(seen.happens, Happens::SupplyBent(node) if NODE[j] == node);
            let truly = heard && !bent;
            let count = |n: &mut u32, is: bool, most: u32| {
                *n = if is { (*n + 1).min(most) } else { 0 };
            };
            count(&mut self.off[j], truly && !seen.on[j], 2);
            count(&mut self.unknown[j], truly && !seen.known[j], 2);
            count(&mut self.sure[j], truly && seen.known[j], 2);
            if truly {
                self.on[j] = seen.on[j];
            }
            count(&mut self.unheard[j], !heard, MISSED + 1);
        }
        let lies = matches!(seen.happens, Happens::SupplyBent(_));
        if !seen.powered && !lies && self.unheard.contains(&0) {
            (self.home, self.stopped) = (false, false);
        }
        for (been, on) in self.been_on.iter_mut().zip(seen.on) {
            *been |= seen.powered && on;
        }
        let needed = seen.on[..NEEDED].iter().all(|on| *on);
        self.complete |= seen.powered && needed && self.been_on.iter().all(|been| *been);
        self.carried |= seen.powered && seen.carried;
        // A drive that says twice that it is off is off; one that is not heard for too long counts as off.
        let needs = |j: usize| j < NEEDED || !stands;
        if follows && (0..JOINTS).any(|j| needs(j) && self.off[j] == 2) {
            return Err("it goes on without a drive that it needs");
        }
        if follows && (0..NEEDED).any(|j| self.unheard[j] > MISSED) {
            return Err("it goes on without a drive that it does not hear");
        }
        // A joint that says so twice does not know its angle: no drive is switched on, but its own to find it out.
        let asked = |j: usize| seen.control[j] == ENABLE_OPERATION && !seen.torque[j] && self.off[j] == 2;
        for j in (0..JOINTS).filter(|j| asked(*j)) {
            if self.unknown.contains(&2) && !(seen.home && self.sure[j] < 2) {
                return Err("a drive was switched on while a joint did not know its angle");
            }
        }
        if !seen.powered && self.off == [2; JOINTS] && (0..JOINTS).any(asked) {
            return Err("a drive was switched on without supply");
        }
        // Whatever one bit says: a robot that stands on a supply that is on is not let go.
        let kept = |j: usize| matches!(seen.control[j], ENABLE_OPERATION | QUICK_STOP);
        if stands
            && seen.powered
            && (0..JOINTS).any(|j| self.on[j] && seen.on[j] && seen.known[j] && !kept(j))
        {
            return Err("a drive of a standing robot was let go");
        }
        if seen.home && !self.home {
            return Err("nobody asked for homing");
        }
        if stands && !self.carried && seen.powered && self.closed {
            return Err("it stands on feet that never carried");
        }
        // A stop lasts until the supply was off.
        let stops = |state: LoopState| matches!(state, LoopState::Stop(_));
        let wanted = seen.happens == Happens::Stop && seen.before == LoopState::Track;
        self.stopped |= seen.powered && (stops(seen.after) || wanted);
        match self.stopped && !stops(seen.after) {
            true => Err("a stop was lost"),
            false => Ok(()),
        }
    }

    /// A joint moves to its target.
    pub(crate) fn moves(&self) -> Result<(), &'static str> {
        match (self.complete, self.stopped) {
            (false, _) => Err("a joint was led before every drive was in operation"),
            (_, true) => Err("a joint was led after a stop"),
            _ => Ok(()),
        }
    }

    /// A joint looks for its angle.
    pub(crate) fn searches(&self) -> Result<(), &'static str> {
        if self.home { Ok(()) } else { Err("a joint looked for its angle unasked") }
    }

    /// A drive forgets its fault.
    pub(crate) fn forgets_fault(&self) -> Result<(), &'static str> {
        if self.reset.is_some() { Ok(()) } else { Err("a fault was forgotten without a reset") }
    }
}
