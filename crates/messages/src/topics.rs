//! The table of topics: the whole data plane on one page.

use crate::command::Domain;
use crate::hash::{FNV1A, fnv1a};
use crate::record::Record;
use crate::{
    BusFrames, CommandTaken, ControllerState, CycleInputs, CycleStats, Event, JointTables, JointTargets,
    Parameters, Plan, Power, Sensors, SimState, WatchdogReset,
};

/// The processes of a running robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Process {
    /// Forwards commands between processes and over TCP.
    Broker,
    /// Cuts motor power.
    Watchdog,
    /// The simulated robot at the far end of the bus.
    SimBackend,
    /// Joint targets to the field bus, sensor data from it; the clock.
    Lowlevel,
    /// Commands to plans.
    Planner,
    /// Plan and sensors to joint targets.
    Controller,
    /// Topics to log files.
    Logger,
    /// Command line, dashboards, tests: readers that come and go.
    Observer,
}

impl Process {
    /// All processes, in the order in which the shipped `config/system.toml` has them started: the logger before those
    /// whose first cycle it is to have, the clock last.
    pub const ALL: [Self; 7] = [
        Self::Broker,
        Self::Logger,
        Self::Watchdog,
        Self::SimBackend,
        Self::Planner,
        Self::Controller,
        Self::Lowlevel,
    ];

    /// The name of the process's folder, command and topics.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Broker => "broker",
            Self::Watchdog => "watchdog",
            Self::SimBackend => "sim-backend",
            Self::Lowlevel => "lowlevel",
            Self::Planner => "planner",
            Self::Controller => "controller",
            Self::Logger => "logger",
            Self::Observer => "observer",
        }
    }

    /// Domains of the commands that the process takes: what the broker forwards to it, and what it takes of a scene.
    pub const fn command_domains(self) -> &'static [Domain] {
        match self {
            Self::Watchdog => &[Domain::System],
            Self::SimBackend => &[Domain::Sim],
            Self::Lowlevel => &[Domain::System, Domain::Joint],
            Self::Planner => &[Domain::Walk, Domain::Vision],
            Self::Controller => &[Domain::Stabilize, Domain::Head],
            Self::Broker | Self::Logger | Self::Observer => &[],
        }
    }
}

/// One row of the table.
#[derive(Clone, Copy, Debug)]
pub struct Topic {
    /// Name of the topic.
    pub name: &'static str,
    /// Content in one sentence.
    pub about: &'static str,
    /// Name of the record type.
    pub type_name: &'static str,
    /// The only process that writes it.
    pub writer: Process,
    /// Processes in the chain that read it, besides logger and observers, which may read everything.
    pub readers: &'static [Process],
    /// Processes that sleep until the topic is written.
    pub wakes: &'static [Process],
    /// Records per second in normal operation; 0: when there is something to say.
    pub rate_hz: u32,
    /// Age in bus cycles from which a reader treats the newest record as missing; 0: never.
    pub stale_after: u32,
    /// Records kept in shared memory: how far a slow logger may fall behind without losing any.
    pub depth: usize,
    /// Whether it goes into the log.
    pub logged: bool,
}

use Process::{Broker, Controller, Logger, Lowlevel, Planner, SimBackend, Watchdog};

macro_rules! topics {
    ($($(#[doc = $about:literal])+ $name:ident: $type:ident = $topic:literal, $writer:ident -> [$($reader:ident),*],
        wakes [$($wake:ident),*], $rate:literal Hz, stale $stale:literal, depth $depth:literal, logged $logged:literal;)*) => {
        $($(#[doc = $about])+ pub const $name: Topic = Topic {
            name: $topic, about: concat!($($about),+), type_name: stringify!($type), writer: $writer, readers: &[$($reader),*],
            wakes: &[$($wake),*], rate_hz: $rate, stale_after: $stale, depth: $depth, logged: $logged,
        };)*

        /// Every topic.
        pub const TOPICS: &[Topic] = &[$($name),*];

        /// Calls `f` with the type of the topic: how code that is generic over records gets from a row of the table
        /// to a Rust type. `None` if no such topic.
        pub fn with_type<R>(topic: &str, f: impl ForType<R>) -> Option<R> {
            $(if topic == $topic { return Some(f.call::<$type>(&$name)); })*
            let _ = f;
            None
        }
    };
}

/// A computation that needs a topic's record type. See [`with_type`].
pub trait ForType<R> {
    /// Called with the record type of `topic`.
    fn call<T: Record>(self, topic: &'static Topic) -> R;
}

topics! {
    /// Measured state of the robot.
    SENSORS: Sensors = "sensors", Lowlevel -> [Controller, Planner], wakes [Planner, Controller],
        1000 Hz, stale 5, depth 256, logged true;
    /// Trajectories to the end of the horizon.
    PLAN: Plan = "plan", Planner -> [Controller], wakes [],
        0 Hz, stale 0, depth 8, logged true;
    /// Heartbeat of the planner; in lockstep the controller waits for it.
    PLANNER_TICK: Event = "planner_tick", Planner -> [Controller], wakes [Controller],
        1000 Hz, stale 100, depth 4, logged false;
    /// Targets of the joints.
    JOINT_TARGETS: JointTargets = "joint_targets", Controller -> [Lowlevel], wakes [Lowlevel],
        1000 Hz, stale 5, depth 256, logged true;
    /// Points that drives play by themselves.
    JOINT_TABLES: JointTables = "joint_tables", Controller -> [Lowlevel], wakes [],
        0 Hz, stale 0, depth 4, logged true;
    /// State and internal variables of the stabilizer.
    CONTROLLER_STATE: ControllerState = "controller_state", Controller -> [Planner], wakes [],
        1000 Hz, stale 100, depth 256, logged true;
    /// Parameters of the planner.
    PARAMETERS_PLANNER: Parameters = "parameters/planner", Planner -> [], wakes [],
        0 Hz, stale 0, depth 8, logged true;
    /// Parameters of the stabilizer.
    PARAMETERS_CONTROLLER: Parameters = "parameters/controller", Controller -> [], wakes [],
        0 Hz, stale 0, depth 8, logged true;
    /// Heartbeat of the joint loop.
    WATCHDOG_RESET: WatchdogReset = "watchdog_reset", Lowlevel -> [Watchdog], wakes [Watchdog],
        1000 Hz, stale 3, depth 256, logged true;
    /// State of the motor supply.
    POWER: Power = "power", Watchdog -> [SimBackend, Lowlevel], wakes [Lowlevel],
        1000 Hz, stale 3, depth 256, logged true;
    /// Frames to the drives.
    BUS_TX: BusFrames = "bus_tx", Lowlevel -> [SimBackend], wakes [SimBackend],
        1000 Hz, stale 5, depth 64, logged false;
    /// Frames from the drives.
    BUS_RX: BusFrames = "bus_rx", SimBackend -> [Lowlevel], wakes [Lowlevel],
        1000 Hz, stale 5, depth 64, logged false;
    /// Truth about the simulated robot.
    SIM_STATE: SimState = "sim_state", SimBackend -> [], wakes [],
        1000 Hz, stale 0, depth 256, logged true;
    /// Progress of the log; in lockstep the joint loop does not run ahead of it.
    LOG_TICK: Event = "log_tick", Logger -> [Lowlevel], wakes [Lowlevel],
        0 Hz, stale 0, depth 4, logged false;
    /// Frames that the joint loop received, in the cycles in which there were any.
    FRAMES_IN: BusFrames = "frames_in", Lowlevel -> [], wakes [],
        1000 Hz, stale 0, depth 64, logged true;
    /// Frames that it sent.
    FRAMES_OUT: BusFrames = "frames_out", Lowlevel -> [], wakes [],
        1000 Hz, stale 0, depth 64, logged true;
    /// Inputs of each cycle of the watchdog.
    INPUTS_WATCHDOG: CycleInputs = "cycle_inputs/watchdog", Watchdog -> [], wakes [],
        1000 Hz, stale 0, depth 256, logged true;
    /// Inputs of each cycle of the simulated robot.
    INPUTS_SIM_BACKEND: CycleInputs = "cycle_inputs/sim-backend", SimBackend -> [], wakes [],
        1000 Hz, stale 0, depth 256, logged true;
    /// Inputs of each cycle of the joint loop.
    INPUTS_LOWLEVEL: CycleInputs = "cycle_inputs/lowlevel", Lowlevel -> [], wakes [],
        1000 Hz, stale 0, depth 256, logged true;
    /// Inputs of each cycle of the planner.
    INPUTS_PLANNER: CycleInputs = "cycle_inputs/planner", Planner -> [], wakes [],
        1000 Hz, stale 0, depth 256, logged true;
    /// Inputs of each cycle of the stabilizer.
    INPUTS_CONTROLLER: CycleInputs = "cycle_inputs/controller", Controller -> [], wakes [],
        1000 Hz, stale 0, depth 256, logged true;
    /// Commands that the broker refused.
    COMMANDS_BROKER: CommandTaken = "commands/broker", Broker -> [], wakes [],
        0 Hz, stale 0, depth 512, logged true;
    /// Commands that the watchdog took or left out.
    COMMANDS_WATCHDOG: CommandTaken = "commands/watchdog", Watchdog -> [], wakes [],
        0 Hz, stale 0, depth 64, logged true;
    /// Commands that the simulated robot took or left out.
    COMMANDS_SIM_BACKEND: CommandTaken = "commands/sim-backend", SimBackend -> [], wakes [],
        0 Hz, stale 0, depth 64, logged true;
    /// Commands that the joint loop took or left out.
    COMMANDS_LOWLEVEL: CommandTaken = "commands/lowlevel", Lowlevel -> [], wakes [],
        0 Hz, stale 0, depth 64, logged true;
    /// Commands that the planner took or left out.
    COMMANDS_PLANNER: CommandTaken = "commands/planner", Planner -> [], wakes [],
        0 Hz, stale 0, depth 64, logged true;
    /// Commands that the stabilizer took or left out.
    COMMANDS_CONTROLLER: CommandTaken = "commands/controller", Controller -> [], wakes [],
        0 Hz, stale 0, depth 64, logged true;
    /// Cycle statistics of the watchdog.
    STATS_WATCHDOG: CycleStats = "cycle_stats/watchdog", Watchdog -> [], wakes [],
        10 Hz, stale 0, depth 16, logged true;
    /// Cycle statistics of the simulated robot.
    STATS_SIM_BACKEND: CycleStats = "cycle_stats/sim-backend", SimBackend -> [], wakes [],
        10 Hz, stale 0, depth 16, logged true;
    /// Cycle statistics of the joint loop.
    STATS_LOWLEVEL: CycleStats = "cycle_stats/lowlevel", Lowlevel -> [], wakes [],
        10 Hz, stale 0, depth 16, logged true;
    /// Cycle statistics of the planner.
    STATS_PLANNER: CycleStats = "cycle_stats/planner", Planner -> [], wakes [],
        10 Hz, stale 0, depth 16, logged true;
    /// Cycle statistics of the stabilizer.
    STATS_CONTROLLER: CycleStats = "cycle_stats/controller", Controller -> [], wakes [],
        10 Hz, stale 0, depth 16, logged true;
    /// Events of the broker.
    EVENTS_BROKER: Event = "events/broker", Broker -> [], wakes [], 0 Hz, stale 0, depth 64, logged true;
    /// Events of the watchdog.
    EVENTS_WATCHDOG: Event = "events/watchdog", Watchdog -> [], wakes [], 0 Hz, stale 0, depth 64, logged true;
    /// Events of the simulated robot.
    EVENTS_SIM_BACKEND: Event = "events/sim-backend", SimBackend -> [], wakes [], 0 Hz, stale 0, depth 64, logged true;
    /// Events of the joint loop.
    EVENTS_LOWLEVEL: Event = "events/lowlevel", Lowlevel -> [], wakes [], 0 Hz, stale 0, depth 64, logged true;
    /// Events of the planner.
    EVENTS_PLANNER: Event = "events/planner", Planner -> [], wakes [], 0 Hz, stale 0, depth 64, logged true;
    /// Events of the stabilizer.
    EVENTS_CONTROLLER: Event = "events/controller", Controller -> [], wakes [], 0 Hz, stale 0, depth 64, logged true;
    /// Events of the logger, such as losses.
    EVENTS_LOGGER: Event = "events/logger", Logger -> [], wakes [], 0 Hz, stale 0, depth 64, logged true;
}

/// Events of all processes.
pub const EVENTS: [&Topic; 7] = [
    &EVENTS_BROKER,
    &EVENTS_WATCHDOG,
    &EVENTS_LOWLEVEL,
    &EVENTS_PLANNER,
    &EVENTS_CONTROLLER,
    &EVENTS_SIM_BACKEND,
    &EVENTS_LOGGER,
];

impl Topic {
    /// The topic of that name.
    pub fn find(name: &str) -> Option<&'static Topic> {
        TOPICS.iter().find(|t| t.name == name)
    }
}

/// Hash (FNV-1a) of the layout of a record type: two programs may share a topic only if it is equal.
pub fn schema_hash<T: Record>() -> u64 {
    let mut hash = FNV1A;
    let mut eat = |s: &str| hash = fnv1a(hash, s.bytes().chain([0]));
    T::describe(&mut |name, fields| {
        eat(name);
        for (type_name, field) in fields {
            eat(&type_name);
            eat(field);
        }
    });
    hash
}
