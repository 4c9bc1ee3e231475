//! Charts as pictures: cost along x, error along y, both logarithmic, a curve for each method, its step beside each point.
//! A dashed line across stands where the largest stable step of an explicit method is; the legend has it if that is not on
//! the curve.

use std::path::Path;

use drawing::color::{BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION};
use drawing::{Color, Figure, Pen};

use super::order::in_ms;
use super::{Cost, ErrorChart, Point};
use crate::Sheet;

const COLORS: [Color; 6] = [BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY];

/// Of curves with more points than this every second one has a label.
const CROWDED: usize = 6;

/// Draws the pictures.
pub(super) fn draw(charts: &[ErrorChart], out: &Path, sheet: &mut Sheet) -> Result<(), String> {
    for together in charts.chunk_by(|a, b| file(a) == file(b)) {
        let first = &together[0];
        let figure = Figure::new(&first.title, &first.about);
        let figure = together.iter().fold(figure, |figure, chart| figure.with(panel(chart)));
        sheet.draw(out, &format!("{}.png", file(first)), &figure)?;
    }
    Ok(())
}

fn file(chart: &ErrorChart) -> &str {
    chart.name.split('.').next().unwrap_or_default()
}

fn panel(chart: &ErrorChart) -> drawing::Chart {
    let x = match chart.cost {
        Cost::PerSecond => "processor time by simulated time [s/s]",
        Cost::PerCall => "processor time of one call [us]",
        Cost::Calls => "evaluations of the right-hand side in a simulated second",
    };
    let mut axes = drawing::Chart::new("", x, &chart.measure).logarithmic().height(520.0);
    let seen = || chart.points.iter().map(|p| visible(p.error)).filter(|e| e.is_finite() && *e > 0.0);
    let (low, high) = (seen().fold(f64::INFINITY, f64::min), seen().fold(0.0, f64::max));
    for (k, curve) in curves(&chart.points).into_iter().enumerate() {
        let color = COLORS[k % COLORS.len()];
        let pen = Pen { color, width: 2.5, dashed: k >= COLORS.len() };
        let points: Vec<_> = curve.points.iter().map(|p| [cost(p, chart.cost), visible(p.error)]).collect();
        let limit = chart.limits.iter().find(|l| l.method == curve.method).map(|l| l.step);
        // Ramps of friction; the unit stands below the title, for the legend is one line.
        let mut name = curve.name.replace(" rad/s", "");
        if let Some(limit) = limit {
            if let Some(x) = curve.cost_at(limit, chart.cost) {
                axes.styled("", vec![[x, low], [x, high]], Pen { color, width: 1.5, dashed: true });
                axes.label([x, low], &format!("stable to {}", in_ms(limit)), color);
            } else {
                name += &format!(" ≤ {}", in_ms(limit));
            }
        }
        if chart.scattered {
            axes.dots(&name, points.clone(), 5.0, color);
        } else {
            axes.styled(&name, points.clone(), pen).dots("", points.clone(), 5.0, color);
        }
        let every = if points.len() > CROWDED { 2 } else { 1 };
        for (at, p) in points.iter().zip(&curve.points).step_by(every) {
            axes.label(*at, &label(p), GREY);
        }
    }
    axes
}

/// Points of one method on one model, as one line.
struct Curve<'a> {
    name: String,
    method: &'a str,
    points: Vec<&'a Point>,
}

impl Curve<'_> {
    /// What a step \[s\] costs, by what the curve's own cost: the same for every step. None outside of the curve.
    fn cost_at(&self, step: f64, along: Cost) -> Option<f64> {
        let mut each: Vec<f64> = self.points.iter().filter_map(|p| Some(cost(p, along) * p.step?)).collect();
        each.sort_by(f64::total_cmp);
        let steps = || self.points.iter().filter_map(|p| p.step);
        let (least, most) = (steps().fold(f64::INFINITY, f64::min), steps().fold(0.0, f64::max));
        (least..=most).contains(&step).then(|| each[each.len() / 2] / step)
    }
}

/// Curves in the order in which they first occur; model and scene are in a name if its method has several.
fn curves(points: &[Point]) -> Vec<Curve<'_>> {
    let varies = |of: fn(&Point) -> &str| {
        let differ = |a: &Point, b: &Point| a.method == b.method && of(a) != of(b);
        points.iter().any(|a| points.iter().any(|b| differ(a, b)))
    };
    let (models, scenes) = (varies(|p| &p.model), varies(|p| &p.scene));
    let mut curves: Vec<Curve<'_>> = Vec::new();
    for p in points {
        let mut name = p.method.clone();
        for (shown, part) in [(models, &p.model), (scenes, &p.scene)] {
            if shown {
                name += &format!(", {part}");
            }
        }
        match curves.iter_mut().find(|c| c.name == name) {
            Some(curve) => curve.points.push(p),
            None => curves.push(Curve { name, method: &p.method, points: vec![p] }),
        }
    }
    curves
}

fn cost(p: &Point, cost: Cost) -> f64 {
    let found = match cost {
        Cost::PerSecond => p.cpu_s_per_s,
        Cost::PerCall => p.cpu_us,
        Cost::Calls => p.calls_per_s,
    };
    found.unwrap_or(f64::NAN)
}

/// No error at all is drawn where rounding errors are.
const ZERO: f64 = 1e-17;

fn visible(error: f64) -> f64 {
    if error == 0.0 { ZERO } else { error }
}

fn label(p: &Point) -> String {
    p.solver.clone().or_else(|| p.step.map(in_ms)).unwrap_or_default()
}
