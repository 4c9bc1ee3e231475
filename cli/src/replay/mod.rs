//! `gangwerk replay LOG`: the recorded inputs of a process, fed to its real step, and what comes out held against the log.
//!
//! - `tape.rs`: the log, topic by topic, in the order of writing; notices what is missing.
//! - `unpacked.rs`: the configuration in the log.
//! - `parts.rs`: one process each: which record goes into which step.
//!
//! A replay begins where the process began, with the configuration in the log. It is exact or says why it cannot be.

mod parts;
mod problem;
mod tape;
mod unpacked;

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

use config::{BusAddress, Setup};

use messages::Process;
use recording::Log;

pub use problem::ReplayProblem;
use tape::Tape;
pub use unpacked::Unpacked;

/// Processes whose step can be replayed.
pub const PROCESSES: [Process; 4] =
    [Process::Planner, Process::Controller, Process::Lowlevel, Process::Watchdog];

/// Replayed records that are equal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Replayed {
    /// Cycles of the process.
    pub cycles: u64,
    /// Records that it wrote.
    pub records: u64,
    /// \[B\] Their size in the log.
    pub bytes: u64,
    /// Commands that it took.
    pub commands: u64,
    /// The log ends in the middle, as that of a killed logger; what is in it is the same.
    pub cut: bool,
}

impl std::fmt::Display for Replayed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { cycles, records, bytes, commands, cut } = self;
        let megabytes = *bytes as f64 * 1e-6;
        write!(
            f,
            "{cycles} cycles, {commands} commands, {records} records, {megabytes:.1} MB: no byte differs"
        )?;
        if *cut { write!(f, "; the log ends in the middle") } else { Ok(()) }
    }
}

/// Replays one process of a log.
///
/// # Errors
/// The log cannot be read, was not made by `gangwerk run`, or has another layout; a [`ReplayProblem`]: a record that the replay
/// needs is missing, or one differs.
pub fn replay(log: &Path, process: Process) -> Result<Replayed, Box<dyn Error>> {
    let file = Log::open(log)?;
    let (setup, bus) = setup_of(&file)?;
    let mut part = parts::of(process, &setup, &bus)?;
    let mut tape = Tape::open(file, process)?;
    let mut done = Replayed::default();
    part.begin(&mut tape)?;
    loop {
        match cycle(&mut tape, part.as_mut(), &mut done) {
            Ok(true) => {}
            Ok(false) => break,
            Err(ReplayProblem::EndOfCut) => {
                done.cut = true;
                break;
            }
            Err(problem) => return Err(problem.into()),
        }
    }
    if done.cycles == 0 {
        return Err(ReplayProblem::NoCycles { process }.into());
    }
    if !done.cut {
        tape.nothing_is_left()?;
    }
    (done.records, done.bytes) = tape.compared();
    Ok(done)
}

/// One cycle; `Ok(false)`: there is no more.
fn cycle(tape: &mut Tape, part: &mut dyn parts::Part, done: &mut Replayed) -> Result<bool, ReplayProblem> {
    let Some(inputs) = tape.inputs()? else { return Ok(false) };
    let commands = tape.commands(&inputs)?;
    part.cycle(tape, &inputs, &commands)?;
    tape.end_of_cycle(&inputs)?;
    done.cycles += 1;
    done.commands += commands.len() as u64;
    Ok(true)
}

/// The configuration of a log, from the files in it, and the field bus.
fn setup_of(log: &Log) -> Result<(Setup, BusAddress), Box<dyn Error>> {
    let unpacked = Unpacked::of(log)?;
    let run = unpacked
        .run
        .as_ref()
        .ok_or("the log does not say how it was run: only logs of `gangwerk run` can be replayed")?;
    let bus: BusAddress = run.bus.parse()?;
    let setup = unpacked.setup(log)?;
    let (theirs, ours) = (log.run().config_hash, setup.hash);
    if theirs != ours {
        return Err(format!(
            "the configuration in the log (hash {ours:016x}) is not the run's ({theirs:016x})"
        )
        .into());
    }
    Ok((setup, bus))
}

/// `gangwerk replay`: every process, or one, and what came of it.
///
/// # Errors
/// There is no such process, or see [`replay`].
pub fn main(log: &Path, process: Option<&str>) -> Result<ExitCode, Box<dyn Error>> {
    let all = PROCESSES;
    let chosen = all.iter().filter(|p| process.is_none_or(|name| p.name() == name));
    let mut some = false;
    for &process in chosen {
        let done = replay(log, process)?;
        println!("{}: {done}", process.name());
        some = true;
    }
    if !some {
        let names = all.map(|p| p.name()).join(", ");
        return Err(format!("--process {}: there is {names}", process.unwrap_or_default()).into());
    }
    Ok(ExitCode::SUCCESS)
}
