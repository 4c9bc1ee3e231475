//! `[joint_control]`: how drives are controlled, of a robot, of one of its drives, or of all of them in a scene.

use std::ops::RangeInclusive;

use drives::{Cascade, ControlLaw, Feedback, JointControl, Resolution, Sampled, Sampling, VoltageLaw};

use crate::section::{NOT_NEGATIVE, POSITIVE, Section};

/// Stand-in while a file is wrong, and of robots without drives.
pub(crate) const NONE: JointControl = JointControl {
    law: ControlLaw::Voltage(VoltageLaw { position: f64::NAN, speed: f64::NAN }),
    sampling: Sampling::Cycle(Sampled { delay: false, difference: false }),
    resolution: Resolution { table_points: None, encoder_counts: None },
};

/// Points of a look-up table in each dimension: an ankle's largest one has 1025^2 rows of 12 bytes.
const TABLE_POINTS: RangeInclusive<u64> = 2..=1025;
/// Counts in a turn of a motor.
const ENCODER_COUNTS: RangeInclusive<u64> = 2..=1 << 24;

pub(crate) fn build(table: &Section<'_, '_>) -> JointControl {
    let law = match table.word("law", &["cascade", "voltage"]) {
        0 => ControlLaw::Cascade(cascade(table)),
        _ => ControlLaw::Voltage(VoltageLaw {
            position: table.number("position", "V/rad", POSITIVE),
            speed: table.number("speed", "V s/rad", NOT_NEGATIVE),
        }),
    };
    let sampling = match table.word("sampling", &["continuous", "cycle"]) {
        0 => Sampling::Continuous,
        _ => Sampling::Cycle(Sampled {
            delay: table.integer("delay", 0..=1) == 1,
            difference: table.word("speed_from", &["state", "difference"]) == 1,
        }),
    };
    if matches!(law, ControlLaw::Voltage(_)) && sampling == Sampling::Continuous {
        table.problem("sampling", "the law \"voltage\" is computed once per cycle; it takes \"cycle\"");
    }
    let points = table.has("table_points").then(|| table.integer("table_points", TABLE_POINTS) as u32);
    let resolution = Resolution { table_points: points, encoder_counts: encoder_counts(table) };
    JointControl { law, sampling, resolution }
}

/// Counts in a turn of the motor: of all drives in `[joint_control]`, of some in `[motor.NAME]`.
pub(crate) fn encoder_counts(table: &Section<'_, '_>) -> Option<u32> {
    table.has("encoder_counts").then(|| table.integer("encoder_counts", ENCODER_COUNTS) as u32)
}

fn cascade(table: &Section<'_, '_>) -> Cascade {
    Cascade {
        feedback: Feedback::ALL[table.word("feedback", &Feedback::WORDS)],
        position_gain: table.number("position_gain", "1/s", POSITIVE),
        speed_bandwidth: table.number("speed_bandwidth", "rad/s", POSITIVE),
        current_bandwidth: table.number("current_bandwidth", "rad/s", POSITIVE),
    }
}
