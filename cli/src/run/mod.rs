//! `gangwerk run SCENE`: every process of the chain, started, watched and ended.
//!
//! - `supervisor.rs`: starts the processes, looks after them, ends them.
//! - `course.rs`: when the run ends and what is done before: the answer to Ctrl-C, to deaths, to standing; pure.
//! - `pulse.rs`: who hangs; pure; told by `hearing.rs`. `backoff.rs`: when who died is started again; pure.
//! - `crash.rs`: what a dead process leaves. `manager.rs`: what a service manager hears.
//! - `view.rs`: what the operator sees; `tally.rs`: what comes again and again.

mod backoff;
mod course;
mod crash;
mod hearing;
mod manager;
mod pulse;
mod supervisor;
mod tally;
mod view;

use std::error::Error;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::ExitStatus;

use config::{BusAddress, Setup};
use ipc::{Mode, Run, Space};
use messages::topics::{CONTROLLER_STATE, SIM_STATE};
use messages::{ControllerState, Process, SimState};
use realtime::{Stop, clock};
use terminal::Console;

use chain::ending::Ending;
use chain::figures::{Figures, Gatherer};

use crate::choose::OtherMethod;

pub use crash::TEXT as CRASH_TEXT;

/// Open files that the supervisor needs, with room for topics to come; 1595 at the last count.
const OPEN_FILES: u64 = 2048;

/// Options of a run.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// Lockstep or real time.
    pub mode: Mode,
    /// In lockstep: no faster than real time.
    pub paced: bool,
    /// Name of the scene, or path of its file.
    pub scene: String,
    /// Method of simulation, if the scene leaves it open or somebody asked for another one: [`crate::choose`].
    pub method: Option<OtherMethod>,
    /// The configuration directory.
    pub config: PathBuf,
    /// Goes on when the scene is over, until it is asked to end.
    pub stays: bool,
    /// The field bus.
    pub bus: BusAddress,
    /// Whether a simulated robot is put at its far end.
    pub robot: bool,
    /// The run directory.
    pub dir: PathBuf,
    /// Path of the log; none: no log.
    pub log: Option<PathBuf>,
    /// In real time, a process without the scheduling that it asks for is not armed.
    pub rt_required: bool,
}

/// Cause of a process's early end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Cause {
    /// It ended.
    Died(ExitStatus),
    /// It lived and wrote nothing for so long \[ns\].
    Hung(u64),
}

impl std::fmt::Display for Cause {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Died(status) => match status.signal() {
                Some(n) => write!(f, "died during the run: signal {n}"),
                None => write!(f, "died during the run: {status}"),
            },
            Self::Hung(ns) => {
                write!(
                    f,
                    "hung during the run: no record of it for {:.1} s",
                    *ns as f64 / clock::SECOND as f64
                )
            }
        }
    }
}

/// Somebody asked for the end before the robot was there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EndedWhileStarting;

impl std::fmt::Display for EndedWhileStarting {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("asked to end while starting")
    }
}

impl Error for EndedWhileStarting {}

/// Outcome of a run.
#[derive(Debug, Default)]
pub struct RunOutcome {
    /// Processes that died or hung before their time, also those that were started again.
    pub lost: Vec<(Process, Cause)>,
    /// Whether a signal asked for the end.
    pub interrupted: bool,
    /// Longest delay of the joint loop \[ms\], if the supply was cut or the robot was stopped because this machine was late.
    pub late_ms: Option<f64>,
    /// Ending of the walk.
    pub ending: Ending,
    /// Records missing from the log.
    pub missing: u64,
    /// True if the logger ended as an error, because its disk failed.
    pub log_broken: bool,
}

/// Runs a scene with all its processes, until `stop` at the latest; what there is to tell goes to `console`.
///
/// `stop` is made before `console`, which is a thread.
///
/// # Errors
/// The configuration is wrong, another run uses the directory, or a process does not start.
pub fn run(order: &RunOptions, stop: Stop, console: &Console) -> Result<RunOutcome, Box<dyn Error>> {
    let files = realtime::open_files(OPEN_FILES);
    if files < OPEN_FILES {
        return Err(format!(
            "this user may have {files} open files, a run takes {OPEN_FILES}: ulimit -n {OPEN_FILES}"
        )
        .into());
    }
    // From here errors name the files of the operator; the processes read the copy.
    let theirs = Setup::load(&order.config, &order.scene)?.on_bus(order.bus.is_classic())?;
    refuse_config_inside(&order.config, &order.dir)?;
    let space = Space::create(&order.dir)?;
    let config = space.dir().join(ipc::CONFIG);
    let _ = std::fs::remove_dir_all(&config); // of a run that was killed
    config::snapshot(&order.config, &config)?;
    config::scenes::add(&order.scene, &config)?;
    let scene = theirs.scene.name;
    let setup = Setup::load(&config, &scene)?.with_method(order.method.map(|other| other.method))?;
    if setup.hash != theirs.hash {
        return Err(format!(
            "{}: changed while the run was starting; start it again",
            order.config.display()
        )
        .into());
    }
    multibody_check(&setup)?;
    let run = Run {
        dir: space.dir().into(),
        mode: order.mode,
        paced: order.paced,
        scene,
        method: order.method.map(|other| other.method.to_string()),
        method_error: order.method.and_then(|other| other.error),
        config,
        bus: order.bus.to_string(),
        robot: order.robot,
        stays: order.stays,
        log: order.log.clone(),
        commit: crate::COMMIT.into(),
        started: (order.mode == Mode::RealTime).then(|| [clock::unix_ns(), clock::now()]),
    };
    run.save()?;
    let outcome = supervisor::supervise(run, space, &setup, order.rt_required, stop, console)?;
    if let Some(log) = order.log.as_ref().filter(|_| outcome.lost.iter().any(|(p, _)| *p == Process::Logger))
    {
        mend(log, console);
    }
    Ok(outcome)
}

/// The end of a run removes what it put into its directory: no place for the operator's configuration.
fn refuse_config_inside(config: &Path, dir: &Path) -> Result<(), String> {
    let inside = match (config.canonicalize(), dir.canonicalize()) {
        // A link is refused for itself.
        (Ok(config), Ok(real)) => !dir.is_symlink() && config.starts_with(real),
        _ => false, // a directory that is still to be made holds nothing
    };
    let (config, dir) = (config.display(), dir.display());
    if inside {
        return Err(format!(
            "--config {config}: lies in the run directory, --dir {dir}; choose another --dir"
        ));
    }
    Ok(())
}

/// Gives the parts of a log their index that the death of the logger cost.
fn mend(log: &Path, console: &Console) {
    let parts = logger::Parts::new(log);
    let there = (1..).map(|part| parts.path(part)).take_while(|path| path.exists());
    for path in there {
        console.say(crate::log::mend(&path).unwrap_or_else(|error| error.to_string()));
    }
}

/// Builds what every process will build, so that a wrong robot is one error and not seven.
fn multibody_check(setup: &Setup) -> Result<(), Box<dyn Error>> {
    sim_backend::SimBackend::new(&setup.robot, &setup.scene)?;
    Ok(())
}

/// The figures of a log.
///
/// # Errors
/// The log cannot be read.
pub fn figures_of(log: &Path, setup: &Setup) -> Result<Figures, Box<dyn Error>> {
    let file = recording::Log::open(log)?;
    let states = file.records::<ControllerState>(&CONTROLLER_STATE)?;
    let sims = file.records::<SimState>(&SIM_STATE)?;
    let mut gatherer = Gatherer::default();
    let mut sims = sims.iter().peekable();
    for state in &states {
        while sims.next_if(|s| s.header.tick < state.header.tick).is_some() {}
        if let Some(sim) = sims.next_if(|s| s.header.tick == state.header.tick) {
            gatherer.add(sim, state);
        }
    }
    Ok(gatherer.figures(setup, 0.0, Some(log.display().to_string())))
}
