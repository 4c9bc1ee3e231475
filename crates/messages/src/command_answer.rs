//! Answers to commands: accepted, or refused with the reason and the limit, by the process that has the last word.
//!
//! A [`Verdict`] is made in a control cycle, so it is plain numbers; its text is made later, by a thread that may
//! allocate. Its number in the protocol (`docs/protocol.md`) is one of [`code`].

use crate::{Command, Detail, EventCode, Live};

/// Numbers of refusals in the protocol, the broker's own first. They travel, and are never given twice; 0: accepted.
#[allow(missing_docs, reason = "names of docs/protocol.md")]
pub mod code {
    pub const MALFORMED: u8 = 1;
    pub const TIMED_OUT: u8 = 2;
    pub const TOO_MANY_CONNECTIONS: u8 = 3;
    pub const NOT_A_COMMAND: u8 = 4;
    pub const OUT_OF_RANGE: u8 = 5;
    pub const BUSY: u8 = 6;
    pub const VERSION: u8 = 7;
    pub const NO_ACCESS: u8 = 8;
    pub const LEASE_HELD: u8 = 9;
    pub const NOBODY_LISTENS: u8 = 10;
    pub const NO_ANSWER: u8 = 11;
    pub const NOT_AUTHENTIC: u8 = 12;
    pub const NO_PARAMETER: u8 = 13;
    // Of the process that decides.
    pub const TOO_OLD: u8 = 20;
    pub const FROM_THE_FUTURE: u8 = 21;
    pub const REPLAYED: u8 = 22;
    pub const LEASE_LOST: u8 = 23;
    pub const LIMIT: u8 = 30;
    pub const NOT_STANDING: u8 = 31;
    pub const NOT_NOW: u8 = 32;
    pub const EVENT: u8 = 33;
    pub const LOADED: u8 = 34;
}

/// Outcome of a command.
pub type Verdict = Result<(), Reason>;

/// Reason of a process for refusing a command. Reasons of the broker itself are its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason {
    /// It was given too long ago.
    TooOld {
        /// \[ns\] how long.
        age_ns: u64,
    },
    /// Its sender's clock is ahead of this machine's.
    FromTheFuture {
        /// \[ns\] how far.
        lead_ns: u64,
    },
    /// Its number is not above the last one of its connection: replayed, or out of order.
    Replayed {
        /// Its number.
        sequence: u64,
        /// The highest number before it.
        last: u64,
    },
    /// Its sender lost the command lease before it took effect.
    LeaseLost,
    /// A number lies outside of what the gait or robot allows.
    Limit {
        /// Index in the command's table of fields.
        field: u8,
        /// Least value.
        low: f64,
        /// Greatest value.
        high: f64,
    },
    /// The robot does not stand on its feet yet.
    NotStanding,
    /// Nothing that can be done in the present state, for example to walk before `walk/stand`.
    NotNow,
    /// A foot carries more than it may.
    Loaded {
        /// \[N\] the heavier foot's load.
        load: f64,
        /// \[N\] the most it may be.
        most: f64,
    },
    /// Subject of an event's detail.
    Event {
        /// Its code.
        code: EventCode,
        /// Its subject.
        detail: Detail,
    },
}

impl Reason {
    /// Number in the protocol.
    pub const fn code(&self) -> u8 {
        match self {
            Self::TooOld { .. } => code::TOO_OLD,
            Self::FromTheFuture { .. } => code::FROM_THE_FUTURE,
            Self::Replayed { .. } => code::REPLAYED,
            Self::LeaseLost => code::LEASE_LOST,
            Self::Limit { .. } => code::LIMIT,
            Self::NotStanding => code::NOT_STANDING,
            Self::NotNow => code::NOT_NOW,
            Self::Event { .. } => code::EVENT,
            Self::Loaded { .. } => code::LOADED,
        }
    }

    /// Sentence for the operator.
    pub fn text(&self, command: &Command) -> String {
        let ms = |ns: u64| ns as f64 * 1e-6;
        match *self {
            Self::TooOld { age_ns } => {
                let most = ms(crate::command_stamp::MAX_AGE);
                format!("it is {:.0} ms old, at most {most:.0} ms: dropped; send it again", ms(age_ns))
            }
            Self::FromTheFuture { lead_ns } => {
                format!("its time is {:.0} ms ahead of this machine's CLOCK_MONOTONIC", ms(lead_ns))
            }
            Self::Replayed { sequence, last } => {
                format!("its sequence {sequence} is not above {last}: replayed, or out of order")
            }
            Self::LeaseLost => "its sender no longer holds the command lease".into(),
            Self::Limit { field, low, high } => limit(command, usize::from(field), low, high),
            Self::NotStanding => "the robot does not stand on its feet, its supply on: system/reset, system/enable, then walk/stand".into(),
            Self::NotNow => not_now(command).into(),
            Self::Loaded { load, most } => {
                format!("{load:.0} N on a foot, at most {most:.0} N: the robot must hang, with its feet free")
            }
            Self::Event { code, detail } => event(code, detail),
        }
    }
}

/// Precondition of the command.
const fn not_now(command: &Command) -> &'static str {
    match command {
        Command::Reset => {
            "no effect: the motor supply is on, the joint loop is silent, or it was given again too soon"
        }
        Command::Home => {
            "no joint waits for its angle: every one knows it, or the motor supply is off (system/reset and system/enable)"
        }
        Command::ZeroForce => {
            "the drives are not on: system/reset and system/enable come first, then joint/home if asked for"
        }
        Command::Box(_) | Command::Gone(_) => {
            "the gait has no [obstacles]: it knows of nothing that lies on the ground"
        }
        Command::Enable => "no effect: system/reset comes first, and the joint loop must be alive",
        _ => "not in the present state; walk/stand comes first, and a skill ends first",
    }
}

/// `forward = 3 m/s: at most 1.39`.
fn limit(command: &Command, field: usize, low: f64, high: f64) -> String {
    let Some(info) = command.info().fields.get(field) else { return "outside of its limits".into() };
    let (name, unit, value) = (info.name, info.unit, command.value(field));
    // The table of a gait holds no more digits than three; neither should the sentence.
    let round = |x: f64| (x * 1e3).round() / 1e3;
    if value > high {
        format!("{name} = {value} {unit}: at most {}", round(high))
    } else if value < low {
        format!("{name} = {value} {unit}: at least {}", round(low))
    } else {
        format!("{name} = {value} {unit}: must lie in [{}, {}]", round(low), round(high))
    }
}

fn event(code: EventCode, detail: Detail) -> String {
    let mm = detail.pack() as f64 * 1e-3;
    match code {
        EventCode::ObstacleTooHigh => format!("{mm} m is higher than the robot steps"),
        EventCode::ObstacleTooLong => format!("a step of {mm} m over it is longer than the robot's"),
        EventCode::NoFoothold => format!("there is no foothold for {mm} m"),
        EventCode::Fallen => {
            "the robot has fallen: put it on its feet, then system/reset, system/enable, walk/stand".into()
        }
        EventCode::SafeStop => "its joints were stopped: secure the robot, then system/emergency_stop, \
                                system/reset, system/enable, walk/stand"
            .into(),
        code => crate::Words::default().sentence(code as u64, detail.pack()),
    }
}

/// Source of live commands in a cycle: nothing here waits, locks or allocates.
pub trait CommandSource {
    /// The next command that may take effect now. What is too old or has lost its lease is answered and left out.
    fn next(&mut self) -> Option<Live>;

    /// Tells the sender what became of it. Of several processes that hear a command only
    /// [the one that decides](Command::decided_by) is heard.
    fn answer(&mut self, live: &Live, verdict: Verdict);

    /// The next command that [`CommandSource::next`] has answered by itself and left out, and why.
    fn left_out(&mut self) -> Option<(Live, Reason)>;

    /// The newest word about the command lease.
    fn lease(&self) -> crate::command_stamp::Lease;

    /// The next command, accepted as it is: for processes that do whatever they are told, or tell it by their state.
    fn accept(&mut self) -> Option<Live> {
        let live = self.next()?;
        self.answer(&live, Ok(()));
        Some(live)
    }
}

/// No source of live commands: a process that hears the scene only.
#[derive(Clone, Copy, Debug)]
pub struct NoCommands;

impl CommandSource for NoCommands {
    fn next(&mut self) -> Option<Live> {
        None
    }

    fn answer(&mut self, _: &Live, _: Verdict) {}

    fn left_out(&mut self) -> Option<(Live, Reason)> {
        None
    }

    fn lease(&self) -> crate::command_stamp::Lease {
        crate::command_stamp::Lease::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::VelocityCommand;

    #[test]
    fn a_refusal_names_field_value_and_limit() {
        let fast = Command::Velocity(VelocityCommand { forward: 1.9, left: -0.9, turn: 0.0 });
        let limit = |field, low, high| Reason::Limit { field, low, high }.text(&fast);
        assert_eq!(limit(0, -0.3, 1.388_888), "forward = 1.9 m/s: at most 1.389");
        assert_eq!(limit(1, -0.2, 0.2), "left = -0.9 m/s: at least -0.2");
        assert_eq!(limit(9, 0.0, 1.0), "outside of its limits");
        assert_eq!(
            Reason::TooOld { age_ns: 134_000_000 }.text(&fast),
            "it is 134 ms old, at most 100 ms: dropped; send it again"
        );
    }
}
