//! Inclination errors of the upper body (5.2), (5.3).

use super::walk::WalkData;
use drawing::color::{BLUE, GREY, VERMILION};
use drawing::{Chart, Figure};

pub(super) fn draw(walk: &WalkData) -> Result<Figure, String> {
    let end = walk.cycles.last().map_or(0.0, |c| c.time);
    let chart = |title: &str, axis: usize, color| {
        let largest = walk.cycles.iter().map(|c| c.state.inclination_error[axis].abs()).fold(0.0, f64::max);
        let title = format!("{title}: largest {largest:.4} rad ({:.2}°)", largest.to_degrees());
        let mut chart = Chart::new(&title, "time [s]", "error [rad]").height(330.0).at_least(0.002).robust();
        let error = walk.over_time(|c| c.state.inclination_error[axis]);
        if error.iter().any(|p| p[1].is_finite()) {
            chart.dashed("", vec![[0.0, 0.0], [end, 0.0]], GREY);
        }
        chart.line("desired − measured", error, color);
        chart
    };
    Ok(Figure::new("Inclination error of the upper body", &walk.about)
        .with(chart("φ_x, forwards and backwards", 0, BLUE))
        .with(chart("φ_y, to the sides", 1, VERMILION)))
}
