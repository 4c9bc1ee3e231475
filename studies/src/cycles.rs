//! How well did the processes of a run keep real time? From the statistics in its log, beside `cyclictest`.

use std::path::Path;

use messages::{CycleStats, Process, Topic};
use recording::Log;
use serde_json::{Value, json};

use crate::Error;
use crate::sheet::{Column, Sheet, fixed, plain};

/// A process of a run: cycles counted (all but the first hundred), execution times and lateness of wake-ups that were planned,
/// cycles that ended after their deadline, whole periods skipped, minor and major page faults, allocations and frees.
const COLUMNS: &[Column] = &[
    plain("/process", "process"),
    plain("/cycles", "cycles"),
    fixed("/execution_us/0", "execution p50 [us]", 1),
    fixed("/execution_us/1", "p99", 1),
    fixed("/execution_us/2", "p99.9", 1),
    fixed("/execution_us/3", "max", 1),
    fixed("/lateness_us/0", "lateness p50 [us]", 1),
    fixed("/lateness_us/1", "p99", 1),
    fixed("/lateness_us/2", "p99.9", 1),
    fixed("/lateness_us/3", "max", 1),
    plain("/overruns", "overruns"),
    plain("/skipped", "skipped"),
    plain("/page_faults", "faults"),
    plain("/allocations", "allocs"),
    plain("/degraded", "without its scheduling"),
];

/// A run in real time by its log, and what the machine gives to anybody before and after it: lateness of `cyclictest` \[us\],
/// p50, p99, p99.9, max; none if it cannot run.
///
/// # Errors
/// The log cannot be read.
pub fn sheet(log: &Path, cyclictest_us: [Option<[u64; 4]>; 2], fell: bool) -> Result<Sheet, Error> {
    let log = Log::open(log)?;
    let mut rows = Vec::new();
    for process in Process::ALL {
        let Some(topic) = Topic::find(&format!("cycle_stats/{}", process.name())) else { continue };
        // The last statistics of every process that wrote some.
        let mut last = None;
        log.each_record(topic, |stats: &CycleStats| last = Some(*stats))?;
        rows.extend(last.map(|stats| row(process, &stats)));
    }
    let mut sheet = Sheet::default();
    for (when, found) in ["before", "after"].into_iter().zip(cyclictest_us) {
        let found = found.map_or("did not run".into(), |[p50, p99, p999, max]| {
            format!("p50 {p50}, p99 {p99}, p99.9 {p999}, max {max} us late")
        });
        sheet.line(format!("cyclictest {when}: {found}"));
    }
    sheet.fact("cyclictest_us", cyclictest_us);
    sheet.rows("processes", COLUMNS, &rows);
    sheet.fact("fell", fell);
    sheet.line(if fell { "The robot fell." } else { "The robot did not fall." });
    Ok(sheet)
}

fn row(process: Process, s: &CycleStats) -> Value {
    let us = |ns: [u64; 4]| ns.map(|ns| ns as f64 * 1e-3);
    json!({
        "process": process.name(),
        "cycles": s.cycles,
        "execution_us": us(s.execution_ns),
        "lateness_us": us(s.lateness_ns),
        "overruns": s.overruns,
        "skipped": s.skipped,
        "page_faults": s.page_faults.iter().sum::<u64>(),
        "allocations": s.allocations.iter().sum::<u64>(),
        "degraded": s.degraded != 0,
    })
}
