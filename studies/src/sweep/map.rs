//! Maps of a sweep: over two of its numbers, the share of walks that were survived, and the mean of a figure over those.

use config::Sweep;
use config::sweep::{SweepMap, SweptNumber, SweptValues};
use drawing::color::{BLACK, BLUE, GREY};
use drawing::{Chart, Figure};

use super::columns::{Cell, CellType};

/// Strips of an axis whose number is drawn.
const STRIPS: usize = 10;
/// Cells of a row or column at most, for their values to be written into them.
const WRITTEN: usize = 12;

/// A map's axis: where its cells begin and end.
struct Axis<'a> {
    column: usize,
    key: &'a str,
    edges: Vec<f64>,
}

impl<'a> Axis<'a> {
    fn of(number: &'a SweptNumber, columns: &[(String, CellType)]) -> Option<Self> {
        let column = columns.iter().position(|(name, _)| *name == number.key)?;
        let edges = match &number.values {
            SweptValues::Each(values) => edges(values),
            SweptValues::Drawn([low, high]) => {
                (0..=STRIPS).map(|k| low + (high - low) * k as f64 / STRIPS as f64).collect()
            }
        };
        Some(Self { column, key: &number.key, edges })
    }

    fn cells(&self) -> usize {
        self.edges.len() - 1
    }

    /// The cell of a row.
    fn cell(&self, row: &[Cell]) -> Option<usize> {
        let x = number(&row[self.column])?;
        let within = |k: &usize| (self.edges[*k]..=self.edges[k + 1]).contains(&x);
        (0..self.cells()).find(within)
    }
}

/// Ends of cells with these values inside: midway between neighbours.
fn edges(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.dedup();
    let between: Vec<f64> = sorted.windows(2).map(|w| 0.5 * (w[0] + w[1])).collect();
    let (first, last) = (sorted[0], sorted[sorted.len() - 1]);
    match (between.first(), between.last()) {
        (Some(low), Some(high)) => {
            let ends = [2.0 * first - low, 2.0 * last - high];
            [&ends[..1], &between, &ends[1..]].concat()
        }
        _ => vec![first - 0.5, first + 0.5],
    }
}

fn number(cell: &Cell) -> Option<f64> {
    if let Cell::Number(x) = cell { *x } else { None }
}

/// The maps that a sweep asks for, of each of its scenes; none if it asks for none.
pub(super) fn maps<'r>(
    sweep: &Sweep,
    columns: &[(String, CellType)],
    rows: impl Iterator<Item = &'r Vec<Cell>> + Clone,
) -> Option<Figure> {
    let SweepMap { across, up, cost } = sweep.map.as_ref()?;
    let axis = |key: &str| Axis::of(sweep.numbers.iter().find(|n| n.key == key)?, columns);
    let (across, up) = (axis(across)?, axis(up)?);
    let place = |name: &str| columns.iter().position(|(known, _)| known == name);
    let survived = place("survived")?;
    let mut figure = Figure::new(&sweep.about, &format!("{} walks", rows.clone().count()));
    for scene in &sweep.scenes {
        let of_scene = rows.clone().filter(|row| matches!(&row[1], Cell::Text(of) if of == scene));
        let share = |row: &Vec<Cell>| Some(f64::from(u8::from(row[survived] == Cell::YesNo(true))));
        let title = format!("{scene}: share of walks that were survived");
        figure = figure.with(map(&title, (&across, &up), of_scene.clone(), share));
        if let Some(name) = cost {
            let column = place(name)?;
            let cost = |row: &Vec<Cell>| number(&row[column]).filter(|_| row[survived] == Cell::YesNo(true));
            let title = format!("{scene}: mean {name} of those");
            figure = figure.with(map(&title, (&across, &up), of_scene, cost));
        }
    }
    Some(figure)
}

/// Mean of a value in each cell, the darker the larger; a cell without any stays empty.
fn map<'r>(
    title: &str,
    (across, up): (&Axis<'_>, &Axis<'_>),
    rows: impl Iterator<Item = &'r Vec<Cell>>,
    value: impl Fn(&Vec<Cell>) -> Option<f64>,
) -> Chart {
    let mut sums = vec![vec![(0.0, 0_u64); across.cells()]; up.cells()];
    for row in rows {
        if let (Some(x), Some(y), Some(v)) = (across.cell(row), up.cell(row), value(row)) {
            let (sum, count) = &mut sums[y][x];
            (*sum, *count) = (*sum + v, *count + 1);
        }
    }
    let mean = |(sum, count): (f64, u64)| (count > 0).then(|| sum / count as f64);
    let largest = sums.iter().flatten().filter_map(|of| mean(*of)).fold(0.0, f64::max);
    let mut chart = Chart::new(title, across.key, up.key).height(420.0);
    for (y, line) in sums.iter().enumerate() {
        for (x, of) in line.iter().enumerate() {
            let Some(mean) = mean(*of) else { continue };
            let ([left, right], [low, high]) =
                ([across.edges[x], across.edges[x + 1]], [up.edges[y], up.edges[y + 1]]);
            let dark = if largest > 0.0 { mean / largest } else { 0.0 };
            let corners = vec![[left, low], [right, low], [right, high], [left, high]];
            chart.area("", corners, BLUE.faint((220.0 * dark) as u8));
            if across.cells() <= WRITTEN && up.cells() <= WRITTEN {
                let middle = [0.5 * (left + right), 0.5 * (low + high)];
                chart.note(middle, &format!("{mean:.2}"), if dark > 0.0 { BLACK } else { GREY });
            }
        }
    }
    for share in [0.0, 0.5, 1.0] {
        chart.area(&format!("{:.3}", share * largest), Vec::new(), BLUE.faint((220.0 * share) as u8));
    }
    chart
}
