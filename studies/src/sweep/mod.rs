//! Sweeps, `gangwerk sweep FILE`: numbers of scenes and gaits × seeds × scenes, each combination a walk and a row of a table.
//!
//! | file | what |
//! |---|---|
//! | `config/src/sweep.rs` | the sweep's file |
//! | `case` | one walk: its numbers, and how it ends |
//! | `columns` | what a row holds |
//! | `rows` | rows as they come in, on disk; who was killed goes on from there |
//! | `table` | all of them, in order, as Parquet |
//! | `map` | survival and cost over two of the numbers |
//!
//! Walks come from all cores of this machine, or as lines from others (`python/gangwerk/sweep.py`), whose [`piece`]s these are.

mod case;
mod columns;
mod map;
mod rows;
mod table;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hasher};
use std::io::{BufRead, Write};
use std::ops::Range;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;

use config::sweep::SweptValues;
use config::{SetupFiles, Sweep};
use serde::Serialize;

use crate::sheet::{Column, fixed, plain};
use crate::{Error, Given, Sheet};
use case::Case;
use columns::Cell;
use map::Maps;
use rows::Rows;
use table::Table;

/// Rows that may wait to be written, before walks do.
const WAITING: usize = 64;

const COLUMNS: &[Column] = &[
    plain("/scene", "scene"),
    plain("/survived", "survived"),
    plain("/walks", "of"),
    fixed("/rate", "rate", 3),
    plain("/how", "others"),
];

/// A sweep that can be walked: its file is right, and so are the files that it names.
pub struct SweepOrder {
    sweep: Sweep,
    /// Files of each scene, read once: they may change while a sweep goes on.
    scenes: Vec<SetupFiles>,
    identity: String,
}

/// Walks of a scene.
#[derive(Serialize)]
struct Row<'a> {
    scene: &'a str,
    survived: u64,
    walks: u64,
    /// \[1\]
    rate: f64,
    /// Number of the others that ended in each way.
    how: BTreeMap<String, u64>,
}

impl SweepOrder {
    /// Reads a sweep's file, and tries every value of every number once; `program` says which program this is.
    ///
    /// # Errors
    /// A file, key, value or name is wrong.
    pub fn load(config: &Path, file: &Path, program: &str) -> Result<Self, Error> {
        let sweep = Sweep::load(file)?;
        columns::check(&sweep)?;
        let (mut hash, mut scenes) = (DefaultHasher::new(), Vec::<SetupFiles>::new());
        for (of, scene) in sweep.scenes.iter().enumerate() {
            let files = SetupFiles::read(config, scene).map_err(|e| format!("{}: {e}", file.display()))?;
            // By two paths it would count as two independent scenes.
            let place = |files: &SetupFiles| {
                let path = files.scene_path();
                path.canonicalize().unwrap_or_else(|_| path.into())
            };
            if let Some(k) = scenes.iter().position(|before| place(before) == place(&files)) {
                let (file, before) = (file.display(), &sweep.scenes[k]);
                return Err(format!("{file}: scenes: `{before}` and `{scene}` are the same file").into());
            }
            // The first combination, and with it each value, or each end of a range, of every number.
            let mut first = Case { scene, of, ..Case::of(&sweep, 0) };
            for (value, number) in first.values.iter_mut().zip(&sweep.numbers) {
                if let SweptValues::Drawn([low, _]) = number.values {
                    *value = low;
                }
            }
            let setup = |case: &Case<'_>| {
                let problem = |e| format!("{}: {}: {e}", file.display(), case.told(&sweep));
                case.setup(&sweep, &files).map_err(problem)
            };
            hash.write_u64(setup(&first)?.hash);
            for (k, number) in sweep.numbers.iter().enumerate() {
                let ends = match &number.values {
                    SweptValues::Each(values) => values.as_slice(),
                    SweptValues::Drawn(range) => range,
                };
                for value in ends {
                    let mut case = first.clone();
                    case.values[k] = *value;
                    setup(&case)?;
                }
            }
            scenes.push(files);
        }
        let identity = format!("{program}, sweep {:016x}, configuration {:016x}", sweep.hash, hash.finish());
        Ok(Self { sweep, scenes, identity })
    }

    /// Program, sweep and configuration: walks of the same identity are the same, bit for bit.
    pub fn identity(&self) -> &str {
        &self.identity
    }

    /// Number of walks that the sweep asks for.
    pub fn walks(&self) -> u64 {
        // Loading has multiplied them.
        self.sweep.combinations().unwrap_or(0) * self.sweep.seeds
    }

    fn line(&self, walk: u64) -> Result<String, String> {
        let case = Case::of(&self.sweep, walk);
        let row = case.walk(&self.sweep, &self.scenes[case.of]).map_err(|e| format!("walk {walk}: {e}"))?;
        Ok(columns::line(&row))
    }
}

/// Walks some of a sweep on one core, and writes each row as soon as it is there.
///
/// # Errors
/// The identity is not the one that is `expected`, there are no such walks, or nobody reads.
pub fn piece(order: &SweepOrder, walks: Range<u64>, expected: &str, to: &mut dyn Write) -> Result<(), Error> {
    if order.identity() != expected {
        let is = order.identity();
        return Err(format!(
            "this is `{is}`, but the sweep was begun by `{expected}`: install the same program and files here"
        )
        .into());
    }
    if walks.start >= walks.end || walks.end > order.walks() {
        let (from, to, all) = (walks.start, walks.end, order.walks());
        return Err(format!("walks {from} to {to}: the sweep has {all}").into());
    }
    for walk in walks {
        writeln!(to, "{}", order.line(walk)?)?;
        to.flush()?;
    }
    Ok(())
}

/// Carries out what is left of a sweep on this machine, on so many cores, and makes table and maps.
///
/// # Errors
/// The directory `out` belongs to another sweep, or cannot be written; a robot cannot be built.
pub fn run(order: &SweepOrder, out: &Path, cores: usize, given: &Given<'_>) -> Result<Sheet, Error> {
    let mut rows = open(order, out)?;
    let left: Vec<u64> = rows.left().collect();
    let (next, stop, begun) = (AtomicUsize::new(0), AtomicBool::new(false), realtime::clock::now());
    let (all, before) = (order.walks() as usize, rows.count());
    std::thread::scope(|scope| -> Result<(), String> {
        let (to, from) = mpsc::sync_channel(WAITING);
        for _ in 0..cores {
            let (to, next, stop, left) = (to.clone(), &next, &stop, &left);
            scope.spawn(move || {
                while !stop.load(Ordering::Relaxed) {
                    let Some(walk) = left.get(next.fetch_add(1, Ordering::Relaxed)) else { return };
                    if to.send(order.line(*walk)).is_err() {
                        return;
                    }
                }
            });
        }
        drop(to);
        for line in from {
            // Whoever still walks finishes that one walk.
            let added = line.and_then(|line| rows.add(&line));
            if added.is_err() {
                stop.store(true, Ordering::Relaxed);
            }
            added?;
            (given.progress)(rows.count(), all, "walks");
        }
        Ok(())
    })?;
    let mut sheet = finish(order, out, &rows)?;
    let walked = rows.count() - before;
    if walked > 0 {
        let minutes = (realtime::clock::now() - begun) as f64 * 1e-9 / 60.0;
        let rate = walked as f64 / (minutes * cores as f64);
        sheet.fact("walks_per_core_minute", rate);
        sheet.line(format!(
            "{walked} walks in {minutes:.1} min on {cores} cores: {rate:.1} per core and minute"
        ));
    }
    Ok(sheet)
}

/// Makes table and maps from rows that others walk: first tells them, in one line of JSON, the sweep's identity and which walks are
/// left, and then reads their rows.
///
/// # Errors
/// As [`run`]; or rows are missing when nobody writes any more.
pub fn collect(
    order: &SweepOrder,
    out: &Path,
    (from, to): (&mut dyn BufRead, &mut dyn Write),
    given: &Given<'_>,
) -> Result<Sheet, Error> {
    let mut rows = open(order, out)?;
    let left: Vec<u64> = rows.left().collect();
    let told = serde_json::json!({ "identity": order.identity(), "walks": order.walks(), "left": left });
    writeln!(to, "{told}")?;
    to.flush()?;
    // A last line without its end was cut off, and may be cut inside of a number: that walk is missing.
    let mut line = String::new();
    while from.read_line(&mut line)? > 0 && line.ends_with('\n') {
        rows.add(line.trim_end_matches(['\n', '\r']))?;
        line.clear();
        (given.progress)(rows.count(), order.walks() as usize, "walks");
    }
    finish(order, out, &rows)
}

fn open(order: &SweepOrder, out: &Path) -> Result<Rows, String> {
    Rows::open(out, order.identity(), columns::columns(&order.sweep), order.walks())
}

/// Table, maps, and a sheet of them.
fn finish(order: &SweepOrder, out: &Path, rows: &Rows) -> Result<Sheet, Error> {
    let missing = rows.left().count();
    if missing > 0 {
        let (all, out) = (order.walks(), out.display());
        return Err(format!(
            "{missing} of {all} walks are missing; start the sweep again with --out {out}: it goes on"
        )
        .into());
    }
    // One pass over the rows, which may not fit into memory.
    let (sweep, columns) = (&order.sweep, columns::columns(&order.sweep));
    let path = out.join("table.parquet");
    let (mut table, mut maps) = (Table::create(&path, &columns)?, Maps::of(sweep, &columns));
    let of_scene = |scene| Row { scene, survived: 0, walks: 0, rate: 0.0, how: BTreeMap::new() };
    let mut scenes: Vec<Row<'_>> = sweep.scenes.iter().map(|scene| of_scene(scene)).collect();
    for row in rows.each() {
        let row = row?;
        if let Some(scene) = scenes.iter_mut().find(|s| row[1] == Cell::Text(s.scene.into())) {
            scene.add(&row, sweep.numbers.len());
        }
        if let Some(maps) = &mut maps {
            maps.add(&row);
        }
        table.push(row)?;
    }
    table.finish()?;
    let mut sheet = Sheet::titled(format!("{}: {} walks", sweep.about, order.walks()));
    sheet.rows("rows", COLUMNS, &scenes);
    sheet.fact("table", path.display().to_string());
    sheet.line(path.display().to_string());
    if let Some(maps) = maps {
        sheet.draw(out, "maps.png", &maps.figure(order.walks()))?;
    }
    Ok(sheet)
}

impl Row<'_> {
    /// Adds a walk with so many numbers.
    fn add(&mut self, row: &[Cell], numbers: usize) {
        self.walks += 1;
        match &row[3 + numbers..6 + numbers] {
            [Cell::YesNo(true), ..] => self.survived += 1,
            [_, Cell::Text(end), Cell::Text(doubts)] => {
                *self.how.entry(kind(end, doubts)).or_default() += 1;
            }
            _ => {}
        }
        self.rate = self.survived as f64 / self.walks as f64;
    }
}

/// Kind of end of a walk that was not survived; one that came to the end of its scene is not to be trusted, was refused something, or missed
/// the bounds of `[survived]`.
fn kind(end: &str, doubts: &str) -> String {
    match end.split_once(": ") {
        Some(("refused", _)) => "refused".into(),
        _ if end == "done" && !doubts.is_empty() => "not to be trusted".into(),
        _ if end == "done" => "not as told".into(),
        _ => end.into(),
    }
}
