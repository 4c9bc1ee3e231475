//! Joints of the robot that a plant has, if some are locked.

use crate::drive::JointMotion;
use crate::inputs::{DriveSwitches, PlantInputs};

use super::Plant;

/// Some joints of a robot; the others are locked.
#[derive(Clone)]
pub(super) struct MovingJoints {
    /// Their places in the robot.
    pub(super) outside: Vec<usize>,
    /// References of all joints of the robot.
    pub(super) reference: Vec<JointMotion>,
    /// \[rad\] Where the joints of the robot were locked.
    pub(super) locked: Vec<f64>,
}

/// Those of a robot's numbers, one per joint, that belong to joints that move.
pub(super) fn of_moving(moving: Option<&MovingJoints>, of_robot: &[f64]) -> Vec<f64> {
    match moving {
        None => of_robot.to_vec(),
        Some(moving) => moving.outside.iter().map(|&j| of_robot[j]).collect(),
    }
}

impl Plant {
    /// Place in the robot of a joint or drive of the model.
    pub(super) fn outside(&self, i: usize) -> usize {
        self.moving.as_ref().map_or(i, |moving| moving.outside[i])
    }

    /// Those of a robot's numbers, one per joint, that belong to joints of the model.
    pub(crate) fn of_moving(&self, of_robot: &[f64]) -> Vec<f64> {
        of_moving(self.moving.as_ref(), of_robot)
    }

    /// Writes where locked joints are \[rad\]; what is told of them, and read, is their target.
    pub(crate) fn hold_locked(&self, angle: &mut [f64]) {
        let Some(MovingJoints { outside, locked, .. }) = &self.moving else { return };
        for (j, at) in locked.iter().enumerate().filter(|(j, _)| outside.binary_search(j).is_err()) {
            angle[j] = *at;
        }
    }

    /// Switches of the model's drives.
    pub(super) fn switches(&self, inputs: &PlantInputs) -> DriveSwitches {
        let Some(MovingJoints { outside, .. }) = &self.moving else { return inputs.switches };
        let of = |bits: u64| outside.iter().enumerate().fold(0, |sum, (i, &j)| sum | (bits >> j & 1) << i);
        let DriveSwitches { powered, off, braked, held } = inputs.switches;
        DriveSwitches { powered, off: of(off), braked: of(braked), held: of(held) }
    }
}
