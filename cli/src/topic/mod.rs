//! `gangwerk topic`: what a running robot says, and what it can be told.
//!
//! - `echo.rs`: records as they come. `measure.rs`: rate, bandwidth and age of a topic.
//! - [`crate::operator`] sends commands.

mod echo;
mod measure;

use std::error::Error;
use std::path::Path;

use config::Setup;
use ipc::{Mode, Run, Space};
use messages::command_text::{COMMANDS, CommandInfo};
use messages::topics::{ForType, Topic, with_type};
use messages::{Process, Record, TOPICS};

use messages::fields::numbers;

pub use echo::{Echo, echo};
pub(crate) use echo::{EchoTable, words};
pub use measure::{Measure, measure};

/// Name of all events together in `topic echo`.
const EVENTS: &str = "events";

/// A robot that runs, as an observer sees it.
pub struct ObservedRobot {
    /// Its shared memory.
    pub space: Space,
    /// Mode.
    pub mode: Mode,
    /// Robot and scene.
    pub setup: Setup,
}

impl ObservedRobot {
    /// The robot that runs in `dir`.
    ///
    /// # Errors
    /// None does: what to do.
    pub fn open(dir: &Path) -> Result<Self, Box<dyn Error>> {
        let space = Space::open(dir, Process::Observer).map_err(|e| {
            format!("no robot runs here: start one with `gangwerk run walk_60s`, or say where it runs with --dir ({e})")
        })?;
        let run = Run::load(dir)?;
        Ok(Self { space, mode: run.mode, setup: Setup::load(&run.config, &run.scene)? })
    }

    /// Names of its joints, in the order of every array of joints.
    pub fn joints(&self) -> Vec<String> {
        self.setup.robot.joints.iter().map(|joint| joint.name.clone()).collect()
    }
}

/// Prints both tables: what can be read, and what can be sent.
pub fn list() {
    println!("topics (gangwerk topic echo NAME)");
    for t in TOPICS {
        println!("  {:26} {:16} {:>8}  from {}", t.name, t.type_name, rate(t), t.writer.name());
    }
    println!("\ncommands (gangwerk topic pub NAME field=number ...)");
    COMMANDS.iter().for_each(describe);
}

fn rate(topic: &Topic) -> String {
    if topic.rate_hz == 0 { "when new".into() } else { format!("{} Hz", topic.rate_hz) }
}

fn describe(command: &CommandInfo) {
    println!("  {:26} {}", command.name, command.about);
    for f in command.fields {
        let default = f.default.map_or("must be given".into(), |d| format!("default {d}"));
        println!("      {:10} [{}, {}] {:6} {default}: {}", f.name, f.range[0], f.range[1], f.unit, f.about);
    }
}

fn find(name: &str) -> Result<&'static Topic, String> {
    Topic::find(name).ok_or_else(|| {
        let known: Vec<&str> = TOPICS.iter().map(|t| t.name).collect();
        messages::unknown("topic", name, &known, "`gangwerk topic list` shows them all")
    })
}

/// Prints everything about a topic, or a command, and its fields with their units.
///
/// # Errors
/// No such topic.
pub fn info(name: &str) -> Result<(), String> {
    if let Some(command) = COMMANDS.iter().find(|c| c.name == name) {
        describe(command);
        return Ok(());
    }
    let t = find(name)?;
    let names = |all: &[Process]| all.iter().map(|p| p.name()).collect::<Vec<_>>().join(", ");
    println!("topic       {}", t.name);
    println!("type        {}", t.type_name);
    println!("written by  {}", t.writer.name());
    println!(
        "read by     {}{}",
        names(t.readers),
        if t.logged { "; in the log" } else { "; not in the log" }
    );
    println!("wakes       {}", names(t.wakes));
    println!("rate        {}", rate(t));
    println!("stale after {} cycles (0: never)", t.stale_after);
    println!("kept        {} records", t.depth);
    with_type(t.name, Fields);
    Ok(())
}

/// Prints the type of a topic.
///
/// # Errors
/// No such topic.
pub fn type_of(name: &str) -> Result<(), String> {
    println!("{}", find(name)?.type_name);
    Ok(())
}

/// Prints the size of a record and its fields.
struct Fields;

impl ForType<()> for Fields {
    fn call<T: Record>(self, _: &'static Topic) {
        println!("size        {} bytes", size_of::<T>());
        let all = numbers(&T::empty(), &[]);
        let mut before = "";
        for number in &all {
            // An array is one line.
            let name = number.name.split('[').next().unwrap_or_default();
            let count = all.iter().filter(|n| n.name.split('[').next() == Some(name)).count();
            if name != before {
                let count = if count > 1 { format!("[{count}]") } else { String::new() };
                println!("  {:32} {}", format!("{name}{count}"), number.unit);
            }
            before = name;
        }
    }
}
