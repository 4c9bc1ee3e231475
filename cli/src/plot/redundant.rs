//! Angles of the joints that a walk on flat ground could do without: pelvis and toes (thesis figure 8.4).

use super::walk::WalkData;
use drawing::color::{BLUE, GREEN, VERMILION};
use drawing::{Chart, Figure};

pub(super) fn draw(walk: &WalkData) -> Result<Figure, String> {
    let named = |part: &str| -> Vec<usize> {
        let joints = walk.robot.joints.iter().enumerate();
        joints.filter(|(_, name)| name.contains(part)).map(|(i, _)| i).collect()
    };
    if walk.cycles.iter().all(|c| c.angle[0].is_nan()) {
        return Err("the log has no sensor records".into());
    }
    let mut figure = Figure::new("Angles of pelvis and toes", &walk.about);
    let groups = [("Pelvis", named("pelvis")), ("Toes", named("toe"))];
    if groups.iter().all(|(_, joints)| joints.is_empty()) {
        return Err("no joint is called pelvis or toe".into());
    }
    for (title, joints) in groups.iter().filter(|(_, joints)| !joints.is_empty()) {
        let mut chart = Chart::new(title, "time [s]", "angle [rad]").height(300.0).at_least(0.05);
        for (&joint, color) in joints.iter().zip([VERMILION, BLUE, GREEN]) {
            let name = walk.robot.joints[joint].replace('_', " ");
            chart.line(&name, walk.over_time(|c| c.angle[joint]), color);
        }
        figure = figure.with(chart);
    }
    Ok(figure)
}
