//! Parameters of every process: name, unit, range, default, meaning, and whether they can be changed while it runs.
//!
//! Parameters that can be changed are in [`crate::parameters`] and named as in the gait file; everything else is fixed at start
//! and named as in the file that it comes from. A value that a configuration does not have (no core, no obstacles) is not listed.

use messages::Command;
use messages::command::ParameterCommand;
use messages::command_text::number_text;

use crate::Setup;
use crate::parameters::{PLANNER, Parameter, STABILIZER};

/// One parameter of one process.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterEntry {
    /// Process that has it.
    pub process: &'static str,
    /// Its name there.
    pub name: String,
    /// SI unit; empty: a count or a share.
    pub unit: &'static str,
    /// Least and greatest value.
    pub range: [f64; 2],
    /// Value from the configuration of this run.
    pub default: f64,
    /// Meaning.
    pub about: &'static str,
    /// Way to change it.
    pub change: Change,
}

/// Ways to change a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// While the robot runs, by the command of its process with this number.
    Live(u32),
    /// Not while the robot runs: it stands in this file of the configuration.
    File(&'static str),
    /// Not at all: it is a constant of the program.
    Constant,
}

impl ParameterEntry {
    /// `process.name`.
    pub fn full_name(&self) -> String {
        format!("{}.{}", self.process, self.name)
    }

    /// The command that gives it another value.
    ///
    /// # Errors
    /// It is fixed, or the value is out of its range.
    pub fn command(&self, value: f64) -> Result<Command, String> {
        let (name, unit, [low, high]) = (self.full_name(), self.unit, self.range);
        let number = match self.change {
            Change::Live(number) => number,
            Change::File(file) => {
                return Err(format!("{name} is fixed at start: change it in config/{file}"));
            }
            Change::Constant => return Err(format!("{name} is a constant of the program")),
        };
        if !(value >= low && value <= high) {
            return Err(format!(
                "{name} = {} is outside of [{low}, {high}] {unit}; nothing was changed",
                number_text(value)
            ));
        }
        let change = ParameterCommand { number, value };
        Ok(if self.process == "planner" {
            Command::WalkParameter(change)
        } else {
            Command::Parameter(change)
        })
    }
}

/// A parameter that is fixed at start.
struct Fixed {
    process: &'static str,
    name: &'static str,
    unit: &'static str,
    range: [f64; 2],
    file: &'static str,
    about: &'static str,
    get: fn(&Setup) -> Option<f64>,
}

/// A row of the table below: process, file, name, unit, range, where it stands, meaning.
macro_rules! fixed {
    ($process:literal, $file:literal, $name:literal, $unit:literal, $range:expr, $get:expr, $about:literal) => {
        Fixed {
            process: $process,
            name: $name,
            unit: $unit,
            range: $range,
            file: $file,
            about: $about,
            get: $get,
        }
    };
}

#[rustfmt::skip]
const FIXED: &[Fixed] = &[
    fixed!("watchdog", "system.toml", "watchdog_missed", "cycles", [1.0, 1e3], |s| Some(s.system.watchdog_missed.into()), "own cycles without a reset until the motor supply is cut"),
    fixed!("watchdog", "system.toml", "toggle_missed", "cycles", [1.0, 1e3], |s| Some(s.system.toggle_missed.into()), "own cycles missed after which the supply's relay has fallen"),
    fixed!("watchdog", "system.toml", "emergency_stop.priority", "", [0.0, 98.0], |s| Some(s.system.emergency_stop.priority.into()), "SCHED_FIFO priority of the thread that listens for the emergency stop"),
    fixed!("sim-backend", "scenes", "depth", "", [1.0, 5.0], |s| Some(s.scene.depth.into()), "modelling depth of the simulated robot"),
    fixed!("sim-backend", "scenes", "substeps", "", [1.0, 1e3], |s| Some(s.scene.substeps.into()), "integration steps per bus cycle"),
    fixed!("sim-backend", "scenes", "duration", "s", [0.0, 1e9], |s| Some(s.scene.duration), "length of the scene"),
    fixed!("sim-backend", "system.toml", "toggle_missed", "cycles", [1.0, 1e3], |s| Some(s.system.toggle_missed.into()), "cycles without a move of the watchdog's toggle until the supply's relay falls"),
    fixed!("lowlevel", "scenes", "cycle", "s", [1e-4, 0.02], |s| Some(s.scene.cycle), "bus cycle, the clock of all processes"),
    fixed!("lowlevel", "system.toml", "targets_missed", "cycles", [1.0, 1e3], |s| Some(s.system.targets_missed.into()), "cycles without new joint targets until the controlled stop"),
    fixed!("lowlevel", "system.toml", "overrun_bucket", "", [1.0, 1e5], |s| Some(s.system.overrun_bucket.into()), "overruns, less one per good cycle, until the controlled stop"),
    fixed!("lowlevel", "system.toml", "following_error", "rad", [0.0, f64::MAX], |s| Some(s.system.following_error), "following error at rest that trips the motor supply"),
    fixed!("lowlevel", "system.toml", "following_time", "s", [0.0, f64::MAX], |s| Some(s.system.following_time), "following error on top, per joint speed"),
    fixed!("lowlevel", "system.toml", "bus.carried_on", "cycles", [0.0, 100.0], |s| Some(s.system.bus.carried_on.into()), "cycles without a node's frames in which its joints are taken to move on"),
    fixed!("lowlevel", "system.toml", "bus.missed", "cycles", [1.0, 1e3], |s| Some(s.system.bus.missed.into()), "cycles without a node's frames until the controlled stop"),
    fixed!("lowlevel", "system.toml", "bus.jump", "rad", [1e-3, 1.0], |s| Some(s.system.bus.jump), "jump of a joint angle that is no reading"),
    fixed!("lowlevel", "system.toml", "bus.jump_speed", "", [1.0, 100.0], |s| Some(s.system.bus.jump_speed), "jump on top, per speed limit and time since the last reading"),
    fixed!("lowlevel", "system.toml", "bus.jump_force", "", [0.1, 100.0], |s| Some(s.system.bus.jump_force), "jump of a component of a foot's force alone that is no reading, over the robot's weight"),
    fixed!("planner", "gaits", "step.width", "m", [1e-9, 1e9], |s| Some(s.gait.step.width), "lateral distance of the sole frames W_step"),
    fixed!("planner", "gaits", "step.double_support", "", [0.02, 0.9], |s| Some(s.gait.step.double_support), "share of a step that is double support"),
    fixed!("planner", "gaits", "step.first_length", "m", [1e-9, 1e9], |s| Some(s.gait.step.first_length), "longest first and last step"),
    fixed!("planner", "gaits", "model.com_height", "m", [0.1, 3.0], |s| Some(s.gait.model.com_height), "height of the centre of gravity while walking"),
    fixed!("planner", "gaits", "model.zmp_margin", "m", [0.0, 0.2], |s| Some(s.gait.model.zmp_margin), "distance of the planned zero-moment point from the edge of support"),
    fixed!("planner", "gaits", "model.friction", "", [0.0, f64::MAX], |s| Some(s.gait.model.friction), "most friction a plan may ask of the ground"),
    fixed!("planner", "gaits", "limits.length.least", "m", [-1.5, 1.5], |s| Some(s.gait.limits.length[0]), "least step length that may be commanded"),
    fixed!("planner", "gaits", "limits.length.most", "m", [-1.5, 1.5], |s| Some(s.gait.limits.length[1]), "greatest step length that may be commanded"),
    fixed!("planner", "gaits", "limits.duration.least", "s", [0.2, 20.0], |s| Some(s.gait.limits.duration[0]), "least duration of a step that may be commanded"),
    fixed!("planner", "gaits", "limits.duration.most", "s", [0.2, 20.0], |s| Some(s.gait.limits.duration[1]), "greatest duration of a step that may be commanded"),
    fixed!("planner", "gaits", "pattern.T_c", "s", [0.0, 20.0], |s| s.gait.pattern.map(|p| p.step_time), "time of a step"),
    fixed!("planner", "gaits", "pattern.T_d", "s", [0.0, 20.0], |s| s.gait.pattern.map(|p| p.double_support), "double support"),
    fixed!("planner", "gaits", "pattern.T_o", "s", [0.0, 20.0], |s| s.gait.pattern.map(|p| p.over_time), "instant at which the swinging ankle passes l_ao, H_ao"),
    fixed!("planner", "gaits", "pattern.T_min", "s", [0.0, 20.0], |s| s.gait.pattern.map(|p| p.low_time), "instant at which the torso is lowest"),
    fixed!("planner", "gaits", "pattern.T_max", "s", [0.0, 20.0], |s| s.gait.pattern.map(|p| p.high_time), "instant at which it is highest"),
    fixed!("planner", "gaits", "pattern.T_1", "s", [0.0, 20.0], |s| s.gait.pattern.map(|p| p.pitch_times[0]), "the rear foot begins to pitch"),
    fixed!("planner", "gaits", "pattern.T_2", "s", [0.0, 20.0], |s| s.gait.pattern.map(|p| p.pitch_times[1]), "the swinging foot has its landing angle"),
    fixed!("planner", "gaits", "pattern.T_3", "s", [0.0, 40.0], |s| s.gait.pattern.map(|p| p.pitch_times[2]), "the front foot lies flat"),
    fixed!("planner", "gaits", "pattern.D_s", "m", [0.0, 1.5], |s| s.gait.pattern.map(|p| p.length), "step length"),
    fixed!("planner", "gaits", "pattern.l_ao", "m", [0.0, 1.5], |s| s.gait.pattern.map(|p| p.over_length), "way of the swinging ankle up to T_o"),
    fixed!("planner", "gaits", "pattern.H_ao", "m", [0.0, 1.5], |s| s.gait.pattern.map(|p| p.over_height), "height of the ankle then"),
    fixed!("planner", "gaits", "pattern.q_b", "rad", [0.0, 0.8], |s| s.gait.pattern.map(|p| p.leave), "pitch, toes down, with which a foot leaves the ground"),
    fixed!("planner", "gaits", "pattern.q_f", "rad", [0.0, 0.8], |s| s.gait.pattern.map(|p| p.land), "pitch, toes up, with which it lands"),
    fixed!("planner", "gaits", "pattern.w_s", "m", [0.0, 1.0], |s| s.gait.pattern.map(|p| p.width), "distance of the feet from side to side"),
    fixed!("planner", "gaits", "pattern.w_p", "m", [0.0, 1.0], |s| s.gait.pattern.map(|p| p.pass), "how far the swinging foot moves outwards in passing"),
    fixed!("planner", "gaits", "pattern.w_m", "m", [-0.5, 0.5], |s| s.gait.pattern.map(|p| p.shift), "how far the torso stands outside of the stance foot"),
    fixed!("planner", "gaits", "pattern.x_ed", "m", [-0.5, 0.5], |s| s.gait.pattern.map(|p| p.end_ahead), "torso in front of the stance ankle at the end of single support"),
    fixed!("planner", "gaits", "pattern.x_sd", "m", [-0.5, 0.5], |s| s.gait.pattern.map(|p| p.start_behind), "torso behind it at the begin of single support"),
    fixed!("planner", "gaits", "pattern.H_min", "m", [0.0, 3.0], |s| s.gait.pattern.map(|p| p.heights[0]), "least height of the torso"),
    fixed!("planner", "gaits", "pattern.H_max", "m", [0.0, 3.0], |s| s.gait.pattern.map(|p| p.heights[1]), "greatest height of the torso"),
    fixed!("planner", "gaits", "pattern.N", "", [2.0, 1024.0], |s| s.gait.pattern.map(|p| p.points as f64), "points of a stride in the tables of the drives"),
    fixed!("planner", "gaits", "obstacles.height", "m", [0.0, 0.5], |s| s.gait.obstacles.map(|o| o.height), "highest obstacle or platform"),
    fixed!("controller", "gaits", "feedback", "", [1.0, 2.0], |s| Some(s.gait.control.feedback as f64), "feedback path of figure 5.8"),
];

/// All parameters of this configuration, by process.
pub fn entries(setup: &Setup) -> Vec<ParameterEntry> {
    // A pattern is checked as a whole, when it is loaded; nothing of it changes while it is walked.
    let mut all = Vec::new();
    if setup.gait.pattern.is_none() {
        all.extend(live("planner", PLANNER, &setup.gait.step));
        all.extend(live("controller", STABILIZER, &setup.gait.control));
    }
    all.extend(FIXED.iter().filter_map(|row| {
        let &Fixed { process, name, unit, range, file, about, get } = row;
        // Keys that a gait with a pattern has not.
        if file == "gaits" && setup.gait.pattern.is_some() && !name.starts_with("pattern.") {
            return None;
        }
        let change = Change::File(file);
        Some(ParameterEntry { process, name: name.into(), unit, range, default: get(setup)?, about, change })
    }));
    for row in &setup.system.processes {
        let mut fixed = |name: &str, unit, range, default, about| {
            let (process, change) = (row.process.name(), Change::File("system.toml"));
            all.push(ParameterEntry { process, name: name.into(), unit, range, default, about, change });
        };
        fixed(
            "priority",
            "",
            [0.0, 98.0],
            row.priority.into(),
            "SCHED_FIFO priority; 0: the ordinary scheduler",
        );
        fixed(
            "deadline",
            "s",
            [0.0, 1.0],
            row.deadline_ns as f64 / 1e9,
            "end of its answer in a cycle; 0: none",
        );
        if let Some(core) = row.core {
            fixed("core", "", [0.0, 1023.0], core as f64, "core that it is bound to");
        }
        fixed(
            "peer_timeout",
            "s",
            [0.0, f64::MAX],
            setup.system.peer_timeout,
            "wait for a missing peer before it is named",
        );
    }
    all.sort_by_key(|entry| entry.process);
    all
}

fn live<T>(process: &'static str, table: &[Parameter<T>], of: &T) -> Vec<ParameterEntry> {
    let entry = |(number, p): (usize, &Parameter<T>)| ParameterEntry {
        process,
        name: p.name.into(),
        unit: p.unit,
        range: p.range,
        default: p.get(of),
        about: p.about,
        change: Change::Live(number as u32),
    };
    table.iter().enumerate().map(entry).collect()
}

/// The parameter of that name: `process.name`, or the name alone for one of the stabilizer.
///
/// # Errors
/// There is none; the text names those that are near.
pub fn find<'a>(entries: &'a [ParameterEntry], name: &str) -> Result<&'a ParameterEntry, String> {
    let full = entries.iter().find(|e| e.full_name() == name);
    let short = || entries.iter().find(|e| e.process == "controller" && e.name == name);
    full.or_else(short).ok_or_else(|| {
        let names: Vec<String> = entries.iter().map(ParameterEntry::full_name).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        messages::unknown("parameter", name, &names, "`gangwerk param list` shows them all")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shipped_configuration_has_each_parameter_once_and_in_its_range() {
        let root = crate::root(None);
        for file in std::fs::read_dir(root.join("scenes")).unwrap() {
            let name = file.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned();
            let entries = entries(&Setup::load(&root, &name).unwrap());
            let mut names: Vec<_> = entries.iter().map(ParameterEntry::full_name).collect();
            // A pattern is played by a controller that has nothing to set.
            let plays = Setup::load(&root, &name).unwrap().gait.pattern.is_some();
            let all = messages::Process::ALL.map(messages::Process::name);
            for process in all.into_iter().filter(|name| !(plays && *name == "controller")) {
                assert!(entries.iter().any(|e| e.process == process), "{process} has none");
            }
            for e in &entries {
                let good = e.default >= e.range[0] && e.default <= e.range[1];
                assert!(good && !e.about.is_empty(), "{name}: {e:?}");
            }
            names.sort();
            names.dedup();
            assert_eq!(names.len(), entries.len(), "{name}: a name stands for two parameters");
        }
    }

    #[test]
    fn a_pattern_has_its_own_parameters_and_none_that_can_be_changed() {
        let entries = entries(&Setup::load(&crate::root(None), "archie_static").unwrap());
        assert_eq!(entries.iter().filter(|e| matches!(e.change, Change::Live(_))).count(), 0);
        let refused = find(&entries, "planner.pattern.w_m").unwrap().command(0.03).unwrap_err();
        assert_eq!(refused, "planner.pattern.w_m is fixed at start: change it in config/gaits");
        assert!(
            find(&entries, "planner.swing_height").is_err() && find(&entries, "planner.step.width").is_err()
        );
    }

    #[test]
    fn a_fixed_parameter_is_refused_with_the_file_and_a_live_one_becomes_the_command_of_its_process() {
        let entries = entries(&Setup::load(&crate::root(None), "walk_1kmh").unwrap());
        let command = |name: &str, value| find(&entries, name).unwrap().command(value);
        let refused = command("watchdog.watchdog_missed", 3.0).unwrap_err();
        assert_eq!(refused, "watchdog.watchdog_missed is fixed at start: change it in config/system.toml");
        let walk = Command::WalkParameter(ParameterCommand { number: 0, value: 0.07 });
        assert_eq!(command("planner.swing_height", 0.07), Ok(walk));
        let gain = Command::Parameter(ParameterCommand { number: 4, value: 1e4 });
        assert_eq!((command("controller.height_p", 1e4), command("height_p", 1e4)), (Ok(gain), Ok(gain)));
        for bad in [f64::NAN, f64::INFINITY, -0.01, 0.16] {
            let refused = command("planner.swing_height", bad).unwrap_err();
            assert!(refused.contains("outside of [0, 0.15] m"), "{refused}");
        }
        // Regression: three hundred digits.
        let refused = command("planner.swing_height", -1e300).unwrap_err();
        assert!(refused.starts_with("planner.swing_height = -1e300 is outside of "), "{refused}");
        let none = find(&entries, "swing").unwrap_err();
        assert!(none.contains("did you mean planner.swing_height?"), "{none}");
    }
}
