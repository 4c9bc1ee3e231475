//! `gangwerk estop`: the emergency stop, with nothing in its way: no command line parser, no configuration, no shared memory, no
//! broker. It asks the watchdog's own thread, over its own socket, and waits for the answer that the supply is off.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use ipc::{StopAnswer, StopButton, StopName};
use realtime::clock;

/// Timeout for an answer, and period of the repeated question \[ns\].
const PATIENCE: u64 = clock::SECOND;
const REPEAT: u64 = clock::SECOND / 20;
/// Between two looks for an answer.
const LOOK: Duration = Duration::from_millis(2);

const HELP: &str = "\
Emergency stop: cuts the motor supply of a robot, and says when it was off.

Usage: gangwerk estop [--all | --dir DIR]

Without options: your robot in the default run directory; if there is none, every robot on this machine.
  --all      every robot on this machine, whoever runs it
  --dir DIR  the robot that runs there
Exit code 0: the supply of every robot asked is off. 1: somebody did not answer, or there is no robot.";

/// Answer of one robot.
#[derive(Clone, Debug)]
pub struct Stopped {
    /// Which.
    pub name: StopName,
    /// Its result.
    pub outcome: StopOutcome,
}

/// Answer of a robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StopOutcome {
    /// Its supply is off since this tick.
    Off {
        /// Tick of the first power record that said so.
        tick: u64,
        /// \[ns\] From the request to that record; none: it was off before.
        after_ns: Option<u64>,
    },
    /// It is not known to be off, and why.
    Failed(String),
}

/// `gangwerk estop`, if that is what was called: to be asked before anything else is done.
pub fn main(arguments: impl Iterator<Item = OsString>) -> Option<ExitCode> {
    let mut arguments = arguments.skip(1);
    if arguments.next()? != "estop" {
        return None;
    }
    let (mut all, mut dir) = (false, None);
    while let Some(argument) = arguments.next() {
        match argument.to_str() {
            Some("--all") => all = true,
            Some("--dir") => dir = arguments.next().map(PathBuf::from),
            Some("--help" | "-h") => {
                println!("{HELP}");
                return Some(ExitCode::SUCCESS);
            }
            // Who calls this means it: what is not understood is said and does not keep it from stopping.
            _ => eprintln!("estop: {} is not understood; stopping all the same", argument.display()),
        }
    }
    let stopped = stop(&robots(all, dir.as_deref()));
    report(&stopped).iter().for_each(|line| println!("{line}"));
    if stopped.is_empty() {
        eprintln!(
            "error: no robot runs on this machine; one in a container or on another machine is stopped there"
        );
    }
    let off = |s: &Stopped| matches!(s.outcome, StopOutcome::Off { .. });
    Some(if !stopped.is_empty() && stopped.iter().all(off) { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Which robots are meant.
fn robots(all: bool, dir: Option<&Path>) -> Vec<StopName> {
    let here = StopName::own(dir.unwrap_or(&ipc::default_dir()));
    // Without a list there is still the name that can be computed.
    let Ok(running) = StopName::all() else { return vec![here] };
    let chosen: Vec<StopName> = match dir {
        _ if all => running,
        Some(dir) => running.into_iter().filter(|name| name.is_in(dir)).collect(),
        None if running.contains(&here) => vec![here.clone()],
        None => running,
    };
    if chosen.is_empty() && dir.is_some() { vec![here] } else { chosen }
}

/// Stops the robot that this user runs in `dir`.
pub(crate) fn stop_own(dir: &Path) -> Vec<Stopped> {
    stop(&[StopName::own(dir)])
}

/// Asks all of them first, then waits for the answers.
pub fn stop(names: &[StopName]) -> Vec<Stopped> {
    let begun = clock::now();
    let failed = |text: String| Some(StopOutcome::Failed(text));
    let mut asked: Vec<(StopName, Result<StopButton, _>, Option<StopOutcome>)> =
        names.iter().map(|name| (name.clone(), StopButton::new(name), None)).collect();
    let (mut next, mut pending) = (begun, false);
    while asked.iter().any(|(.., outcome)| outcome.is_none()) && clock::now() < begun + PATIENCE {
        let repeat = clock::now() >= next;
        next += if repeat { REPEAT } else { 0 };
        for (_, button, outcome) in asked.iter_mut().filter(|(.., outcome)| outcome.is_none()) {
            match button {
                Err(e) => *outcome = failed(format!("no socket: {e}")),
                Ok(button) if repeat => {
                    // A full queue is no error: it is full of requests.
                    if let Err(e) = button.press() {
                        *outcome = failed(format!("nobody listens, so no watchdog runs there: {e}"));
                    }
                }
                Ok(_) => {}
            }
            match button.as_ref().ok().and_then(|button| button.answer(LOOK)) {
                Some(StopAnswer::Off { tick, stamp_ns }) => {
                    *outcome = Some(StopOutcome::Off { tick, after_ns: stamp_ns.checked_sub(begun) });
                }
                Some(StopAnswer::Pending) => pending = true,
                None => {}
            }
        }
    }
    let silent = if pending {
        "it has the request, but no cycle of its watchdog has acted on it: its time stands still"
    } else {
        "no answer: its watchdog hangs; without it the relay falls by itself"
    };
    let outcome = |o: Option<StopOutcome>| o.unwrap_or_else(|| StopOutcome::Failed(silent.into()));
    asked.into_iter().map(|(name, _, o)| Stopped { name, outcome: outcome(o) }).collect()
}

/// One line for each robot.
pub fn report(stopped: &[Stopped]) -> Vec<String> {
    let line = |s: &Stopped| {
        let robot = format!("{} (user {})", s.name.dir(), s.name.uid);
        match &s.outcome {
            StopOutcome::Off { tick, after_ns: Some(ns) } => {
                format!("{robot}: power off at tick {tick}, {} us after the request", ns / 1000)
            }
            StopOutcome::Off { tick, after_ns: None } => {
                format!("{robot}: power was off already, since tick {tick}")
            }
            StopOutcome::Failed(why) => format!("{robot}: NOT KNOWN TO BE OFF: {why}"),
        }
    };
    stopped.iter().map(line).collect()
}
