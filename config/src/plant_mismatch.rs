//! Plant mismatch, `[plant_mismatch]` of a scene: differences between the simulated robot and the model of the robot's software.
//!
//! ```toml
//! [plant_mismatch]
//! ground_tilt = [0.0, 2.0] # [deg] roll and pitch of the ground about the origin; positive pitch: downhill along x
//! ground_height = -0.04 # [m] under what the robot starts on, which must then be an object: beside it is a drop
//! contact_stiffness = 0.5 # [1] of the soles, over the robot's
//! joint_offset_rad = { right_knee_flexion = 0.01 } # [rad] encoders read as much too much
//! drive_clock_ppm = { right_knee_flexion = 50 } # [ppm] as much too fast, where drives play tables by their own clocks
//! mass_factor = { all = 1.1, right_knee_flexion = 0.9 } # [1] of the body behind a joint, over the robot's
//! torso_mass_factor = 1.2 # [1] of the torso
//! torso_cog_shift = [0.03, 0.0, 0.0] # [m] of the torso's own centre of gravity, in its axes
//! payload = { mass = 8.0, position = [0.1, 0.0, 0.0] } # [kg], [m] on the torso, from that centre, in its axes
//! ```
//!
//! An offset differs from `sensors.encoder.bias_rad`: drives work with their encoders, so the joint itself stands as
//! much too low, and the reading shows what was wanted.

use crate::section::{POSITIVE, Section};
use crate::sensors::PerJoint;

/// Masses that are not as described are of the same order.
const MASS_FACTOR: std::ops::RangeInclusive<f64> = 0.1..=10.0;

/// `[plant_mismatch]` of a scene. The default is a robot and a world as the software believes.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantMismatch {
    /// \[rad\] Roll and pitch of the ground: turned about x, then y of the world, about the origin.
    pub ground_tilt: [f64; 2],
    /// \[m\] Height of the ground over the origin, on which the robot starts.
    pub ground_height: f64,
    /// \[1\] Stiffness of the soles over the robot's.
    pub contact_stiffness: f64,
    /// \[rad\] By how much the encoders of a joint, both sides, read too much.
    pub joint_offset: PerJoint,
    /// \[ppm\] By how much the clock of a joint's drive is too fast; felt by drives that play tables freely.
    pub drive_clock: PerJoint,
    /// \[1\] Mass and moments of inertia over the robot's, of the body behind each joint.
    pub mass_factor: PerJoint,
    /// \[1\] The same of the torso.
    pub torso_mass_factor: f64,
    /// \[m\] @torso Shift of the torso's own centre of gravity.
    pub torso_cog_shift: [f64; 3],
    /// Payload that the torso carries.
    pub payload: Option<Payload>,
}

/// A mass without extent that the torso carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Payload {
    /// \[kg\]
    pub mass: f64,
    /// \[m\] @torso From the torso's own centre of gravity as the software believes it.
    pub position: [f64; 3],
}

impl Default for PlantMismatch {
    fn default() -> Self {
        Self {
            ground_tilt: [0.0; 2],
            ground_height: 0.0,
            contact_stiffness: 1.0,
            joint_offset: PerJoint::default(),
            drive_clock: PerJoint::default(),
            mass_factor: PerJoint::default(),
            torso_mass_factor: 1.0,
            torso_cog_shift: [0.0; 3],
            payload: None,
        }
    }
}

impl PlantMismatch {
    /// Whether the bodies of the robot weigh what its software believes.
    pub fn weighs_as_described(&self) -> bool {
        let own = [Some(self.torso_mass_factor), self.mass_factor.all];
        let factors = own.into_iter().flatten().chain(self.mass_factor.own.iter().map(|(_, x)| *x));
        let mut others = factors.filter(|x| *x != 1.0);
        others.next().is_none() && self.torso_cog_shift == [0.0; 3] && self.payload.is_none()
    }

    pub(crate) fn build(table: &Section<'_, '_>) -> Self {
        let mut built = Self::default();
        if table.has("ground_tilt") {
            built.ground_tilt = table.numbers("ground_tilt", "deg", -30.0..=30.0).map(f64::to_radians);
        }
        if table.has("ground_height") {
            built.ground_height = table.number("ground_height", "m", -10.0..=0.0);
        }
        if table.has("contact_stiffness") {
            built.contact_stiffness = table.number("contact_stiffness", "", 1e-3..=1e3);
        }
        built.joint_offset = PerJoint::build(table, "joint_offset_rad", "rad", -1.0..=1.0);
        built.drive_clock = PerJoint::build(table, "drive_clock_ppm", "ppm", -1e4..=1e4);
        built.mass_factor = PerJoint::build(table, "mass_factor", "", MASS_FACTOR);
        if table.has("torso_mass_factor") {
            built.torso_mass_factor = table.number("torso_mass_factor", "", MASS_FACTOR);
        }
        if table.has("torso_cog_shift") {
            built.torso_cog_shift = table.numbers("torso_cog_shift", "m", -1.0..=1.0);
        }
        if table.has("payload") {
            built.payload = table.table("payload", |row| Payload {
                mass: row.number("mass", "kg", POSITIVE),
                position: row.numbers("position", "m", -2.0..=2.0),
            });
        }
        built
    }
}
