//! Inputs of a plant during one bus cycle, besides the references of its joints.

use crate::external_forces::ExternalForces;

/// Inputs of a plant during one bus cycle, besides the references of its joints.
#[derive(Clone, Copy, Debug, Default)]
pub struct PlantInputs {
    /// Forces on the torso.
    pub forces: ExternalForces,
    /// Drives with and without torque.
    pub switches: DriveSwitches,
}

/// One integration step of a bus cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Substep {
    /// Number in the cycle, from zero.
    pub index: u32,
    /// \[s\] Length.
    pub h: f64,
}

/// Motor supply, and drives that are an exception; one bit per drive.
#[derive(Clone, Copy, Debug, Default)]
pub struct DriveSwitches {
    /// Motor supply; without it no motor has torque.
    pub powered: bool,
    /// Drives whose power stage is off all the same.
    pub off: u64,
    /// Drives whose brakes are closed; one without a brake does not care.
    pub braked: u64,
    /// Drives that have not had torque yet: until then somebody holds their joints in the start pose.
    pub held: u64,
}

impl PlantInputs {
    /// No force from outside, all drives on.
    pub const POWERED: Self = Self {
        forces: ExternalForces { push: [0.0; 3], push_moment: [0.0; 3], rope: None },
        switches: DriveSwitches { powered: true, off: 0, braked: 0, held: 0 },
    };
}

impl DriveSwitches {
    /// True if a drive's power stage is on.
    pub(crate) fn has_torque(&self, drive: usize) -> bool {
        self.powered && self.off >> drive & 1 == 0
    }

    /// True if a drive's brake is closed.
    pub(crate) fn is_braked(&self, drive: usize) -> bool {
        self.braked >> drive & 1 == 1
    }

    /// True if a drive's joints are held from outside.
    pub(crate) fn is_held(&self, drive: usize) -> bool {
        self.held >> drive & 1 == 1
    }
}
