//! Rates as pictures: over the size for each kind.

use drawing::color::{BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION};
use drawing::{Chart, Color, Figure, Pen};

use super::Row;

const COLORS: [Color; 6] = [BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY];

/// One chart for each kind, a line for each type and speed.
pub(super) fn rates(rows: &[Row], about: &str) -> Figure {
    let mut figure = Figure::new("How often unknown ground is walked over", about);
    for of in rows.chunk_by(|a, b| a.kind == b.kind) {
        let mut chart = Chart::new(of[0].name, &format!("size [{}]", of[0].unit), "share walked [1]")
            .height(220.0)
            .at_least(1.0);
        let mut walks: Vec<(u8, f64)> = Vec::new();
        of.iter().map(|r| (r.depth, r.speed_kmh)).for_each(|walk| {
            if !walks.contains(&walk) {
                walks.push(walk);
            }
        });
        for (k, &(depth, kmh)) in walks.iter().enumerate() {
            let these = of.iter().filter(|r| (r.depth, r.speed_kmh) == (depth, kmh));
            let mut points: Vec<[f64; 2]> = these.map(|r| [r.size, r.rate]).collect();
            points.sort_by(|a, b| a[0].total_cmp(&b[0]));
            let pen = Pen { color: COLORS[k % COLORS.len()], width: 2.5, dashed: k >= COLORS.len() };
            chart.styled(&format!("type {depth}, {kmh} km/h"), points.clone(), pen);
            chart.dots("", points, 6.0, pen.color);
        }
        figure = figure.with(chart);
    }
    figure
}
