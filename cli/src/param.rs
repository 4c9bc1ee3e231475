//! `gangwerk param list|get|set`: parameters of the running stabilizer by name.

use std::error::Error;
use std::path::Path;
use std::time::Duration;

use config::parameters::{PARAMETERS, Parameter};
use ipc::Space;
use messages::command::ParameterCommand;
use messages::{Command, Parameters, Process, topics};
use realtime::clock;

/// How long a new value may take to show \[ns\].
const PATIENCE: u64 = clock::SECOND;

/// Prints the table; with values if a robot runs in `dir`.
pub fn list(dir: &Path) {
    let values = present(dir).ok();
    for (i, p) in PARAMETERS.iter().enumerate() {
        let value = values.map_or("-".into(), |v| v.values[i].to_string());
        println!("{:22} {value:>8} {:10} [{}, {}]  {}", p.name, p.unit, p.range[0], p.range[1], p.about);
    }
    if values.is_none() {
        println!("\nno robot runs in {}: values are those of its gait file", dir.display());
    }
}

/// Prints the value of one parameter.
///
/// # Errors
/// No such parameter, or no robot runs in `dir`.
pub fn get(dir: &Path, name: &str) -> Result<(), Box<dyn Error>> {
    let (number, p) = find(name)?;
    println!("{} {}", present(dir)?.values[number as usize], p.unit);
    Ok(())
}

/// Sets a parameter and waits until the stabilizer has it.
///
/// # Errors
/// No such parameter, a value out of its range, no robot, no broker, a refusal, or no answer.
pub fn set(dir: &Path, name: &str, value: f64, take_over: bool) -> Result<(), Box<dyn Error>> {
    let (number, p) = find(name)?;
    let [low, high] = p.range;
    if !(value >= low && value <= high) {
        return Err(format!(
            "{name} = {value} is outside of [{low}, {high}] {}; nothing was changed",
            p.unit
        )
        .into());
    }
    let mut client = crate::operator::connect(dir, "gangwerk param")?;
    crate::operator::give(&mut client, &Command::Parameter(ParameterCommand { number, value }), take_over)?;
    let begun = clock::now();
    while present(dir)?.values[number as usize] != value {
        if clock::now() - begun > PATIENCE {
            return Err(format!("{name}: the stabilizer did not take the value; is it running?").into());
        }
        std::thread::park_timeout(Duration::from_millis(5));
    }
    println!("{name} = {value} {}", p.unit);
    Ok(())
}

fn present(dir: &Path) -> Result<Parameters, Box<dyn Error>> {
    let space = Space::open(dir, Process::Observer)?;
    let mut reader = space.reader::<Parameters>(&topics::PARAMETERS)?;
    Ok(*reader.latest().ok_or("the stabilizer has not started yet")?)
}

fn find(name: &str) -> Result<(u32, &'static Parameter), String> {
    Parameter::find(name).ok_or_else(|| {
        let near: Vec<_> =
            PARAMETERS.iter().map(|p| p.name).filter(|n| n.contains(name) || name.contains(n)).collect();
        let hint =
            if near.is_empty() { String::new() } else { format!("did you mean {}? ", near.join(" or ")) };
        format!("there is no parameter {name}; {hint}`gangwerk param list` shows them all")
    })
}
