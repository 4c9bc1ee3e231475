//! Refusals of the broker: why a frame, a connection or a command does not go on, with its number in the protocol.

use messages::command_answer::code;
use messages::{Command, Reason};

use crate::message::{VERSION, service, service_message};

/// Reason for refusing a message.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// No frame of this protocol; the connection is closed.
    Malformed(String),
    /// A frame or its first byte did not come in time; the connection is closed.
    TimedOut(&'static str),
    /// The broker has as many connections as it takes; the connection is closed.
    TooManyConnections(&'static str),
    /// The payload is no command, or not the one that the address names.
    NotACommand(String),
    /// A parameter that there is not, or that cannot be changed while the robot runs.
    NoParameter(String),
    /// A number is not finite or out of range.
    OutOfRange(String),
    /// More messages than the broker takes.
    Busy(String),
    /// Another version of the protocol or another table of commands; the connection is closed.
    Version {
        /// Version and schema of the client.
        client: (u16, u64),
        /// Schema of this broker.
        schema: u64,
    },
    /// The connection has not the right to do this.
    NoAccess(String),
    /// Somebody else holds the command lease.
    LeaseHeld(String),
    /// No process that decides about this command is there.
    NobodyListens(&'static str),
    /// The process that decides did not answer in time.
    NoAnswer(&'static str),
    /// A wrong proof of the key, or a frame that is not authentic; the connection is closed.
    NotAuthentic,
    /// Age, sequence, lease: see there.
    Reason(Reason, &'static str, String),
}

impl Refusal {
    /// A reason of [`messages::command_answer`] with its text.
    pub fn because(reason: Reason, command: &Command) -> Self {
        Self::Reason(reason, command.name(), reason.text(command))
    }

    /// Number for the wire and the log.
    pub const fn code(&self) -> u8 {
        match self {
            Self::Malformed(_) => code::MALFORMED,
            Self::TimedOut(_) => code::TIMED_OUT,
            Self::TooManyConnections(_) => code::TOO_MANY_CONNECTIONS,
            Self::NotACommand(_) => code::NOT_A_COMMAND,
            Self::OutOfRange(_) => code::OUT_OF_RANGE,
            Self::Busy(_) => code::BUSY,
            Self::Version { .. } => code::VERSION,
            Self::NoAccess(_) => code::NO_ACCESS,
            Self::LeaseHeld(_) => code::LEASE_HELD,
            Self::NobodyListens(_) => code::NOBODY_LISTENS,
            Self::NoAnswer(_) => code::NO_ANSWER,
            Self::NotAuthentic => code::NOT_AUTHENTIC,
            Self::NoParameter(_) => code::NO_PARAMETER,
            Self::Reason(reason, ..) => reason.code(),
        }
    }

    /// Whether the connection ends with it: after these the bytes that follow mean nothing.
    pub(crate) const fn is_final(&self) -> bool {
        matches!(
            self,
            Self::Malformed(_)
                | Self::TimedOut(_)
                | Self::TooManyConnections(_)
                | Self::Version { .. }
                | Self::NotAuthentic
        )
    }

    /// The answer to the frame `sequence`.
    pub(crate) fn to_message(&self, sequence: u64, now_ns: u64) -> Vec<u8> {
        let mut payload = vec![self.code()];
        payload.extend(self.to_string().bytes());
        service_message(service::REFUSED, sequence, now_ns, &payload)
    }
}

impl std::fmt::Display for Refusal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Malformed(why) => write!(f, "not a frame of the broker's protocol: {why}"),
            Self::TimedOut(what) => write!(f, "{what} did not come in time"),
            Self::TooManyConnections(whose) => {
                write!(f, "too many connections {whose}; close one and try again")
            }
            Self::NotACommand(why) | Self::OutOfRange(why) | Self::NoParameter(why) => write!(f, "{why}"),
            Self::Busy(what) => write!(f, "{what}; send more slowly"),
            Self::Version { client: (version, theirs), schema } => write!(
                f,
                "the client speaks version {version} with schema {theirs:016x}, this broker version {VERSION} with \
                 schema {schema:016x}: build both from one source"
            ),
            Self::NoAccess(why) => write!(f, "{why}"),
            Self::LeaseHeld(holder) => {
                write!(f, "{holder} holds the command lease; end that one, or take it over (`--take-over`)")
            }
            Self::NobodyListens(who) => write!(f, "{who} decides about this and is not there"),
            Self::NoAnswer(who) => {
                write!(f, "{who} has not answered in time: it hangs, or its cycles are late")
            }
            Self::NotAuthentic => write!(f, "the key is not known, or the frame is not authentic"),
            Self::Reason(_, name, text) => write!(f, "{name}: {text}"),
        }
    }
}
impl std::error::Error for Refusal {}
