//! Responses of the tuning as charts.

use drawing::color::{BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION};
use drawing::{Chart, Color, Figure};

use crate::joint_bench::ShaftState;

use super::{LedTrial, RECORD, TURN, Trial};

const COLORS: [Color; 6] = [BLUE, VERMILION, GREEN, PURPLE, SKY, ORANGE];
/// Name and title of the picture of each step of 6.1.2.
const STEPS: [(&str, &str); 4] = [
    ("raised.png", "Figures 6.3, 6.4: both gains raised by 50 %"),
    ("integral_printed.png", "Figure 6.5: K_I raised by 30 %, K_p / 3 as printed"),
    ("integral.png", "Figure 6.5: K_I raised by 30 %, K_p / 1.333"),
    ("best.png", "Figure 6.6: best gains, printed ones, K_I halved"),
];

/// The pictures with the names of their files; `step` \[rad/s\].
pub(super) fn figures(
    steps: &[Vec<Trial>],
    placed: &[Trial],
    led: &[LedTrial],
    step: f64,
) -> Vec<(&'static str, Figure)> {
    let mut figures = Vec::new();
    for ((name, title), trials) in STEPS.into_iter().zip(steps) {
        let beside: &[Trial] = if name == "best.png" { placed } else { &[] };
        let lines: Vec<(String, &[ShaftState])> =
            trials.iter().chain(beside).map(|t| (label(t), &t.response[..])).collect();
        figures.push((name, figure(title, &lines, ("speed / step [1]", step), seconds(trials))));
    }
    let lines: Vec<(String, &[ShaftState])> = led.iter().map(|t| (t.what.clone(), &t.response[..])).collect();
    let mut chart = Chart::new("Position", "time [ms]", "angle / step [1]");
    draw(&mut chart, &lines, |s| s.angle / TURN, 0.5 * RECORD);
    figures.push(("position.png", Figure::new("Figure 6.7: step of the position", "").with(chart)));
    figures
}

fn label(trial: &Trial) -> String {
    let what = trial.what.rsplit(", ").next().unwrap_or_default();
    if trial.printed.is_empty() { what.into() } else { format!("{what}: {}", trial.printed) }
}

/// \[s\] Time in which the responses differ: a record of slow ones, a tenth of it where all have settled by then.
fn seconds(trials: &[Trial]) -> f64 {
    if trials.iter().any(|t| t.measures.rise_s > 0.1 * RECORD) { RECORD } else { 0.1 * RECORD }
}

fn figure(title: &str, lines: &[(String, &[ShaftState])], (unit, step): (&str, f64), seconds: f64) -> Figure {
    let mut speed = Chart::new("Speed", "time [ms]", unit).robust();
    draw(&mut speed, lines, |s| s.speed / step, seconds);
    let mut current = Chart::new("Current", "time [ms]", "current [A]").robust();
    draw(&mut current, lines, |s| s.current, seconds);
    Figure::new(title, "").with(speed).with(current)
}

fn draw(chart: &mut Chart, lines: &[(String, &[ShaftState])], y: impl Fn(&ShaftState) -> f64, seconds: f64) {
    for (k, (name, states)) in lines.iter().enumerate() {
        let shown = states.iter().filter(|s| s.time <= seconds);
        chart.line(name, shown.map(|s| [1e3 * s.time, y(s)]).collect(), COLORS[k % COLORS.len()]);
    }
}
