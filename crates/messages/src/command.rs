//! Commands of an operator: messages of the command plane (design: thesis 7.4).
//!
//! A message is (domain, id, priority, payload). The broker forwards whole domains to the processes that
//! subscribed to them. [`COMMANDS`](crate::command_text::COMMANDS) lists all
//! commands with their fields and ranges; [`Command::check`] holds a command against it.

use serde::{Deserialize, Serialize};

/// Groups of messages; a process subscribes to whole domains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[repr(u16)]
pub enum Domain {
    /// Emergency stop, reset, enable, end.
    System = 0,
    /// Walking commands.
    Walk = 1,
    /// Parameters of the stabilizer.
    Stabilize = 2,
    /// Parameters of the joint loop.
    Joint = 3,
    /// Camera head.
    Head = 4,
    /// Logging.
    Log = 5,
    /// The simulated robot.
    Sim = 6,
    /// Vision.
    Vision = 7,
}

impl Domain {
    /// All domains.
    pub const ALL: [Self; 8] = [
        Self::System,
        Self::Walk,
        Self::Stabilize,
        Self::Joint,
        Self::Head,
        Self::Log,
        Self::Sim,
        Self::Vision,
    ];

    /// The name used in `gangwerk topic`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::System => "system",
            Self::Walk => "walk",
            Self::Stabilize => "stabilize",
            Self::Joint => "joint",
            Self::Head => "head",
            Self::Log => "log",
            Self::Sim => "sim",
            Self::Vision => "vision",
        }
    }
}

impl TryFrom<u16> for Domain {
    type Error = u16;

    fn try_from(n: u16) -> Result<Self, u16> {
        Self::ALL.get(usize::from(n)).copied().ok_or(n)
    }
}

/// Priority of a message: higher ones pass lower ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[repr(u8)]
pub enum Priority {
    /// Emergency stop.
    High = 0,
    /// Commands.
    Normal = 1,
    /// Everything that can wait.
    Low = 2,
}

impl Priority {
    /// All classes, the most urgent first.
    pub const ALL: [Self; 3] = [Self::High, Self::Normal, Self::Low];
}

impl TryFrom<u8> for Priority {
    type Error = u8;

    fn try_from(n: u8) -> Result<Self, u8> {
        Self::ALL.get(usize::from(n)).copied().ok_or(n)
    }
}

/// Everything an operator may ask for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Command {
    /// `system/emergency_stop`: motor supply off, latched.
    EmergencyStop,
    /// `system/reset`: first edge after a power-off: forget the reason.
    Reset,
    /// `system/enable`: second edge: motor supply on.
    Enable,
    /// `system/end`: stop walking, stand, end all processes.
    End,
    /// `walk/stand`: go from any standing pose to the walking pose.
    Stand,
    /// `walk/start`: walk with the present step parameters.
    Start,
    /// `walk/stop`: stop walking and stand.
    Stop,
    /// `walk/step`: step parameters from the next step on.
    Step(StepCommand),
    /// `walk/velocity`: walk with this velocity; zero is a stop.
    Velocity(VelocityCommand),
    /// `sim/push`: push the simulated robot now.
    Push(PushCommand),
    /// `stabilize/parameter`: give a parameter of the stabilizer another value, from the next cycle on.
    Parameter(ParameterCommand),
    /// `head/fixate`: look at a point from now on, whatever the robot does.
    Fixate(FixateCommand),
    /// `head/joints`: move the camera head to these angles.
    HeadJoints(HeadJointsCommand),
    /// `head/rest`: move the camera head to its comfortable angles.
    HeadRest,
    /// `walk/distance`: walk a distance, from standing to standing.
    Distance(DistanceCommand),
    /// `walk/platform`: climb onto a platform, or off it.
    Platform(PlatformCommand),
    /// `joint/home`: joints that do not know their angles find them out.
    Home,
    /// `joint/zero_force`: the force sensors of the hanging robot read zero from now on.
    ZeroForce,
    /// `sim/lower`: lower the simulated robot on its crane.
    Lower(LowerCommand),
    /// `walk/parameter`: give a parameter of the planner another value, from the next step that is planned.
    WalkParameter(ParameterCommand),
    /// `vision/box`: an upright box is known from now on; the same id again moves it.
    Box(BoxCommand),
    /// `vision/gone`: a box is not there any more.
    Gone(GoneCommand),
}

/// Step parameters (thesis table 4.1).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StepCommand {
    /// \[m\] Step length forward L_x.
    pub length: f64,
    /// \[m\] Step length to the left L_y, per step.
    #[serde(default)]
    pub side: f64,
    /// \[rad\] Turn to the left per step.
    #[serde(default)]
    pub turn: f64,
    /// \[s\] Duration of a step.
    pub duration: f64,
}

/// A velocity of the robot in its own frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VelocityCommand {
    /// \[m/s\] forward
    #[serde(default)]
    pub forward: f64,
    /// \[m/s\] to the left
    #[serde(default)]
    pub left: f64,
    /// \[rad/s\] to the left
    #[serde(default)]
    pub turn: f64,
}

/// A distance to walk (thesis 4.3.4).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DistanceCommand {
    /// \[m\] Distance; backwards if negative.
    pub distance: f64,
    /// \[m/s\] Largest speed.
    pub speed: f64,
    /// \[m/s^2\] Largest acceleration, from step to step.
    pub acceleration: f64,
}

/// A platform to climb onto or off (thesis 4.3.4).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlatformCommand {
    /// \[m\] Distance of its edge ahead of the middle of the sole frames.
    pub distance: f64,
    /// \[m\] Height of the ground behind the edge; lower if negative.
    pub height: f64,
}

/// A way of the crane that holds the simulated robot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LowerCommand {
    /// \[m\] Downwards; upwards if negative.
    pub distance: f64,
}

/// A push at the torso's centre of gravity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PushCommand {
    /// \[N\] @world
    pub force: [f64; 3],
    /// \[s\]
    pub duration: f64,
}

/// Another value for a parameter; `gangwerk param` knows them by name.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ParameterCommand {
    /// \[1\] Its number in the table of parameters.
    pub number: u32,
    /// In the parameter's unit and range.
    pub value: f64,
}

/// A point to look at.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FixateCommand {
    /// \[m\] @I_0
    pub point: [f64; 3],
}

/// Angles of the camera head.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeadJointsCommand {
    /// \[rad\] to the left
    #[serde(default)]
    pub pan: f64,
    /// \[rad\] upwards
    #[serde(default)]
    pub tilt: f64,
}

/// An upright box that the robot steps over or stops before, until its lifetime is over.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoxCommand {
    /// \[1\] Its number, 1 to [`MAX_BOXES`].
    pub id: u32,
    /// \[m\] @I_0 Middle of its base.
    pub base: [f64; 3],
    /// \[rad\] @I_0 Turn about the vertical.
    pub yaw: f64,
    /// \[m\] Length, width, height: along its own x, y, z.
    pub size: [f64; 3],
    /// \[s\] Time after which it is gone, unless it is told again.
    pub lifetime: f64,
}

/// Most boxes that are known at once; each id is the place of one.
pub const MAX_BOXES: usize = 32;

/// A box that is not there any more.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GoneCommand {
    /// \[1\] Its number.
    pub id: u32,
}

impl Command {
    /// Domain and id of the message that carries this command.
    pub const fn address(&self) -> (Domain, u16) {
        match self {
            Self::EmergencyStop => (Domain::System, 0),
            Self::Reset => (Domain::System, 1),
            Self::Enable => (Domain::System, 2),
            Self::End => (Domain::System, 3),
            Self::Stand => (Domain::Walk, 0),
            Self::Start => (Domain::Walk, 1),
            Self::Stop => (Domain::Walk, 2),
            Self::Step(_) => (Domain::Walk, 3),
            Self::Velocity(_) => (Domain::Walk, 4),
            Self::Distance(_) => (Domain::Walk, 5),
            Self::Platform(_) => (Domain::Walk, 6),
            Self::WalkParameter(_) => (Domain::Walk, 7),
            Self::Home => (Domain::Joint, 0),
            Self::ZeroForce => (Domain::Joint, 1),
            Self::Push(_) => (Domain::Sim, 0),
            Self::Lower(_) => (Domain::Sim, 1),
            Self::Parameter(_) => (Domain::Stabilize, 0),
            Self::Fixate(_) => (Domain::Head, 0),
            Self::HeadJoints(_) => (Domain::Head, 1),
            Self::HeadRest => (Domain::Head, 2),
            Self::Box(_) => (Domain::Vision, 0),
            Self::Gone(_) => (Domain::Vision, 1),
        }
    }

    /// Priority of the command.
    pub const fn priority(&self) -> Priority {
        match self {
            Self::EmergencyStop => Priority::High,
            _ => Priority::Normal,
        }
    }

    /// Whether nothing refuses it: neither age nor sequence, neither lease nor rights. It can only bring the robot to rest.
    pub const fn always_passes(&self) -> bool {
        matches!(self, Self::EmergencyStop | Self::Stop | Self::End)
    }

    /// Whether its sender must hold the command lease: whatever moves the robot or changes how it moves. A push disturbs
    /// the simulated robot and is no command to it; boxes move nothing, and who sees them need not be who steers.
    pub const fn needs_lease(&self) -> bool {
        !self.always_passes() && !matches!(self, Self::Push(_) | Self::Box(_) | Self::Gone(_))
    }

    /// Whether it goes on until somebody stops it, so that its sender must stay.
    pub fn is_unbounded(&self) -> bool {
        match self {
            Self::Start => true,
            Self::Velocity(v) => [v.forward, v.left, v.turn] != [0.0; 3],
            _ => false,
        }
    }

    /// Name of the process that has the last word and answers it.
    pub const fn decided_by(&self) -> &'static str {
        match self {
            Self::EmergencyStop | Self::Reset | Self::Enable => "watchdog",
            Self::End => "supervisor",
            Self::Stand
            | Self::Start
            | Self::Stop
            | Self::Step(_)
            | Self::Velocity(_)
            | Self::Distance(_)
            | Self::Platform(_)
            | Self::WalkParameter(_)
            | Self::Box(_)
            | Self::Gone(_) => "planner",
            Self::Parameter(_) | Self::Fixate(_) | Self::HeadJoints(_) | Self::HeadRest => "controller",
            Self::Home | Self::ZeroForce => "lowlevel",
            Self::Push(_) | Self::Lower(_) => "sim-backend",
        }
    }

    /// The name used in `gangwerk topic`, e.g. `walk/velocity`.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::EmergencyStop => "system/emergency_stop",
            Self::Reset => "system/reset",
            Self::Enable => "system/enable",
            Self::End => "system/end",
            Self::Stand => "walk/stand",
            Self::Start => "walk/start",
            Self::Stop => "walk/stop",
            Self::Step(_) => "walk/step",
            Self::Velocity(_) => "walk/velocity",
            Self::Distance(_) => "walk/distance",
            Self::Platform(_) => "walk/platform",
            Self::WalkParameter(_) => "walk/parameter",
            Self::Home => "joint/home",
            Self::ZeroForce => "joint/zero_force",
            Self::Push(_) => "sim/push",
            Self::Lower(_) => "sim/lower",
            Self::Parameter(_) => "stabilize/parameter",
            Self::Fixate(_) => "head/fixate",
            Self::HeadJoints(_) => "head/joints",
            Self::HeadRest => "head/rest",
            Self::Box(_) => "vision/box",
            Self::Gone(_) => "vision/gone",
        }
    }
}
