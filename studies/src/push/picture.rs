//! Survived impulses as a polar plot: around the circle goes the stride, outwards the impulse.

use std::f64::consts::TAU;

use drawing::color::{BLUE, GREEN, GREY, LIGHT, ORANGE, PURPLE, SKY, VERMILION};
use drawing::{Chart, Color, Figure, Pen};

use super::Row;

/// By direction: sides and diagonals, dashed where it is to the right of its mirror image.
const PENS: [(Color, bool); 8] = [
    (BLUE, false),
    (SKY, false),
    (VERMILION, false),
    (ORANGE, false),
    (GREEN, false),
    (ORANGE, true),
    (PURPLE, false),
    (SKY, true),
];

/// One case beside the bound of the pendulum, forward, backward and to the sides; of a robot of this mass \[kg\].
pub(super) fn beside_bound(rows: &[Row], mass: f64) -> Figure {
    let mut chart = Chart::new("", "share of the stride", "[N s/kg]").at_least(0.2);
    for (row, (color, _)) in rows.iter().zip(PENS).step_by(2) {
        let line = |impulses: &[f64], by: f64| {
            row.share.iter().zip(impulses).map(|(share, x)| [*share, x / by]).collect::<Vec<_>>()
        };
        let survived = line(&row.impulse_n_s, mass);
        chart.dots("", survived.clone(), 3.5, color);
        chart.line(row.direction, survived, color);
        chart.dashed(&format!("{}, pendulum", row.direction), line(&row.bound_n_s_per_kg, 1.0), color);
    }
    Figure::new("Impulse survived, and what a pendulum is caught from in one step", &about(rows)).with(chart)
}

/// The case, in words.
fn about(rows: &[Row]) -> String {
    rows.first().map_or(String::new(), |row| {
        let (walk, depth, cycle) = (&row.walk, row.depth, 1e3 * row.cycle_s);
        format!("{walk}, type {depth}, cycle {cycle} ms, sensors {}, {} m above", row.sensors, row.above_m)
    })
}

/// One case, all directions; of a robot of this mass \[kg\].
pub(super) fn polar(rows: &[Row], mass: f64) -> Figure {
    let mut chart = Chart::new("", "[N s/kg]", "[N s/kg]").equal();
    let most = rows.iter().flat_map(|row| &row.impulse_n_s).fold(0.0_f64, |most, x| most.max(x / mass));
    let ring = 10f64.powf((most / 2.0).log10().floor());
    let ring = [1.0, 2.0, 5.0].map(|x| x * ring).into_iter().rfind(|x| 2.0 * x <= most).unwrap_or(ring);
    let at = |share: f64, radius: f64| {
        let (sin, cos) = (TAU * share).sin_cos();
        [radius * cos, radius * sin]
    };
    for k in 1..=(most / ring).ceil().max(1.0) as u32 {
        let radius = f64::from(k) * ring;
        let circle = (0..=180).map(|j| at(f64::from(j) / 180.0, radius)).collect();
        chart.styled("", circle, Pen { color: LIGHT, width: 1.5, dashed: false });
        chart.label(at(0.125, radius), &format!("{radius:.2}"), GREY);
    }
    for (row, (color, dashed)) in rows.iter().zip(PENS) {
        // Instants are in their order; the last one meets the first one again.
        let mut line: Vec<_> =
            row.share.iter().zip(&row.impulse_n_s).map(|(s, x)| at(*s, x / mass)).collect();
        chart.dots("", line.clone(), 3.5, color);
        line.extend(line.first().copied());
        chart.styled(row.direction, line, Pen { color, width: 2.5, dashed });
    }
    let about = format!("{}; angle: share of the stride, from the right foot's load on", about(rows));
    Figure::new("Impulse survived over the stride, by direction", &about).with(chart)
}
