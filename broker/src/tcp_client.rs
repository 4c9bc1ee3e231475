//! A blocking client of the broker's TCP port, for the command line and for tests.

use std::collections::VecDeque;
use std::io::{Error, ErrorKind, Read, Write};
use std::net::{Ipv4Addr, TcpStream};
use std::time::Duration;

use messages::Command;
use messages::command::{Domain, Priority};

use crate::message::{
    HEAD, MAX_BYTES, Message, SERVICE, domain_mask, service, service_message, split_u32, write_command,
};

/// How long the broker may take for an answer.
const ANSWER_TIME: Duration = Duration::from_secs(3);
/// A client that only listens gives a sign of life this often.
const PING_TIME: Duration = Duration::from_secs(20);

/// A connection to the broker, which closes it after a minute in which this client neither sends nor
/// [receives](TcpClient::receive).
#[derive(Debug)]
pub struct TcpClient {
    stream: TcpStream,
    /// Bytes read, not yet a whole frame.
    partial: Vec<u8>,
    /// Commands that came while an answer was waited for.
    received: VecDeque<Command>,
}

/// What the broker sent.
enum Frame {
    Command(Command),
    Accepted(u32),
    Refused(String),
    Line(String),
}

impl TcpClient {
    /// Connects to the broker on this machine.
    ///
    /// # Errors
    /// Nobody listens on the port.
    pub fn connect(port: u16) -> Result<Self, String> {
        let stream = TcpStream::connect((Ipv4Addr::LOCALHOST, port))
            .map_err(|e| format!("no broker on 127.0.0.1:{port}: {e}; start one with `gangwerk run`"))?;
        let set = stream.set_nodelay(true).and_then(|()| stream.set_write_timeout(Some(ANSWER_TIME)));
        set.map_err(|e| e.to_string())?;
        Ok(Self { stream, partial: Vec::new(), received: VecDeque::new() })
    }

    /// Publishes a command and waits until the broker has forwarded it; returns to how many clients.
    ///
    /// # Errors
    /// The broker's reason to refuse it, or that the connection is lost.
    pub fn publish(&mut self, command: &Command) -> Result<u32, String> {
        self.publish_as(command, command.priority())
    }

    /// The same with another priority; the broker refuses High for anything but an emergency stop.
    pub fn publish_as(&mut self, command: &Command, priority: Priority) -> Result<u32, String> {
        let mut buffer = [0; MAX_BYTES];
        let bytes = write_command(command, priority, 0, &mut buffer).map_err(|e| e.to_string())?;
        self.send(&bytes[4..])?;
        self.answer(&mut Vec::new())
    }

    /// From now on commands of these domains come in, and no others.
    pub fn subscribe(&mut self, domains: &[Domain]) -> Result<(), String> {
        self.send(&service_message(service::SUBSCRIBE, &domain_mask(domains).to_le_bytes()))?;
        self.answer(&mut Vec::new()).map(drop)
    }

    /// One line about the broker and one about each of its clients.
    pub fn statistics(&mut self) -> Result<Vec<String>, String> {
        self.send(&service_message(service::STATISTICS, &[]))?;
        let mut lines = Vec::new();
        self.answer(&mut lines)?;
        Ok(lines)
    }

    /// The next command of the subscribed domains; none if there is none in this time, which may be hours.
    ///
    /// # Errors
    /// The connection is lost.
    pub fn receive(&mut self, timeout: Duration) -> Result<Option<Command>, String> {
        let mut left = timeout;
        loop {
            if let Some(command) = self.received.pop_front() {
                return Ok(Some(command));
            }
            let wait = left.min(PING_TIME);
            match self.frame(wait)? {
                Some(Frame::Command(command)) => return Ok(Some(command)),
                Some(Frame::Refused(reason)) => return Err(reason),
                Some(_) => {}
                None if left <= PING_TIME => return Ok(None),
                None => {
                    left -= wait;
                    self.send(&service_message(service::PING, &[]))?;
                    self.answer(&mut Vec::new())?;
                }
            }
        }
    }

    fn send(&mut self, message: &[u8]) -> Result<(), String> {
        let mut frame = (message.len() as u32).to_le_bytes().to_vec();
        frame.extend_from_slice(message);
        match self.stream.write_all(&frame) {
            Ok(()) => Ok(()),
            // The broker closed the connection; it may have said why.
            Err(e) => Err(match self.frame(ANSWER_TIME) {
                Ok(Some(Frame::Refused(reason))) => reason,
                _ => format!("connection to the broker lost: {e}"),
            }),
        }
    }

    /// Waits for the answer to the last frame; commands that come before it are kept.
    fn answer(&mut self, lines: &mut Vec<String>) -> Result<u32, String> {
        loop {
            match self.frame(ANSWER_TIME)? {
                Some(Frame::Accepted(receivers)) => return Ok(receivers),
                Some(Frame::Refused(reason)) => return Err(reason),
                Some(Frame::Line(line)) => lines.push(line),
                Some(Frame::Command(command)) => self.received.push_back(command),
                None => return Err(format!("the broker has not answered for {} s", ANSWER_TIME.as_secs())),
            }
        }
    }

    /// The next frame; none if it does not begin in time.
    fn frame(&mut self, timeout: Duration) -> Result<Option<Frame>, String> {
        let lost = |e: Error| format!("connection to the broker lost: {e}");
        self.stream.set_read_timeout(Some(timeout.max(Duration::from_millis(1)))).map_err(lost)?;
        loop {
            if let Some((length, rest)) = split_u32(&self.partial) {
                let length = length as usize;
                if !(HEAD..=MAX_BYTES).contains(&length) {
                    return Err(format!("a frame of {length} bytes came: that is no broker of this version"));
                }
                if rest.len() >= length {
                    let frame = interpret(&rest[..length])?;
                    self.partial.drain(..4 + length);
                    return Ok(Some(frame));
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
}

fn interpret(bytes: &[u8]) -> Result<Frame, String> {
    let message = Message::parse(bytes).map_err(|e| e.to_string())?;
    if message.domain != SERVICE {
        return message.command().map(Frame::Command).map_err(|e| format!("the broker sent: {e}"));
    }
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    match (message.id, message.payload) {
        (service::ACCEPTED, payload) => Ok(Frame::Accepted(split_u32(payload).map_or(0, |(n, _)| n))),
        (service::REFUSED, [_code, reason @ ..]) => Ok(Frame::Refused(text(reason))),
        (service::LINE, line) => Ok(Frame::Line(text(line))),
        (id, _) => Err(format!("the broker answered with service {id}, which this version does not know")),
    }
}
