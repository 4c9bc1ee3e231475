//! The running robot as clients of the broker see it: parameters, events, and its state.
//!
//! The broker reads topics as any observer does: no process knows of it or waits for it.

use config::Setup;
use config::registry::{self, Change, ParameterEntry};
use ipc::{IpcError, Reader, Space};
use messages::command_stamp::{LEASE, MAX_AGE};
use messages::topics::{CONTROLLER_STATE, EVENTS, PARAMETERS_CONTROLLER, PARAMETERS_PLANNER, POWER, SENSORS};
use messages::{Command, ControllerState, Event, EventCode, MAX_JOINTS, Parameters, Power, Sensors};

use crate::connection::{RATE, UNANSWERED};
use crate::pending::ANSWER_TIME;
use crate::refusal::Refusal;

/// The newest records; none before the first.
struct NewestRecords<'a> {
    sensors: Option<&'a Sensors>,
    controller: Option<&'a ControllerState>,
    power: Option<&'a Power>,
}

/// Numbers of a STATE: name, unit, how many, meaning, and where the i-th comes from.
type Field = (&'static str, &'static str, usize, &'static str, fn(&NewestRecords<'_>, usize) -> Option<f64>);

#[rustfmt::skip]
const STATE: &[Field] = &[
    ("supply", "", 1, "motor supply: 1 on", |s, _| Some(s.power?.on as f64)),
    ("power_off_reason", "", 1, "code of the event for which it is off", |s, _| Some(s.power?.reason as f64)),
    ("start_up", "", 1, "state of the start-up: 0 off, 1 not homed, 2 homing, 3 enabling, 4 hanging, 5 zeroed, 6 standing, 7 stopped", |s, _| Some(s.sensors?.start_up as f64)),
    ("gait", "", 1, "walking state: 0 idle, 1 standing, 2 starting, 3 walking, 4 stopping", |s, _| Some(s.controller?.gait as f64)),
    ("not_standing", "", 1, "1 while no walking command is taken", |s, _| Some(s.controller?.not_standing as f64)),
    ("age", "cycles", 1, "of the stabilizer's record", |s, _| Some(s.sensors?.header.tick.saturating_sub(s.controller?.header.tick) as f64)),
    ("phase", "", 2, "phases of the feet, right, left", |s, i| Some(s.controller?.phase[i] as f64)),
    ("contact", "", 2, "1: the foot presses on the ground; right, left", |s, i| Some(s.controller?.contact[i] as f64)),
    ("origin", "m,m,rad", 3, "planning frame: x, y, heading in the first one", |s, i| Some(s.controller?.origin[i])),
    ("com", "m", 3, "measured centre of gravity in the planning frame", |s, i| Some(s.controller?.com[i])),
    ("feet", "m,m,m,rad", 8, "measured sole frames in the planning frame: right, left", |s, i| Some(s.controller?.feet[i / 4][i % 4])),
    ("zmp", "m", 2, "measured zero-moment point; NaN: no foot carries", |s, i| Some(s.controller?.zmp[i])),
    ("zmp_desired", "m", 2, "planned zero-moment point", |s, i| Some(s.controller?.zmp_desired[i])),
    ("zmp_margin", "m", 1, "from the measured one to the edge of support", |s, _| Some(s.controller?.zmp_margin)),
    ("inclination_error", "rad", 2, "desired minus measured inclinations of the upper body", |s, i| Some(s.controller?.inclination_error[i])),
    ("orientation", "", 4, "of the torso in the world, quaternion x, y, z, w", |s, i| Some(s.sensors?.imu.orientation[i])),
    ("angular_velocity", "rad/s", 3, "of the torso, in its frame", |s, i| Some(s.sensors?.imu.angular_velocity[i])),
    ("joint_angle", "rad", MAX_JOINTS, "in the order of the robot's joints, then zeros", |s, i| Some(s.sensors?.joint_angle[i])),
];

/// One LINE per number or array of a STATE: `name count unit meaning`, the unit `-` if there is none.
pub fn layout() -> Vec<String> {
    let line = |&(name, unit, count, about, _): &Field| {
        format!("{name} {count} {} {about}", if unit.is_empty() { "-" } else { unit })
    };
    STATE.iter().map(line).collect()
}

/// Parameters of one process that can be changed.
struct Set {
    process: &'static str,
    reader: Reader<Parameters>,
    /// Number of the record that was told last, and its values.
    told: (u64, Parameters),
}

/// Readers of a running robot, and the table of its parameters.
pub struct Observation {
    entries: Vec<ParameterEntry>,
    sensors: Reader<Sensors>,
    controller: Reader<ControllerState>,
    power: Reader<Power>,
    events: Vec<(&'static str, Reader<Event>)>,
    set: [Set; 2],
}

impl Observation {
    /// Of the run in this space.
    ///
    /// # Errors
    /// A topic cannot be read.
    pub fn open(space: &Space, setup: Option<&Setup>) -> Result<Self, IpcError> {
        let set = |process, topic| -> Result<Set, IpcError> {
            Ok(Set { process, reader: space.reader(topic)?, told: (0, Parameters::default()) })
        };
        let mut entries = setup.map_or(Vec::new(), registry::entries);
        entries.extend(own());
        entries.sort_by_key(|e| e.process);
        let mut events = Vec::new();
        for topic in EVENTS {
            let mut reader = space.reader(topic)?;
            reader.refresh(); // nobody is told what was before
            events.push((topic.writer.name(), reader));
        }
        Ok(Self {
            entries,
            sensors: space.reader(&SENSORS)?,
            controller: space.reader(&CONTROLLER_STATE)?,
            power: space.reader(&POWER)?,
            events,
            set: [set("planner", &PARAMETERS_PLANNER)?, set("controller", &PARAMETERS_CONTROLLER)?],
        })
    }

    /// The parameter of that name.
    ///
    /// # Errors
    /// There is none.
    pub fn find(&self, name: &str) -> Result<&ParameterEntry, String> {
        registry::find(&self.entries, name)
    }

    /// Present value of a parameter: what its process says, or the default.
    pub fn value(&mut self, entry: &ParameterEntry) -> f64 {
        let said = self.set.iter_mut().find(|set| set.process == entry.process);
        match (entry.change, said.and_then(|set| set.reader.latest())) {
            (Change::Live(number), Some(record)) => record.values[number as usize],
            _ => entry.default,
        }
    }

    /// All parameters with their values.
    pub fn all(&mut self) -> Vec<(ParameterEntry, f64)> {
        let entries = self.entries.clone();
        entries.into_iter().map(|entry| (entry.clone(), self.value(&entry))).collect()
    }

    /// The same as lines: `process.name unit low high default value change meaning`, the unit `-` if there is none, `change`
    /// one of `live`, `fixed` (in the configuration) and `constant` (of the program).
    pub fn parameters(&mut self) -> Vec<String> {
        let line = |(e, value): (ParameterEntry, f64)| {
            let [low, high] = e.range;
            let unit = if e.unit.is_empty() { "-" } else { e.unit }.replace(' ', "*");
            let change = match e.change {
                Change::Live(_) => "live",
                Change::File(_) => "fixed",
                Change::Constant => "constant",
            };
            let (name, default) = (e.full_name(), e.default);
            format!("{name} {unit} {low:?} {high:?} {default:?} {value:?} {change} {}", e.about)
        };
        self.all().into_iter().map(line).collect()
    }

    /// Those that can be changed, by full name.
    pub(crate) fn values(&mut self) -> Vec<(String, f64)> {
        let live = |(e, value): (ParameterEntry, f64)| {
            matches!(e.change, Change::Live(_)).then(|| (e.full_name(), value))
        };
        self.all().into_iter().filter_map(live).collect()
    }

    /// Those that have been changed since the last call.
    pub fn changed(&mut self) -> Vec<(String, f64)> {
        let mut changed = Vec::new();
        for Set { process, reader, told } in &mut self.set {
            // Somebody who asked for the value may have read the record before.
            reader.refresh();
            let number = reader.number();
            let Some(new) =
                reader.held().filter(|new| number != told.0 || new.header.epoch != told.1.header.epoch)
            else {
                continue;
            };
            for entry in self.entries.iter().filter(|e| e.process == *process && told.1.count > 0) {
                let Change::Live(number) = entry.change else { continue };
                let value = new.values[number as usize];
                if told.1.values[number as usize] != value {
                    changed.push((entry.full_name(), value));
                }
            }
            *told = (number, *new);
        }
        changed
    }

    /// The command that gives a parameter another value.
    pub(crate) fn command(&self, name: &str, value: f64) -> Result<Command, Refusal> {
        let entry = self.find(name).map_err(Refusal::NoParameter)?;
        entry.command(value).map_err(|why| match entry.change {
            Change::Live(_) => Refusal::OutOfRange(why),
            _ => Refusal::NoParameter(why),
        })
    }

    /// The next thing that a process reported, as the payload of an EVENT.
    pub(crate) fn next_event(&mut self) -> Option<Vec<u8>> {
        let (process, event) =
            self.events.iter_mut().find_map(|(process, reader)| Some((*process, *reader.follow()?)))?;
        let mut payload = event.header.tick.to_le_bytes().to_vec();
        payload.extend((event.code as u32).to_le_bytes());
        payload.extend(event.detail.to_le_bytes());
        let name = EventCode::from_number(event.code).unwrap_or(EventCode::None);
        payload.extend(format!("{process} {name:?}").bytes());
        Some(payload)
    }

    /// The payload of a STATE; what nobody has written yet is NaN.
    pub(crate) fn state(&mut self, lost: u64) -> Vec<u8> {
        let seen = NewestRecords {
            sensors: self.sensors.latest(),
            controller: self.controller.latest(),
            power: self.power.latest(),
        };
        let mut payload = seen.sensors.map_or(0, |s| s.header.tick).to_le_bytes().to_vec();
        payload.extend((lost as u32).to_le_bytes());
        for (.., count, _, get) in STATE {
            for i in 0..*count {
                payload.extend((get(&seen, i).unwrap_or(f64::NAN) as f32).to_le_bytes());
            }
        }
        payload
    }
}

/// Limits of the broker itself.
fn own() -> [ParameterEntry; 5] {
    let seconds = |ns: u64| ns as f64 / 1e9;
    [
        ("lease", "s", seconds(LEASE), "command lease after the last heartbeat of its holder"),
        ("max_age", "s", seconds(MAX_AGE), "age from which a command is dropped"),
        ("answer_time", "s", seconds(ANSWER_TIME), "time in which a process must answer a command"),
        ("rate", "1/s", RATE as f64, "frames of one connection that may command"),
        ("unanswered", "", UNANSWERED as f64, "frames of one connection that are not answered yet"),
    ]
    .map(|(name, unit, value, about)| ParameterEntry {
        process: "broker",
        name: name.into(),
        unit,
        range: [value; 2],
        default: value,
        about,
        change: Change::Constant,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_fits_into_a_frame() {
        let numbers: usize = STATE.iter().map(|field| field.2).sum();
        assert!(12 + 4 * numbers <= crate::message::MAX_BYTES - crate::message::HEAD, "{numbers} numbers");
    }
}
