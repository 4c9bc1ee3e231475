//! Age of the joint targets, in cycles.

use std::hash::{Hash, Hasher};

use messages::JointTargets;

/// Age of the joint targets.
#[derive(Clone, Debug)]
pub(crate) struct TargetAge {
    /// Tick of the newest targets that were used.
    used: u64,
    /// Cycles since targets were new, now and in the cycle before.
    cycles: u32,
    before: u32,
    /// Cycles after which targets are too old.
    limit: u32,
}

impl TargetAge {
    /// Of targets that are late when they are older than `limit` cycles.
    pub(crate) fn new(limit: u32) -> Self {
        Self { used: 0, cycles: 0, before: 0, limit }
    }

    /// One cycle with the newest targets there are.
    pub(crate) fn step(&mut self, targets: Option<&JointTargets>) {
        self.before = self.cycles;
        match targets.map(|t| t.header.tick).filter(|&tick| tick > self.used) {
            Some(tick) => (self.used, self.cycles) = (tick, 0),
            None => self.cycles = self.cycles.saturating_add(1),
        }
    }

    /// Hashes what decides what comes next, at this tick.
    pub(crate) fn hash_state(&self, tick: u64, h: &mut impl Hasher) {
        (tick > self.used, self.cycles.min(self.limit + 1)).hash(h);
    }

    /// Cycles since targets were new.
    pub(crate) fn cycles(&self) -> u32 {
        self.cycles
    }

    /// New in this cycle.
    pub(crate) fn is_fresh(&self) -> bool {
        self.cycles == 0
    }

    /// Too old.
    pub(crate) fn is_late(&self) -> bool {
        self.cycles > self.limit
    }

    /// None were new in the cycle before.
    pub(crate) fn was_stale(&self) -> bool {
        self.before > 0
    }
}
