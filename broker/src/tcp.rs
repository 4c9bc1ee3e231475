//! TCP on the loopback interface: the same messages for programs that do not share memory with the broker.
//!
//! A frame is its length as u32, little endian, and then a message as in [`crate::message`], 5 to 512 bytes. Every
//! frame of a client is answered by one frame of the domain `SERVICE` (accepted or refused), in order; commands of the
//! domains that it subscribed to come in between.
//!
//! Limits: [`CONNECTIONS`] connections; beyond them a few more are heard for an emergency stop and nothing else. A frame
//! must be complete [`FRAME_TIME`] after its first byte, the first one as soon after connecting; a connection that says
//! nothing for [`IDLE_TIME`] is closed (a client that only listens sends PING). A client that does not read loses its
//! messages first and its connection after [`FRAME_TIME`]. At most [`RATE`] messages per second are taken from one
//! connection, emergency stops not counted. Bytes that are no frame close their connection, with one line in the log.

use std::collections::VecDeque;
use std::net::{Ipv4Addr, TcpListener};
use std::sync::Arc;
use std::sync::mpsc as queue;
use std::time::Duration;

use messages::Command;
use messages::command::{Domain, Priority};
use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::sync::{Semaphore, mpsc, oneshot};
use tokio::task::AbortHandle;
use tokio::time::{Instant, timeout};

use crate::message::{HEAD, MAX_BYTES, Message, Refusal, SERVICE, service, service_message, split_u32};

/// Connections at once.
pub const CONNECTIONS: usize = 32;
/// Connections beyond them that are heard for an emergency stop; one more closes the oldest of them.
pub const RESERVE: usize = 8;
/// A frame takes no longer than this, from its first byte to its last, to come and to be read by the other side.
pub const FRAME_TIME: Duration = Duration::from_secs(2);
/// Longest silence of a client.
pub const IDLE_TIME: Duration = Duration::from_secs(60);
/// Messages per second from one connection, and as many at once.
pub const RATE: f64 = 500.0;
/// Tokens of TCP connections begin here.
pub const FIRST_TOKEN: u32 = 0x8000_0000;
/// Frames that wait for one client.
const WAITING: usize = 128;
/// How long the rest of what a closed connection sent is read.
const FAREWELL: Duration = Duration::from_millis(200);

/// A command's way into the broker: number of the connection, message, and where the answer goes.
pub type Publication = (u32, Vec<u8>, oneshot::Sender<Result<u32, Refusal>>);

/// What else a connection asks of the broker.
pub enum Request {
    /// Sets the domains of a client.
    Subscribe {
        /// Number of the connection.
        token: u32,
        /// Bit n for domain n.
        domains: u32,
        /// Way to the client.
        frames: mpsc::Sender<Vec<u8>>,
        /// Told when it is done.
        answer: oneshot::Sender<()>,
    },
    /// Asks for statistics.
    Statistics {
        /// Told the lines.
        answer: oneshot::Sender<Vec<String>>,
    },
    /// The connection is closed.
    Leave {
        /// Its number.
        token: u32,
    },
}

/// Where the broker finds what connections hand in. A connection waits for the answer to one thing before it hands in
/// the next, so these queues hold no more than there are connections.
pub struct Inlet {
    /// Commands by class.
    pub publish: [queue::Receiver<Publication>; 3],
    /// Everything else.
    pub requests: queue::Receiver<Request>,
}

/// The other end, for the connections.
#[derive(Clone)]
pub struct Gate {
    publish: [queue::Sender<Publication>; 3],
    requests: queue::Sender<Request>,
}

/// A gate to the broker and its inlet.
pub fn gate() -> (Gate, Inlet) {
    let [(high, h), (normal, n), (low, l)] = [(); 3].map(|()| queue::channel());
    let (requests, asked) = queue::channel();
    (Gate { publish: [high, normal, low], requests }, Inlet { publish: [h, n, l], requests: asked })
}

impl Gate {
    async fn publish(&self, token: u32, priority: Priority, bytes: &[u8]) -> Result<u32, Refusal> {
        let (answer, answered) = oneshot::channel();
        let _ = self.publish[priority as usize].send((token, bytes.to_vec(), answer));
        in_time(answered).await?
    }

    async fn ask<T>(&self, request: impl FnOnce(oneshot::Sender<T>) -> Request) -> Result<T, Refusal> {
        let (answer, answered) = oneshot::channel();
        let _ = self.requests.send(request(answer));
        in_time(answered).await
    }
}

async fn in_time<T>(answered: oneshot::Receiver<T>) -> Result<T, Refusal> {
    match timeout(FRAME_TIME, answered).await {
        Ok(Ok(answer)) => Ok(answer),
        _ => Err(Refusal::Busy),
    }
}

/// Listens on the loopback interface and on no other; port 0 lets the system choose one.
///
/// # Errors
/// The port is taken.
pub fn bind(port: u16) -> Result<TcpListener, String> {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(|e| {
        format!("cannot listen on 127.0.0.1:{port}: {e}; is another run active? Choose another tcp_port in system.toml")
    })?;
    listener.set_nonblocking(true).map_err(|e| e.to_string())?;
    Ok(listener)
}

/// Serves connections until the process ends, in a thread of its own.
///
/// # Errors
/// The thread or its run-time cannot be made.
pub fn serve(listener: TcpListener, gate: Gate) -> Result<(), String> {
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .map_err(|e| format!("cannot make the run-time of the TCP server: {e}"))?;
    let accept = move || {
        runtime.block_on(async move {
            match tokio::net::TcpListener::from_std(listener) {
                Ok(listener) => accept(listener, gate).await,
                Err(e) => tracing::error!("no TCP connections: {e}"),
            }
        });
    };
    std::thread::Builder::new()
        .name("tcp".into())
        .spawn(accept)
        .map_err(|e| format!("no thread for TCP: {e}"))?;
    Ok(())
}

async fn accept(listener: tokio::net::TcpListener, gate: Gate) {
    let places = Arc::new(Semaphore::new(CONNECTIONS));
    let mut reserve: VecDeque<AbortHandle> = VecDeque::new();
    let mut token = FIRST_TOKEN;
    loop {
        let stream = match listener.accept().await {
            Ok((stream, _)) => stream,
            Err(e) => {
                tracing::warn!("cannot accept a TCP connection: {e}");
                tokio::time::sleep(Duration::from_millis(100)).await;
                continue;
            }
        };
        let gate = gate.clone();
        if let Ok(place) = places.clone().try_acquire_owned() {
            tokio::spawn(async move {
                connection(stream, gate, token, Entry::Full).await;
                drop(place);
            });
        } else {
            reserve.retain(|task| !task.is_finished());
            if reserve.len() >= RESERVE {
                reserve.pop_front().inspect(AbortHandle::abort);
                tracing::warn!(code = Refusal::TooManyConnections.code(), "{}", Refusal::TooManyConnections);
            }
            reserve.push_back(
                tokio::spawn(connection(stream, gate, token, Entry::EmergencyStop)).abort_handle(),
            );
        }
        token = token.checked_add(1).unwrap_or(FIRST_TOKEN);
    }
}

/// What a connection may do.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Entry {
    Full,
    EmergencyStop,
}

/// One connection, from its first byte to its end.
async fn connection(stream: TcpStream, gate: Gate, token: u32, entry: Entry) {
    let _ = stream.set_nodelay(true);
    let (mut read, write) = stream.into_split();
    let (frames, outgoing) = mpsc::channel(WAITING);
    let mut speaking = std::pin::pin!(speak(write, outgoing));
    let session = Session { gate: &gate, token, entry, frames: &frames };
    let end = tokio::select! {
        end = listen(&mut read, &session) => Some(end),
        () = &mut speaking => None,
    };
    let _ = gate.requests.send(Request::Leave { token });
    let Some(end) = end else { return log_end(token, &Refusal::TimedOut("the reading of an answer")) };
    if let Err(refusal) = &end {
        log_end(token, refusal);
        let _ = frames.try_send(refusal.to_message());
    }
    // What waits goes first, then the reason. The rest of the input is read, or the system would throw both away.
    drop(frames);
    let _ = timeout(FRAME_TIME, speaking).await;
    if end.is_err() {
        let _ = timeout(FAREWELL, tokio::io::copy(&mut read.take(1 << 16), &mut tokio::io::sink())).await;
    }
}

fn log_end(token: u32, refusal: &Refusal) {
    tracing::warn!(code = refusal.code(), connection = token - FIRST_TOKEN, "connection closed: {refusal}");
}

/// Writes frames until there will be no more, or the other side does not read.
async fn speak(mut write: impl AsyncWrite + Unpin, mut outgoing: mpsc::Receiver<Vec<u8>>) {
    while let Some(message) = outgoing.recv().await {
        let mut frame = (message.len() as u32).to_le_bytes().to_vec();
        frame.extend(message);
        if !matches!(timeout(FRAME_TIME, write.write_all(&frame)).await, Ok(Ok(()))) {
            return;
        }
    }
    let _ = write.shutdown().await;
}

/// What is needed to serve one client.
struct Session<'a> {
    gate: &'a Gate,
    token: u32,
    entry: Entry,
    frames: &'a mpsc::Sender<Vec<u8>>,
}

/// Takes frames until the client closes the connection, or must be closed.
async fn listen(read: &mut (impl AsyncRead + Unpin), session: &Session<'_>) -> Result<(), Refusal> {
    let mut buffer = [0; MAX_BYTES];
    let mut patience = FRAME_TIME;
    let mut bucket = Bucket { level: RATE, at: Instant::now() };
    while let Some(bytes) = read_frame(read, &mut buffer, patience).await? {
        let message = Message::parse(bytes)?;
        let urgent = message.command() == Ok(Command::EmergencyStop);
        if session.entry == Entry::EmergencyStop && !urgent {
            return Err(Refusal::TooManyConnections);
        }
        let answer =
            if urgent || bucket.take() { session.handle(&message, bytes).await } else { Err(Refusal::Busy) };
        let answer = match answer {
            Err(refusal) if refusal.is_final() => return Err(refusal),
            Err(refusal) => refusal.to_message(),
            Ok(receivers) => service_message(service::ACCEPTED, &receivers.to_le_bytes()),
        };
        let _ = session.frames.send(answer).await;
        if session.entry == Entry::Full {
            patience = IDLE_TIME;
        }
    }
    Ok(())
}

impl Session<'_> {
    /// Does what one frame asks for; returns to how many clients it went.
    async fn handle(&self, message: &Message<'_>, bytes: &[u8]) -> Result<u32, Refusal> {
        let &Self { gate, token, frames, .. } = self;
        if message.domain != SERVICE {
            return gate.publish(token, message.priority, bytes).await;
        }
        match message.id {
            service::SUBSCRIBE => {
                let Some((domains, [])) =
                    split_u32(message.payload).filter(|(d, _)| d >> Domain::ALL.len() == 0)
                else {
                    return Err(Refusal::Malformed("a subscription to domains that there are not".into()));
                };
                let frames = frames.clone();
                gate.ask(|answer| Request::Subscribe { token, domains, frames, answer }).await?;
            }
            service::STATISTICS => {
                for line in gate.ask(|answer| Request::Statistics { answer }).await? {
                    let _ = frames.send(service_message(service::LINE, line.as_bytes())).await;
                }
            }
            service::PING => {}
            id => {
                let why = format!("service {id}, there are 3 (subscribe), 4 (statistics) and 5 (ping)");
                return Err(Refusal::Malformed(why));
            }
        }
        Ok(0)
    }
}

/// One frame, or none if the client closed the connection between two frames.
async fn read_frame<'a>(
    read: &mut (impl AsyncRead + Unpin),
    buffer: &'a mut [u8; MAX_BYTES],
    patience: Duration,
) -> Result<Option<&'a [u8]>, Refusal> {
    let mut length = [0; 4];
    match timeout(patience, read.read(&mut length[..1])).await {
        Err(_) => return Err(Refusal::TimedOut("a frame")),
        Ok(Ok(0) | Err(_)) => return Ok(None),
        Ok(Ok(_)) => {}
    }
    let rest = async {
        let cut = |_| Refusal::Malformed("the connection ended inside a frame".into());
        read.read_exact(&mut length[1..]).await.map_err(cut)?;
        let length = u32::from_le_bytes(length) as usize;
        if !(HEAD..=MAX_BYTES).contains(&length) {
            return Err(Refusal::Malformed(format!(
                "length {length}, a frame has {HEAD} to {MAX_BYTES} bytes"
            )));
        }
        let bytes = &mut buffer[..length];
        read.read_exact(bytes).await.map_err(cut)?;
        Ok(&*bytes)
    };
    timeout(FRAME_TIME, rest).await.map_err(|_| Refusal::TimedOut("the rest of a frame"))?.map(Some)
}

/// A token bucket: [`RATE`] per second, as many at once.
struct Bucket {
    level: f64,
    at: Instant,
}

impl Bucket {
    fn take(&mut self) -> bool {
        let now = Instant::now();
        self.level = (self.level + RATE * now.duration_since(self.at).as_secs_f64()).min(RATE);
        self.at = now;
        let free = self.level >= 1.0;
        if free {
            self.level -= 1.0;
        }
        free
    }
}

#[cfg(test)]
#[path = "tcp_tests.rs"]
mod tests;
