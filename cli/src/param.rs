//! `gangwerk param list|get|set`: parameters of all processes of a running robot by name.

use std::error::Error;
use std::path::Path;
use std::time::Duration;

use broker::observation::Observation;
use config::Setup;
use config::registry::{Change, Entry};
use ipc::{Run, Space};
use messages::Process;
use realtime::clock;

/// How long a new value may take to show \[ns\].
const PATIENCE: u64 = clock::SECOND;

/// A running robot; it needs no broker to be looked at.
struct Robot {
    observation: Observation,
    _space: Space,
}

impl Robot {
    fn open(dir: &Path) -> Result<Self, Box<dyn Error>> {
        let space = Space::open(dir, Process::Observer)?;
        let run = Run::load(dir)?;
        let setup = Setup::load(&run.config, &run.scene)?;
        Ok(Self { observation: Observation::open(&space, Some(&setup))?, _space: space })
    }

    fn find(&self, name: &str) -> Result<Entry, String> {
        self.observation.find(name).cloned()
    }
}

/// Prints the table of the robot that runs in `dir`.
///
/// # Errors
/// None runs there.
pub fn list(dir: &Path) -> Result<(), Box<dyn Error>> {
    let mut process = "";
    for (e, value) in Robot::open(dir)?.observation.all() {
        if e.process != process {
            process = e.process;
            println!("{process}");
        }
        let ([low, high], number) = (e.range, text(value));
        let set = if matches!(e.change, Change::Live(_)) { "can be set" } else { "fixed" };
        let default =
            if value == e.default { String::new() } else { format!(" (default {})", text(e.default)) };
        println!(
            "  {:26} {number:>8} {:10} [{}, {}]  {set}  {}{default}",
            e.name,
            e.unit,
            text(low),
            text(high),
            e.about
        );
    }
    Ok(())
}

/// A number; what is no limit is "any".
fn text(x: f64) -> String {
    if x == f64::MAX { "any".into() } else { x.to_string() }
}

/// Prints the value of one parameter.
///
/// # Errors
/// No such parameter, or no robot runs in `dir`.
pub fn get(dir: &Path, name: &str) -> Result<(), Box<dyn Error>> {
    let mut robot = Robot::open(dir)?;
    let entry = robot.find(name)?;
    println!("{} {}", robot.observation.value(&entry), entry.unit);
    Ok(())
}

/// Sets a parameter and waits until its process has it.
///
/// # Errors
/// No such parameter, one that is fixed, a value out of its range, no robot, no broker, a refusal, or no answer.
pub fn set(dir: &Path, name: &str, value: f64, take_over: bool) -> Result<(), Box<dyn Error>> {
    let mut robot = Robot::open(dir)?;
    let entry = robot.find(name)?;
    let command = entry.command(value)?;
    let mut client = crate::operator::connect(dir, "gangwerk param")?;
    crate::operator::give(&mut client, &command, take_over)?;
    let begun = clock::now();
    while robot.observation.value(&entry) != value {
        if clock::now() - begun > PATIENCE {
            return Err(format!("{name}: {} did not take the value; is it running?", entry.process).into());
        }
        std::thread::park_timeout(Duration::from_millis(5));
    }
    println!("{name} = {value} {}", entry.unit);
    Ok(())
}
