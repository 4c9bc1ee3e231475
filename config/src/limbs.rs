//! Limbs that no foot needs: the camera head and the arms. A robot may have neither.

use crate::joint::{Joint, joint_index};
use crate::section::{NOT_NEGATIVE, POSITIVE, Section};

/// A camera head: pan about a vertical axis, tilt about a lateral one that meets it, cameras on what tilts.
#[derive(Clone, Debug, PartialEq)]
pub struct Head {
    /// Joint of the vertical axis.
    pub pan: usize,
    /// Joint of the lateral axis.
    pub tilt: usize,
    /// Joint of the angle between the cameras, and the distance of their focal points \[m\]; none: they are parallel.
    pub vergence: Option<(usize, f64)>,
    /// Link that carries the cameras; their optical axes lie along its x.
    pub link: String,
    /// \[m\] Middle between the focal points, in that link.
    pub camera: [f64; 3],
    /// \[rad/s\] Cut-off of the low pass of smooth pursuit.
    pub pursuit_bandwidth: f64,
    /// \[rad/s\] Fastest smooth pursuit.
    pub pursuit_speed: f64,
    /// \[rad\] Tracking error from which on the head jumps instead.
    pub saccade_error: f64,
    /// \[rad/s\] Fastest jump.
    pub saccade_speed: f64,
    /// \[rad/s^2\] Largest acceleration of jumps and pursuit.
    pub acceleration: f64,
    /// \[s\] Time after which the heading of odometry counts, not that of the inertial measurement unit.
    pub heading_time: f64,
    /// \[m\] Points nearer to the cameras than this are not looked at.
    pub nearest: f64,
}

/// The joints that swing the arms back and forth; right, left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arms {
    /// Indices of the joints.
    pub joints: [usize; 2],
}

impl Head {
    /// `[head]`.
    pub(crate) fn build(table: &Section<'_, '_>, joints: &[Joint]) -> Option<Self> {
        let names: Vec<&str> = joints.iter().map(|joint| joint.name.as_str()).collect();
        let joint = |key: &str| joint_index(table, key, &table.text(key), &names);
        let vergence = |table: &Section<'_, '_>| {
            let found = joint_index(table, "joint", &table.text("joint"), &names);
            (found, table.number("baseline", "m", 1e-3..=1.0))
        };
        let vergence = if table.has("vergence") { table.table("vergence", vergence) } else { None };
        let (pan, tilt) = (joint("pan"), joint("tilt"));
        let head = Self {
            pan: pan.unwrap_or(0),
            tilt: tilt.unwrap_or(0),
            vergence: vergence.and_then(|(joint, baseline)| Some((joint?, baseline))),
            link: table.text("link"),
            camera: table.numbers("camera", "m", -1.0..=1.0),
            pursuit_bandwidth: table.number("pursuit_bandwidth", "rad/s", POSITIVE),
            pursuit_speed: table.number("pursuit_speed", "rad/s", POSITIVE),
            saccade_error: table.number("saccade_error", "rad", NOT_NEGATIVE),
            saccade_speed: table.number("saccade_speed", "rad/s", POSITIVE),
            acceleration: table.number("acceleration", "rad/s^2", POSITIVE),
            heading_time: table.number("heading_time", "s", POSITIVE),
            nearest: table.number("nearest", "m", POSITIVE),
        };
        // A saccade takes over at the speed of pursuit, and no joint may be asked for more than it can.
        if head.pursuit_speed > head.saccade_speed {
            table.problem("pursuit_speed", "is above saccade_speed: a jump may begin at this speed");
        }
        for j in [pan, tilt].into_iter().flatten().chain(head.vergence.map(|(j, _)| j)) {
            let Joint { name, speed_limit, .. } = &joints[j];
            if head.saccade_speed > *speed_limit {
                let text = format!("is above the {speed_limit} rad/s of joint `{name}`");
                table.problem("saccade_speed", text);
            }
        }
        (pan.is_some() && tilt.is_some()).then_some(head)
    }
}

impl Arms {
    /// `[arms]`.
    pub(crate) fn build(table: &Section<'_, '_>, joints: &[Joint]) -> Option<Self> {
        let names: Vec<&str> = joints.iter().map(|joint| joint.name.as_str()).collect();
        let [right, left] = ["right", "left"].map(|key| joint_index(table, key, &table.text(key), &names));
        Some(Self { joints: [right?, left?] })
    }
}
