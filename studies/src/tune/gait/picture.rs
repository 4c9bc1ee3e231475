//! Cost over evaluations, and its slices through the optimum.

use drawing::color::{BLUE, GREEN, VERMILION};
use drawing::{Chart, Color, Figure};

use super::cost::NO_WALK;
use super::{Search, Slice};

const COLORS: [Color; 3] = [BLUE, VERMILION, GREEN];

/// One chart of the searches, one for each slice.
pub(super) fn draw(scene: &str, searches: &[Search], slices: &[Slice]) -> Figure {
    let mut chart = Chart::new("Least cost so far", "evaluations", "cost").height(300.0).logarithmic();
    for (search, color) in searches.iter().zip(COLORS.into_iter().cycle()) {
        // From the first walk on.
        let walked = search.history.iter().enumerate().filter(|(_, cost)| **cost < NO_WALK);
        let points = walked.map(|(k, &cost)| [k as f64 + 1.0, cost]).collect();
        chart.line(&search.method.name(), points, color);
    }
    let mut figure = Figure::new("Tuned gait", &format!("scene {scene}")).with(chart);
    let best = searches.iter().map(|search| search.cost).fold(f64::INFINITY, f64::min);
    for slice in slices {
        let mut chart = Chart::new("", &slice.key, "cost over the least").height(220.0).robust();
        let points: Vec<[f64; 2]> =
            slice.points.iter().filter_map(|&(x, c)| c.map(|c| [x, c / best])).collect();
        chart.line("", points.clone(), BLUE);
        chart.dots("", points, 3.0, BLUE);
        chart.dots("best", vec![[slice.best, 1.0]], 6.0, VERMILION);
        figure = figure.with(chart);
    }
    figure
}
