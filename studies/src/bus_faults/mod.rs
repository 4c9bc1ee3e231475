//! Faults of the field bus while Lola walks: what is noticed, named and done, and how the robot ends.
//!
//! Each case begins at several instants of a stride, in the walk of scene `walk_2kmh` unless told otherwise. Cycles are counted from the first
//! one that the fault strikes.
//!
//! | file | what |
//! |---|---|
//! | `cases` | the faults, and what is demanded |
//! | `trial` | one fault at one instant |

mod cases;
mod trial;

use std::path::Path;

use config::Setup;
use messages::EventCode;
use serde::Serialize;
use serde_json::json;

use crate::sheet::{Column, plain};
use crate::{Error, Given, Sheet, Study, push};
use cases::Case;
use chain::parallel;
use trial::FaultTrial;

/// The walk that is disturbed, unless another one is.
pub const SCENE: &str = "walk_2kmh";

/// Cycles are the latest of all instants.
const FAULTS: &[Column] = &[
    plain("/fault", "fault"),
    plain("/noticed_cycles", "noticed"),
    plain("/reacted_cycles", "stop or power off"),
    plain("/at_rest_cycles", "joints at rest after that"),
    plain("/power_off_cycles", "supply off"),
    plain("/log", "log"),
    plain("/end", "end"),
    plain("/upright", "upright"),
];
const BURSTS: &[Column] = &[
    plain("/0", "burst, all frames of"),
    plain("/1", "1 line of a knee: walks on"),
    plain("/2", "upright"),
    plain("/3", "all lines: walks on"),
    plain("/4", "upright"),
];

/// The study's arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct BusFaults {
    /// The walk.
    #[arg(long, default_value = SCENE)]
    pub scene: String,
    /// At how many instants of a stride each fault begins.
    #[arg(long, default_value_t = 4, value_parser = clap::value_parser!(u64).range(1..=100))]
    pub instants: u64,
}

impl Study for BusFaults {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        Ok(run(given.config, &self.scene, self.instants as usize)?.sheet())
    }
}

/// How a robot ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum TrialEnd {
    /// It walks on.
    Walks,
    /// It was stopped and stands.
    Stands,
    /// It was stopped, its joints came to rest, then it fell.
    FellBraked,
    /// It fell with joints in motion.
    Fell,
}

/// What was found about a case.
#[derive(Clone, Debug, Serialize)]
pub struct FaultCaseRow {
    /// What happens to the bus.
    pub fault: String,
    /// \[cycle\] Until lowlevel tells something, at the latest.
    pub noticed_cycles: Option<u64>,
    /// \[cycle\] Until a stop or power off begins, at the latest.
    pub reacted_cycles: Option<u64>,
    /// \[cycle\] From then until all joints rest, at the latest; none: not before the end or the fall.
    pub at_rest_cycles: Option<u64>,
    /// \[cycle\] Until the motor supply is off, at the latest; none: it stays on.
    pub power_off_cycles: Option<u64>,
    /// Names of what the log tells, at any instant.
    pub log: Vec<String>,
    /// The worst end.
    pub end: TrialEnd,
    /// \[1\] Instants at which the robot did not fall.
    pub upright: usize,
    /// What is demanded and not met; empty: all is.
    pub unmet: String,
}

/// Lengths of bursts that were survived.
#[derive(Clone, Debug, Serialize)]
pub struct Burst {
    /// \[cycle\]
    pub cycles: u32,
    /// \[1\] Of the instants, walked on: all lines lost, the line of a knee lost.
    pub walked_on: [usize; 2],
    /// \[1\] Of the instants, did not fall.
    pub upright: [usize; 2],
}

/// What was found.
#[derive(Clone, Debug, Serialize)]
pub struct FaultFindings {
    /// \[s\] Bus cycle.
    pub cycle_s: f64,
    /// \[1\] Instants of a stride at which each fault began.
    pub instants: usize,
    /// The cases.
    pub rows: Vec<FaultCaseRow>,
    /// The bursts.
    pub bursts: Vec<Burst>,
}

impl FaultFindings {
    /// Cases whose demands are not met.
    pub fn failed(&self) -> impl Iterator<Item = &FaultCaseRow> {
        self.rows.iter().filter(|row| !row.unmet.is_empty())
    }

    /// As docs/bus_faults.md holds it.
    pub fn sheet(&self) -> Sheet {
        let n = self.instants;
        let of = |upright: usize| format!("{upright}/{n}");
        let mut sheet = Sheet::titled(format!(
            "Faults of the bus while Lola walks 2 km/h, bus cycle {} ms, begun at {n} instants of a stride; the latest of all.",
            self.cycle_s * 1e3
        ));
        let row = |row: &FaultCaseRow| {
            let end = match row.end {
                TrialEnd::Walks => "walks on",
                TrialEnd::Stands => "stopped, stands",
                TrialEnd::FellBraked => "falls with its joints braked",
                TrialEnd::Fell => "falls",
            };
            let unmet =
                if row.unmet.is_empty() { String::new() } else { format!(" **not met: {}**", row.unmet) };
            let mut shown = json!(row);
            shown["end"] = format!("{end}{unmet}").into();
            shown["upright"] = of(row.upright).into();
            shown
        };
        sheet.table(FAULTS, &self.rows.iter().map(row).collect::<Vec<_>>());
        sheet.line("");
        let burst = |b: &Burst| {
            let [all, knee] = [0, 1].map(|k| [of(b.walked_on[k]), of(b.upright[k])]);
            json!([format!("{} cycles", b.cycles), knee[0], knee[1], all[0], all[1]])
        };
        sheet.table(BURSTS, &self.bursts.iter().map(burst).collect::<Vec<_>>());
        sheet.facts(self);
        sheet
    }
}

/// All cases at `instants` of a stride of a scene.
///
/// # Errors
/// A configuration or robot is wrong, or the robot falls without a fault.
pub fn run(config: &Path, scene: &str, instants: usize) -> Result<FaultFindings, Error> {
    let setup = Setup::load(config, scene)?;
    let starts = push::at_instants(&setup, instants)?;
    let rows = rows(&starts, &cases::all(&setup))?;
    let lengths = cases::BURSTS;
    let bursts = parallel::map(lengths.len() * 2 * instants, |k| {
        let fault = cases::burst(lengths[k / (2 * instants)], k / instants % 2 == 1);
        Some(trial::run(&starts[k % instants].chain, &[fault]))
    });
    let bursts: Vec<FaultTrial> = bursts.into_iter().flatten().collect::<Result<_, _>>()?;
    let bursts = lengths.iter().zip(bursts.chunks(2 * instants)).map(|(&cycles, trials)| {
        let count = |ok: fn(&FaultTrial) -> bool| {
            [0, 1].map(|i| trials[i * instants..(i + 1) * instants].iter().filter(|t| ok(t)).count())
        };
        Burst {
            cycles,
            walked_on: count(|t| t.end() == TrialEnd::Walks),
            upright: count(|t| t.end() <= TrialEnd::Stands),
        }
    });
    Ok(FaultFindings { cycle_s: setup.scene.cycle, instants, rows, bursts: bursts.collect() })
}

/// Those of the cases whose names are wanted, without the bursts.
///
/// # Errors
/// As [`run`].
pub fn run_some(
    config: &Path,
    scene: &str,
    instants: usize,
    wanted: impl Fn(&str) -> bool,
) -> Result<Vec<FaultCaseRow>, Error> {
    let setup = Setup::load(config, scene)?;
    let mut cases = cases::all(&setup);
    cases.retain(|case| wanted(&case.name));
    rows(&push::at_instants(&setup, instants)?, &cases)
}

/// Each case, begun at each of these instants.
fn rows(starts: &[push::Instant], cases: &[Case]) -> Result<Vec<FaultCaseRow>, Error> {
    let instants = starts.len();
    let trials = parallel::map(cases.len() * instants, |k| {
        Some(trial::run(&starts[k % instants].chain, &cases[k / instants].faults))
    });
    let trials: Vec<FaultTrial> = trials.into_iter().flatten().collect::<Result<_, _>>()?;
    Ok(cases.iter().zip(trials.chunks(instants)).map(|(case, trials)| row(case, trials)).collect())
}

/// The worst of all instants.
fn row(case: &Case, trials: &[FaultTrial]) -> FaultCaseRow {
    // Later than everything: it did not happen at one instant.
    let latest = |of: fn(&FaultTrial) -> Option<u64>| {
        let all: Vec<Option<u64>> = trials.iter().map(of).collect();
        if all.iter().all(Option::is_some) { all.into_iter().max().flatten() } else { None }
    };
    let mut row = FaultCaseRow {
        fault: case.name.clone(),
        noticed_cycles: latest(|t| t.noticed),
        reacted_cycles: latest(|t| t.reacted),
        at_rest_cycles: latest(|t| t.at_rest),
        power_off_cycles: latest(|t| t.power_off),
        log: Vec::new(),
        end: trials.iter().map(FaultTrial::end).max().unwrap_or(TrialEnd::Fell),
        upright: trials.iter().filter(|t| t.end() <= TrialEnd::Stands).count(),
        unmet: String::new(),
    };
    for name in trials.iter().flat_map(|t| &t.log).map(|code| format!("{code:?}")) {
        if !row.log.contains(&name) {
            row.log.push(name);
        }
    }
    row.unmet = case.demand.unmet(&row, trials).join("; ");
    row
}

/// Events that are a stop or no power.
fn is_reaction(code: EventCode) -> bool {
    use EventCode::{BusOff, BusSilent, DriveTripped, FollowingError, NodeSilent, PowerOff, SafeStop};
    matches!(code, BusOff | BusSilent | DriveTripped | FollowingError | NodeSilent | PowerOff | SafeStop)
}
