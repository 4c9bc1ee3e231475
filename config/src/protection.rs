//! What a robot's drives do for themselves: limits at which they fail safe, and home switches of joints without absolute
//! encoder.

use drives::homing::HomeSwitch;
use drives::thermal::Thermal;

use crate::drive::Drive;
use crate::robot::{Joint, joint_index};
use crate::section::{NOT_NEGATIVE, POSITIVE, Section};

/// `[protection]`: limits of every drive.
#[derive(Clone, Debug, PartialEq)]
pub struct Protection {
    /// \[rad\] Following error at rest that is a fault ...
    pub following_error: f64,
    /// \[s\] ... plus this much per rad/s of joint speed.
    pub following_time: f64,
    /// \[1\] Current that is a fault, over the drive's current limit.
    pub over_current: f64,
    /// \[°C\] At which a winding's temperature is told as a warning.
    pub warning: f64,
    /// Windings, one per drive.
    pub windings: Vec<Thermal>,
}

impl Protection {
    pub(crate) fn build(table: &Section<'_, '_>, drives: &[Drive]) -> Self {
        let surroundings = table.number("surroundings", "deg C", -40.0..=60.0);
        let highest = table.number("temperature", "deg C", 60.0..=250.0);
        let winding = |drive: &Drive| {
            let [continuous_current, time_constant] = drive.winding.unwrap_or_else(|| {
                let name = &drive.name;
                let text = format!("the motor of drive `{name}` has no continuous_current and thermal_time");
                table.problem("temperature", text);
                [f64::NAN; 2]
            });
            Thermal { continuous_current, time_constant, surroundings, highest }
        };
        Self {
            following_error: table.number("following_error", "rad", POSITIVE),
            following_time: table.number("following_time", "s", NOT_NEGATIVE),
            over_current: table.number("over_current", "", 1.0..=10.0),
            warning: table.number("warning", "deg C", 40.0..=250.0),
            windings: drives.iter().map(winding).collect(),
        }
    }
}

/// `[home.JOINT]`: the home switches, by joint; none for a joint with an absolute encoder.
pub(crate) fn homes(top: &Section<'_, '_>, joints: &[Joint]) -> Vec<Option<HomeSwitch>> {
    let mut homes = vec![None; joints.len()];
    let names: Vec<&str> = joints.iter().map(|joint| joint.name.as_str()).collect();
    let row = |row: &Section<'_, '_>| HomeSwitch {
        angle: row.number("angle_deg", "deg", -360.0..=360.0).to_radians(),
        fast: row.number("fast", "rad/s", POSITIVE),
        slow: row.number("slow", "rad/s", POSITIVE),
    };
    let all = |table: &Section<'_, '_>| {
        for name in table.keys() {
            let home = table.table(&name, row);
            if let Some(j) = joint_index(table, &name, &name, &names) {
                homes[j] = home;
            }
        }
    };
    if top.has("home") {
        top.table("home", all);
    }
    homes
}
