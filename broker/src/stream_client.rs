//! A blocking client of the broker on a stream, for everything outside of the run: command line, dashboard, joystick,
//! gateway, tests.

use std::collections::VecDeque;
use std::io::{Error, ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::time::Duration;

use messages::command::{Domain, Priority};
use messages::{Command, Stamp};
use realtime::clock::{SECOND, now};

use crate::awaited::PATIENCE;
use crate::doors::SOCKET;
use crate::keys::{Half, Key, NONCE, TAG, nonce, session};
use crate::message::{
    HEAD, MAX_BYTES, Message, SERVICE, VERSION, domain_mask, frame, schema, service, service_message,
    split_u32, split_u64, write_command,
};

/// Timeout for the broker's answer; a process that decides has less.
const ANSWER_TIME: Duration = Duration::from_nanos(PATIENCE);
/// Heartbeat of a client that only listens, and of one that holds the lease.
pub(crate) const PING_TIME: Duration = Duration::from_millis(100);
/// Silence of a client without the lease after which it is to give a heartbeat, to keep its connection \[ns\].
pub const IDLE: u64 = 20 * SECOND;

/// Operations common to Unix and TCP streams.
trait Stream: Read + Write + Send {
    fn set_timeouts(&self, read: Duration, write: Duration) -> Result<(), Error>;
}

impl Stream for UnixStream {
    fn set_timeouts(&self, read: Duration, write: Duration) -> Result<(), Error> {
        self.set_read_timeout(Some(read)).and_then(|()| self.set_write_timeout(Some(write)))
    }
}

impl Stream for TcpStream {
    fn set_timeouts(&self, read: Duration, write: Duration) -> Result<(), Error> {
        self.set_read_timeout(Some(read)).and_then(|()| self.set_write_timeout(Some(write)))
    }
}

/// Outcome of a command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Answer {
    /// Number of the command on its connection.
    pub sequence: u64,
    /// 0: accepted; otherwise the number of the reason, as in the protocol.
    pub code: u8,
    /// The process that accepted it, or the reason why not.
    pub text: String,
}

impl Answer {
    /// The process that accepted it.
    ///
    /// # Errors
    /// The reason of the refusal.
    pub fn accepted(self) -> Result<String, String> {
        if self.code == 0 { Ok(self.text) } else { Err(self.text) }
    }
}

/// Message from the broker.
#[derive(Clone, Debug, PartialEq)]
pub enum News {
    /// A command of a domain subscribed to.
    Command(Command),
    /// An answer.
    Answer(Answer),
    /// The command lease changed hands: number of the grant and holder; 0: nobody holds it.
    Lease(u32, String),
    /// A line of text.
    Line(String),
    /// The first answer.
    Welcome(Welcome),
    /// State of the robot: tick, messages that this client has lost, and the numbers of [`StreamClient::watch`]'s lines.
    State(u64, u32, Vec<f32>),
    /// Event that a process reported: tick, process and name of the event, and its detail.
    Event(u64, String, u64),
    /// Present value of a parameter that can be changed.
    Parameter(String, f64),
}

/// The broker's description of itself and of the connection.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Welcome {
    nonce: [u8; NONCE],
    /// Number of the connection.
    pub token: u32,
    /// Domains that it may command: bit n for domain n.
    pub may: u32,
}

/// A connection to the broker. It is closed after a minute in which this client neither sends nor
/// [receives](StreamClient::news); with it goes the command lease.
pub struct StreamClient {
    stream: Box<dyn Stream>,
    /// Bytes read, not yet a whole frame.
    partial: Vec<u8>,
    /// Messages received while waiting for an answer.
    waiting: VecDeque<News>,
    sequence: u64,
    /// Tags of frames to the broker and from it, once a key is proved.
    halves: Option<[Half; 2]>,
    /// Newest time of the broker and own time when it came, on a network: no clock is shared there.
    clock: Option<(u64, u64)>,
    /// Time of the last frame to the broker \[ns\].
    spoke: u64,
}

impl StreamClient {
    /// Connects to the broker of the run in `dir`, through its socket. `name`: who this is, for others.
    ///
    /// # Errors
    /// No broker runs there, or it is of another version.
    pub fn connect(dir: &Path, name: &str) -> Result<Self, String> {
        let path = dir.join(SOCKET);
        let stream = UnixStream::connect(&path).map_err(|e| match ipc::wrong_dir(dir) {
            Some(wrong) => wrong.to_string(),
            None => format!("no broker at {}: {e}; start one with `gangwerk run`", path.display()),
        })?;
        Self::begin(Box::new(stream), name, None, None)
    }

    /// Connects over TCP, with a key or as a stranger, who may stop the robot and on the loopback interface read.
    ///
    /// # Errors
    /// Nobody listens there, the key is not known, or the broker is of another version.
    pub fn connect_tcp(address: SocketAddr, name: &str, key: Option<&Key>) -> Result<Self, String> {
        let stream = TcpStream::connect(address)
            .map_err(|e| format!("no broker on {address}: {e}; start one with `gangwerk run`"))?;
        stream.set_nodelay(true).map_err(|e| e.to_string())?;
        // Nothing of the broker's time is known: the oldest that there is.
        Self::begin(Box::new(stream), name, key, Some((0, now())))
    }

    fn begin(
        stream: Box<dyn Stream>,
        name: &str,
        key: Option<&Key>,
        clock: Option<(u64, u64)>,
    ) -> Result<Self, String> {
        stream.set_timeouts(ANSWER_TIME, ANSWER_TIME).map_err(|e| e.to_string())?;
        let (partial, waiting) = (Vec::new(), VecDeque::new());
        let mut client = Self { stream, partial, waiting, sequence: 0, halves: None, clock, spoke: 0 };
        let own = nonce()?;
        let mut hello = VERSION.to_le_bytes().to_vec();
        hello.extend(schema().to_le_bytes());
        hello.extend(own);
        hello.extend(name.bytes());
        if let Some(key) = key {
            hello.push(0);
            hello.extend(key.name.bytes());
        }
        client.request(service::HELLO, &hello)?;
        let welcome = loop {
            match client.frame(ANSWER_TIME)? {
                Some(News::Welcome(welcome)) => break welcome,
                Some(News::Answer(answer)) => return Err(answer.text),
                Some(_) => {}
                None => return Err(silent()),
            }
        };
        if let Some(key) = key {
            let halves = session(key, &own, &welcome.nonce);
            let sequence = client.request(service::PROVE, &halves[0].proof())?;
            client.halves = Some(halves);
            // A refusal carries no tag, so it cannot be told from the answer of a wrong broker.
            let wrong = |_| format!("key {}: the key is not known, or the frame is not authentic", key.name);
            client.answer(sequence).map_err(wrong)?.accepted()?;
        }
        Ok(client)
    }

    /// The broker's time \[ns\]: on this machine everybody's; on a network the newest one heard and the own time since,
    /// which is never ahead of it.
    pub fn time(&self) -> u64 {
        self.clock.map_or_else(now, |(broker, at)| broker + now().saturating_sub(at))
    }

    /// Sends a command and waits for its answer.
    ///
    /// # Errors
    /// The reason of the refusal, or that the connection is lost.
    pub fn publish(&mut self, command: &Command) -> Result<String, String> {
        let sequence = self.send(command)?;
        self.answer(sequence)?.accepted()
    }

    /// Sends a command; its number.
    ///
    /// # Errors
    /// The connection is lost.
    pub fn send(&mut self, command: &Command) -> Result<u64, String> {
        self.send_as(command, command.priority())
    }

    /// The same with another priority; the broker refuses High for anything but an emergency stop.
    ///
    /// # Errors
    /// The connection is lost.
    pub fn send_as(&mut self, command: &Command, priority: Priority) -> Result<u64, String> {
        let (sequence, sent_ns) = (self.next(), self.time());
        let stamp = Stamp { sequence, sent_ns, ..Stamp::default() };
        let mut buffer = [0; MAX_BYTES];
        let bytes =
            write_command(command, priority, &stamp, &mut buffer).map_err(|e| e.to_string())?.to_vec();
        self.write(&bytes)?;
        Ok(sequence)
    }

    /// Waits for the answer to the frame `sequence`; what comes before it is kept.
    ///
    /// # Errors
    /// The connection is lost, or the broker silent.
    pub fn answer(&mut self, sequence: u64) -> Result<Answer, String> {
        let kept = |n: &News| matches!(n, News::Answer(a) if a.sequence == sequence);
        if let Some(at) = self.waiting.iter().position(kept)
            && let Some(News::Answer(answer)) = self.waiting.remove(at)
        {
            return Ok(answer);
        }
        loop {
            match self.frame(ANSWER_TIME)? {
                // A reason without a number: the connection ends.
                Some(News::Answer(answer)) if answer.sequence == 0 => return Err(answer.text),
                Some(News::Answer(answer)) if answer.sequence == sequence => return Ok(answer),
                Some(news) => self.waiting.push_back(news),
                None => return Err(silent()),
            }
        }
    }

    /// From now on commands of these domains come in, and no others.
    ///
    /// # Errors
    /// The connection may not read, or is lost.
    pub fn subscribe(&mut self, domains: &[Domain]) -> Result<(), String> {
        let sequence = self.request(service::SUBSCRIBE, &domain_mask(domains).to_le_bytes())?;
        self.answer(sequence)?.accepted().map(drop)
    }

    /// One line about the broker and one about each of its clients.
    ///
    /// # Errors
    /// The connection may not read, or is lost.
    pub fn statistics(&mut self) -> Result<Vec<String>, String> {
        self.lines(service::STATISTICS, &[])
    }

    /// Watches the robot: its present state at once, and from now on at `rate` \[1/s\] and with `events` what processes
    /// report. What a STATE holds, one number or array per line.
    ///
    /// # Errors
    /// The rate is too high, the connection may not read, or is lost.
    pub fn watch(&mut self, rate: u16, events: bool) -> Result<Vec<String>, String> {
        let [low, high] = rate.to_le_bytes();
        self.lines(service::WATCH, &[low, high, u8::from(events)])
    }

    fn lines(&mut self, id: u16, payload: &[u8]) -> Result<Vec<String>, String> {
        let sequence = self.request(id, payload)?;
        self.answer(sequence)?.accepted()?;
        let (lines, rest) = self.waiting.drain(..).partition(|n| matches!(n, News::Line(_)));
        self.waiting = rest;
        let lines: VecDeque<News> = lines;
        Ok(lines
            .into_iter()
            .filter_map(|n| if let News::Line(text) = n { Some(text) } else { None })
            .collect())
    }

    /// Takes the command lease; `over`: also from somebody who holds it. The first command that needs it does so, too.
    ///
    /// # Errors
    /// Somebody holds it, or the connection is lost.
    pub fn take_lease(&mut self, over: bool) -> Result<(), String> {
        let sequence = self.ask_lease(over)?;
        self.answer(sequence)?.accepted().map(drop)
    }

    /// The same without waiting: number of the request.
    ///
    /// # Errors
    /// The connection is lost.
    pub fn ask_lease(&mut self, over: bool) -> Result<u64, String> {
        self.request(service::TAKE_LEASE, &[u8::from(over)])
    }

    /// Gives the command lease back; number of the request.
    ///
    /// # Errors
    /// The connection is lost.
    pub fn give_lease(&mut self) -> Result<u64, String> {
        self.request(service::GIVE_LEASE, &[])
    }

    /// Gives the parameter `process.name` another value; number of the request, which the deciding process answers.
    ///
    /// # Errors
    /// The connection is lost.
    pub fn set(&mut self, name: &str, value: f64) -> Result<u64, String> {
        self.request(service::SET, &[&value.to_le_bytes()[..], name.as_bytes()].concat())
    }

    /// Heartbeat: keeps the lease for 500 ms more. Not answered.
    ///
    /// # Errors
    /// The connection is lost.
    pub fn ping(&mut self) -> Result<(), String> {
        self.request(service::PING, &[]).map(drop)
    }

    /// Heartbeat, unless something was sent within `pause` \[ns\]: whatever a client sends is one.
    ///
    /// # Errors
    /// The connection is lost.
    pub fn keep_alive(&mut self, pause: u64) -> Result<(), String> {
        if now() > self.spoke + pause { self.ping() } else { Ok(()) }
    }

    /// Next message; none if the timeout passes. Sends heartbeats meanwhile.
    ///
    /// # Errors
    /// The connection is lost, or the broker closes it for this reason.
    pub fn news(&mut self, timeout: Duration) -> Result<Option<News>, String> {
        if let Some(news) = self.waiting.pop_front() {
            return Ok(Some(news));
        }
        let mut left = timeout;
        loop {
            let wait = left.min(PING_TIME);
            match self.frame(wait)? {
                // A reason without a number: the connection ends.
                Some(News::Answer(answer)) if answer.sequence == 0 => return Err(answer.text),
                Some(news) => return Ok(Some(news)),
                None => {}
            }
            left -= wait;
            if left.is_zero() {
                return Ok(None);
            }
            self.ping()?;
        }
    }

    fn next(&mut self) -> u64 {
        self.sequence += 1;
        self.sequence
    }

    fn request(&mut self, id: u16, payload: &[u8]) -> Result<u64, String> {
        let (sequence, time) = (self.next(), self.time());
        self.write(&service_message(id, sequence, time, payload))?;
        Ok(sequence)
    }

    fn write(&mut self, message: &[u8]) -> Result<(), String> {
        let frame = frame(message, self.halves.as_mut().map(|[to_broker, _]| to_broker));
        match self.stream.write_all(&frame) {
            Ok(()) => {
                self.spoke = now();
                Ok(())
            }
            // The broker closed the connection; it may have said why.
            Err(e) => Err(match self.frame(ANSWER_TIME) {
                Ok(Some(News::Answer(answer))) if answer.code != 0 => answer.text,
                _ => format!("connection to the broker lost: {e}"),
            }),
        }
    }

    /// The next frame; none if it does not begin in time.
    fn frame(&mut self, timeout: Duration) -> Result<Option<News>, String> {
        let lost = |e: Error| format!("connection to the broker lost: {e}");
        self.stream.set_timeouts(timeout.max(Duration::from_millis(1)), ANSWER_TIME).map_err(lost)?;
        loop {
            if let Some((length, rest)) = split_u32(&self.partial) {
                let length = length as usize;
                if !(HEAD..=MAX_BYTES + TAG).contains(&length) {
                    return Err(format!(
                        "a frame of {length} bytes came: that is no broker of version {VERSION}"
                    ));
                }
                if rest.len() >= length {
                    let frame = rest[..length].to_vec();
                    self.partial.drain(..4 + length);
                    return self.interpret(&frame).map(Some);
                }
            }
            let mut chunk = [0; 4096];
            match self.stream.read(&mut chunk) {
                Ok(0) => return Err(lost(ErrorKind::UnexpectedEof.into())),
                Ok(n) => self.partial.extend_from_slice(&chunk[..n]),
                Err(e) if matches!(e.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => return Ok(None),
                Err(e) if e.kind() == ErrorKind::Interrupted => {}
                Err(e) => return Err(lost(e)),
            }
        }
    }

    fn interpret(&mut self, frame: &[u8]) -> Result<News, String> {
        // With a key, every frame ends with its tag: nothing is read before that is right.
        let mut bytes = frame;
        if let Some([_, from_broker]) = &mut self.halves {
            let (message, tag) = frame.split_at(frame.len().saturating_sub(TAG));
            if !from_broker.open(message, tag) {
                return Err(
                    "a frame came that is not authentic: this is not the broker that has the key".into()
                );
            }
            bytes = message;
        }
        let message = Message::parse(bytes).map_err(|e| e.to_string())?;
        if message.domain != SERVICE {
            return message.command().map(News::Command).map_err(|e| format!("the broker sent: {e}"));
        }
        let (sequence, payload) = (message.stamp.sequence, message.payload);
        // The broker's clock, for stamps by which it judges age: the latest one it sent, carried on by our own.
        if let Some(clock) = &mut self.clock
            && message.stamp.sent_ns > clock.0 + now().saturating_sub(clock.1)
        {
            *clock = (message.stamp.sent_ns, now());
        }
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        match (message.id, payload) {
            (service::ACCEPTED, name) => Ok(News::Answer(Answer { sequence, code: 0, text: text(name) })),
            (service::REFUSED, &[code, ref reason @ ..]) => {
                Ok(News::Answer(Answer { sequence, code, text: text(reason) }))
            }
            (service::LINE, line) => Ok(News::Line(text(line))),
            (service::LEASE, payload) => {
                let (grant, rest) = split_u32(payload).ok_or("a LEASE without its number came")?;
                Ok(News::Lease(grant, text(split_u64(rest).map_or(&[][..], |(_, name)| name))))
            }
            (service::STATE | service::EVENT | service::PARAMETER, payload) => seen(message.id, payload)
                .ok_or_else(|| format!("a message {} came that is too short", message.id)),
            (service::WELCOME, payload) => {
                welcome(payload).map(News::Welcome).ok_or_else(|| "a WELCOME came that is none".into())
            }
            (id, _) => {
                Err(format!("the broker answered with service {id}, which this version does not know"))
            }
        }
    }
}

/// STATE, EVENT or PARAMETER.
fn seen(id: u16, payload: &[u8]) -> Option<News> {
    let (first, rest) = split_u64(payload)?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Some(match id {
        service::STATE => {
            let (lost, numbers) = split_u32(rest)?;
            let numbers = numbers.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]));
            News::State(first, lost, numbers.collect())
        }
        service::EVENT => {
            let (detail, name) = split_u64(split_u32(rest)?.1)?;
            News::Event(first, text(name), detail)
        }
        _ => News::Parameter(text(rest), f64::from_bits(first)),
    })
}

fn welcome(payload: &[u8]) -> Option<Welcome> {
    let (_version, rest) = payload.split_first_chunk::<2>()?;
    let (_schema, rest) = split_u64(rest)?;
    let (nonce, rest) = rest.split_first_chunk::<NONCE>()?;
    let (token, rest) = split_u32(rest)?;
    Some(Welcome { nonce: *nonce, token, may: split_u32(rest)?.0 })
}

fn silent() -> String {
    format!("the broker has not answered for {} s", ANSWER_TIME.as_secs())
}
