//! Stable gains of an elastic joint over its sampling time, as a picture.

use ::drives::elastic_joint::{ElasticJoint, Gains, HeldJoint};
use ::drives::{Feedback, Sampled};
use drawing::color::{BLUE, VERMILION};
use drawing::{Chart, Color, Figure, Pen};

use super::joint::{AIR, DELAYED, EXACT, STANCE};

/// \[s\] Shortest and longest sampling time, and how many.
const PERIODS: (f64, f64, u32) = (2e-4, 8e-3, 33);
/// \[N m s/rad\] Gains K_d that are tried, and how far they are apart.
const SPEED_GAINS: (f64, f64, f64) = (0.2, 14e3, 1.04);
/// Smallest and largest K_p/K that are looked at.
const POSITION_GAINS: (f64, f64) = (1e-3, 30.0);

struct Arrangement {
    name: &'static str,
    feedback: Feedback,
    sampled: Sampled,
    color: Color,
}

const ARRANGEMENTS: [Arrangement; 4] = [
    Arrangement { name: "motor", feedback: Feedback::Motor, sampled: EXACT, color: BLUE },
    Arrangement { name: "motor, 1 cycle late", feedback: Feedback::Motor, sampled: DELAYED, color: BLUE },
    Arrangement { name: "link + motor", feedback: Feedback::LinkMotor, sampled: EXACT, color: VERMILION },
    Arrangement {
        name: "link + motor, 1 cycle late",
        feedback: Feedback::LinkMotor,
        sampled: DELAYED,
        color: VERMILION,
    },
];

/// The picture.
pub(super) fn figure() -> Figure {
    let about = "J_J = 10 kg m2 standing, 0.5 in the air; J_M = 1.2, K = 31 kN m/rad. motor: (5.45), link + motor: (5.49). \
                 K_p up to 30 K, at its best K_d.";
    let mut figure = Figure::new("Stable gains of an elastic joint over its sampling time", about);
    for (name, joint) in [("standing", STANCE), ("in the air", AIR)] {
        figure = figure.with(position_chart(name, &joint)).with(speed_chart(name, &joint));
    }
    figure
}

fn position_chart(name: &str, joint: &ElasticJoint) -> Chart {
    let title = format!("Largest K_p, {name}");
    let mut chart = Chart::new(&title, "sampling time [ms]", "K_p / K [1]").logarithmic().height(330.0);
    for a in ARRANGEMENTS {
        let points =
            periods().map(|t| [1e3 * t, largest_position(joint, &joint.held(t), &a)]).collect::<Vec<_>>();
        chart.styled(a.name, points, a.pen());
    }
    chart
}

fn speed_chart(name: &str, joint: &ElasticJoint) -> Chart {
    let title = format!("K_d at K_p = 0.1 K, {name}");
    let mut chart = Chart::new(&title, "sampling time [ms]", "K_d [N m s/rad]").logarithmic().height(330.0);
    for a in ARRANGEMENTS {
        let ends: Vec<[f64; 3]> = periods()
            .map(|t| {
                let [least, largest] = speeds(joint, &joint.held(t), &a);
                [1e3 * t, least, largest]
            })
            .collect();
        chart.styled(a.name, ends.iter().map(|e| [e[0], e[2]]).collect(), a.pen());
        chart.styled("", ends.iter().map(|e| [e[0], e[1]]).collect(), a.pen());
    }
    chart
}

impl Arrangement {
    fn pen(&self) -> Pen {
        Pen { color: self.color, width: 2.5, dashed: self.sampled.delay }
    }

    fn stable(&self, joint: &ElasticJoint, held: &HeldJoint, kp: f64, kd: f64) -> bool {
        held.is_stable(self.feedback, Gains { position: kp * joint.stiffness, speed: kd }, self.sampled)
    }
}

fn periods() -> impl Iterator<Item = f64> {
    let (first, last, count) = PERIODS;
    (0..count).map(move |i| first * (last / first).powf(f64::from(i) / f64::from(count - 1)))
}

fn speed_gains() -> impl DoubleEndedIterator<Item = f64> {
    let (least, largest, factor) = SPEED_GAINS;
    let count = ((largest / least).ln() / factor.ln()) as i32;
    (0..=count).map(move |i| least * factor.powi(i))
}

/// K_p/K up to which all smaller ones are stable too, at the best K_d; NaN if there is none.
fn largest_position(joint: &ElasticJoint, held: &HeldJoint, a: &Arrangement) -> f64 {
    let (least, largest) = POSITION_GAINS;
    let mut best = least;
    for kd in speed_gains() {
        while best < largest && a.stable(joint, held, best * 1.02, kd) {
            best *= 1.02;
        }
    }
    if best > least { best } else { f64::NAN }
}

/// Ends of the stable K_d; NaN if there is none.
fn speeds(joint: &ElasticJoint, held: &HeldJoint, a: &Arrangement) -> [f64; 2] {
    let stable = |kd: &f64| a.stable(joint, held, 0.1, *kd);
    let [least, largest] = [speed_gains().find(stable), speed_gains().rfind(stable)];
    [least, largest].map(|end| end.unwrap_or(f64::NAN))
}
