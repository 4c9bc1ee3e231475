//! Processes that are stopped for a while and go on, as by SIGSTOP and SIGCONT, while the robot walks.
//!
//! One process does not run for some cycles, at random instants of a walk; the others go on with what is there. Afterwards
//! the supply has not come on by itself, no joint is faster and no foot carries more than in the undisturbed walk, and
//! nobody was blamed who did nothing.

use config::Setup;
use messages::{EventCode, Process, SimState};
use serde::Serialize;

use chain::Chain;
use chain::parallel;
use serde_json::json;

use crate::random::Random;
use crate::sheet::{Column, fixed, plain};
use crate::{Error, Given, Sheet, Study};

/// Processes whose stop the chain can feel.
pub const PROCESSES: [Process; 5] =
    [Process::Watchdog, Process::SimBackend, Process::Planner, Process::Controller, Process::Lowlevel];

/// Durations of the stops \[ms\].
pub const MILLIS: [f64; 7] = [2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 1000.0];
/// \[s\] The walk is periodic from here on ...
const WALKS: f64 = 5.0;
/// \[s\] ... and random instants are chosen out of this time.
const INSTANTS: f64 = 10.0;
/// \[s\] Time from the resumption to the end of a trial.
const AFTERMATH: f64 = 2.0;

/// Stops of one process for one duration, and the worst of them; of what was reported, in how many.
const COLUMNS: &[Column] = &[
    plain("/process", "stopped"),
    plain("/cycles", "cycles"),
    plain("/trials", "trials"),
    plain("/came_back", "back by itself"),
    plain("/power_off", "power off"),
    plain("/fell", "fell"),
    fixed("/joint_speed", "joint speed", 2),
    fixed("/force", "force", 2),
    plain("/reported", "reported"),
];

/// The study's arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct Stalls {
    /// The walk.
    #[arg(long, default_value = "walk_1kmh")]
    pub scene: String,
    /// Random instants for each process and duration.
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=1000))]
    pub instants: u64,
    /// Seed of the instants.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

impl Study for Stalls {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        let trials = run(given.config, &self.scene, &MILLIS, self.instants as usize, self.seed)?;
        Ok(sheet(&trials))
    }
}

/// Largest numbers of a piece of a walk.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Peaks {
    /// \[rad/s\] Of any joint, by the angles of the simulated robot.
    pub joint_speed: f64,
    /// \[N\] Of either foot, normal.
    pub force: f64,
}

/// What came of one stop.
#[derive(Clone, Debug, Serialize)]
pub struct StallTrial {
    /// Who was stopped.
    pub process: &'static str,
    /// \[1\] Cycles for which.
    pub cycles: u64,
    /// \[s\] When.
    pub at: f64,
    /// After the resumption, over those of the undisturbed walk \[1\].
    pub joint_speed: f64,
    /// The same of the force \[1\].
    pub force: f64,
    /// Whether the supply came on after it had gone off; nobody asked for it.
    pub came_back: bool,
    /// Whether the supply went off.
    pub power_off: bool,
    /// Whether the robot fell.
    pub fell: bool,
    /// Processes and what they reported from the stop on, each once.
    #[serde(serialize_with = "as_text")]
    pub events: Vec<(Process, EventCode)>,
}

fn as_text<S: serde::Serializer>(events: &[(Process, EventCode)], s: S) -> Result<S::Ok, S::Error> {
    s.collect_seq(events.iter().map(|(process, code)| format!("{}: {code:?}", process.name())))
}

impl Peaks {
    /// Takes note of one cycle of the simulated robot.
    fn add(&mut self, before: &SimState, now: &SimState) {
        let elapsed = now.time - before.time;
        if elapsed > 0.0 {
            let speeds =
                before.joint_angle.iter().zip(&now.joint_angle).map(|(a, b)| ((b - a) / elapsed).abs());
            self.joint_speed = speeds.fold(self.joint_speed, f64::max);
        }
        self.force = now.foot_wrench.iter().map(|w| w.force[2]).fold(self.force, f64::max);
    }
}

/// Stops of `millis` \[ms\] of each process, at `instants` random instants each, in the walk of `scene`.
///
/// # Errors
/// The scene cannot be loaded or built.
pub fn run(
    config: &std::path::Path,
    scene: &str,
    millis: &[f64],
    instants: usize,
    seed: u64,
) -> Result<Vec<StallTrial>, Error> {
    let mut setup = Setup::load(config, scene)?;
    // The walk goes on to the end of the last trial.
    setup.scene.commands.retain(|(at, _)| *at < WALKS);
    let mut walking = Chain::new(&setup)?;
    let dt = walking.cycle();
    advance(&mut walking, WALKS);
    let ahead = INSTANTS + AFTERMATH;
    let undisturbed = peaks(&mut walking.clone(), (ahead / dt) as u64);

    // One walk passes all instants in their order; a trial goes on from a copy.
    let mut cases: Vec<(u64, Process, u64)> = Vec::new();
    let mut random = Random(seed);
    for process in PROCESSES {
        for &ms in millis {
            for _ in 0..instants {
                let at = (random.unit() * INSTANTS / dt) as u64;
                cases.push((at, process, (ms * 1e-3 / dt).round().max(1.0) as u64));
            }
        }
    }
    cases.sort_by_key(|case| case.0);
    let mut trials = Vec::new();
    // In batches, because each copy of the chain takes its memory.
    for batch in cases.chunks(64) {
        let starts: Vec<Chain> = batch
            .iter()
            .map(|&(at, _, _)| {
                while walking.tick() < (WALKS / dt) as u64 + at {
                    walking.step();
                }
                walking.clone()
            })
            .collect();
        trials.extend(parallel::map(batch.len(), |i| {
            let (_, process, cycles) = batch[i];
            trial(starts[i].clone(), process, cycles, &undisturbed)
        }));
    }
    let place = |t: &StallTrial| (PROCESSES.iter().position(|p| p.name() == t.process), t.cycles);
    trials.sort_by_key(place);
    Ok(trials)
}

fn advance(chain: &mut Chain, to: f64) {
    while (chain.tick() as f64) < to / chain.cycle() {
        chain.step();
    }
}

fn peaks(chain: &mut Chain, cycles: u64) -> Peaks {
    let mut peaks = Peaks::default();
    let mut before = chain.step().sim_state;
    for _ in 0..cycles {
        let now = chain.step().sim_state;
        peaks.add(&before, &now);
        before = now;
    }
    peaks
}

/// Stops `process` for some cycles from here on, and lets it go on.
fn trial(mut chain: Chain, process: Process, cycles: u64, undisturbed: &Peaks) -> StallTrial {
    let at = chain.tick() as f64 * chain.cycle();
    let after = (AFTERMATH / chain.cycle()) as u64;
    let mut before = *chain.robot().state();
    let (mut found, mut events) = (Peaks::default(), Vec::new());
    let (mut power_off, mut came_back, mut fell) = (false, false, false);
    // The stop, then what comes of it.
    for i in 0..cycles + after {
        let stopped = [process];
        let c = chain.step_without(if i < cycles { &stopped } else { &[] });
        for &(process, code, _) in &c.events {
            if !events.contains(&(process, code)) {
                events.push((process, code));
            }
        }
        let now = &c.sim_state;
        came_back |= power_off && now.power == 1;
        power_off |= now.power == 0;
        fell |= now.fallen == 1;
        found.add(&before, now);
        before = *now;
    }
    StallTrial {
        process: process.name(),
        cycles,
        at,
        joint_speed: found.joint_speed / undisturbed.joint_speed,
        force: found.force / undisturbed.force,
        came_back,
        power_off,
        fell,
        events,
    }
}

/// All trials; for people a row per process and duration.
pub fn sheet(trials: &[StallTrial]) -> Sheet {
    let same = |a: &StallTrial, b: &StallTrial| (a.process, a.cycles) == (b.process, b.cycles);
    let row = |group: &[StallTrial]| {
        let count = |f: fn(&StallTrial) -> bool| group.iter().filter(|t| f(t)).count();
        let most = |f: fn(&StallTrial) -> f64| group.iter().map(f).fold(0.0, f64::max);
        // Each event with the number of trials that reported it.
        let mut reported: Vec<(String, usize)> = Vec::new();
        for (process, code) in group.iter().flat_map(|t| &t.events) {
            let name = format!("{}: {code:?}", process.name());
            match reported.iter_mut().find(|(n, _)| *n == name) {
                Some((_, n)) => *n += 1,
                None => reported.push((name, 1)),
            }
        }
        json!({
            "process": group[0].process, "cycles": group[0].cycles, "trials": group.len(),
            "came_back": count(|t| t.came_back), "power_off": count(|t| t.power_off), "fell": count(|t| t.fell),
            "joint_speed": most(|t| t.joint_speed), "force": most(|t| t.force),
            "reported": reported.iter().map(|(name, n)| format!("{name} {n}")).collect::<Vec<_>>(),
        })
    };
    let mut sheet = Sheet::default();
    sheet.fact("trials", trials);
    sheet.table(COLUMNS, &trials.chunk_by(same).map(row).collect::<Vec<_>>());
    sheet
}
