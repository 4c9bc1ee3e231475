//! Steps, masses, soles and cycle of one robot: all stages of planning read them, none changes them.

use crate::pose::{PlanarPose, rotate};
use crate::sole::Sole;
use config::{Gait, gait};

/// Gait and geometry that plans are made with.
#[derive(Clone)]
pub(crate) struct WalkingModel {
    /// Steps; its values may be changed between two plans.
    pub step: gait::StepSettings,
    /// The model the centre of gravity is planned with.
    pub model: gait::GaitModel,
    /// Ranges of a step.
    pub limits: gait::CommandLimits,
    /// Support rectangles: right, left.
    pub soles: [Sole; 2],
    /// Feet may be closed after a step of any length: nothing falls that moves slowly enough.
    pub closes_at_once: bool,
    /// \[s\] Length of a cycle; phases end on whole cycles.
    pub cycle_s: f64,
}

impl WalkingModel {
    /// For feet with these support rectangles, with a cycle of 1 ms until it is set.
    pub(crate) fn new(gait: &Gait, soles: [Sole; 2]) -> Self {
        Self {
            step: gait.step.clone(),
            model: gait.model,
            limits: gait.limits,
            soles,
            closes_at_once: false,
            cycle_s: 1e-3,
        }
    }

    /// Whole cycles nearest to `t` \[s\], at least one.
    pub(crate) fn cycles(&self, t: f64) -> u64 {
        (t / self.cycle_s).round().max(1.0) as u64
    }

    /// \[m\] Point over which the body rests between two feet.
    pub(crate) fn standing_point(&self, feet: &[PlanarPose; 2]) -> [f64; 2] {
        let heading = 0.5 * (feet[0].heading + feet[1].heading);
        let ahead = rotate(heading, [self.model.com_forward, 0.0]);
        [0.5 * (feet[0].x + feet[1].x) + ahead[0], 0.5 * (feet[0].y + feet[1].y) + ahead[1]]
    }
}
