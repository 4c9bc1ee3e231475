//! Tracking error of the leg joints.

use super::walk::WalkData;
use drawing::color::{BLUE, VERMILION};
use drawing::{Chart, Figure};

/// \[rad\] Resolution of the bus: joints without drives are off their targets by less.
const NOTHING: f64 = 1e-6;
/// Title, and the words that the names of its joints contain.
const GROUPS: [(&str, &str, &str); 3] =
    [("Hip flexion", "hip", "flex"), ("Knee", "knee", ""), ("Ankle flexion", "ankle", "flex")];

pub(super) fn draw(walk: &WalkData) -> Result<Figure, String> {
    let moves = |c: &super::walk::CycleData| c.state.tracking_error.iter().any(|error| error.abs() > NOTHING);
    if !walk.cycles.iter().any(moves) {
        return Err(
            "every joint is where its target is: the scene has no drives (depth = 2 or more has)".into()
        );
    }
    let mut figure = Figure::new("Joint tracking: target of the last cycle − measured angle", &walk.about);
    let mut found = false;
    for (title, part, motion) in GROUPS {
        let joints: Vec<usize> = walk
            .robot
            .joints
            .iter()
            .enumerate()
            .filter(|(_, name)| name.contains(part) && name.contains(motion))
            .map(|(i, _)| i)
            .collect();
        if joints.is_empty() {
            continue;
        }
        found = true;
        figure = figure.with(chart(walk, title, &joints));
    }
    if found { Ok(figure) } else { Err("no joint is called hip, knee or ankle".into()) }
}

fn chart(walk: &WalkData, title: &str, joints: &[usize]) -> Chart {
    let error = |joint: usize| move |c: &super::walk::CycleData| c.state.tracking_error[joint];
    let largest =
        joints.iter().flat_map(|&j| walk.cycles.iter().map(move |c| error(j)(c).abs())).fold(0.0, f64::max);
    let title = format!("{title}: largest {largest:.4} rad");
    let mut chart = Chart::new(&title, "time [s]", "error [rad]").height(270.0).at_least(2e-3).robust();
    for (&joint, color) in joints.iter().zip([VERMILION, BLUE]) {
        chart.line(&walk.robot.joints[joint].replace('_', " "), walk.over_time(error(joint)), color);
    }
    chart
}
