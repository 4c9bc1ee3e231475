//! One connection over a stream, from its first byte to its end: `docs/protocol.md`.
//!
//! A frame is its length as u32, little endian, and then a message as in [`crate::message`]; on a connection that has
//! proved a key, a tag of 16 bytes follows, which the length counts. Every frame of a client but a heartbeat is
//! answered, with the number of the frame; commands are answered when the process that decides has decided.
//!
//! Limits: a frame must be complete [`FRAME_TIME`] after its first byte, the first one as soon after connecting; a
//! connection that says nothing for [`IDLE_TIME`] is closed. At most [`UNANSWERED`] frames are on their way, the next is
//! not read until one of them is answered. A client that does not read loses what it subscribed to first and its
//! connection after [`FRAME_TIME`]. At most [`Rights::rate`] messages per second are taken, emergency stops not counted; a
//! stop beyond them waits, and is not refused. Bytes that are no frame close their connection.

use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use messages::Command;
use messages::command::Domain;
use realtime::Bucket;
use realtime::clock::now;
use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite, AsyncWriteExt};
use tokio::sync::{Semaphore, mpsc, oneshot};
use tokio::time::{sleep, timeout};

use crate::exchange::FIRST_STREAM;
use crate::identity::identity;
use crate::inlet::{BrokerTable, Gate, Request};
use crate::keys::{self, Half, Key, NONCE, TAG};
use crate::log_gate::LogGate;
use crate::members::Outgoing;
use crate::message::{
    HEAD, MAX_BYTES, Message, SERVICE, VERSION, frame, schema, service, service_message, split_u32, split_u64,
};
use crate::refusal::Refusal;

/// A frame takes no longer than this, from its first byte to its last, to come and to be read by the other side.
pub const FRAME_TIME: Duration = Duration::from_secs(2);
/// Longest silence of a client.
pub const IDLE_TIME: Duration = Duration::from_secs(60);
/// Messages per second, and at once, of a connection that may command.
pub const RATE: u64 = 2000;
/// Frames of one connection that are not answered yet.
pub const UNANSWERED: usize = 64;
/// Most states of the robot per second that a client gets; the broker looks a hundred times a second.
pub(crate) const MAX_RATE: u16 = 50;
/// Frames that wait for one client, answers not counted.
const WAITING: usize = 128;
/// Time for which the rest of a closed connection is read.
const FAREWELL: Duration = Duration::from_millis(200);
/// Longest name of a client \[B\].
const NAME: usize = 64;

/// Rights of a connection before it shows a key.
#[derive(Clone, Debug)]
pub struct Rights {
    /// Identity, for the log and for others that want the lease.
    pub peer: String,
    /// Domains that it may command: bit n for domain n. Whatever they are, it may stop the robot.
    pub may: u32,
    /// Whether it may subscribe and ask.
    pub reads: bool,
    /// One place too many: it is heard for a stop and what clients say before one, and for nothing else.
    pub only_stops: bool,
    /// Messages per second, and as many at once.
    pub rate: u64,
    /// Keys that it may show.
    pub keys: Arc<Vec<Key>>,
}

/// One connection. The broker hears of its end whatever ends it.
struct Session {
    gate: Gate,
    token: u32,
    rights: Rights,
    out: Outgoing,
    permits: Arc<Semaphore>,
    joined: bool,
    bucket: Bucket,
    /// Name and key that the client has claimed, both nonces: until it proves the key.
    claimed: Option<(String, Key, [Half; 2])>,
    /// True once it has proved a key.
    proven: Arc<AtomicBool>,
    incoming: Option<Half>,
    outgoing: Arc<OnceLock<Half>>,
}

impl Drop for Session {
    fn drop(&mut self) {
        if self.joined {
            self.gate.ask(Request::Leave { token: self.token });
        }
    }
}

/// Serves a client until it closes the connection, or must be closed; then why, for the log.
pub async fn serve(
    read: impl AsyncRead + Unpin,
    write: impl AsyncWrite + Unpin,
    gate: Gate,
    token: u32,
    rights: Rights,
) -> Result<(), Refusal> {
    serve_at_door(read, write, gate, token, rights, Arc::default()).await
}

/// The same for a door, which keeps the place of who has `proven` a key.
pub(crate) async fn serve_at_door(
    mut read: impl AsyncRead + Unpin,
    write: impl AsyncWrite + Unpin,
    gate: Gate,
    token: u32,
    rights: Rights,
    proven: Arc<AtomicBool>,
) -> Result<(), Refusal> {
    let (answers, given) = mpsc::unbounded_channel();
    let (frames, subscribed) = mpsc::channel(WAITING);
    let out = Outgoing { answers, frames };
    let permits = Arc::new(Semaphore::new(UNANSWERED));
    let (incoming, outgoing) = (None, Arc::new(OnceLock::new()));
    let mut speaking = std::pin::pin!(speak(write, given, subscribed, permits.clone(), outgoing.clone()));
    let bucket = Bucket::full(rights.rate, rights.rate);
    let mut session = Session {
        bucket,
        gate,
        token,
        rights,
        out,
        permits,
        joined: false,
        claimed: None,
        proven,
        incoming,
        outgoing,
    };
    let end = tokio::select! {
        end = session.listen(&mut read) => end,
        () = &mut speaking => return Err(Refusal::TimedOut("the reading of an answer")),
    };
    // Whoever closes the link loses the lease at once; but who only stops writing reads the answers to the end.
    if session.joined {
        session.gate.ask(Request::Closing { token });
    }
    tokio::select! {
        _ = timeout(FRAME_TIME, session.permits.acquire_many(UNANSWERED as u32)) => {}
        () = &mut speaking => return end,
    }
    if let Err(refusal) = &end {
        let _ = session.out.answers.send(refusal.to_message(0, now()));
    }
    drop(session);
    // The reason goes last, and the rest of the input is read, or the system would throw both away.
    let _ = timeout(FRAME_TIME, speaking).await;
    if end.is_err() {
        let _ = timeout(FAREWELL, tokio::io::copy(&mut read.take(1 << 16), &mut tokio::io::sink())).await;
    }
    end
}

/// Writes frames, answers first, until there will be no more, or the other side does not read.
async fn speak(
    mut write: impl AsyncWrite + Unpin,
    mut answers: mpsc::UnboundedReceiver<Vec<u8>>,
    mut frames: mpsc::Receiver<Vec<u8>>,
    permits: Arc<Semaphore>,
    seal: Arc<OnceLock<Half>>,
) {
    let mut half: Option<Half> = None;
    loop {
        let message = tokio::select! {
            biased;
            Some(answer) = answers.recv() => answer,
            Some(frame) = frames.recv() => frame,
            else => break,
        };
        if half.is_none() {
            half = seal.get().cloned();
        }
        let frame = frame(&message, half.as_mut());
        if !matches!(timeout(FRAME_TIME, write.write_all(&frame)).await, Ok(Ok(()))) {
            return;
        }
        let answer = Message::parse(&message)
            .is_ok_and(|m| m.domain == SERVICE && matches!(m.id, service::ACCEPTED | service::REFUSED));
        // A reason without a number ends the connection, and answers no frame.
        if answer && Message::parse(&message).is_ok_and(|m| m.stamp.sequence != 0) {
            permits.add_permits(1);
        }
    }
    let _ = write.shutdown().await;
}

impl Session {
    /// Takes frames until the client closes the connection, or must be closed.
    async fn listen(&mut self, read: &mut (impl AsyncRead + Unpin)) -> Result<(), Refusal> {
        let mut buffer = [0; MAX_BYTES + TAG];
        let mut patience = FRAME_TIME;
        while let Some(bytes) = read_frame(read, &mut buffer, patience).await? {
            let bytes = self.authentic(bytes)?;
            let message = Message::parse(bytes)?;
            let urgent = message.command() == Ok(Command::EmergencyStop);
            let stops = urgent || message.command() == Ok(Command::Stop);
            if self.rights.only_stops && !stops && !comes_before_a_stop(&message) {
                return Err(Refusal::TooManyConnections("of this user or address"));
            }
            if stops && !urgent {
                self.hold_back().await;
            }
            let taken = stops || self.bucket.take(now());
            self.take(&message, bytes, taken).await?;
            if self.joined {
                patience = IDLE_TIME;
            }
        }
        Ok(())
    }

    /// Takes from the ration what must not be refused. Beyond it this connection waits, so that a flood of stops is no quicker
    /// than any other.
    async fn hold_back(&mut self) {
        let wait = Duration::from_nanos(self.bucket.owe(now()));
        if !wait.is_zero() {
            sleep(wait).await;
        }
    }

    /// The message of a frame, without its tag.
    fn authentic<'a>(&mut self, frame: &'a [u8]) -> Result<&'a [u8], Refusal> {
        let Some(half) = &mut self.incoming else {
            if frame.len() > MAX_BYTES {
                return Err(Refusal::Malformed(length(frame.len())));
            }
            return Ok(frame);
        };
        let (message, tag) = frame.split_last_chunk::<TAG>().ok_or(Refusal::NotAuthentic)?;
        if half.open(message, tag) { Ok(message) } else { Err(Refusal::NotAuthentic) }
    }

    /// One message; `taken`: it is within the connection's ration.
    async fn take(&mut self, message: &Message<'_>, bytes: &[u8], taken: bool) -> Result<(), Refusal> {
        let sequence = message.stamp.sequence;
        let is_service = |id| message.domain == SERVICE && message.id == id;
        if is_service(service::PING) {
            if taken {
                self.gate.ask(Request::Alive { token: self.token, sent_ns: message.stamp.sent_ns });
            }
            return Ok(());
        }
        if sequence == 0 {
            return Err(Refusal::Malformed("sequence 0, numbers begin with 1".into()));
        }
        if is_service(service::HELLO) {
            return self.hello(message).await;
        }
        // Given back when the answer has gone out.
        self.permits.acquire().await.map_err(|_| Refusal::TimedOut("an answer"))?.forget();
        let done = if !taken {
            Err(Refusal::Busy(format!("more than {} messages per second", self.rights.rate)))
        } else if message.domain == SERVICE {
            self.serve_request(message).await
        } else {
            self.publish(message, bytes).await
        };
        match done {
            Err(refusal) if refusal.is_final() => {
                self.permits.add_permits(1);
                Err(refusal)
            }
            Err(refusal) => {
                let _ = self.out.answers.send(refusal.to_message(sequence, now()));
                Ok(())
            }
            Ok(()) => Ok(()),
        }
    }

    async fn publish(&mut self, message: &Message<'_>, bytes: &[u8]) -> Result<(), Refusal> {
        if !self.joined {
            // A stop is accepted before HELLO.
            let stops = message.command().is_ok_and(|c| matches!(c, Command::EmergencyStop | Command::Stop));
            if !stops {
                return Err(Refusal::NoAccess("the first frame of a connection is HELLO".into()));
            }
            self.join(String::new(), 0).await?;
        }
        self.gate.publish(self.token, message.priority, bytes);
        Ok(())
    }

    /// Identity of the client, and the check that both sides mean the same by the same bytes.
    async fn hello(&mut self, message: &Message<'_>) -> Result<(), Refusal> {
        let malformed = || Refusal::Malformed("a HELLO without version, schema and nonce".into());
        let (version, rest) = message.payload.split_first_chunk::<2>().ok_or_else(malformed)?;
        let (theirs, rest) = split_u64(rest).ok_or_else(malformed)?;
        let (nonce, names) = rest.split_first_chunk::<NONCE>().ok_or_else(malformed)?;
        let (version, schema) = (u16::from_le_bytes(*version), schema());
        // 0: the client learns the table of commands from the broker.
        if version != VERSION || theirs != 0 && theirs != schema {
            return Err(Refusal::Version { client: (version, theirs), schema });
        }
        if self.joined || self.claimed.is_some() {
            return Err(Refusal::Malformed("a second HELLO".into()));
        }
        let text = String::from_utf8_lossy(names);
        let (name, key) = text.split_once('\0').unwrap_or((&text, ""));
        let name: String = name.chars().filter(|c| !c.is_control()).take(NAME).collect();
        let own = keys::nonce().map_err(Refusal::Malformed)?;
        let (claims, mut may) = (!key.is_empty(), self.granted(self.rights.may));
        if claims {
            let key = self.rights.keys.iter().find(|k| k.name == key).ok_or(Refusal::NotAuthentic)?;
            may = self.granted(key.may);
            self.claimed = Some((name, key.clone(), keys::session(key, nonce, &own)));
        } else {
            self.join(name, may).await?;
        }
        let mut payload = VERSION.to_le_bytes().to_vec();
        payload.extend(schema.to_le_bytes());
        payload.extend(own);
        payload.extend(self.token.to_le_bytes());
        payload.extend(may.to_le_bytes());
        payload.push(u8::from(claims));
        let welcome = service_message(service::WELCOME, message.stamp.sequence, now(), &payload);
        let _ = self.out.answers.send(welcome);
        Ok(())
    }

    async fn prove(&mut self, message: &Message<'_>) -> Result<(), Refusal> {
        let (name, key, [to_broker, to_client]) = self.claimed.take().ok_or(Refusal::NotAuthentic)?;
        if !to_broker.proves(message.payload) {
            return Err(Refusal::NotAuthentic);
        }
        self.rights.reads = true;
        self.bucket.change_rate(RATE, now());
        self.proven.store(true, Relaxed);
        // From here on both directions carry tags: also what the broker sends to whoever joins.
        self.incoming = Some(to_broker);
        let _ = self.outgoing.set(to_client);
        self.join(format!("{name} with key {}", key.name), self.granted(key.may)).await?;
        let accepted = service_message(service::ACCEPTED, message.stamp.sequence, now(), &[]);
        let _ = self.out.answers.send(accepted);
        Ok(())
    }

    /// Domains that this connection may command of those that it has the right to.
    const fn granted(&self, may: u32) -> u32 {
        if self.rights.only_stops { 0 } else { may }
    }

    /// The broker knows the client from here on.
    async fn join(&mut self, name: String, may: u32) -> Result<(), Refusal> {
        let (done, joined) = oneshot::channel();
        let (token, peer) = (self.token, &self.rights.peer);
        let name = identity(&name, peer);
        self.gate.ask(Request::Join { token, name, may, out: self.out.clone(), done });
        match timeout(FRAME_TIME, joined).await {
            Ok(Ok(())) => self.joined = true,
            _ => return Err(Refusal::TimedOut("the broker's own answer")),
        }
        Ok(())
    }

    /// Request to the broker itself in one frame.
    async fn serve_request(&mut self, message: &Message<'_>) -> Result<(), Refusal> {
        let (token, sequence) = (self.token, message.stamp.sequence);
        // Before HELLO and without the right to read, nothing but a proof of the key is served.
        if message.id == service::PROVE {
            return self.prove(message).await;
        }
        if !self.joined {
            return Err(Refusal::NoAccess("the first frame of a connection is HELLO".into()));
        }
        if !self.rights.reads {
            return Err(Refusal::NoAccess("this connection may only stop the robot; show a key".into()));
        }
        // The frame only becomes a request here; the thread that owns clients and lease answers it.
        let sent_ns = message.stamp.sent_ns;
        self.gate.ask(match message.id {
            service::SUBSCRIBE => {
                let Some((domains, [])) =
                    split_u32(message.payload).filter(|(d, _)| d >> Domain::ALL.len() == 0)
                else {
                    return Err(Refusal::Malformed("a subscription to domains that there are not".into()));
                };
                Request::Subscribe { token, sequence, domains }
            }
            service::STATISTICS => Request::Lines { token, sequence, table: BrokerTable::Statistics },
            service::DESCRIBE => Request::Lines { token, sequence, table: BrokerTable::Commands },
            service::PARAMETERS => Request::Lines { token, sequence, table: BrokerTable::Parameters },
            service::WATCH => {
                let &[low, high, events @ (0 | 1)] = message.payload else {
                    return Err(Refusal::Malformed("a WATCH without rate and events".into()));
                };
                let rate = u16::from_le_bytes([low, high]);
                if rate > MAX_RATE {
                    return Err(Refusal::OutOfRange(format!("rate = {rate} /s: at most {MAX_RATE}")));
                }
                Request::Watch { token, sequence, rate, events: events == 1 }
            }
            service::SET => {
                let Some((value, name)) = message.payload.split_first_chunk() else {
                    return Err(Refusal::Malformed("a SET without a value".into()));
                };
                let text = String::from_utf8_lossy(name);
                let name = text.chars().filter(|c| !c.is_control()).take(NAME).collect();
                Request::Set { token, sequence, sent_ns, value: f64::from_le_bytes(*value), name }
            }
            service::TAKE_LEASE => {
                let over = message.payload == [1];
                Request::TakeLease { token, sequence, sent_ns, over }
            }
            service::GIVE_LEASE => Request::GiveLease { token, sequence },
            id => return Err(Refusal::Malformed(format!("service {id}, which a client cannot ask for"))),
        });
        Ok(())
    }
}

/// Frames that clients send before a stop: they are answered even beyond the places.
fn comes_before_a_stop(message: &Message<'_>) -> bool {
    let harmless = [service::HELLO, service::PROVE, service::PING, service::SUBSCRIBE, service::DESCRIBE];
    message.domain == SERVICE && harmless.contains(&message.id)
}

/// One frame, or none if the client closed the connection between two frames.
async fn read_frame<'a>(
    read: &mut (impl AsyncRead + Unpin),
    buffer: &'a mut [u8; MAX_BYTES + TAG],
    patience: Duration,
) -> Result<Option<&'a [u8]>, Refusal> {
    let mut head = [0; 4];
    match timeout(patience, read.read(&mut head[..1])).await {
        Err(_) => return Err(Refusal::TimedOut("a frame")),
        Ok(Ok(0) | Err(_)) => return Ok(None),
        Ok(Ok(_)) => {}
    }
    let rest = async {
        let cut = |_| Refusal::Malformed("the connection ended inside a frame".into());
        read.read_exact(&mut head[1..]).await.map_err(cut)?;
        let bytes = u32::from_le_bytes(head) as usize;
        if !(HEAD..=MAX_BYTES + TAG).contains(&bytes) {
            return Err(Refusal::Malformed(length(bytes)));
        }
        let bytes = &mut buffer[..bytes];
        read.read_exact(bytes).await.map_err(cut)?;
        Ok(&*bytes)
    };
    timeout(FRAME_TIME, rest).await.map_err(|_| Refusal::TimedOut("the rest of a frame"))?.map(Some)
}

fn length(bytes: usize) -> String {
    format!("length {bytes}, a frame has {HEAD} to {MAX_BYTES} bytes")
}

/// Writes why a connection was closed, unless there are too many such lines.
pub(crate) fn log_end(log: &mut LogGate, token: u32, peer: &str, refusal: &Refusal) {
    if let Some(folded) = log.admit(now()) {
        let connection = token - FIRST_STREAM;
        tracing::warn!(code = refusal.code(), connection, folded, "connection closed: {peer}: {refusal}");
    }
}

#[cfg(test)]
#[path = "connection_tests.rs"]
mod tests;
