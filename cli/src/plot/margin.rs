//! Stability margin: distance of the zero-moment point to the edge of the support polygon, over time.

use super::walk::WalkData;
use drawing::color::{BLUE, GREY};
use drawing::{Chart, Figure};

/// \[m\] Below this little is left.
const LITTLE: f64 = 0.01;

pub(super) fn draw(walk: &WalkData) -> Result<Figure, String> {
    let known: Vec<[f64; 2]> =
        walk.over_time(|c| c.state.zmp_margin).into_iter().filter(|p| p[1].is_finite()).collect();
    let least = known.iter().min_by(|a, b| a[1].total_cmp(&b[1])).ok_or("no foot ever carries load")?;
    let little = known.iter().filter(|p| p[1] < LITTLE).count() as f64 / known.len() as f64;
    let title = format!(
        "Least {:.1} mm at {:.2} s; below {:.0} mm in {:.1} % of the time",
        1e3 * least[1],
        least[0],
        1e3 * LITTLE,
        100.0 * little
    );
    let mut chart = Chart::new(&title, "time [s]", "distance to the edge [mm]").height(500.0).at_least(10.0);
    let end = walk.cycles.last().map_or(0.0, |c| c.time);
    chart.line("zero-moment point, inside is positive", walk.over_time(|c| 1e3 * c.state.zmp_margin), BLUE);
    chart.dashed("edge of the support polygon", vec![[0.0, 0.0], [end, 0.0]], GREY);
    Ok(Figure::new("Stability margin", &walk.about).with(chart.robust()))
}
