//! The way from a robot without power to one that may walk, as the joint loop sees it.

/// State of the start-up; numbers are part of the log format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum StartUp {
    /// Motor supply off.
    Off = 0,
    /// Supply on; joints that do not know their angles keep all drives from being switched on.
    NotHomed = 1,
    /// These joints look for their references; the others are held.
    Homing = 2,
    /// Drives are being switched on.
    Enabling = 3,
    /// Drives on, the feet do not carry.
    Hanging = 4,
    /// The same with force sensors that read zero.
    Zeroed = 5,
    /// The feet carry: walking commands are taken.
    Standing = 6,
    /// A controlled stop that is latched until the supply was off.
    Stopped = 7,
}

impl StartUp {
    /// All states, in order of their numbers.
    pub const ALL: [Self; 8] = [
        Self::Off,
        Self::NotHomed,
        Self::Homing,
        Self::Enabling,
        Self::Hanging,
        Self::Zeroed,
        Self::Standing,
        Self::Stopped,
    ];

    /// The state of a number from a record; a number that is none is `Off`.
    pub fn from_number(n: u64) -> Self {
        Self::ALL.get(n as usize).copied().unwrap_or(Self::Off)
    }

    /// State, and the operator's next action.
    pub const fn advice(self) -> &'static str {
        match self {
            Self::Off => "motor supply off: gangwerk topic pub system/reset, then system/enable",
            Self::NotHomed => {
                "motor supply on, drives off: find the joints' references (gangwerk topic pub joint/home)"
            }
            Self::Homing => "homing: wait",
            Self::Enabling => "drives are being switched on",
            Self::Hanging => {
                "hanging, drives enabled: zero the force sensors (gangwerk topic pub joint/zero_force)"
            }
            Self::Zeroed => {
                "hanging, force sensors zeroed: lower the robot (simulated: gangwerk topic pub sim/lower \
                 distance=0.3)"
            }
            Self::Standing => "standing: ready for walk/stand, then walk/velocity",
            Self::Stopped => {
                "stopped: secure the robot, then gangwerk topic pub system/emergency_stop, system/reset, system/enable"
            }
        }
    }

    /// Whether the robot stands on its feet as far as the joint loop knows; a robot that was stopped did.
    pub const fn stands(self) -> bool {
        matches!(self, Self::Standing | Self::Stopped)
    }
}
