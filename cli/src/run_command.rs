//! `gangwerk run`: a run, its results and its exit code, with nothing printed but through the console.

use std::error::Error;
use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use cli::choose::MethodWish;
use cli::exit::Exit;
use cli::run::{EndedWhileStarting, RunOptions, RunOutcome};
use config::method::Integrator;
use config::{BusAddress, Setup};
use ipc::Mode;
use realtime::{Stop, clock};
use terminal::Console;

use crate::desk::Desk;

/// Timeout for the terminal to take the remaining output when a run has ended.
const LAST_WORDS: Duration = Duration::from_secs(2);

/// Arguments of `gangwerk run`.
#[derive(clap::Args)]
pub(crate) struct RunArguments {
    /// Name of a scene, see `gangwerk scene list`, or path of a scene file.
    scene: String,
    /// Depth of the model, 1 to 5, instead of the scene's: docs/howto/scenes.md.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=5), conflicts_with = "no_robot")]
    depth: Option<u8>,
    /// Integrator instead of the scene's: euler, rk4, semi_implicit or bdf; default with another depth: the one made for it.
    #[arg(long, value_name = "NAME", conflicts_with = "no_robot")]
    integrator: Option<Integrator>,
    /// Simulated time: every process waits for the others, and two runs are bit for bit the same.
    #[arg(long)]
    lockstep: bool,
    /// Lockstep no faster than real time: a busy machine slows the robot down instead of felling it.
    #[arg(long, requires = "lockstep")]
    paced: bool,
    /// Go on when the scene is over, until Ctrl-C; the first walking command that somebody gives ends the scene's own.
    #[arg(long = "stay")]
    stays: bool,
    /// Serve the page of the operator's desk beside it, and show it where there is a desktop: see `gangwerk dashboard`.
    #[arg(long)]
    desk: bool,
    /// Field bus: shm, can:vcan0 (all lines), can:vcan0-8 (one each), canfd:INTERFACES, sercos:INTERFACES.
    #[arg(long, default_value = "shm")]
    bus: BusAddress,
    /// No simulated robot: somebody else is at the far end of the bus, a robot or a replay.
    #[arg(long)]
    no_robot: bool,
    /// Directory of log and pictures; default: runs/latest, or one where this user may write instead.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// No log and no pictures.
    #[arg(long)]
    no_log: bool,
    /// Refuse to arm if a process does not get the scheduling and the locked memory that it asks for.
    #[arg(long, value_name = "required")]
    rt: Option<RealTime>,
    /// Log, but draw no pictures.
    #[arg(long)]
    no_plots: bool,
    /// End with the figures of the log as one JSON object on standard output, instead of a table and pictures.
    #[arg(long, conflicts_with = "no_log")]
    json: bool,
    /// Directory in which the processes meet; a second robot needs another one.
    #[arg(long, value_name = "DIR", default_value_os_t = ipc::default_dir())]
    dir: PathBuf,
    /// End, as with Ctrl-C, when this process, which started it, ends.
    #[arg(long, hide = true, value_name = "PID")]
    with_parent: Option<u32>,
}

/// Demand on the scheduling of the processes. A doc line at a value would be part of the help.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum RealTime {
    Required,
}

impl RunArguments {
    /// Without arguments: the demonstration. Where somebody looks at a terminal the robot stays, to be steered, and so no log grows;
    /// otherwise it ends.
    pub(crate) fn demonstration() -> Self {
        let watched = io::stdout().is_terminal() && io::stderr().is_terminal();
        Self {
            scene: "demo".into(),
            depth: None,
            integrator: None,
            lockstep: true,
            paced: true,
            stays: watched,
            desk: watched,
            bus: BusAddress::Shared,
            no_robot: false,
            out: None,
            no_log: watched,
            rt: None,
            no_plots: false,
            json: false,
            dir: ipc::default_dir(),
            with_parent: None,
        }
    }
}

/// `gangwerk run` with the configuration in `config`.
///
/// # Errors
/// There is no place for the log, the process that it is to end with is gone, or the run cannot be started.
pub(crate) fn main(arguments: RunArguments, config: PathBuf) -> Result<ExitCode, Box<dyn Error>> {
    let RunArguments { scene, lockstep, paced, stays, desk, bus, no_robot, out, no_log, rt, .. } = arguments;
    let wish = MethodWish { depth: arguments.depth, integrator: arguments.integrator };
    if let Some(parent) = arguments.with_parent {
        Stop::with_parent()?;
        // One that ended before that sends no signal.
        if std::os::unix::process::parent_id() != parent {
            return Err(format!("--with-parent {parent}: this process is gone").into());
        }
    }
    let mode = if lockstep { Mode::Lockstep } else { Mode::RealTime };
    // Before there is a place for its log.
    Setup::load(&config, &scene)?;
    let log = match no_log {
        true => None,
        false => Some(place(out)?.join(format!("{}.mcap", config::scenes::name(&scene)))),
    };
    if let Some(log) = log.as_ref().filter(|log| recording::is_being_written(log)) {
        return Err(
            format!("{}: another run writes it; choose another place with --out", log.display()).into()
        );
    }
    let order = RunOptions {
        mode,
        paced,
        scene,
        method: None,
        stays,
        config,
        bus,
        robot: !no_robot,
        dir: arguments.dir,
        log,
        rt_required: rt == Some(RealTime::Required),
    };
    run(order, wish, Results::of(arguments.json, arguments.no_plots), desk)
}

/// Directory for log and pictures: the one asked for, else `runs/latest`, else the user's data directory.
///
/// # Errors
/// Neither can be made.
fn place(asked: Option<PathBuf>) -> Result<PathBuf, String> {
    let made = |dir: &Path| {
        // A directory of somebody else's may be there already: only a file in it shows.
        let probe = dir.join(format!(".gangwerk-{}", std::process::id()));
        std::fs::create_dir_all(dir)?;
        std::fs::File::create(&probe).and_then(|_| std::fs::remove_file(&probe))
    };
    let told =
        |dir: &Path, e: &std::io::Error| format!("{}: {e}; choose another place with --out", dir.display());
    if let Some(dir) = asked {
        return made(&dir).map_err(|e| told(&dir, &e)).map(|()| dir);
    }
    let here = PathBuf::from("runs/latest");
    let Err(error) = made(&here) else { return Ok(here) };
    let variable = |name| std::env::var_os(name).map(PathBuf::from).filter(|dir| dir.is_absolute());
    let state = variable("XDG_STATE_HOME").or_else(|| Some(variable("HOME")?.join(".local/state")));
    let own = state.map(|dir| dir.join("gangwerk/latest")).filter(|dir| made(dir).is_ok());
    let own = own.ok_or_else(|| told(&here, &error))?;
    eprintln!("{}: {error}; log and pictures go to {}", here.display(), own.display());
    Ok(own)
}

/// Results made from the log of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Results {
    /// Its figures, for other programs.
    Json,
    /// Its figures, for people.
    Table,
    /// The same and pictures.
    Pictures,
}

impl Results {
    /// As the command line asks for them.
    fn of(json: bool, no_plots: bool) -> Self {
        match (json, no_plots) {
            (true, _) => Self::Json,
            (false, true) => Self::Table,
            (false, false) => Self::Pictures,
        }
    }
}

/// A run, with nothing printed but through the console: a paused terminal holds up neither robot nor end. With a `desk` its page
/// is served besides.
fn run(
    mut order: RunOptions,
    wish: MethodWish,
    wanted: Results,
    desk: bool,
) -> Result<ExitCode, Box<dyn Error>> {
    let (setup, method) = cli::choose::load_with(&order.config, &order.scene, wish)?;
    order.method = method;
    // First of all that starts a thread: one with signals of its own would be where Ctrl-C ends everything.
    let stop = Stop::on_signals()?;
    let length = Some((setup.scene.duration * 10.0) as u64).filter(|_| !order.stays);
    let console = Console::start(length, clock::now)?;
    terminal::divert(&console);
    // A robot walks without its page, too.
    let page =
        desk.then(|| Desk::open(&order.dir, &console).map_err(|e| console.say(format!("no page: {e}"))));
    let exit = run_on(&order, &setup, wanted, stop, &console).unwrap_or_else(|error| {
        console.say(format!("error: {error}"));
        if error.is::<EndedWhileStarting>() { Exit::Interrupted } else { Exit::Error }
    });
    drop(page);
    console.flush(LAST_WORDS);
    Ok(exit.into())
}

fn run_on(
    order: &RunOptions,
    setup: &Setup,
    wanted: Results,
    stop: Stop,
    console: &Console,
) -> Result<Exit, Box<dyn Error>> {
    let outcome = cli::run::run(order, stop, console)?;
    // Results: what the log says, and whether that is all of the run.
    let mut told = true;
    if let Some(log) = order.log.as_ref().filter(|_| order.robot) {
        let text = results(log, setup, &outcome, wanted, console);
        told = text.map_err(|error| console.say(format!("error: {error}"))).is_ok_and(|text| {
            // A paused terminal is no reason to call the run a failure; a full disk under the results is.
            console.result(text, LAST_WORDS) || outcome.interrupted
        });
    }
    // Reasons, last, so that they stand at the end: who was lost and why.
    for (process, cause) in &outcome.lost {
        console.say(format!("{} {cause}", process.name()));
    }
    if let Some(ms) = outcome.late_ms.filter(|_| order.robot) {
        console.say(format!(
            "this machine was too slow for real time: the joint loop came up to {ms:.1} ms late, and its motor supply was cut \
             or the robot stopped, as a real one's would; take --lockstep, which needs no real time, or see `gangwerk doctor`"
        ));
    }
    if outcome.log_broken {
        console.say("the log is not complete: its logger failed");
    } else if outcome.missing > 0 {
        console.say(format!("the log is not complete: {} records are missing", outcome.missing));
    }
    let failed = !outcome.lost.is_empty() || outcome.log_broken || !told;
    let exit = if failed { Exit::Error } else { Exit::of(&outcome.ending, outcome.interrupted) };
    if matches!(exit, Exit::Fell | Exit::NotDone) {
        let (by, at) = outcome.ending.end();
        let refused = outcome.ending.refused;
        console
            .say(format!("ended by {by}, at {at:.3} s; commands of the scene that were refused: {refused}"));
    }
    Ok(exit)
}

/// Figures of a log, and the names of its pictures.
fn results(
    log: &Path,
    setup: &Setup,
    outcome: &RunOutcome,
    wanted: Results,
    console: &Console,
) -> Result<String, Box<dyn Error>> {
    let figures = cli::run::figures_of(log, setup)?.ended(&outcome.ending);
    if wanted == Results::Json {
        return Ok(serde_json::to_string(&figures)?);
    }
    let mut text = chain::figures::table(&figures);
    if outcome.missing > 0 || outcome.log_broken {
        text += "\nINCOMPLETE: records are missing from the log, and these figures are of the others";
    }
    if wanted == Results::Pictures {
        let pictures = cli::plot::run(log, log.parent().unwrap_or(log))?;
        text += &pictures.written.iter().map(|path| format!("\n{}", path.display())).collect::<String>();
        pictures.skipped.iter().for_each(|reason| console.say(format!("not drawn: {reason}")));
        text += &format!("\ngangwerk dashboard --replay {} shows it again", log.display());
    }
    Ok(text)
}
