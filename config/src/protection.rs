//! Functions of the drives themselves: limits at which they fail safe, and home switches of joints without absolute
//! encoder.

use drives::homing::HomeSwitch;
use drives::thermal::Thermal;

use crate::drive::Drive;
use crate::joint::{Joint, joint_index};
use crate::section::{NOT_NEGATIVE, POSITIVE, Section};

/// `[protection]`: limits of every drive.
#[derive(Clone, Debug, PartialEq)]
pub struct Protection {
    /// \[rad\] Following error at rest that is a fault.
    pub following_error: f64,
    /// \[s\] Following error that is allowed in addition, per rad/s of joint speed.
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
                let text =
                    format!("needs continuous_current and thermal_time of the motor of drive `{name}`");
                table.problem("temperature", text);
                [f64::NAN; 2]
            });
            Thermal { continuous_current, time_constant, surroundings, highest }
        };
        let warning = table.number("warning", "deg C", 40.0..=250.0);
        if warning <= surroundings || warning >= highest {
            table.problem(
                "warning",
                format!("{warning} deg C must lie between surroundings = {surroundings} and temperature = {highest} deg C"),
            );
        }
        Self {
            following_error: table.number("following_error", "rad", POSITIVE),
            following_time: table.number("following_time", "s", NOT_NEGATIVE),
            over_current: table.number("over_current", "", 1.0..=10.0),
            warning,
            windings: drives.iter().map(winding).collect(),
        }
    }
}

/// `[home.JOINT]`: the home switches, by joint; none for a joint with an absolute encoder.
pub(crate) fn homes(top: &Section<'_, '_>, joints: &[Joint]) -> Vec<Option<HomeSwitch>> {
    let mut homes = vec![None; joints.len()];
    let names: Vec<&str> = joints.iter().map(|joint| joint.name.as_str()).collect();
    let all = |table: &Section<'_, '_>| {
        for name in table.keys() {
            let joint = joint_index(table, &name, &name, &names);
            let home = table.table(&name, |row| switch(row, joint.map(|j| &joints[j])));
            if let Some(j) = joint {
                homes[j] = home;
            }
        }
    };
    if top.has("home") {
        top.table("home", all);
    }
    homes
}

/// A home switch that its joint, if there is such a one, can reach and cross.
fn switch(row: &Section<'_, '_>, joint: Option<&Joint>) -> HomeSwitch {
    let angle_deg = row.number("angle_deg", "deg", -360.0..=360.0);
    let switch = HomeSwitch {
        angle: angle_deg.to_radians(),
        fast: row.number("fast", "rad/s", POSITIVE),
        slow: row.number("slow", "rad/s", POSITIVE),
    };
    if switch.slow > switch.fast {
        row.problem("slow", format!("{} rad/s must not be above fast = {} rad/s", switch.slow, switch.fast));
    }
    let Some(joint) = joint else { return switch };
    let [lo, hi] = joint.range;
    if switch.angle <= lo || switch.angle >= hi {
        let [lo, hi] = [lo, hi].map(f64::to_degrees);
        let text = format!("{angle_deg} lies outside of the joint's range_deg [{lo:.1}, {hi:.1}]");
        row.problem("angle_deg", text);
    }
    if switch.fast > joint.speed_limit {
        let text =
            format!("{} rad/s is above the joint's speed_limit, {} rad/s", switch.fast, joint.speed_limit);
        row.problem("fast", text);
    }
    switch
}
