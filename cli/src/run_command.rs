//! `gangwerk run`: a run, its results and its exit code, with nothing printed but through the console.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use cli::exit::Exit;
use cli::run::{RunOptions, RunOutcome};
use config::Setup;
use realtime::{Stop, clock};
use terminal::Console;

/// Timeout for the terminal to take the remaining output when a run has ended.
const LAST_WORDS: Duration = Duration::from_secs(2);

/// Directory for log and pictures: the one asked for, else `runs/latest`, else the user's data directory.
///
/// # Errors
/// Neither can be made.
pub(crate) fn place(asked: Option<PathBuf>) -> Result<PathBuf, String> {
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
pub(crate) enum Results {
    /// Its figures, for other programs.
    Json,
    /// Its figures, for people.
    Table,
    /// The same and pictures.
    Pictures,
}

impl Results {
    /// As the command line asks for them.
    pub(crate) fn of(json: bool, no_plots: bool) -> Self {
        match (json, no_plots) {
            (true, _) => Self::Json,
            (false, true) => Self::Table,
            (false, false) => Self::Pictures,
        }
    }
}

/// A run, with nothing printed but through the console: a paused terminal holds up neither robot nor end.
pub(crate) fn run(mut order: RunOptions, wanted: Results) -> Result<ExitCode, Box<dyn Error>> {
    let (setup, choice) = cli::choose::load(&order.config, &order.scene, true)?;
    order.method = choice.map(|choice| choice.method);
    // First of all that starts a thread: one with signals of its own would be where Ctrl-C ends everything.
    let stop = Stop::on_signals()?;
    let console = Console::start(Some((setup.scene.duration * 10.0) as u64), clock::now)?;
    terminal::divert(&console);
    let exit = run_on(&order, &setup, wanted, stop, &console).unwrap_or_else(|error| {
        console.say(format!("error: {error}"));
        Exit::Error
    });
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
    }
    Ok(text)
}
