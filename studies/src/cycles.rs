//! How well did the processes of a run keep real time? From the statistics in its log, beside `cyclictest`.

use std::path::Path;

use messages::{CycleStats, Process, Topic};
use recording::Log;
use serde::Serialize;

/// One process of a run.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Its name.
    pub process: &'static str,
    /// Cycles counted: all but the first hundred.
    pub cycles: u64,
    /// \[us\] Execution time: p50, p99, p99.9, max.
    pub execution_us: [f64; 4],
    /// \[us\] Lateness of wake-ups that were planned: p50, p99, p99.9, max.
    pub lateness_us: [f64; 4],
    /// Cycles that ended after their deadline.
    pub overruns: u64,
    /// Whole periods skipped.
    pub skipped: u64,
    /// Minor and major page faults.
    pub page_faults: u64,
    /// Allocations and frees.
    pub allocations: u64,
    /// Whether it runs without the scheduling it asked for.
    pub degraded: bool,
}

/// A run in real time, and what the machine gives to anybody before and after it.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// \[us\] Lateness of `cyclictest` before and after the run: p50, p99, p99.9, max; none if it cannot run.
    pub cyclictest_us: [Option<[u64; 4]>; 2],
    /// Whether the robot fell.
    pub fell: bool,
    /// The processes.
    pub processes: Vec<Row>,
}

/// The last statistics of every process that wrote some.
///
/// # Errors
/// The log cannot be read.
pub fn of_log(log: &Path) -> Result<Vec<Row>, Box<dyn std::error::Error>> {
    let log = Log::open(log)?;
    let mut rows = Vec::new();
    for process in Process::ALL {
        let Some(topic) = Topic::find(&format!("cycle_stats/{}", process.name())) else { continue };
        let mut last = None;
        log.each_record(topic, |stats: &CycleStats| last = Some(*stats))?;
        rows.extend(last.map(|stats| Row::new(process, &stats)));
    }
    Ok(rows)
}

impl Row {
    fn new(process: Process, s: &CycleStats) -> Self {
        let us = |ns: [u64; 4]| ns.map(|ns| ns as f64 * 1e-3);
        Self {
            process: process.name(),
            cycles: s.cycles,
            execution_us: us(s.execution_ns),
            lateness_us: us(s.lateness_ns),
            overruns: s.overruns,
            skipped: s.skipped,
            page_faults: s.page_faults.iter().sum(),
            allocations: s.allocations.iter().sum(),
            degraded: s.degraded != 0,
        }
    }
}

/// The report as lines for people.
pub fn table(r: &Report) -> String {
    let us = |times: [f64; 4]| times.map(|us| format!("{us:9.1}")).concat();
    let cyclictest = |when: &str, found: Option<[u64; 4]>| {
        let found = found.map_or("    did not run".into(), |f| us(f.map(|us| us as f64)));
        format!("{:57}{found}   [us] cyclictest {when}\n", "")
    };
    let [before, after] = r.cyclictest_us;
    let mut text = format!(
        "{:21}{:36}{:36}\n{:12}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}{:>10}{:>8}{:>8}{:>8}\n",
        "",
        "execution [us]",
        "lateness [us]",
        "process",
        "cycles",
        "p50",
        "p99",
        "p99.9",
        "max",
        "p50",
        "p99",
        "p99.9",
        "max",
        "overruns",
        "skipped",
        "faults",
        "allocs"
    );
    text += &cyclictest("before", before);
    for p in &r.processes {
        text += &format!(
            "{:12}{:9}{}{}{:10}{:8}{:8}{:8}{}\n",
            p.process,
            p.cycles,
            us(p.execution_us),
            us(p.lateness_us),
            p.overruns,
            p.skipped,
            p.page_faults,
            p.allocations,
            if p.degraded { "   without the scheduling it asked for" } else { "" }
        );
    }
    text + &cyclictest("after", after) + if r.fell { "The robot fell." } else { "The robot did not fall." }
}
