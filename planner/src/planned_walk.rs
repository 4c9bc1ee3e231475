//! Planned walk: a plan, and the planner's own knowledge of it.

use crate::steps::{MAX_STEPS, Stride};
use crate::verdict::{Blocked, PlanVerdict};
use messages::{Plan, Record};

/// Cycles between the publication of a plan and its start.
pub const LEAD: u64 = 10;

/// Cycles that plans need besides their own.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Margins {
    /// From publication to start: [`LEAD`], after the time that tables for drives take.
    pub(crate) lead: u64,
    /// From the end of a plan to the end of its tables.
    pub(crate) tail: u64,
}

impl Default for Margins {
    fn default() -> Self {
        Self { lead: LEAD, tail: 0 }
    }
}

/// A plan, and what the planner remembers of it.
#[derive(Clone)]
pub struct PlannedWalk {
    /// The plan as the controller gets it.
    pub plan: Box<Plan>,
    /// Its steps.
    pub strides: [Stride; MAX_STEPS],
    /// Its length in cycles.
    pub end_cycle: u64,
    /// Obstacle that keeps it from going where it should.
    pub(crate) blocked: Option<Blocked>,
    /// \[m\] Least distance of the modified zero-moment point from the edge of the support polygon.
    pub margin: f64,
    /// First fault of it, if any.
    pub verdict: PlanVerdict,
    /// It meets the periodic solution in its divergent component only (thesis 4.6.2).
    pub divergent: bool,
}

impl Default for PlannedWalk {
    fn default() -> Self {
        Self::new()
    }
}

impl PlannedWalk {
    /// An empty plan.
    pub fn new() -> Self {
        Self {
            plan: Box::new(Plan::empty()),
            strides: [Stride::NONE; MAX_STEPS],
            end_cycle: 0,
            margin: 0.0,
            verdict: PlanVerdict::Sound,
            divergent: false,
            blocked: None,
        }
    }

    /// The steps in use.
    pub fn steps(&self) -> &[Stride] {
        &self.strides[..self.plan.step_count as usize]
    }

    /// Sole frames at `t` \[s\]: x, y, z, heading.
    pub(crate) fn soles(&self, t: f64) -> [[f64; 4]; 2] {
        [0, 1].map(|i| self.plan.feet[i].sample(t).position)
    }
}
