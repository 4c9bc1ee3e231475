//! Cycle statistics of a process: fills the record `cycle_stats`.

use crate::{Histogram, allocations, sanitizer};
use messages::{BusCounters, CycleStats};

/// Measures the cycles of the thread it lives on.
#[derive(Debug)]
pub struct CycleMeter {
    lateness: Histogram,
    execution: Histogram,
    begun_ns: u64,
    planned_ns: u64,
    deadline_ns: u64,
    faults_before: [u64; 2],
    armed: bool,
    stats: CycleStats,
}

impl CycleMeter {
    /// A cycle is late if it ends more than `deadline_ns` after its planned wake-up; 0: never.
    /// `degraded` and `config_hash` are published as they are.
    pub fn new(deadline_ns: u64, degraded: bool, config_hash: u64) -> Self {
        let stats = CycleStats { degraded: u64::from(degraded), config_hash, ..CycleStats::default() };
        Self {
            lateness: Histogram::new(),
            execution: Histogram::new(),
            begun_ns: 0,
            planned_ns: 0,
            deadline_ns,
            faults_before: [0; 2],
            armed: false,
            stats,
        }
    }

    /// The last preparation is done: forgets the cycles so far and counts page faults and allocations from here.
    pub fn arm(&mut self) {
        self.lateness = Histogram::new();
        self.execution = Histogram::new();
        (self.stats.cycles, self.stats.overruns, self.stats.skipped) = (0, 0, 0);
        self.faults_before = page_faults();
        sanitizer::find();
        allocations::arm();
        self.armed = true;
    }

    /// A cycle planned for `planned_ns` began at `now_ns`.
    ///
    /// Lateness is taken against the plan, not against the cycle before: a constant lateness shows.
    pub fn begin(&mut self, planned_ns: u64, now_ns: u64) {
        self.planned_ns = planned_ns;
        self.begun_ns = now_ns;
        self.lateness.record(now_ns.saturating_sub(planned_ns));
        if self.armed {
            sanitizer::enter();
        }
    }

    /// It ended at `now_ns`, and `skipped` wake-ups were missed.
    pub fn end(&mut self, now_ns: u64, skipped: u64) {
        if self.armed {
            sanitizer::exit();
        }
        self.execution.record(now_ns.saturating_sub(self.begun_ns));
        self.stats.cycles += 1;
        self.stats.skipped += skipped;
        let late = self.deadline_ns > 0 && now_ns.saturating_sub(self.planned_ns) > self.deadline_ns;
        self.stats.overruns += u64::from(late || skipped > 0);
    }

    /// Errors of the field bus since start.
    pub fn count_bus(&mut self, counters: BusCounters) {
        self.stats.bus = counters;
    }

    /// The record, except for its header. Costs a few microseconds: for a few times per second.
    pub fn stats(&mut self) -> &mut CycleStats {
        self.stats.lateness_ns = self.lateness.percentiles();
        self.stats.execution_ns = self.execution.percentiles();
        self.stats.lateness_octaves = self.lateness.octaves();
        self.stats.execution_octaves = self.execution.octaves();
        let faults = page_faults();
        self.stats.page_faults = [faults[0] - self.faults_before[0], faults[1] - self.faults_before[1]];
        self.stats.allocations = allocations::counted();
        &mut self.stats
    }
}

/// Minor and major page faults of this thread since it began.
fn page_faults() -> [u64; 2] {
    // SAFETY: all-zero bytes are a valid `rusage`, a struct of integers.
    let mut usage: libc::rusage = unsafe { std::mem::zeroed() };
    // SAFETY: `usage` is a writable `rusage`; RUSAGE_THREAD is known to every Linux since 2.6.26.
    unsafe { libc::getrusage(libc::RUSAGE_THREAD, &mut usage) };
    [usage.ru_minflt as u64, usage.ru_majflt as u64]
}
