//! `gangwerk estop`: the emergency stop, with nothing in its way: no command line parser, no configuration, no shared memory, no
//! broker. It asks the watchdog's own thread, over its own socket, and waits for the answer that the supply is off.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use ipc::StopName;

pub use watchdog::stop_request::{StopOutcome, Stopped, stop};

/// Help, which is printed before the command line is parsed.
pub const HELP: &str = "\
Emergency stop: cuts the motor supply of a robot, and says when it was off.

Usage: gangwerk estop [--all | --dir DIR]

Without options: your robot in the default run directory; if there is none, every robot on this machine.
  --all      every robot on this machine, whoever runs it
  --dir DIR  the robot that runs there
Exit codes:
  0  the supply of every robot that was asked is off
  1  somebody did not answer, or there is no robot";

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

/// One line for each robot.
pub fn report(stopped: &[Stopped]) -> Vec<String> {
    let line = |s: &Stopped| format!("{} (user {}): {}", s.name.dir(), s.name.uid, s.outcome);
    stopped.iter().map(line).collect()
}
