//! `events/PROCESS`: what happened, for the log.

use crate::{Header, record};

/// What happened. Numbers are part of the log format: append only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u64)]
pub enum EventCode {
    /// Nothing.
    None = 0,
    /// A process armed and began its cycles; detail: 0.
    Started = 1,
    /// A process ended as asked.
    Ended = 2,
    /// Motor supply switched on.
    PowerOn = 3,
    /// Motor supply switched off; detail: the code of the reason.
    PowerOff = 4,
    /// The joint loop did not reset the watchdog in time; detail: cycles missed.
    ResetMissed = 5,
    /// Joint targets are too old; detail: age in cycles.
    TargetsStale = 6,
    /// A target was not finite; detail: joint index.
    TargetNotFinite = 7,
    /// A target left its range, or asked for more speed or acceleration than the joint has, and was held back; detail: joint
    /// index.
    TargetLimited = 8,
    /// A joint did not follow its target; detail: joint index.
    FollowingError = 9,
    /// Bus frames are missing; detail: age in cycles.
    BusSilent = 10,
    /// A cycle overran; detail: periods skipped.
    Overrun = 11,
    /// Too many overruns: controlled stop.
    TooManyOverruns = 12,
    /// The planner fell silent: the running plan is walked to its end.
    PlannerSilent = 13,
    /// A plan was refused; detail: the plan's id.
    PlanRefused = 14,
    /// A command was refused; detail: its message id.
    CommandRefused = 15,
    /// The robot has fallen.
    Fallen = 16,
    /// Both feet are off the ground while they should carry.
    Lifted = 17,
    /// Somebody asked for the emergency stop on its own line; detail: user id << 32 | process id, zeros if unknown.
    EmergencyStop = 18,
    /// The watchdog missed cycles of its own, for so long that the supply's relay fell.
    WatchdogSilent = 19,
    /// Inverse kinematics or force control met a singularity or limit; detail: which.
    ControlLimited = 20,
    /// A controlled stop began; detail: the code of the reason.
    SafeStop = 21,
    /// The controller switched to a plan; detail: its id.
    PlanActive = 22,
    /// Records were overwritten before the logger read them; detail: how many.
    LogDropped = 23,
    /// Messages of the command plane were lost by clients that did not keep up; detail: how many since the last time.
    MessagesLost = 24,
    /// A sensor value is not finite; the last good ones are used, then a stop.
    SensorNotFinite = 25,
    /// A parameter got another value; detail: its number.
    ParameterSet = 26,
    /// A simulated drive left what its model holds for; detail: its number. Its gear and friction stay as they were.
    DriveFault = 27,
    /// Contact forces of the simulated soles were not found to their tolerance; detail: sweeps.
    ContactNotConverged = 28,
    /// An object of the scene cannot do what its schedule says, because the robot touches it; detail: its number.
    ObjectHeld = 29,
    /// An object of the scene goes on with its schedule; detail: its number.
    ObjectResumed = 30,
    /// The simulation lost its numbers: a state is not finite. The robot stays where it was last; detail: the state.
    Diverged = 31,
    /// A simulated sensor left its range; detail: how many numbers.
    SensorClipped = 32,
    /// The adaptive integrator met its bounds, as at dry friction; detail: the state that would not settle. The rest of the
    /// cycle was done in one semi-implicit step.
    IntegratorGaveUp = 33,
    /// A command to the camera head was refused: the robot has none, or the angles or the point are none it can take;
    /// detail: the message's id.
    HeadRefused = 34,
    /// The point to look at is out of reach: the head holds as near as it gets; detail: the joint at the end of its
    /// range, or the number of joints if the point is too near to the cameras.
    GazeHeld = 35,
    /// The point to look at can be looked at again.
    GazeResumed = 36,
    /// The head jumps to where it is to look; detail: how long it will take \[us\].
    Saccade = 37,
    /// No plan from the next step on can be walked as commanded; the active one goes on to its end; detail: its id.
    PlanKept = 38,
    /// Something in the way is higher than the robot steps: it stops before it; detail: height \[mm\].
    ObstacleTooHigh = 39,
    /// Something in the way is longer than a step: the robot stops before it; detail: length \[mm\].
    ObstacleTooLong = 40,
    /// A step would end on something or touch it: the robot stops before it; detail: its height, or how far it would go \[mm\].
    NoFoothold = 41,
    /// A swing foot met the ground early; the next step begins at once. Detail: the plan's id.
    EarlyContact = 42,
    /// Frames are missing in a cycle; told at the first, second, fourth, eighth ... time; detail: the node.
    FramesLost = 43,
    /// A node's frames are missing for so long that its joints are no longer carried on; detail: 1000 times the node plus
    /// the cycles.
    NodeHeld = 44,
    /// The node is heard again; detail: 1000 times the node plus the cycles it was missing.
    NodeBack = 45,
    /// A node's frames are missing for too long; detail: 1000 times the node plus the cycles.
    NodeSilent = 46,
    /// A frame was refused: late, sent twice, of wrong length, unknown; or a reading that cannot be. Told at the first,
    /// second, fourth ... time; detail: a [`Refused`].
    FrameRefused = 47,
    /// Errors on a line: its controller warns; detail: the line.
    BusWarning = 48,
    /// More errors on a line: its controller no longer takes part in the handling of errors; detail: the line.
    BusPassive = 49,
    /// The controller of a line left the bus; detail: the line.
    BusOff = 50,
    /// The controller of a line takes part again; detail: the line.
    BusActive = 51,
    /// A local controller heard no targets for so long that its drives have a fault and bring their joints to rest by
    /// themselves; detail: the node.
    NodeStopped = 52,
    /// The ring of the field bus is open; detail: address of the station before the gap << 16 | of the one behind it; 0: the
    /// master.
    RingBroken = 53,
    /// The ring of the field bus is closed again.
    RingClosed = 54,
    /// A drive has a fault of its own: controlled stop, if none was before; detail: joint index + 65536 times its error code.
    DriveTripped = 55,
    /// A drive was not switched on, or is off while the supply is on: nothing is followed; detail: joint index.
    DriveNotEnabled = 56,
    /// A joint does not know its angle, so no drive is switched on; detail: joint index.
    NotHomed = 57,
    /// All joints know their angles; detail: cycles it took.
    Homed = 58,
    /// The force sensors read zero from now on; detail: what was taken away at most \[N\].
    ForceZeroed = 59,
    /// The force sensors cannot be set to zero: the robot does not hang still with its drives on; detail: load on its
    /// feet \[N\].
    ZeroRefused = 60,
    /// A walking command was refused: the robot does not stand on its feet yet; detail: its message id.
    NotStanding = 61,
    /// A drive that a standing robot can do without has a fault: its joint is held, the robot goes on; detail as of
    /// [`Self::DriveTripped`].
    DriveHeld = 62,
    /// Drives fell out of the operation of the field bus, after a pause of lowlevel: all are started again. That they are
    /// back is told by [`Self::NodeBack`].
    BusRestart = 63,
    /// The supply was measured off while it was to be on: its relay fell, or a fuse or a switch is open.
    SupplyLost = 64,
    /// Who commanded the walk lost the command lease, by death, silence or a closed link: the robot stops. Detail: the
    /// number of the grant.
    LeaseLost = 65,
}

/// Why a frame or a reading was refused, in the detail of [`EventCode::FrameRefused`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refused {
    /// Of an earlier cycle.
    Late = 1,
    /// Came a second time.
    Twice = 2,
    /// Its length is not that of its message.
    Length = 3,
    /// Nobody knows its identifier.
    Unknown = 4,
    /// Its reading is further from the last one than can be.
    Jump = 5,
}

impl EventCode {
    /// All codes, in order of their numbers.
    pub const ALL: [Self; 66] = [
        Self::None,
        Self::Started,
        Self::Ended,
        Self::PowerOn,
        Self::PowerOff,
        Self::ResetMissed,
        Self::TargetsStale,
        Self::TargetNotFinite,
        Self::TargetLimited,
        Self::FollowingError,
        Self::BusSilent,
        Self::Overrun,
        Self::TooManyOverruns,
        Self::PlannerSilent,
        Self::PlanRefused,
        Self::CommandRefused,
        Self::Fallen,
        Self::Lifted,
        Self::EmergencyStop,
        Self::WatchdogSilent,
        Self::ControlLimited,
        Self::SafeStop,
        Self::PlanActive,
        Self::LogDropped,
        Self::MessagesLost,
        Self::SensorNotFinite,
        Self::ParameterSet,
        Self::DriveFault,
        Self::ContactNotConverged,
        Self::ObjectHeld,
        Self::ObjectResumed,
        Self::Diverged,
        Self::SensorClipped,
        Self::IntegratorGaveUp,
        Self::HeadRefused,
        Self::GazeHeld,
        Self::GazeResumed,
        Self::Saccade,
        Self::PlanKept,
        Self::ObstacleTooHigh,
        Self::ObstacleTooLong,
        Self::NoFoothold,
        Self::EarlyContact,
        Self::FramesLost,
        Self::NodeHeld,
        Self::NodeBack,
        Self::NodeSilent,
        Self::FrameRefused,
        Self::BusWarning,
        Self::BusPassive,
        Self::BusOff,
        Self::BusActive,
        Self::NodeStopped,
        Self::RingBroken,
        Self::RingClosed,
        Self::DriveTripped,
        Self::DriveNotEnabled,
        Self::NotHomed,
        Self::Homed,
        Self::ForceZeroed,
        Self::ZeroRefused,
        Self::NotStanding,
        Self::DriveHeld,
        Self::BusRestart,
        Self::SupplyLost,
        Self::LeaseLost,
    ];

    /// The code of a number from a record.
    pub fn from_number(n: u64) -> Option<Self> {
        Self::ALL.get(n as usize).copied()
    }
}

record! {
    /// One thing that happened. Written by the process that saw it.
    record Event {
        /// When.
        header: Header,
        /// \[1\] An [`EventCode`].
        code: u64,
        /// \[1\] See the code.
        detail: u64,
    }
}
