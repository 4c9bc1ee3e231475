//! `gangwerk param`: parameters of all processes of a running robot by name, one by one or as a file.
//!
//! A file is lines of `name = value`, with remarks behind `#`.

use std::error::Error;
use std::path::Path;
use std::time::Duration;

use broker::StreamClient;
use broker::observation::Observation;
use config::registry::{Change, ParameterEntry};
use ipc::Space;
use messages::Command;
use realtime::clock;

use crate::topic::ObservedRobot;

/// Timeout until a new value shows \[ns\].
const PATIENCE: u64 = clock::SECOND;

/// The parameters of a running robot; it needs no broker to be looked at.
struct ParameterObservation {
    observation: Observation,
    _space: Space,
}

impl ParameterObservation {
    fn open(dir: &Path) -> Result<Self, Box<dyn Error>> {
        let robot = ObservedRobot::open(dir)?;
        Ok(Self { observation: Observation::open(&robot.space, Some(&robot.setup))?, _space: robot.space })
    }

    fn find(&self, name: &str) -> Result<ParameterEntry, String> {
        self.observation.find(name).cloned()
    }
}

/// Prints the table of the robot that runs in `dir`.
///
/// # Errors
/// None runs there.
pub fn list(dir: &Path) -> Result<(), Box<dyn Error>> {
    let mut process = "";
    for (e, value) in ParameterObservation::open(dir)?.observation.all() {
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
    let mut robot = ParameterObservation::open(dir)?;
    let entry = robot.find(name)?;
    println!("{} {}", robot.observation.value(&entry), entry.unit);
    Ok(())
}

/// Prints everything about a parameter.
///
/// # Errors
/// No such parameter, or no robot runs in `dir`.
pub fn describe(dir: &Path, name: &str) -> Result<(), Box<dyn Error>> {
    let mut robot = ParameterObservation::open(dir)?;
    let entry = robot.find(name)?;
    let [low, high] = entry.range;
    println!("parameter  {}", entry.full_name());
    println!("meaning    {}", entry.about);
    println!("value      {} {}", text(robot.observation.value(&entry)), entry.unit);
    println!("default    {} {}", text(entry.default), entry.unit);
    println!("range      [{}, {}] {}", text(low), text(high), entry.unit);
    println!("set        {}", remark(&entry));
    Ok(())
}

/// Whether and where a parameter can be set.
fn remark(entry: &ParameterEntry) -> String {
    match entry.change {
        Change::Live(_) => "while the robot runs".into(),
        Change::File(file) => format!("before the start, in {file} of the configuration"),
        Change::Constant => "never: a constant of the program".into(),
    }
}

/// Sets parameters, none of them if one cannot be, and waits until their processes have them.
///
/// # Errors
/// No such parameter, one that is fixed, a value out of its range (all of these at once), no robot, no broker, a refusal, or
/// no answer.
pub fn set(dir: &Path, wanted: &[(String, f64)], take_over: bool) -> Result<(), Box<dyn Error>> {
    let mut robot = ParameterObservation::open(dir)?;
    let (mut commands, mut wrong): (Vec<(ParameterEntry, f64, Command)>, Vec<String>) = Default::default();
    for (name, value) in wanted {
        match robot.find(name).and_then(|entry| Ok((entry.command(*value)?, entry))) {
            Ok((command, entry)) => commands.push((entry, *value, command)),
            Err(error) => wrong.push(error),
        }
    }
    if !wrong.is_empty() {
        return Err(wrong.join("\n       ").into());
    }
    let mut client = StreamClient::connect(dir, "gangwerk param")?;
    for (entry, value, command) in commands {
        crate::operator::give(&mut client, &command, take_over)?;
        let begun = clock::now();
        while robot.observation.value(&entry) != value {
            if clock::now() - begun > PATIENCE {
                let (name, process) = (entry.full_name(), entry.process);
                return Err(format!("{name}: {process} did not take the value; is it running?").into());
            }
            std::thread::park_timeout(Duration::from_millis(5));
        }
        println!("{} = {value} {}", entry.full_name(), entry.unit);
    }
    Ok(())
}

/// Writes the values of all parameters to a file: those that can be set as lines, the others as remarks.
///
/// # Errors
/// No robot runs in `dir`, or the file cannot be written.
pub fn dump(dir: &Path, file: &Path) -> Result<(), Box<dyn Error>> {
    let mut lines =
        String::from("# Parameters of a running robot; `gangwerk param load FILE` sets them again.\n");
    for (entry, value) in ParameterObservation::open(dir)?.observation.all() {
        let mark = if matches!(entry.change, Change::Live(_)) { "" } else { "# " };
        let (name, unit, about) = (entry.full_name(), entry.unit, entry.about);
        lines +=
            &format!("{mark}{name} = {value:?} # {unit} {about}; {}\n", remark(&entry)).replace("  ", " ");
    }
    std::fs::write(file, lines).map_err(|e| format!("{}: {e}", file.display()))?;
    println!("{}", file.display());
    Ok(())
}

/// Sets the values of a file that the robot has not.
///
/// # Errors
/// As of [`set`]; the file cannot be read, or a line of it is no parameter.
pub fn load(dir: &Path, file: &Path, take_over: bool) -> Result<(), Box<dyn Error>> {
    let text = std::fs::read_to_string(file).map_err(|e| format!("{}: {e}", file.display()))?;
    let wanted = lines(&text).map_err(|e| format!("{}: {e}", file.display()))?;
    let mut robot = ParameterObservation::open(dir)?;
    // A name that there is not is told with all others that are wrong.
    let differs = |(name, value): &(String, f64)| {
        robot.find(name).map_or(true, |entry| robot.observation.value(&entry) != *value)
    };
    let (all, wanted): (usize, Vec<_>) = (wanted.len(), wanted.into_iter().filter(differs).collect());
    set(dir, &wanted, take_over)
        .map_err(|e| format!("{}: nothing was set that is not told above: {e}", file.display()))?;
    println!("{} of {all} were set, the others had their values", wanted.len());
    Ok(())
}

/// Names and values of a file.
///
/// # Errors
/// The first line that is no `name = value`.
fn lines(text: &str) -> Result<Vec<(String, f64)>, String> {
    let mut found = Vec::new();
    for (n, line) in (1..).zip(text.lines()) {
        let line = line.split('#').next().unwrap_or_default().trim();
        if !line.is_empty() {
            let pair = line
                .split_once('=')
                .and_then(|(name, value)| Some((name.trim(), value.trim().parse().ok()?)));
            let (name, value) =
                pair.ok_or_else(|| format!("line {n}: `{line}` is not of the form name = number"))?;
            found.push((name.to_owned(), value));
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::lines;

    #[test]
    fn a_file_is_names_and_values_with_remarks() {
        let text = "# all of it\n\ncontroller.height_p = 10.5 # 1/s\n# watchdog.missed = 2\nplanner.swing_height=-0.0\n";
        let found = lines(text).unwrap();
        assert_eq!(found, [("controller.height_p".into(), 10.5), ("planner.swing_height".into(), -0.0)]);
        assert_eq!(lines("\na b").unwrap_err(), "line 2: `a b` is not of the form name = number");
        assert!(lines("a = fast").is_err());
    }
}
