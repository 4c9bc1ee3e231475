//! The load of CAN lines over time, as a picture.

use drawing::color::{BLUE, GREEN, GREY, VERMILION};
use drawing::{Chart, Figure};
use fieldbus::load_course::{LineCourse, LoadCourse, PIECE};

/// Points of a line; more are not told apart.
const MOST_POINTS: usize = 400;
/// Lines in one chart.
const TOGETHER: usize = 3;

/// Charts of up to three lines each.
pub(super) fn figure(course: &LoadCourse, names: &[String], source: &str) -> Figure {
    let (piece, lines) = course.lines(MOST_POINTS);
    let fullest = lines.iter().max_by(|a, b| a.mean.total_cmp(&b.mean));
    let about = fullest.map_or_else(
        || format!("{source}  ·  no frame"),
        |line| {
            let (name, piece, short) = (&names[line.line as usize], 1e3 * piece, PIECE as f64 * 1e-6);
            format!("{source}  ·  fullest line {name}  ·  curves: means of {piece:.0} ms; titles: mean, largest of {short:.0} ms")
        },
    );
    let charts = lines.chunks(TOGETHER).map(|lines| chart(lines, names));
    charts.fold(Figure::new("Load of the lines", &about), Figure::with)
}

fn chart(lines: &[LineCourse], names: &[String]) -> Chart {
    let percent = |share: f64| 100.0 * share;
    let said = lines.iter().map(|line| {
        let name = &names[line.line as usize];
        format!("{name} {:.1}, {:.1} %", percent(line.mean), percent(line.most))
    });
    let title = said.collect::<Vec<_>>().join("; ");
    let mut chart = Chart::new(&title, "time [s]", "load [%]").height(230.0);
    let end = lines.iter().filter_map(|line| line.points.last()).map(|p| p[0]).fold(0.0, f64::max);
    chart.dashed("", vec![[0.0, 0.0], [end, 0.0]], GREY);
    for (line, color) in lines.iter().zip([BLUE, VERMILION, GREEN]) {
        let points = line.points.iter().map(|[time, share]| [*time, percent(*share)]).collect();
        chart.line(&names[line.line as usize], points, color);
    }
    chart
}
