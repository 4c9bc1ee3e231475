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

/// Sum and number of values in each cell.
type Sums = Vec<Vec<(f64, u64)>>;

/// The maps that a sweep asks for: of each scene one of survival and, if it names a cost, one of that.
pub(super) struct Maps<'a> {
    sweep: &'a Sweep,
    axes: [Axis<'a>; 2],
    survived: usize,
    cost: Option<(&'a str, usize)>,
    /// Of each scene: survival, cost.
    sums: Vec<[Sums; 2]>,
}

impl<'a> Maps<'a> {
    /// Empty maps; none if the sweep asks for none.
    pub(super) fn of(sweep: &'a Sweep, columns: &[(String, CellType)]) -> Option<Self> {
        let SweepMap { across, up, cost } = sweep.map.as_ref()?;
        let axis = |key: &str| Axis::of(sweep.numbers.iter().find(|n| n.key == key)?, columns);
        let axes = [axis(across)?, axis(up)?];
        let place = |name: &str| columns.iter().position(|(known, _)| known == name);
        let cost = cost.as_deref().and_then(|name| Some((name, place(name)?)));
        let empty = vec![vec![(0.0, 0); axes[0].cells()]; axes[1].cells()];
        let sums = vec![[empty.clone(), empty]; sweep.scenes.len()];
        Some(Self { sweep, axes, survived: place("survived")?, cost, sums })
    }

    /// Adds a walk.
    pub(super) fn add(&mut self, row: &[Cell]) {
        let scene = self.sweep.scenes.iter().position(|s| matches!(&row[1], Cell::Text(of) if of == s));
        let [across, up] = &self.axes;
        let (Some(scene), Some(x), Some(y)) = (scene, across.cell(row), up.cell(row)) else { return };
        let good = row[self.survived] == Cell::YesNo(true);
        let cost = self.cost.and_then(|(_, column)| number(&row[column])).filter(|_| good);
        for (sums, value) in self.sums[scene].iter_mut().zip([Some(f64::from(u8::from(good))), cost]) {
            if let Some(value) = value {
                let (sum, count) = &mut sums[y][x];
                (*sum, *count) = (*sum + value, *count + 1);
            }
        }
    }

    /// All of them.
    pub(super) fn figure(&self, walks: u64) -> Figure {
        let mut figure = Figure::new(&self.sweep.about, &format!("{walks} walks"));
        for (scene, [survival, cost]) in self.sweep.scenes.iter().zip(&self.sums) {
            figure =
                figure.with(self.chart(&format!("{scene}: share of walks that were survived"), survival));
            if let Some((name, _)) = self.cost {
                figure = figure.with(self.chart(&format!("{scene}: mean {name} of those"), cost));
            }
        }
        figure
    }

    /// Mean of each cell, the darker the larger; a cell without any stays empty.
    fn chart(&self, title: &str, sums: &Sums) -> Chart {
        let [across, up] = &self.axes;
        let mean = |(sum, count): (f64, u64)| (count > 0).then(|| sum / count as f64);
        let largest = sums.iter().flatten().filter_map(|of| mean(*of)).fold(0.0, f64::max);
        // Three digits of the largest one.
        let decimals =
            if largest > 0.0 { (2.0 - largest.log10().floor()).clamp(0.0, 9.0) as usize } else { 2 };
        let mut chart = Chart::new(title, across.key, up.key).height(420.0);
        let written = across.cells() <= WRITTEN && up.cells() <= WRITTEN;
        for (y, line) in sums.iter().enumerate() {
            for (x, of) in line.iter().enumerate() {
                let Some(mean) = mean(*of) else { continue };
                let ([left, right], [low, high]) =
                    ([across.edges[x], across.edges[x + 1]], [up.edges[y], up.edges[y + 1]]);
                let dark = if largest > 0.0 { mean / largest } else { 0.0 };
                let corners = vec![[left, low], [right, low], [right, high], [left, high]];
                chart.area("", corners, BLUE.faint((220.0 * dark) as u8));
                if written {
                    let middle = [0.5 * (left + right), 0.5 * (low + high)];
                    chart.note(middle, &format!("{mean:.decimals$}"), if dark > 0.0 { BLACK } else { GREY });
                }
            }
        }
        for share in [0.0, 0.5, 1.0] {
            chart.area(
                &format!("{:.decimals$}", share * largest),
                Vec::new(),
                BLUE.faint((220.0 * share) as u8),
            );
        }
        chart
    }
}
