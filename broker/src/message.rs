//! A message as bytes, the same in queues and in frames of a stream (`docs/protocol.md`).
//!
//! | bytes | content |
//! |---|---|
//! | 0..2 | domain, u16: a [`Domain`], or [`SERVICE`] for talk with the broker itself |
//! | 2..4 | id in the domain, u16 |
//! | 4 | [`Priority`], u8 |
//! | 5..8 | zero |
//! | 8..12 | origin, u32: number of the sender's connection; written by the broker |
//! | 12..16 | grant, u32: the lease under which the broker admitted it; written by the broker |
//! | 16..24 | sequence, u64: of a command, rising on its connection; of an answer, that of what it answers |
//! | 24..32 | time, u64 \[ns\]: CLOCK_MONOTONIC of this machine when it was sent |
//! | 32.. | payload: a [`Command`] encoded by [`messages::wire`], or what the service id says |
//!
//! All numbers are little endian.

use messages::command::{Domain, Priority};
use messages::command_text::COMMANDS;
use messages::{Command, FNV1A, Stamp, fnv1a, wire};

use crate::keys::Half;
use crate::refusal::Refusal;

/// Version of the protocol: changes with the layout of messages and with the meaning of services.
pub const VERSION: u16 = 3;
/// Longest message \[B\].
pub const MAX_BYTES: usize = ipc::MAX_MESSAGE;
/// Bytes before the payload.
pub const HEAD: usize = 32;
/// The domain of talk with the broker itself.
pub const SERVICE: u16 = 0xffff;

/// Ids in the domain [`SERVICE`]: what a client asks, then what the broker answers.
pub mod service {
    /// Register or renew, by queue: `[token u32, domains u32, lost u32, name]`. Answered with [`ACCEPTED`].
    pub const REGISTER: u16 = 1;
    /// Leave, by queue: `[token u32]`.
    pub(crate) const LEAVE: u16 = 2;
    /// Subscribe to domains, by stream: `[domains u32]`, bit n for domain n.
    pub const SUBSCRIBE: u16 = 3;
    /// Ask for statistics, by stream.
    pub const STATISTICS: u16 = 4;
    /// Heartbeat, by stream; renews the sender's lease and is not answered.
    pub const PING: u16 = 5;
    /// Verdict on a command, by queue: `[token u32, origin u32, code u8, text]`; the head has the command's sequence.
    pub const VERDICT: u16 = 6;
    /// First frame of a stream: `[version u16, schema u64, nonce 16 bytes, name, 0, name of the key]`.
    pub const HELLO: u16 = 7;
    /// Proof of the key, by stream: `[tag 32 bytes]`.
    pub const PROVE: u16 = 8;
    /// Take the command lease, by stream: `[over u8]`; 1 takes it from whoever holds it.
    pub const TAKE_LEASE: u16 = 9;
    /// Give the command lease back, by stream.
    pub const GIVE_LEASE: u16 = 10;
    /// Ask for the table of commands, by stream.
    pub const DESCRIBE: u16 = 11;
    /// Watch the robot, by stream: `[rate u16, events u8]`. The present state comes at once; then, with a rate \[1/s\], state
    /// at that rate, and with `events` = 1 what the processes report.
    pub const WATCH: u16 = 12;
    /// Ask for the table of parameters, by stream.
    pub(crate) const PARAMETERS: u16 = 13;
    /// Give a parameter another value, by stream: `[value f64, name]`; answered like the command of its process.
    pub(crate) const SET: u16 = 14;
    /// Done: `[name of the process that took it]`.
    pub const ACCEPTED: u16 = 16;
    /// Not done: `[code u8, reason]`.
    pub(crate) const REFUSED: u16 = 17;
    /// One line of text; [`ACCEPTED`] follows the last one.
    pub const LINE: u16 = 18;
    /// Answer to [`HELLO`]: `[version u16, schema u64, nonce 16 bytes, token u32, domains u32, prove u8]`.
    pub const WELCOME: u16 = 19;
    /// State of the command lease: `[grant u32, until u64, holder]`; grant 0: nobody holds it.
    pub const LEASE: u16 = 20;
    /// State of the robot: `[tick u64, lost u32, numbers f32 ...]`; the LINEs of [`WATCH`] say what they are.
    pub const STATE: u16 = 21;
    /// Event of a process: `[tick u64, code u32, detail u64, PROCESS NAME]`.
    pub(crate) const EVENT: u16 = 22;
    /// Present value of a parameter that can be changed: `[value f64, name]`.
    pub const PARAMETER: u16 = 23;
}

/// Hash of everything that the payloads mean: names, addresses, fields and ranges of all commands (FNV-1a, 64 bits).
pub fn schema() -> u64 {
    describe().iter().fold(FNV1A, |hash, line| fnv1a(hash, line.bytes()))
}

/// The table of commands for programs that learn it from the broker, one command per line:
/// `name domain id number needs_lease field:type:unit:low:high:default ...`, type as of Python's `struct`.
pub fn describe() -> Vec<String> {
    let line = |info: &messages::command_text::CommandInfo| {
        let command = info.example();
        let (domain, id) = command.address();
        let mut bytes = [0; wire::MAX_BYTES];
        let number = wire::encode(&command, &mut bytes).ok().and_then(|b| b.first_chunk().copied());
        let (number, lease) = (number.map_or(0, u32::from_le_bytes), u8::from(command.needs_lease()));
        let mut line = format!("{} {} {id} {number} {lease}", info.name, domain as u16);
        for f in info.fields {
            let kind = if f.is_whole() { "I" } else { "d" };
            let default = f.default.map_or(String::new(), |d| format!("{d:?}"));
            line += &format!(" {}:{kind}:{}:{:?}:{:?}:{default}", f.name, f.unit, f.range[0], f.range[1]);
        }
        line
    };
    COMMANDS.iter().map(line).collect()
}

/// A view of a message's bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Message<'a> {
    /// A [`Domain`] or [`SERVICE`].
    pub domain: u16,
    /// Which message of the domain.
    pub id: u16,
    /// Priority.
    pub priority: Priority,
    /// Sender and time.
    pub stamp: Stamp,
    /// Payload.
    pub payload: &'a [u8],
}

impl<'a> Message<'a> {
    /// Splits the bytes; the payload is not looked at.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, Refusal> {
        let malformed = |why: String| Refusal::Malformed(why);
        let Some((head, payload)) = bytes.split_first_chunk::<HEAD>() else {
            return Err(malformed(format!("{} bytes, at least {HEAD} are needed", bytes.len())));
        };
        let &[d0, d1, i0, i1, class, ref rest @ ..] = head;
        let priority = Priority::try_from(class)
            .map_err(|n| malformed(format!("priority {n}, there are 0 (high), 1 and 2 (low)")))?;
        let domain = u16::from_le_bytes([d0, d1]);
        if domain != SERVICE && Domain::try_from(domain).is_err() {
            return Err(malformed(format!(
                "domain {domain}, there are 0 to {} and {SERVICE}",
                Domain::ALL.len() - 1
            )));
        }
        if rest[..3] != [0; 3] {
            return Err(malformed("bytes 5 to 7 are not zero".into()));
        }
        let stamp = Stamp {
            origin: u32::from_le_bytes(part(head, 8)),
            grant: u32::from_le_bytes(part(head, 12)),
            sequence: u64::from_le_bytes(part(head, 16)),
            sent_ns: u64::from_le_bytes(part(head, 24)),
        };
        Ok(Self { domain, id: u16::from_le_bytes([i0, i1]), priority, stamp, payload })
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

/// `N` bytes of the head from `at`.
fn part<const N: usize>(head: &[u8; HEAD], at: usize) -> [u8; N] {
    head[at..at + N].try_into().unwrap_or([0; N])
}

/// Writes a command as a message; returns the bytes used. Allocates nothing.
pub fn write_command<'a>(
    command: &Command,
    priority: Priority,
    stamp: &Stamp,
    buffer: &'a mut [u8; MAX_BYTES],
) -> Result<&'a [u8], wire::WireError> {
    let (domain, id) = command.address();
    buffer[..2].copy_from_slice(&(domain as u16).to_le_bytes());
    buffer[2..4].copy_from_slice(&id.to_le_bytes());
    buffer[4..8].copy_from_slice(&[priority as u8, 0, 0, 0]);
    write_stamp(buffer, stamp);
    let n = wire::encode(command, &mut buffer[HEAD..])?.len();
    Ok(&buffer[..HEAD + n])
}

/// Writes the stamp into the head of a message.
pub(crate) fn write_stamp(message: &mut [u8], stamp: &Stamp) {
    message[8..12].copy_from_slice(&stamp.origin.to_le_bytes());
    message[12..16].copy_from_slice(&stamp.grant.to_le_bytes());
    message[16..24].copy_from_slice(&stamp.sequence.to_le_bytes());
    message[24..32].copy_from_slice(&stamp.sent_ns.to_le_bytes());
}

/// A message of the domain [`SERVICE`], numbered `sequence`, of the time `now_ns`.
pub fn service_message(id: u16, sequence: u64, now_ns: u64, payload: &[u8]) -> Vec<u8> {
    let mut bytes = vec![0; HEAD];
    bytes[..2].copy_from_slice(&SERVICE.to_le_bytes());
    bytes[2..4].copy_from_slice(&id.to_le_bytes());
    bytes[4] = Priority::Low as u8;
    write_stamp(&mut bytes, &Stamp { sequence, sent_ns: now_ns, ..Stamp::default() });
    bytes.extend_from_slice(&payload[..payload.len().min(MAX_BYTES - HEAD)]);
    bytes
}

/// A frame: length, message, and its tag on a connection that has proved a key.
pub(crate) fn frame(message: &[u8], half: Option<&mut Half>) -> Vec<u8> {
    let tag = half.map(|half| half.seal(message));
    let tag = tag.as_ref().map_or(&[][..], |tag| &tag[..]);
    [&((message.len() + tag.len()) as u32).to_le_bytes()[..], message, tag].concat()
}

/// The u32 in front, and the rest.
pub(crate) fn split_u32(bytes: &[u8]) -> Option<(u32, &[u8])> {
    let (number, rest) = bytes.split_first_chunk()?;
    Some((u32::from_le_bytes(*number), rest))
}

/// The u64 in front, and the rest.
pub(crate) fn split_u64(bytes: &[u8]) -> Option<(u64, &[u8])> {
    let (number, rest) = bytes.split_first_chunk()?;
    Some((u64::from_le_bytes(*number), rest))
}

/// Queues to the broker by priority class.
pub(crate) const PUBLISH: [&str; 3] = ["broker-high", "broker-normal", "broker-low"];
/// Queue to the broker for registration and verdicts.
pub(crate) const REGISTRATION: &str = "broker-service";
/// Wake-up of the queues to the broker.
pub(crate) const BROKER_BELL: &str = "broker-queues";

/// Queue from the broker to a client, and what it rings.
pub(crate) fn client_queue(name: &str) -> String {
    format!("client-{name}")
}

/// Bit n for domain n.
pub fn domain_mask(domains: &[Domain]) -> u32 {
    domains.iter().fold(0, |mask, d| mask | 1 << *d as u16)
}
