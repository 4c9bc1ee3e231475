//! A message as bytes, the same in queues and in TCP frames, and everything that makes one refused.
//!
//! | bytes | content |
//! |---|---|
//! | 0..2 | domain, u16 little endian: a [`Domain`], or [`SERVICE`] for talk with the broker itself |
//! | 2..4 | id in the domain, u16 little endian |
//! | 4 | [`Priority`], u8 |
//! | 5.. | payload: a [`Command`] encoded by [`messages::wire`], or what the service id says |
//!
//! In the queues to the broker the number of the sender, u32, stands in front.

use messages::command::{Domain, Priority};
use messages::{Command, wire};

/// Longest message \[B\].
pub const MAX_BYTES: usize = ipc::MAX_MESSAGE;
/// Bytes before the payload.
pub const HEAD: usize = 5;
/// The domain of talk with the broker itself.
pub const SERVICE: u16 = 0xffff;

/// Ids in the domain [`SERVICE`]: what a client asks, then what the broker answers, one answer per message.
pub mod service {
    /// Register or renew: `[token u32, domains u32, lost u32, name in UTF-8]` in the service queue; `lost` is what
    /// the client has missed so far. Answered with [`ACCEPTED`] in the client's queue.
    pub const REGISTER: u16 = 1;
    /// Leave: `[token u32]` in the service queue.
    pub const LEAVE: u16 = 2;
    /// Subscribe to domains: `[domains u32]`, bit n for domain n. TCP only.
    pub const SUBSCRIBE: u16 = 3;
    /// Ask for statistics. TCP only.
    pub const STATISTICS: u16 = 4;
    /// Sign of life. TCP only.
    pub const PING: u16 = 5;
    /// Done; `[receivers u32]`: to how many clients a command went.
    pub const ACCEPTED: u16 = 16;
    /// Not done: `[code u8, reason in UTF-8]`.
    pub const REFUSED: u16 = 17;
    /// One line of statistics in UTF-8; [`ACCEPTED`] follows the last one.
    pub const LINE: u16 = 18;
}

/// Why a message is refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// No frame of this protocol; the connection is closed.
    Malformed(String),
    /// A frame or its first byte did not come in time; the connection is closed.
    TimedOut(&'static str),
    /// The broker has as many connections as it takes; the connection is closed.
    TooManyConnections,
    /// The payload is no command, or not the one that the address names.
    NotACommand(String),
    /// A number is not finite or out of range.
    OutOfRange(String),
    /// More messages than the broker takes.
    Busy,
}

impl Refusal {
    /// Number for the wire and the log.
    pub const fn code(&self) -> u8 {
        match self {
            Self::Malformed(_) => 1,
            Self::TimedOut(_) => 2,
            Self::TooManyConnections => 3,
            Self::NotACommand(_) => 4,
            Self::OutOfRange(_) => 5,
            Self::Busy => 6,
        }
    }

    /// Whether the connection ends with it: after these the bytes that follow mean nothing.
    pub const fn is_final(&self) -> bool {
        matches!(self, Self::Malformed(_) | Self::TimedOut(_) | Self::TooManyConnections)
    }

    /// The answer for the client.
    pub fn to_message(&self) -> Vec<u8> {
        let mut payload = vec![self.code()];
        payload.extend(self.to_string().bytes().take(MAX_BYTES - HEAD - 1));
        service_message(service::REFUSED, &payload)
    }
}

impl std::fmt::Display for Refusal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Malformed(why) => write!(f, "not a frame of the broker's protocol: {why}"),
            Self::TimedOut(what) => write!(f, "{what} did not come in time"),
            Self::TooManyConnections => write!(f, "too many connections; close one and try again"),
            Self::NotACommand(why) | Self::OutOfRange(why) => write!(f, "{why}"),
            Self::Busy => write!(f, "too many messages at once; send them more slowly"),
        }
    }
}
impl std::error::Error for Refusal {}

/// A view of a message's bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Message<'a> {
    /// A [`Domain`] or [`SERVICE`].
    pub domain: u16,
    /// Which message of the domain.
    pub id: u16,
    /// How urgent.
    pub priority: Priority,
    /// What it says.
    pub payload: &'a [u8],
}

impl<'a> Message<'a> {
    /// Splits the bytes; the payload is not looked at.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, Refusal> {
        let malformed = |why: String| Refusal::Malformed(why);
        let &[d0, d1, i0, i1, class, ref payload @ ..] = bytes else {
            return Err(malformed(format!("{} bytes, at least {HEAD} are needed", bytes.len())));
        };
        let priority = Priority::try_from(class)
            .map_err(|n| malformed(format!("priority {n}, there are 0 (high), 1 and 2 (low)")))?;
        let domain = u16::from_le_bytes([d0, d1]);
        if domain != SERVICE && Domain::try_from(domain).is_err() {
            return Err(malformed(format!(
                "domain {domain}, there are 0 to {} and {SERVICE}",
                Domain::ALL.len() - 1
            )));
        }
        Ok(Self { domain, id: u16::from_le_bytes([i0, i1]), priority, payload })
    }

    /// The same for a message that came in the queue of a class, which must be its own.
    pub(crate) fn command_of_class(&self, class: usize) -> Result<Command, Refusal> {
        if self.priority as usize != class {
            return Err(Refusal::Malformed(format!(
                "priority {:?} in the queue of class {class}",
                self.priority
            )));
        }
        self.command()
    }

    /// The command inside, if it is the one that the address names, of a fitting priority and in its ranges.
    ///
    /// An emergency stop travels as High and nothing else does; any other command may be sent as Normal or Low.
    pub fn command(&self) -> Result<Command, Refusal> {
        let command = wire::decode(self.payload).map_err(|e| Refusal::NotACommand(e.to_string()))?;
        let (domain, id) = command.address();
        if (domain as u16, id) != (self.domain, self.id) {
            let (d, i, name) = (self.domain, self.id, command.name());
            return Err(Refusal::NotACommand(format!(
                "message ({d}, {i}) carries {name}, which is another one"
            )));
        }
        if (self.priority == Priority::High) != (command.priority() == Priority::High) {
            let why = format!("{} cannot be sent with priority {:?}", command.name(), self.priority);
            return Err(Refusal::NotACommand(why));
        }
        command.check().map_err(Refusal::OutOfRange)?;
        Ok(command)
    }
}

/// Writes a command as a message behind `prefix`; returns the bytes used. Allocates nothing.
pub fn write_command<'a>(
    command: &Command,
    priority: Priority,
    prefix: u32,
    buffer: &'a mut [u8; MAX_BYTES],
) -> Result<&'a [u8], wire::WireError> {
    let (domain, id) = command.address();
    buffer[..4].copy_from_slice(&prefix.to_le_bytes());
    buffer[4..6].copy_from_slice(&(domain as u16).to_le_bytes());
    buffer[6..8].copy_from_slice(&id.to_le_bytes());
    buffer[8] = priority as u8;
    let n = wire::encode(command, &mut buffer[4 + HEAD..])?.len();
    Ok(&buffer[..4 + HEAD + n])
}

/// A message of the domain [`SERVICE`].
pub fn service_message(id: u16, payload: &[u8]) -> Vec<u8> {
    let [d0, d1] = SERVICE.to_le_bytes();
    let [i0, i1] = id.to_le_bytes();
    let mut bytes = vec![d0, d1, i0, i1, Priority::Low as u8];
    bytes.extend_from_slice(payload);
    bytes
}

/// The u32 in front, and the rest.
pub(crate) fn split_u32(bytes: &[u8]) -> Option<(u32, &[u8])> {
    let (number, rest) = bytes.split_first_chunk()?;
    Some((u32::from_le_bytes(*number), rest))
}

/// Queues to the broker by priority class.
pub(crate) const PUBLISH: [&str; 3] = ["broker-high", "broker-normal", "broker-low"];
/// Queue to the broker for registration.
pub(crate) const REGISTRATION: &str = "broker-service";
/// What the queues to the broker ring.
pub(crate) const BROKER_BELL: &str = "broker-queues";

/// Queue from the broker to a client, and what it rings.
pub(crate) fn client_queue(name: &str) -> String {
    format!("client-{name}")
}

/// Bit n for domain n.
pub fn domain_mask(domains: &[Domain]) -> u32 {
    domains.iter().fold(0, |mask, d| mask | 1 << *d as u16)
}
