//! Plant mismatch, `[plant_mismatch]` of a scene: differences between the simulated robot and the model of the robot's software.
//!
//! ```toml
//! [plant_mismatch]
//! ground_tilt = [0.0, 2.0] # [deg] roll and pitch of the ground about the origin; positive pitch: downhill along x
//! contact_stiffness = 0.5 # [1] of the soles, over the robot's
//! joint_offset_rad = { right_knee_flexion = 0.01 } # [rad] encoders read as much too much
//! drive_clock_ppm = { right_knee_flexion = 50 } # [ppm] as much too fast, where drives play tables by their own clocks
//! ```
//!
//! An offset differs from `sensors.encoder.bias_rad`: drives work with their encoders, so the joint itself stands as
//! much too low, and the reading shows what was wanted.

use crate::section::Section;
use crate::sensors::PerJoint;

/// `[plant_mismatch]` of a scene. The default is a robot and a world as the software believes.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantMismatch {
    /// \[rad\] Roll and pitch of the ground: turned about x, then y of the world, about the origin.
    pub ground_tilt: [f64; 2],
    /// \[1\] Stiffness of the soles over the robot's.
    pub contact_stiffness: f64,
    /// \[rad\] By how much the encoders of a joint, both sides, read too much.
    pub joint_offset: PerJoint,
    /// \[ppm\] By how much the clock of a joint's drive is too fast; felt by drives that play tables freely.
    pub drive_clock: PerJoint,
}

impl Default for PlantMismatch {
    fn default() -> Self {
        Self {
            ground_tilt: [0.0; 2],
            contact_stiffness: 1.0,
            joint_offset: PerJoint::default(),
            drive_clock: PerJoint::default(),
        }
    }
}

impl PlantMismatch {
    pub(crate) fn build(table: &Section<'_, '_>) -> Self {
        let mut built = Self::default();
        if table.has("ground_tilt") {
            built.ground_tilt = table.numbers("ground_tilt", "deg", -30.0..=30.0).map(f64::to_radians);
        }
        if table.has("contact_stiffness") {
            built.contact_stiffness = table.number("contact_stiffness", "", 1e-3..=1e3);
        }
        built.joint_offset = PerJoint::build(table, "joint_offset_rad", "rad", -1.0..=1.0);
        built.drive_clock = PerJoint::build(table, "drive_clock_ppm", "ppm", -1e4..=1e4);
        built
    }
}
