//! `[joint_control]`: how drives are controlled, of a robot, of one of its drives, or of all of them in a scene.

use std::ops::RangeInclusive;

use drives::{
    Cascade, CascadeOutput, CascadePi, ControlLaw, Feedback, JointControl, Resolution, SamplePeriods,
    Sampled, Sampling, VoltageLaw,
};

use crate::section::{NOT_NEGATIVE, POSITIVE, Section};

/// Stand-in while a file is wrong, and of robots without drives.
pub(crate) const NONE: JointControl = JointControl {
    law: ControlLaw::Voltage(VoltageLaw { position: f64::NAN, speed: f64::NAN }),
    sampling: Sampling::Cycle(Sampled { delay: false, difference: false }),
    resolution: Resolution { table_points: None, encoder_counts: None },
};

/// Points of a look-up table in each dimension: an ankle's largest one has 1025^2 rows of 12 bytes.
const TABLE_POINTS: RangeInclusive<u64> = 2..=1025;
/// \[s\] Periods of a drive's own clock.
const PERIOD: RangeInclusive<f64> = 1e-5..=0.01;
/// Counts in a turn of a motor.
const ENCODER_COUNTS: RangeInclusive<u64> = 2..=1 << 24;

pub(crate) fn build(table: &Section<'_, '_>) -> JointControl {
    let law = match table.word("law", &["cascade", "cascade_pi", "voltage"]) {
        0 => ControlLaw::Cascade(cascade(table)),
        1 => ControlLaw::CascadePi(cascade_pi(table)),
        _ => ControlLaw::Voltage(VoltageLaw {
            position: table.number("position", "V/rad", POSITIVE),
            speed: table.number("speed", "V s/rad", NOT_NEGATIVE),
        }),
    };
    let sampling = match table.word("sampling", &["continuous", "cycle", "period"]) {
        0 => Sampling::Continuous,
        2 => Sampling::Period(periods(table)),
        _ => Sampling::Cycle(Sampled {
            delay: table.integer("delay", 0..=1) == 1,
            difference: table.word("speed_from", &["state", "difference"]) == 1,
        }),
    };
    match (law, sampling) {
        (ControlLaw::Voltage(_), Sampling::Continuous | Sampling::Period(_)) => {
            table.problem("sampling", "the law \"voltage\" is computed once per cycle; it takes \"cycle\"");
        }
        (ControlLaw::Cascade(_), Sampling::Period(_)) => {
            let text = "the law \"cascade\" takes \"continuous\" or \"cycle\"; a period of its own has \"cascade_pi\"";
            table.problem("sampling", text);
        }
        (ControlLaw::CascadePi(_), Sampling::Continuous | Sampling::Cycle(_)) => {
            let text = "the law \"cascade_pi\" has a clock of its own; it takes \"period\", with speed_period and \
                        position_period";
            table.problem("sampling", text);
        }
        _ => {}
    }
    let points = table.has("table_points").then(|| table.integer("table_points", TABLE_POINTS) as u32);
    let resolution = Resolution { table_points: points, encoder_counts: encoder_counts(table) };
    JointControl { law, sampling, resolution }
}

/// Counts in a turn of the motor: of all drives in `[joint_control]`, of some in `[motor.NAME]`.
pub(crate) fn encoder_counts(table: &Section<'_, '_>) -> Option<u32> {
    table.has("encoder_counts").then(|| table.integer("encoder_counts", ENCODER_COUNTS) as u32)
}

fn cascade_pi(table: &Section<'_, '_>) -> CascadePi {
    CascadePi {
        position_gain: table.number("position_gain", "1/s", POSITIVE),
        speed_bandwidth: table.number("speed_bandwidth", "rad/s", POSITIVE),
        speed_integral: table.number("speed_integral", "1/s", NOT_NEGATIVE),
        speed_filter: table.number("speed_filter", "s", 0.0..=0.1),
        feed_forward: table.numbers("feed_forward", "", 0.0..=1.0),
        output: match table.word("output", &["current", "voltage"]) {
            0 => CascadeOutput::Current(table.number("current_bandwidth", "rad/s", POSITIVE)),
            _ => CascadeOutput::Voltage,
        },
    }
}

fn periods(table: &Section<'_, '_>) -> SamplePeriods {
    let speed = table.number("speed_period", "s", PERIOD);
    let position = table.number("position_period", "s", PERIOD);
    let samples = (position / speed).round();
    // NaN: its own problem has been named.
    if (position / speed - samples).abs() > 1e-6 * samples || samples < 1.0 {
        let text = format!("{position} is not allowed; it takes a whole multiple of speed_period = {speed}");
        table.problem("position_period", text);
    }
    SamplePeriods { speed, position_every: samples as u32 }
}

fn cascade(table: &Section<'_, '_>) -> Cascade {
    Cascade {
        feedback: Feedback::ALL[table.word("feedback", &Feedback::WORDS)],
        position_gain: table.number("position_gain", "1/s", POSITIVE),
        speed_bandwidth: table.number("speed_bandwidth", "rad/s", POSITIVE),
        current_bandwidth: table.number("current_bandwidth", "rad/s", POSITIVE),
    }
}
