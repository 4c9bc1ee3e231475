//! Details of events: what each kind of event says about its subject, packed into the one number of a record and back.

use crate::event::EventCode;

/// Subject of an event: which joint, which node and for how many cycles, which plan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Detail {
    /// No detail.
    #[default]
    Nothing,
    /// Event that caused this one; [`EventCode::None`] if that is not known.
    Cause(EventCode),
    /// Number of bus cycles.
    Cycles(u64),
    /// Number of things of one kind: records, messages, periods, sweeps.
    Count(u64),
    /// Index in a list of the process: parameter, object, state, simulated drive, line; or the number of a grant.
    Number(u64),
    /// Index in the robot's joint table.
    Joint(usize),
    /// Index of a local controller of the field bus.
    Node(usize),
    /// Index of a local controller, and the cycles in which it was silent; packed, at most 999 of them are kept.
    NodeCycles(usize, u32),
    /// Id of a plan.
    Plan(u64),
    /// Message id of a command.
    Message(u64),
    /// User id and process id of who asked, zeros if unknown.
    Caller {
        /// User id.
        user: u32,
        /// Process id.
        process: u32,
    },
    /// Limit that the stabilizer met.
    Limit(ControlLimit),
    /// Reason for refusing a frame or a reading.
    Frame(RefusedFrame),
    /// Addresses of two stations of a ring; 0: the master.
    Stations(u16, u16),
    /// Joint index and error code of its drive.
    Drive {
        /// Index in the robot's joint table.
        joint: usize,
        /// Error code (CiA 402).
        error: u16,
    },
    /// Joint index, point of its table from 1 or 0, and what is wrong there.
    Table {
        /// Index in the robot's joint table.
        joint: usize,
        /// Number of the point, from 1; 0: the table as a whole.
        point: usize,
        /// What is wrong.
        fault: TableFault,
    },
    /// \[mm\]
    Millimetres(u64),
    /// \[N\]
    Newtons(u64),
    /// \[us\]
    Microseconds(u64),
    /// Steps: their length, side and turn to the left, and duration.
    Steps {
        /// \[mm\] Forward.
        length: i16,
        /// \[mm\] To the left.
        side: i16,
        /// \[mrad\] To the left.
        turn: i16,
        /// \[ms\]
        duration: u16,
    },
}

/// Kind of detail that an event has; the place of the names that the table of events uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum DetailKind {
    Nothing,
    Cause,
    Cycles,
    Count,
    Number,
    Joint,
    Node,
    NodeCycles,
    Plan,
    Message,
    Caller,
    Limit,
    Frame,
    Stations,
    Drive,
    Table,
    Millimetres,
    Newtons,
    Microseconds,
    Steps,
}

/// Reason why tables of points are not played, in the detail of [`EventCode::TablesRefused`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableFault {
    /// Not 2 to 1024 points, not 1 to 256 samples apart, or less than a bus cycle.
    Shape = 1,
    /// Other joints, or other counts.
    Robot = 2,
    /// A point, or the cubic to the next one, leaves the joint's range.
    Range = 3,
    /// Too fast.
    Speed = 4,
    /// More acceleration than the drive has.
    Acceleration = 5,
    /// The joint is elsewhere when it begins.
    Begin = 6,
    /// It begins between two points of the running table.
    BetweenPoints = 7,
    /// It ends in motion.
    End = 8,
    /// No room beside the running table.
    Room = 9,
    /// Not loaded in time, or begun while joints are not led.
    Late = 10,
    /// The drive samples with another period.
    Sampling = 11,
    /// The drive answered something else.
    WrongAnswer = 12,
    /// The drive did not answer.
    NoAnswer = 13,
    /// The drive did not say that it is ready to begin.
    NotArmed = 14,
    /// The drives of this robot, or in this scene, play no tables.
    NoTables = 15,
    /// The drive has started anew, or left the network.
    Restarted = 16,
}

/// Limit of the stabilizer, in the detail of [`EventCode::ControlLimited`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ControlLimit {
    /// The task is nearly singular and damped.
    Task = 1,
    /// A modification of the feet.
    Feet = 2,
    /// Speed, acceleration or range of a joint.
    Joints = 3,
}

/// Reason for refusing a frame or a reading, in the detail of [`EventCode::FrameRefused`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RefusedFrame {
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

impl ControlLimit {
    /// All limits, in the order of their numbers.
    pub const ALL: [Self; 3] = [Self::Task, Self::Feet, Self::Joints];

    fn from_number(n: u64) -> Option<Self> {
        Self::ALL.into_iter().find(|limit| *limit as u64 == n)
    }

    /// The same in words.
    pub(crate) const fn text(self) -> &'static str {
        match self {
            Self::Task => "a task is nearly singular",
            Self::Feet => "a modification of the feet",
            Self::Joints => "speed, acceleration or range of a joint",
        }
    }
}

impl TableFault {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 16] = [
        Self::Shape,
        Self::Robot,
        Self::Range,
        Self::Speed,
        Self::Acceleration,
        Self::Begin,
        Self::BetweenPoints,
        Self::End,
        Self::Room,
        Self::Late,
        Self::Sampling,
        Self::WrongAnswer,
        Self::NoAnswer,
        Self::NotArmed,
        Self::NoTables,
        Self::Restarted,
    ];

    fn from_number(n: u64) -> Option<Self> {
        Self::ALL.into_iter().find(|fault| *fault as u64 == n)
    }

    /// The same in words.
    pub(crate) const fn text(self) -> &'static str {
        match self {
            Self::Shape => "it takes 2 to 1024 points, 1 to 256 samples and at least a bus cycle apart",
            Self::Robot => "it is of another robot",
            Self::Range => "leaves the range of the joint",
            Self::Speed => "is too fast",
            Self::Acceleration => "takes more acceleration than the drive has",
            Self::Begin => "the joint is elsewhere when it begins",
            Self::BetweenPoints => "begins between two points of the running table",
            Self::End => "ends in motion",
            Self::Room => "has no room beside the running table",
            Self::Late => "was not loaded in time, or the joints are not led",
            Self::Sampling => "the drive samples with another period than the robot's file says",
            Self::WrongAnswer => "the drive answered something else",
            Self::NoAnswer => "the drive did not answer",
            Self::NotArmed => "the drive did not say that it is ready to begin",
            Self::NoTables => "its drives play no tables here",
            Self::Restarted => "the drive has started anew, or left the network",
        }
    }
}

impl RefusedFrame {
    fn from_number(n: u64) -> Option<Self> {
        use RefusedFrame::{Jump, Late, Length, Twice, Unknown};
        [Late, Twice, Length, Unknown, Jump].into_iter().find(|why| *why as u64 == n)
    }

    /// The same in words.
    pub(crate) const fn text(self) -> &'static str {
        match self {
            Self::Late => "of an earlier cycle",
            Self::Twice => "came a second time",
            Self::Length => "its length is not that of its message",
            Self::Unknown => "nobody knows its identifier",
            Self::Jump => "its reading is further from the last one than can be",
        }
    }
}

impl Detail {
    /// Number in the record of an event.
    pub const fn pack(self) -> u64 {
        match self {
            Self::Nothing => 0,
            Self::Cause(code) => code as u64,
            Self::Cycles(n)
            | Self::Count(n)
            | Self::Number(n)
            | Self::Plan(n)
            | Self::Message(n)
            | Self::Millimetres(n)
            | Self::Newtons(n)
            | Self::Microseconds(n) => n,
            Self::Joint(i) | Self::Node(i) => i as u64,
            Self::Steps { length, side, turn, duration } => {
                let parts = [length as u16, side as u16, turn as u16, duration];
                parts[0] as u64 | (parts[1] as u64) << 16 | (parts[2] as u64) << 32 | (parts[3] as u64) << 48
            }
            // As people read numbers: 12004 is node 12 for 4 cycles.
            Self::NodeCycles(node, cycles) => {
                1000 * node as u64 + if cycles < 999 { cycles as u64 } else { 999 }
            }
            Self::Caller { user, process } => (user as u64) << 32 | process as u64,
            Self::Limit(limit) => limit as u64,
            Self::Frame(why) => why as u64,
            Self::Stations(before, behind) => (before as u64) << 16 | behind as u64,
            Self::Drive { joint, error } => joint as u64 | (error as u64) << 16,
            Self::Table { joint, point, fault } => joint as u64 | (point as u64) << 8 | (fault as u64) << 24,
        }
    }

    /// Detail of a kind, from the number in a record; a number that the kind does not have stays a number.
    pub(crate) fn unpack(kind: DetailKind, n: u64) -> Self {
        match kind {
            DetailKind::Nothing => Self::Nothing,
            DetailKind::Cause => EventCode::from_number(n).map_or(Self::Number(n), Self::Cause),
            DetailKind::Cycles => Self::Cycles(n),
            DetailKind::Count => Self::Count(n),
            DetailKind::Number => Self::Number(n),
            DetailKind::Joint => Self::Joint(n as usize),
            DetailKind::Node => Self::Node(n as usize),
            DetailKind::NodeCycles => Self::NodeCycles((n / 1000) as usize, (n % 1000) as u32),
            DetailKind::Plan => Self::Plan(n),
            DetailKind::Message => Self::Message(n),
            DetailKind::Caller => Self::Caller { user: (n >> 32) as u32, process: n as u32 },
            DetailKind::Limit => ControlLimit::from_number(n).map_or(Self::Number(n), Self::Limit),
            DetailKind::Frame => RefusedFrame::from_number(n).map_or(Self::Number(n), Self::Frame),
            DetailKind::Stations => Self::Stations((n >> 16) as u16, n as u16),
            DetailKind::Drive => Self::Drive { joint: (n & 0xFFFF) as usize, error: (n >> 16) as u16 },
            DetailKind::Table => TableFault::from_number(n >> 24).map_or(Self::Number(n), |fault| {
                Self::Table { joint: (n & 0xFF) as usize, point: (n >> 8 & 0xFFFF) as usize, fault }
            }),
            DetailKind::Millimetres => Self::Millimetres(n),
            DetailKind::Newtons => Self::Newtons(n),
            DetailKind::Microseconds => Self::Microseconds(n),
            DetailKind::Steps => {
                let part = |k: u32| (n >> (16 * k)) as u16;
                Self::Steps {
                    length: part(0) as i16,
                    side: part(1) as i16,
                    turn: part(2) as i16,
                    duration: part(3),
                }
            }
        }
    }

    /// True if an event with this kind of detail may carry it.
    pub(crate) fn is_of(self, kind: DetailKind) -> bool {
        // Silence longer than there is room for packs to less, so it is not compared.
        matches!((self, kind), (Self::Nothing, _) | (Self::NodeCycles(..), DetailKind::NodeCycles))
            || Self::unpack(kind, self.pack()) == self
    }
}
