//! The zero-moment point in the support polygons: from above and over time.

use super::paths::{draw_footprints, map};
use super::walk::WalkData;
use drawing::color::{BLACK, GREEN, VERMILION};
use drawing::{Chart, Figure};

pub(super) fn draw(walk: &WalkData) -> Result<Figure, String> {
    if walk.cycles.iter().all(|c| c.state.zmp[0].is_nan()) {
        return Err("no foot ever carries load".into());
    }
    let mut above = map("From above");
    draw_footprints(&mut above, walk);
    above.line("measured", walk.path(|c| c.place(c.state.zmp)), VERMILION);
    above.dashed("planned", walk.path(|c| c.place(c.state.zmp_desired)), BLACK);
    let margin = walk
        .cycles
        .iter()
        .map(|c| c.state.zmp_margin)
        .filter(|m| m.is_finite())
        .fold(f64::INFINITY, f64::min);
    let title =
        format!("Zero-moment point and support: least distance to the edge {:.1} mm", 1000.0 * margin);
    Ok(Figure::new(&title, &walk.about)
        .with(above)
        .with(over_time(walk, 0, "Forward"))
        .with(over_time(walk, 1, "Sideways")))
}

/// One coordinate with the extent of the support polygon in that direction.
fn over_time(walk: &WalkData, axis: usize, title: &str) -> Chart {
    let label = ["x [m]", "y [m]"][axis];
    let mut chart = Chart::new(title, "time [s]", label).height(400.0).at_least(0.05);
    let time: Vec<f64> = walk.cycles.iter().map(|c| c.time).collect();
    let (mut lo, mut hi) = (Vec::new(), Vec::new());
    for cycle in &walk.cycles {
        let polygon = cycle.support(&walk.robot);
        let all = polygon.iter().map(|p| p[axis]);
        let none = if polygon.is_empty() { f64::NAN } else { f64::INFINITY };
        lo.push(all.clone().fold(none, |a, b| if a.is_nan() { a } else { a.min(b) }));
        hi.push(all.fold(-none, |a, b| if a.is_nan() { a } else { a.max(b) }));
    }
    chart.band("support polygon", &time, &lo, &hi, GREEN.faint(0x40));
    chart.line("measured", walk.over_time(|c| c.place(c.state.zmp)[axis]), VERMILION);
    chart.dashed("planned", walk.over_time(|c| c.place(c.state.zmp_desired)[axis]), BLACK);
    chart
}
