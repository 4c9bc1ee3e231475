//! Vertical forces on the feet: measured, and desired after modification (5.22).

use super::walk::WalkData;
use drawing::color::{BLACK, BLUE, VERMILION};
use drawing::{Chart, Figure};

pub(super) fn draw(walk: &WalkData) -> Result<Figure, String> {
    if walk.cycles.iter().all(|c| c.force_z[0].is_nan()) {
        return Err("the log has no sensor records".into());
    }
    let chart = |title: &str, foot: usize, color| {
        let peak = walk.cycles.iter().map(|c| c.force_z[foot]).fold(0.0, f64::max);
        let title = format!("{title}: peak {peak:.0} N");
        let mut chart =
            Chart::new(&title, "time [s]", "vertical force [N]").height(360.0).at_least(10.0).robust();
        chart.line("measured", walk.over_time(|c| c.force_z[foot]), color);
        chart.dashed("desired", walk.over_time(|c| c.state.wrench_desired[foot].force[2]), BLACK);
        chart
    };
    Ok(Figure::new("Vertical contact forces", &walk.about)
        .with(chart("Right foot", 0, VERMILION))
        .with(chart("Left foot", 1, BLUE)))
}
