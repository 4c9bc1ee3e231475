//! State of the processes: alive, cycles, lateness, and how fast simulated time goes.

use std::path::Path;

use ipc::{IpcError, Reader, Space};
use messages::topics::{STATS_CONTROLLER, STATS_LOWLEVEL, STATS_PLANNER, STATS_SIM_BACKEND, STATS_WATCHDOG};
use messages::{CycleStats, Process, Topic};
use serde_json::{Value, json};

const STATS: [&Topic; 5] =
    [&STATS_WATCHDOG, &STATS_SIM_BACKEND, &STATS_LOWLEVEL, &STATS_PLANNER, &STATS_CONTROLLER];

/// Statistics of the processes of one run.
pub struct Health {
    stats: Vec<(Process, Reader<CycleStats>)>,
    model: String,
    error: Option<f64>,
    /// Tick and time \[ns\] of the last look.
    last: Option<(u64, u64)>,
}

impl Health {
    /// Of the run in this space, simulated by `model` with this estimated error.
    ///
    /// # Errors
    /// A topic cannot be read.
    pub fn open(space: &Space, model: String, error: Option<f64>) -> Result<Self, IpcError> {
        let stats = STATS.into_iter().map(|topic| Ok((topic.writer, space.reader(topic)?)));
        Ok(Self { stats: stats.collect::<Result<_, IpcError>>()?, model, error, last: None })
    }

    /// The message `processes` at `tick`, at `now` \[ns\]; `cycle` \[s\].
    pub fn tell(&mut self, dir: &Path, tick: u64, now: u64, cycle: f64) -> Value {
        let factor = self.last.filter(|&(t, at)| tick >= t && now > at).map(|(t, at)| {
            // Simulated time over wall time since the last look.
            (tick - t) as f64 * cycle / ((now - at) as f64 * 1e-9)
        });
        self.last = Some((tick, now));
        let list: Vec<Value> = Process::ALL.iter().map(|&process| self.process(dir, process)).collect();
        let (model, error) = (&self.model, self.error);
        json!({"type": "processes", "list": list, "real_time_factor": factor, "estimated_error": error, "model": model})
    }

    fn process(&mut self, dir: &Path, process: Process) -> Value {
        let state = if ipc::owner(dir, process).is_some() { "running" } else { "gone" };
        let stats = self.stats.iter_mut().find(|(of, _)| *of == process);
        let Some(s) = stats.and_then(|(_, reader)| reader.latest()) else {
            return json!({"name": process.name(), "state": state, "degraded": false, "cycles": null,
                "overruns": null, "skipped": null, "lateness_us": null, "execution_us": null,
                "lateness_octaves": null, "execution_octaves": null});
        };
        let times = |ns: &[u64; 4]| {
            let [p50, p99, p999, max] = ns.map(|ns| ns as f64 * 1e-3);
            json!({"p50": p50, "p99": p99, "p999": p999, "max": max})
        };
        json!({"name": process.name(), "state": state, "degraded": s.degraded != 0, "cycles": s.cycles,
            "overruns": s.overruns, "skipped": s.skipped, "lateness_us": times(&s.lateness_ns),
            "execution_us": times(&s.execution_ns), "lateness_octaves": s.lateness_octaves,
            "execution_octaves": s.execution_octaves})
    }
}
