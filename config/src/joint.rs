//! Joints of a robot: `[[joint]]`.

use messages::nearest;

use crate::section::{POSITIVE, Section};

/// One driven joint.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Name in the URDF.
    pub name: String,
    /// \[rad\] Software range.
    pub range: [f64; 2],
    /// \[rad/s\]
    pub speed_limit: f64,
    /// \[rad/s^2\] Deceleration for bringing the joint to rest.
    pub braking: f64,
    /// \[rad/s^2\] Acceleration that its drives can give it at any angle of its range ([`crate::Robot::acceleration`] is exact);
    /// infinite for a robot of ideal drives.
    pub acceleration: f64,
    /// \[rad\] Comfortable angle for redundancy resolution.
    pub comfort: f64,
    /// \[1\] Weight W of the joint's speed in the inverse kinematics (5.36); 1 where the file says none.
    pub weight: f64,
}

impl Joint {
    pub(crate) fn build(row: &Section<'_, '_>) -> Self {
        Self {
            name: row.text("name"),
            range: row.interval("range_deg", "deg", -360.0..=360.0).map(f64::to_radians),
            speed_limit: row.number("speed_limit", "rad/s", POSITIVE),
            braking: row.number("braking", "rad/s^2", POSITIVE),
            acceleration: f64::INFINITY,
            comfort: row.number("comfort_deg", "deg", -360.0..=360.0).to_radians(),
            weight: if row.has("weight") { row.number("weight", "", POSITIVE) } else { 1.0 },
        }
        .checked(row)
    }

    fn checked(self, row: &Section<'_, '_>) -> Self {
        if self.comfort < self.range[0] || self.comfort > self.range[1] {
            row.problem("comfort_deg", format!("lies outside of range_deg of joint `{}`", self.name));
        }
        self
    }
}

/// The position of a joint that a key names.
pub(crate) fn joint_index(at: &Section<'_, '_>, key: &str, name: &str, joints: &[&str]) -> Option<usize> {
    let found = joints.iter().position(|joint| *joint == name);
    if found.is_none() && !name.is_empty() {
        let hint = nearest(name, joints).map_or(String::new(), |n| format!("; the nearest is `{n}`"));
        at.problem(key, format!("there is no joint `{name}`{hint}"));
    }
    found
}
