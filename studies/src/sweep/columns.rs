//! Columns of a sweep's rows: which walk it was, the numbers that were varied, how it ended, and figures of the walk.

use chain::figures::Figures;
use config::Sweep;

use super::case::{Case, survived};

/// Type of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CellType {
    Whole,
    Text,
    YesNo,
    Number,
}

/// Value of a row at one column; `Number(None)`: there is no such figure.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Cell {
    Whole(u64),
    Text(String),
    YesNo(bool),
    Number(Option<f64>),
}

/// A figure of a walk.
type Figure = fn(&Figures) -> f64;

/// Figures by their names in `gangwerk sim --json`; a component of a list behind a dot.
const FIGURES: &[(&str, Figure)] = &[
    ("ended_at", |f| f.ended_at),
    ("distance_m", |f| f.distance_m),
    ("mean_speed_m_s", |f| f.mean_speed_m_s),
    ("steps", |f| f.steps as f64),
    ("step_length_m", |f| f.step_length_m),
    ("step_duration_s", |f| f.step_duration_s),
    ("step_turn_rad", |f| f.step_turn_rad),
    ("end_pose.0", |f| f.end_pose[0]),
    ("end_pose.1", |f| f.end_pose[1]),
    ("end_pose.2", |f| f.end_pose[2]),
    ("inclination_error_max_rad.0", |f| f.inclination_error_max_rad[0]),
    ("inclination_error_max_rad.1", |f| f.inclination_error_max_rad[1]),
    ("inclination_error_rms_rad.0", |f| f.inclination_error_rms_rad[0]),
    ("inclination_error_rms_rad.1", |f| f.inclination_error_rms_rad[1]),
    ("joint_tracking_error_max_rad", |f| f.joint_tracking_error_max_rad),
    ("peak_normal_force_n", |f| f.peak_normal_force_n),
    ("landing_excess_weights", |f| f.landing_excess_weights),
    ("zmp_margin_min_m", |f| f.zmp_margin_min_m),
];

/// The figure of that name.
pub(super) fn figure(name: &str) -> Option<Figure> {
    FIGURES.iter().find(|(known, _)| *known == name).map(|(_, figure)| *figure)
}

/// Refuses a name that is no figure.
///
/// # Errors
/// With the figures that there are.
pub(super) fn check(sweep: &Sweep) -> Result<(), String> {
    let names: Vec<&str> = FIGURES.iter().map(|(name, _)| *name).collect();
    let bounds = sweep.survived.iter().map(|(name, _)| ("survived", name));
    let cost = sweep.map.iter().filter_map(|map| map.cost.as_ref()).map(|name| ("map.cost", name));
    if let Some((key, name)) = bounds.chain(cost).find(|(_, name)| figure(name).is_none()) {
        let near =
            messages::nearest(name, &names).map_or(String::new(), |n| format!("; the nearest is `{n}`"));
        let (file, all) = (sweep.file.display(), names.join(", "));
        return Err(format!("{file}: {key}: there is no figure `{name}`{near}; there is {all}"));
    }
    // Axes have to be numbers that are varied.
    let mut axes = sweep.map.iter().flat_map(|map| [("map.across", &map.across), ("map.up", &map.up)]);
    match axes.find(|(_, name)| !sweep.numbers.iter().any(|n| n.key == **name)) {
        None => Ok(()),
        Some((key, name)) => {
            Err(format!("{}: {key}: `{name}` is not the key of a [[number]]", sweep.file.display()))
        }
    }
}

/// Names and types of all columns.
pub(super) fn columns(sweep: &Sweep) -> Vec<(String, CellType)> {
    let plain = |name: &str, of: CellType| (name.to_owned(), of);
    let mut all =
        vec![plain("walk", CellType::Whole), plain("scene", CellType::Text), plain("seed", CellType::Whole)];
    all.extend(sweep.numbers.iter().map(|n| plain(&n.key, CellType::Number)));
    all.extend([plain("survived", CellType::YesNo), plain("ended_by", CellType::Text)]);
    all.push(plain("doubts", CellType::Text));
    all.extend(FIGURES.iter().map(|(name, _)| plain(name, CellType::Number)));
    all
}

fn begin(case: &Case<'_>) -> Vec<Cell> {
    let mut row = vec![Cell::Whole(case.walk), Cell::Text(case.scene.into()), Cell::Whole(case.seed)];
    row.extend(case.values.iter().map(|x| Cell::Number(Some(*x))));
    row
}

/// The row of a walk.
pub(super) fn walked(case: &Case<'_>, sweep: &Sweep, figures: &Figures) -> Vec<Cell> {
    let mut row = begin(case);
    row.extend([Cell::YesNo(survived(figures, sweep)), Cell::Text(figures.ended_by.clone())]);
    row.push(Cell::Text(figures.doubts.join("; ")));
    let number = |(_, f): &(&str, Figure)| Cell::Number(Some(f(figures)).filter(|x| x.is_finite()));
    row.extend(FIGURES.iter().map(number));
    row
}

/// The row of values that do not go together.
pub(super) fn refused(case: &Case<'_>, why: &str) -> Vec<Cell> {
    let mut row = begin(case);
    row.extend([Cell::YesNo(false), Cell::Text(format!("refused: {why}")), Cell::Text(String::new())]);
    row.extend(FIGURES.iter().map(|_| Cell::Number(None)));
    row
}

/// A row as a line, cells between tabs; numbers are written such that reading gives the same bits.
pub(super) fn line(row: &[Cell]) -> String {
    let cell = |cell: &Cell| match cell {
        Cell::Whole(n) => n.to_string(),
        Cell::Text(text) => text.replace(['\t', '\n', '\r'], " "),
        Cell::YesNo(yes) => yes.to_string(),
        Cell::Number(x) => x.map_or(String::new(), |x| x.to_string()),
    };
    row.iter().map(cell).collect::<Vec<_>>().join("\t")
}

/// The row of a line; none if it has other columns.
pub(super) fn row(line: &str, columns: &[(String, CellType)]) -> Option<Vec<Cell>> {
    let cells: Vec<&str> = line.split('\t').collect();
    let cell = |(text, (_, of)): (&&str, &(String, CellType))| match of {
        CellType::Whole => text.parse().ok().map(Cell::Whole),
        CellType::Text => Some(Cell::Text((*text).into())),
        CellType::YesNo => text.parse().ok().map(Cell::YesNo),
        CellType::Number if text.is_empty() => Some(Cell::Number(None)),
        CellType::Number => text.parse::<f64>().ok().filter(|x| x.is_finite()).map(|x| Cell::Number(Some(x))),
    };
    (cells.len() == columns.len()).then(|| cells.iter().zip(columns).map(cell).collect())?
}
