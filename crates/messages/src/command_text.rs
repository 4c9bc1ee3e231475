//! The table of commands, and their text form for people: `walk/velocity forward=0.5 turn=-0.1`.
//!
//! One table serves `gangwerk topic list`, the parser and the check of ranges, so that what is listed is what is
//! accepted. Text is `field=number`, separated by blanks or commas, in any order; fields with a default may be left
//! out. Nothing here runs in a control cycle: errors are text and allocate.

use crate::command::{
    BoxCommand, Command, DistanceCommand, Domain, FixateCommand, GoneCommand, HeadJointsCommand,
    LowerCommand, MAX_BOXES, ParameterCommand, PlatformCommand, PushCommand, StepCommand, VelocityCommand,
};
use crate::unknown;

/// One number of a command.
#[derive(Clone, Copy, Debug)]
pub struct FieldInfo {
    /// Name in the text form.
    pub name: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// Least and greatest value accepted.
    pub range: [f64; 2],
    /// Value when it is left out; none: it must be given.
    pub default: Option<f64>,
    /// Meaning.
    pub about: &'static str,
}

/// One command.
#[derive(Clone, Copy, Debug)]
pub struct CommandInfo {
    /// Name of the topic.
    pub name: &'static str,
    /// Task.
    pub about: &'static str,
    /// Its numbers.
    pub fields: &'static [FieldInfo],
    build: fn(&[f64]) -> Command,
}

/// Most numbers in one command.
pub(crate) const MAX_FIELDS: usize = 9;

const fn field(
    name: &'static str,
    unit: &'static str,
    range: [f64; 2],
    default: Option<f64>,
    about: &'static str,
) -> FieldInfo {
    FieldInfo { name, unit, range, default, about }
}

const fn plain(name: &'static str, build: fn(&[f64]) -> Command, about: &'static str) -> CommandInfo {
    CommandInfo { name, about, fields: &[], build }
}

/// Numbers of a command that gives a parameter another value.
const PARAMETER: &[FieldInfo] = &[
    field(
        "number",
        "",
        [0.0, 1e3],
        None,
        "number of the parameter among those of its process that can be changed",
    ),
    field("value", "", [-1e9, 1e9], None, "in the parameter's unit"),
];

/// Number of a box.
const BOX_ID: FieldInfo = field("id", "", [1.0, MAX_BOXES as f64], None, "number of the box");

/// Every command. The ranges are those of any use on any robot; a gait narrows them.
pub const COMMANDS: &[CommandInfo] = &[
    plain("system/emergency_stop", |_| Command::EmergencyStop, "motor supply off, latched"),
    plain("system/reset", |_| Command::Reset, "first edge after a power-off: forget the reason"),
    plain("system/enable", |_| Command::Enable, "second edge: motor supply on"),
    plain("system/end", |_| Command::End, "stop walking, stand, end all processes"),
    plain("walk/stand", |_| Command::Stand, "go from any standing pose to the walking pose"),
    plain("walk/start", |_| Command::Start, "walk with the present step parameters"),
    plain("walk/stop", |_| Command::Stop, "stop walking and stand"),
    CommandInfo {
        name: "walk/step",
        about: "step parameters from the next step on",
        fields: &[
            field("length", "m", [-1.0, 1.0], None, "step length forward"),
            field("side", "m", [-0.5, 0.5], Some(0.0), "step length to the left"),
            field("turn", "rad", [-0.7, 0.7], Some(0.0), "turn to the left per step"),
            field("duration", "s", [0.3, 5.0], None, "duration of a step"),
        ],
        build: |v| Command::Step(StepCommand { length: v[0], side: v[1], turn: v[2], duration: v[3] }),
    },
    CommandInfo {
        name: "walk/velocity",
        about: "walk with this velocity; zero is a stop",
        fields: &[
            field("forward", "m/s", [-2.0, 2.0], Some(0.0), "forward"),
            field("left", "m/s", [-1.0, 1.0], Some(0.0), "to the left"),
            field("turn", "rad/s", [-1.0, 1.0], Some(0.0), "to the left"),
        ],
        build: |v| Command::Velocity(VelocityCommand { forward: v[0], left: v[1], turn: v[2] }),
    },
    CommandInfo {
        name: "walk/distance",
        about: "walk this far, from standing to standing",
        fields: &[
            field("distance", "m", [-100.0, 100.0], None, "forward; backwards if negative"),
            field("speed", "m/s", [0.01, 2.0], None, "largest speed"),
            field("acceleration", "m/s^2", [0.01, 5.0], Some(0.3), "largest acceleration"),
        ],
        build: |v| Command::Distance(DistanceCommand { distance: v[0], speed: v[1], acceleration: v[2] }),
    },
    CommandInfo {
        name: "walk/platform",
        about: "climb onto a platform, or off it",
        fields: &[
            field("distance", "m", [0.0, 10.0], None, "from the middle of the sole frames to its edge"),
            field("height", "m", [-0.5, 0.5], None, "of the ground behind the edge over the one before it"),
        ],
        build: |v| Command::Platform(PlatformCommand { distance: v[0], height: v[1] }),
    },
    CommandInfo {
        name: "walk/parameter",
        about: "give a parameter of the planner another value; gangwerk param does it by name",
        fields: PARAMETER,
        build: |v| Command::WalkParameter(ParameterCommand { number: v[0] as u32, value: v[1] }),
    },
    CommandInfo {
        name: "sim/push",
        about: "push the simulated robot at its torso's centre of gravity",
        fields: &[
            field("force.x", "N", [-5000.0, 5000.0], Some(0.0), "force in the world frame"),
            field("force.y", "N", [-5000.0, 5000.0], Some(0.0), "force in the world frame"),
            field("force.z", "N", [-5000.0, 5000.0], Some(0.0), "force in the world frame"),
            field("duration", "s", [0.0, 10.0], None, "how long"),
        ],
        build: |v| Command::Push(PushCommand { force: [v[0], v[1], v[2]], duration: v[3] }),
    },
    plain("joint/home", |_| Command::Home, "joints that do not know their angles find them out"),
    plain(
        "joint/zero_force",
        |_| Command::ZeroForce,
        "the hanging robot's force sensors read zero from now on",
    ),
    CommandInfo {
        name: "sim/lower",
        about: "lower the simulated robot on its crane",
        fields: &[field("distance", "m", [-2.0, 2.0], None, "downwards; upwards if negative")],
        build: |v| Command::Lower(LowerCommand { distance: v[0] }),
    },
    CommandInfo {
        name: "stabilize/parameter",
        about: "give a parameter of the stabilizer another value; gangwerk param does it by name",
        fields: PARAMETER,
        build: |v| Command::Parameter(ParameterCommand { number: v[0] as u32, value: v[1] }),
    },
    CommandInfo {
        name: "head/fixate",
        about: "look at a point from now on, whatever the robot does",
        fields: &[
            field("x", "m", [-1e3, 1e3], None, "where the robot began: forward"),
            field("y", "m", [-1e3, 1e3], None, "to the left"),
            field("z", "m", [-1e2, 1e2], None, "over the ground"),
        ],
        build: |v| Command::Fixate(FixateCommand { point: [v[0], v[1], v[2]] }),
    },
    CommandInfo {
        name: "head/joints",
        about: "move the camera head to these angles",
        fields: &[
            field("pan", "rad", [-3.2, 3.2], Some(0.0), "to the left"),
            field("tilt", "rad", [-1.6, 1.6], Some(0.0), "upwards"),
        ],
        build: |v| Command::HeadJoints(HeadJointsCommand { pan: v[0], tilt: v[1] }),
    },
    plain("head/rest", |_| Command::HeadRest, "move the camera head to its comfortable angles"),
    CommandInfo {
        name: "vision/box",
        about: "an upright box is known from now on; the same id again moves it",
        fields: &[
            BOX_ID,
            field("x", "m", [-1e3, 1e3], None, "middle of its base, where the robot began: forward"),
            field("y", "m", [-1e3, 1e3], None, "to the left"),
            field("z", "m", [-10.0, 10.0], Some(0.0), "over the ground"),
            field("yaw", "rad", [-6.3, 6.3], Some(0.0), "turn of the box to the left"),
            field("length", "m", [1e-3, 100.0], None, "along its own x axis"),
            field("width", "m", [1e-3, 100.0], None, "along its own y axis"),
            field("height", "m", [1e-3, 10.0], None, "from base to top"),
            field("lifetime", "s", [0.1, 60.0], None, "time after which it is gone, unless it is told again"),
        ],
        build: |v| {
            let (base, size) = ([v[1], v[2], v[3]], [v[5], v[6], v[7]]);
            Command::Box(BoxCommand { id: v[0] as u32, base, yaw: v[4], size, lifetime: v[8] })
        },
    },
    CommandInfo {
        name: "vision/gone",
        about: "a box is not there any more",
        fields: &[BOX_ID],
        build: |v| Command::Gone(GoneCommand { id: v[0] as u32 }),
    },
];

impl CommandInfo {
    /// The command of that name.
    pub fn find(name: &str) -> Option<&'static Self> {
        COMMANDS.iter().find(|c| c.name == name)
    }

    /// The command with all fields at zero, for its address and priority.
    pub fn example(&self) -> Command {
        (self.build)(&[0.0; MAX_FIELDS])
    }

    /// The command with these numbers, one per field, in their ranges.
    ///
    /// # Errors
    /// Too few or too many, or one that is not finite, out of range, or not whole where it must be.
    pub fn command(&self, values: &[f64]) -> Result<Command, String> {
        let (name, fields) = (self.name, self.fields);
        if values.len() != fields.len() {
            return Err(format!("{name}: {} numbers instead of {}", values.len(), fields.len()));
        }
        for (f, x) in fields.iter().zip(values) {
            f.check(name, *x)?; // before a number becomes an integer, which hides NaN
        }
        let command = (self.build)(values);
        let cut = fields.iter().zip(values).zip(command.values()).find(|((_, x), y)| *x != y);
        match cut {
            Some(((f, x), _)) => Err(format!("{name}: {} = {x} must be a whole number", f.name)),
            None => Ok(command),
        }
    }

    /// Names of all fields, for messages.
    fn field_names(&self) -> Vec<&'static str> {
        self.fields.iter().map(|f| f.name).collect()
    }
}

impl FieldInfo {
    /// Numbers of a parameter and of a box are whole.
    pub fn is_whole(&self) -> bool {
        matches!(self.name, "number" | "id")
    }

    /// Refuses what is not a number or out of range. NaN lies in no range.
    fn check(&self, command: &str, x: f64) -> Result<(), String> {
        let Self { name, unit, range: [lo, hi], .. } = *self;
        if x >= lo && x <= hi {
            return Ok(());
        }
        let why = if x.is_finite() { "is outside of" } else { "is not a finite number; it must lie in" };
        Err(format!("{command}: {name} = {} {why} [{lo}, {hi}] {unit}", number_text(x)))
    }
}

/// A number in a sentence; with a power of ten where it would else have hundreds of digits.
pub fn number_text(x: f64) -> String {
    let plain = !x.is_finite() || x == 0.0 || (1e-9..1e12).contains(&x.abs());
    if plain { x.to_string() } else { format!("{x:e}") }
}

impl Command {
    /// The numbers of the command, in the order of its [`CommandInfo::fields`]; the rest are zero.
    fn values(&self) -> [f64; MAX_FIELDS] {
        let four = match *self {
            Self::Step(s) => [s.length, s.side, s.turn, s.duration],
            Self::Velocity(v) => [v.forward, v.left, v.turn, 0.0],
            Self::Distance(d) => [d.distance, d.speed, d.acceleration, 0.0],
            Self::Platform(p) => [p.distance, p.height, 0.0, 0.0],
            Self::Parameter(p) | Self::WalkParameter(p) => [f64::from(p.number), p.value, 0.0, 0.0],
            Self::Fixate(FixateCommand { point: [x, y, z] }) => [x, y, z, 0.0],
            Self::Lower(l) => [l.distance, 0.0, 0.0, 0.0],
            Self::HeadJoints(h) => [h.pan, h.tilt, 0.0, 0.0],
            Self::Push(p) => [p.force[0], p.force[1], p.force[2], p.duration],
            Self::Gone(g) => [f64::from(g.id), 0.0, 0.0, 0.0],
            Self::Box(BoxCommand { id, base: [x, y, z], yaw, size: [length, width, height], lifetime }) => {
                return [f64::from(id), x, y, z, yaw, length, width, height, lifetime];
            }
            _ => [0.0; 4],
        };
        std::array::from_fn(|i| four.get(i).copied().unwrap_or(0.0))
    }

    /// The number of that field of its [`CommandInfo::fields`]; zero if there is none.
    pub fn value(&self, field: usize) -> f64 {
        self.values().get(field).copied().unwrap_or(0.0)
    }

    /// The command with this address and these numbers, whatever they are; none if there is no such command.
    pub(crate) fn of_values(address: (Domain, u16), values: &[f64; MAX_FIELDS]) -> Option<Self> {
        let info = COMMANDS.iter().find(|info| info.example().address() == address)?;
        Some((info.build)(values))
    }

    /// The row of [`COMMANDS`] for this command.
    pub fn info(&self) -> &'static CommandInfo {
        CommandInfo::find(self.name()).expect("every command is in the table")
    }

    /// The first number of the command that is not finite or out of any use, by field name.
    pub fn check(&self) -> Result<(), String> {
        self.info().fields.iter().zip(self.values()).try_for_each(|(f, x)| f.check(self.name(), x))
    }

    /// The command that `name` and `text` describe, e.g. `walk/step` and `length=0.3 duration=0.8`, in its ranges.
    ///
    /// # Errors
    /// An unknown topic or field (with the nearest names), a missing or repeated field, text that is no number, a
    /// number that is not finite or out of range.
    pub fn parse(name: &str, text: &str) -> Result<Self, String> {
        let info = CommandInfo::find(name).ok_or_else(|| {
            let names: Vec<_> = COMMANDS.iter().map(|c| c.name).collect();
            unknown("topic", name, &names, "`gangwerk topic list` shows them all")
        })?;
        // What was written, whatever the order.
        let mut given = [None; MAX_FIELDS];
        for part in text.split([' ', ',', '\t', '\n']).filter(|p| !p.is_empty()) {
            let (index, value) = info.parse_field(part)?;
            if given[index].replace(value).is_some() {
                return Err(format!("{name}: {} is given twice", info.fields[index].name));
            }
        }
        if !info.fields.is_empty() && given.iter().all(Option::is_none) {
            return Err(format!("{name}: give it numbers, for example {}", info.usage()));
        }
        // What was left out.
        let mut values = [0.0; MAX_FIELDS];
        for (i, f) in info.fields.iter().enumerate() {
            values[i] = given[i].or(f.default).ok_or_else(|| {
                format!(
                    "{name}: {} is missing: a number in [{}, {}] {}",
                    f.name, f.range[0], f.range[1], f.unit
                )
            })?;
        }
        info.command(&values[..info.fields.len()])
    }
}

impl CommandInfo {
    /// Index and value of one `field=number`.
    fn parse_field(&self, part: &str) -> Result<(usize, f64), String> {
        let name = self.name;
        if self.fields.is_empty() {
            return Err(format!("{name}: takes no numbers, but got `{part}`"));
        }
        let (field, number) = part.split_once('=').ok_or_else(|| {
            format!("{name}: `{part}` is not of the form field=number, for example {}", self.usage())
        })?;
        let index = (self.fields.iter().position(|f| f.name == field)).ok_or_else(|| {
            let takes = format!("it takes {}", self.usage());
            format!("{name}: {}", unknown("field", field, &self.field_names(), &takes))
        })?;
        let value = number.parse().map_err(|_| {
            let [lo, hi] = self.fields[index].range;
            format!(
                "{name}: {field} = `{number}` is not a number in [{lo}, {hi}] {}",
                self.fields[index].unit
            )
        })?;
        Ok((index, value))
    }

    /// The text form with every field, for help: `length=<m> side=<m>`.
    pub fn usage(&self) -> String {
        let fields: Vec<_> = self.fields.iter().map(|f| format!("{}=<{}>", f.name, f.unit)).collect();
        fields.join(" ")
    }
}
