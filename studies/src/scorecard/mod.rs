//! `gangwerk scorecard`: everything the robots are to be able to do, walked, measured and held against what is demanded
//! and what others have reached.
//!
//! What is walked stands in `entries.rs`. Walks do not depend on each other, and each is deterministic: they share the
//! cores, and the table is the same on one core. A fall is a row like any other.

mod demand;
mod entries;
mod fastest;
mod pushes;
mod rates;
pub(crate) mod walk;

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use chain::parallel;
use config::Setup;
use serde::Serialize;
use serde_json::json;

use crate::sheet::{Column, Sheet, plain};
use entries::{ENTRIES, GROUND, PICTURED, PUSHES};

/// Errors are sentences: they come from other threads, which boxed ones cannot.
pub type Result<T> = std::result::Result<T, String>;
/// Told how many tasks are done, of how many, and which one was done last.
pub type Progress<'a> = &'a (dyn Fn(usize, usize, &str) + Sync);

/// What is to be walked.
#[derive(Clone, Copy, Debug)]
pub struct ScorecardOptions<'a> {
    /// Configuration directory.
    pub config: &'a Path,
    /// Only entries whose name contains this.
    pub only: Option<&'a str>,
    /// Only the fastest bus cycle, pushes at two instants, and ground at two places.
    pub quick: bool,
    /// Seed of every scene.
    pub seed: u64,
}

/// What was found.
#[derive(Clone, Debug, Serialize)]
pub struct Scorecard {
    /// Seed of every scene.
    pub seed: u64,
    /// Goals met.
    pub met: usize,
    /// Goals.
    pub goals: usize,
    /// \[s\] Processor time of everything.
    pub cpu_s: f64,
    /// One row per demand.
    pub rows: Vec<ScorecardRow>,
}

/// Whether a goal was met.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Goal {
    /// It was.
    Met,
    /// It was not.
    Missed,
    /// There is none: a figure to be compared.
    Measured,
}

/// One demand.
#[derive(Clone, Debug, Serialize)]
pub struct ScorecardRow {
    /// What is walked.
    pub entry: String,
    /// With which scene.
    pub scene: String,
    /// Which figure is looked at.
    pub what: String,
    /// What it is to be.
    pub demanded: String,
    /// What it is; none if the walk did not get to its end.
    pub ours: Option<f64>,
    /// Its unit.
    pub unit: String,
    /// Whether that is enough.
    pub goal: Goal,
    /// What else is to be said, such as how the walk ended.
    pub note: String,
    /// Type of the model, integrator, steps per bus cycle.
    pub depth: String,
    /// \[s\] Bus cycle.
    pub cycle_s: f64,
    /// \[s\] Processor time of all that the entry simulated.
    pub cpu_s: f64,
    /// The thesis's figure or the best published one.
    pub published: String,
}

/// One piece of work: its name, and what finds its rows.
struct ScorecardTask<'a> {
    name: String,
    work: Box<dyn Fn() -> Result<Vec<ScorecardRow>> + Send + Sync + 'a>,
}

/// Walks everything.
///
/// # Errors
/// A configuration is wrong, or no entry has this name.
pub fn run(order: &ScorecardOptions<'_>, progress: Progress<'_>) -> Result<Scorecard> {
    let mut tasks = tasks(order);
    if let Some(only) = order.only {
        let known: Vec<String> = tasks.iter().map(|task| task.name.clone()).collect();
        tasks.retain(|task| task.name.contains(only));
        if tasks.is_empty() {
            return Err(format!("no entry contains `{only}`; there are: {}", known.join("; ")));
        }
    }
    let rows = perform(&tasks, progress)?;
    let goals = rows.iter().filter(|row| row.goal != Goal::Measured).count();
    let met = rows.iter().filter(|row| row.goal == Goal::Met).count();
    // Rows of one walk share its processor time.
    let alone = |a: &ScorecardRow, b: &ScorecardRow| {
        a.entry == b.entry && a.cycle_s == b.cycle_s && a.cpu_s == b.cpu_s
    };
    let cpu_s = rows.chunk_by(alone).map(|walk| walk[0].cpu_s).sum();
    Ok(Scorecard { seed: order.seed, met, goals, cpu_s, rows })
}

/// Scenes of which the thesis shows pictures, set up as in the table, with the shortest bus cycle.
///
/// # Errors
/// A configuration is wrong.
pub fn pictured(order: &ScorecardOptions<'_>) -> Result<Vec<Setup>> {
    let chosen = ENTRIES.iter().filter(|entry| PICTURED.contains(&entry.name));
    let asked = chosen.filter(|entry| order.only.is_none_or(|only| entry.name.contains(only)));
    asked.map(|entry| walk::of_entry(order, entry, entry.cycles[0])).collect()
}

fn tasks<'a>(order: &'a ScorecardOptions<'a>) -> Vec<ScorecardTask<'a>> {
    let mut tasks = Vec::new();
    let mut add = |name: String, work: Box<dyn Fn() -> Result<Vec<ScorecardRow>> + Send + Sync + 'a>| {
        tasks.push(ScorecardTask { name, work });
    };
    for entry in ENTRIES {
        for &cycle in &entry.cycles[..if order.quick { 1 } else { entry.cycles.len() }] {
            let name = format!("{}, {} ms", entry.name, 1e3 * cycle);
            add(name, Box::new(move || walk::rows(order, entry, cycle)));
        }
    }
    add("as fast as it goes".into(), Box::new(move || fastest::rows(order, 0.001)));
    // One task for each direction, and each kind of ground: rows of one table stand together.
    for (k, pushed) in PUSHES.iter().enumerate() {
        add(format!("push {}", pushed.name), Box::new(move || pushes::walking(order, k, 0.001)));
    }
    for (k, pushed) in PUSHES.iter().enumerate() {
        add(format!("push {}, standing", pushed.name), Box::new(move || pushes::standing(order, k, 0.001)));
    }
    add("random commands".into(), Box::new(move || rates::as_told(order)));
    for (k, (kind, size, _)) in GROUND.iter().enumerate() {
        add(format!("unknown {}", kind.of(*size)), Box::new(move || rates::over_ground(order, k)));
    }
    tasks
}

/// All tasks on all cores; rows in their order. The last ones, which take longest, are begun first, so that no core
/// waits for them at the end.
fn perform(tasks: &[ScorecardTask<'_>], progress: Progress<'_>) -> Result<Vec<ScorecardRow>> {
    let done = AtomicUsize::new(0);
    let mut found = parallel::map(tasks.len(), |k| {
        let task = &tasks[tasks.len() - 1 - k];
        let rows = (task.work)();
        progress(done.fetch_add(1, Ordering::Relaxed) + 1, tasks.len(), &task.name);
        rows
    });
    found.reverse();
    Ok(found.into_iter().collect::<Result<Vec<_>>>()?.concat())
}

/// As [`chain::figures::Figures`] says it.
fn depth_of(scene: &config::Scene) -> String {
    format!("{}, {:?} x {}", scene.model(), scene.integrator, scene.substeps)
}

const COLUMNS: &[Column] =
    &[plain("/0", ""), plain("/1", ""), plain("/2", ""), plain("/3", ""), plain("/4", "")];

impl Scorecard {
    /// A heading and a table per walk.
    pub fn sheet(&self) -> Sheet {
        let mut sheet = Sheet::default();
        let walk = |a: &ScorecardRow, b: &ScorecardRow| {
            a.entry == b.entry && a.cycle_s == b.cycle_s && a.depth == b.depth
        };
        for rows in self.rows.chunk_by(walk) {
            let ScorecardRow { entry, scene, depth, cycle_s, cpu_s, .. } = &rows[0];
            sheet.line(format!("{entry} ({scene}): {depth}, cycle {} ms, {cpu_s:.1} s CPU", 1e3 * cycle_s));
            // Demanded, ours, published, and whether the goal is met; what is to be said about them below.
            let shown = |row: &ScorecardRow| {
                let ours = row.ours.map_or("-".into(), |x| format!("{} {}", figure(x), row.unit));
                let goal = match row.goal {
                    Goal::Met => "met",
                    Goal::Missed => "MISSED",
                    Goal::Measured => "",
                };
                json!([format!("  {}", row.what), row.demanded, ours, goal, row.published])
            };
            sheet.table(COLUMNS, &rows.iter().map(shown).collect::<Vec<_>>());
            let mut notes: Vec<&String> =
                rows.iter().map(|row| &row.note).filter(|n| !n.is_empty()).collect();
            notes.dedup();
            notes.iter().for_each(|note| sheet.line(format!("    {note}")));
        }
        let Self { met, goals, seed, cpu_s, .. } = self;
        sheet.line(format!("{met} of {goals} goals met, seed {seed}, {cpu_s:.0} s CPU"));
        sheet.facts(self);
        sheet
    }
}

/// Three digits, no needless ones.
fn figure(x: f64) -> String {
    if x.fract() == 0.0 {
        return format!("{x}");
    }
    if x != 0.0 && x.abs() < 0.1 { format!("{x:.4}") } else { format!("{x:.3}") }
}

#[cfg(test)]
mod tests;
