//! The global broker without its loop: who subscribed to which domain, forwarding, and what each client has lost.
//!
//! Urgency: before every message that it forwards, the broker looks into the queues of the higher classes; so a
//! message of High waits for one message of a lower class at most, however many there are of those.

use std::time::Duration;

use ipc::{IpcError, QueueReceiver, QueueSender, QueueWaiter, Space};
use messages::command::{Domain, Priority};
use realtime::clock::{SECOND, now};
use tokio::sync::mpsc;

use crate::message::{
    BROKER_BELL, Message, PUBLISH, REGISTRATION, Refusal, client_queue, service, service_message, split_u32,
};
use crate::tcp::{FIRST_TOKEN, Inlet, Request};

/// Clients by queue that have not renewed their registration for this long are let go \[ns\].
const LEASE: u64 = 2 * SECOND;
/// Clients by queue, at most.
const MAX_CLIENTS: usize = 32;
/// Messages forwarded before the service queue and the leases get their turn, and the other way round.
const AT_ONCE: usize = 64;
/// How often leases and losses are looked at \[ns\].
const ROUND: u64 = SECOND / 4;

/// What the broker has to report, for the log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Report {
    /// A message was refused; its (domain, id) as one number, domain first.
    Refused(u32),
    /// Clients have lost this many messages more.
    Lost(u64),
}

/// The way to a client.
enum Exit {
    Queue { sender: Box<QueueSender>, renewed: u64 },
    Tcp(mpsc::Sender<Vec<u8>>),
}

struct Member {
    token: u32,
    name: String,
    domains: u32,
    exit: Exit,
    sent: u64,
    lost: u64,
}

impl Member {
    /// A client that does not keep up loses its own messages; the broker never waits for it.
    fn deliver(&mut self, bytes: &[u8]) {
        self.sent += 1;
        match &mut self.exit {
            // The receiving end counts what is lost and tells it with its registration.
            Exit::Queue { sender, .. } => _ = sender.send(bytes),
            Exit::Tcp(frames) => self.lost += u64::from(frames.try_send(bytes.to_vec()).is_err()),
        }
    }

    fn describe(&self) -> String {
        let subscribed = Domain::ALL.into_iter().filter(|d| self.domains & 1 << *d as u16 != 0);
        let domains = subscribed.map(Domain::name).collect::<Vec<_>>().join(", ");
        format!("{}: sent {}, lost {}; subscribed to {domains}", self.name, self.sent, self.lost)
    }
}

/// The broker's state.
pub struct Exchange<'a> {
    space: &'a Space,
    publish: [QueueReceiver; 3],
    registration: QueueReceiver,
    bell: QueueWaiter,
    inlet: Inlet,
    members: Vec<Member>,
    forwarded: [u64; 3],
    refused: u64,
    reported_lost: u64,
    next_round: u64,
}

impl<'a> Exchange<'a> {
    /// Opens the broker's ends of the queues. `inlet` is where TCP connections hand in their messages.
    ///
    /// # Errors
    /// A queue cannot be opened.
    pub fn new(space: &'a Space, inlet: Inlet) -> Result<Self, IpcError> {
        let [high, normal, low] = PUBLISH.map(|queue| space.queue_receiver(queue));
        Ok(Self {
            publish: [high?, normal?, low?],
            registration: space.queue_receiver(REGISTRATION)?,
            bell: space.queue_waiter(BROKER_BELL)?,
            space,
            inlet,
            members: Vec::new(),
            forwarded: [0; 3],
            refused: 0,
            reported_lost: 0,
            next_round: now(),
        })
    }

    /// Sleeps until a queue has something, at most `limit`.
    pub fn wait(&mut self, limit: Duration) {
        self.bell.wait(limit);
    }

    /// Forwards what waits, at most a bounded number of messages, then serves registrations. Returns whether there
    /// was anything to do; never waits.
    pub fn turn(&mut self, report: &mut dyn FnMut(Report)) -> bool {
        let mut busy = false;
        for _ in 0..AT_ONCE {
            if !self.forward_next(report) {
                break;
            }
            busy = true;
        }
        for _ in 0..AT_ONCE {
            if !(self.register_next() || self.answer_next()) {
                break;
            }
            busy = true;
        }
        let time = now();
        if time >= self.next_round {
            self.next_round = time + ROUND;
            self.release_silent(time);
            self.report_losses(report);
        }
        busy
    }

    /// Forwards the most urgent message; false if none waits.
    fn forward_next(&mut self, report: &mut dyn FnMut(Report)) -> bool {
        for class in 0..Priority::ALL.len() {
            if let Some(bytes) = self.publish[class].receive() {
                let bytes = bytes.to_vec();
                let (token, message) = split_u32(&bytes).unwrap_or((0, &[]));
                let _ = self.forward(token, class, message, report);
                return true;
            }
            if let Ok((token, message, answer)) = self.inlet.publish[class].try_recv() {
                let _ = answer.send(self.forward(token, class, &message, report));
                return true;
            }
        }
        false
    }

    /// Checks a message and gives it to every client but its sender that subscribed to its domain; returns to how many.
    fn forward(
        &mut self,
        from: u32,
        class: usize,
        bytes: &[u8],
        report: &mut dyn FnMut(Report),
    ) -> Result<u32, Refusal> {
        let checked = Message::parse(bytes).and_then(|m| m.command_of_class(class).map(|_| m.domain));
        let domain = checked.inspect_err(|refusal| {
            self.refused += 1;
            tracing::warn!(code = refusal.code(), "message refused: {refusal}");
            let address =
                bytes.first_chunk().map_or(u32::MAX, |&[a, b, c, d]| u32::from_le_bytes([c, d, a, b]));
            report(Report::Refused(address));
        })?;
        self.forwarded[class] += 1;
        let mut receivers = 0;
        for member in self.members.iter_mut().filter(|m| m.token != from && m.domains & 1 << domain != 0) {
            member.deliver(bytes);
            receivers += 1;
        }
        Ok(receivers)
    }

    /// Serves one request of a TCP connection; false if none waits.
    fn answer_next(&mut self) -> bool {
        let Ok(request) = self.inlet.requests.try_recv() else { return false };
        match request {
            Request::Subscribe { token, domains, frames, answer } => {
                self.members.retain(|m| m.token != token);
                let name = format!("tcp-{}", token - FIRST_TOKEN);
                self.members.push(Member { token, name, domains, exit: Exit::Tcp(frames), sent: 0, lost: 0 });
                let _ = answer.send(());
            }
            Request::Statistics { answer } => _ = answer.send(self.statistics()),
            Request::Leave { token } => self.members.retain(|m| m.token != token),
        }
        true
    }

    /// Serves one registration; false if none waits.
    fn register_next(&mut self) -> bool {
        let Some(bytes) = self.registration.receive() else { return false };
        let bytes = bytes.to_vec();
        if self.register(&bytes).is_none() {
            self.refused += 1;
            tracing::warn!("a registration of {} bytes makes no sense", bytes.len());
        }
        true
    }

    fn register(&mut self, bytes: &[u8]) -> Option<()> {
        let message = Message::parse(bytes).ok()?;
        let (token, rest) = split_u32(message.payload)?;
        if message.id == service::LEAVE {
            self.members.retain(|m| m.token != token);
            return Some(());
        }
        let (domains, rest) = split_u32(rest)?;
        let (lost, name) = split_u32(rest)?;
        let name = std::str::from_utf8(name).ok()?;
        if token >= FIRST_TOKEN || message.id != service::REGISTER {
            return None;
        }
        let known = self.members.iter().position(|m| m.token == token);
        let Some(index) = known.or_else(|| self.join(token, name)) else { return Some(()) };
        let member = &mut self.members[index];
        (member.domains, member.lost) = (domains, lost.into());
        if let Exit::Queue { sender, renewed } = &mut member.exit {
            *renewed = now();
            sender.send(&service_message(service::ACCEPTED, &[]));
        }
        Some(())
    }

    /// Opens the queue of a new client; returns its place in the list.
    fn join(&mut self, token: u32, name: &str) -> Option<usize> {
        let by_queue = self.members.iter().filter(|m| m.token < FIRST_TOKEN).count();
        if by_queue >= MAX_CLIENTS {
            tracing::warn!("{name} cannot join: {MAX_CLIENTS} clients are connected");
            return None;
        }
        let queue = client_queue(name);
        let sender = self.space.queue_sender(&queue, &queue);
        let sender = sender.map(Box::new).map_err(|e| tracing::warn!("{name} cannot join: {e}")).ok()?;
        tracing::info!("{name} joined");
        let exit = Exit::Queue { sender, renewed: now() };
        self.members.push(Member { token, name: name.into(), domains: 0, exit, sent: 0, lost: 0 });
        Some(self.members.len() - 1)
    }

    /// Lets go of clients that were killed or hang; one that comes back registers again.
    fn release_silent(&mut self, time: u64) {
        self.members.retain(|m| match &m.exit {
            Exit::Queue { renewed, .. } if time.saturating_sub(*renewed) > LEASE => {
                tracing::warn!("{} is silent: its queue is released", m.name);
                false
            }
            _ => true,
        });
    }

    fn lost_before_forwarding(&self) -> u64 {
        self.publish.iter().map(QueueReceiver::lost).sum()
    }

    fn report_losses(&mut self, report: &mut dyn FnMut(Report)) {
        let lost = self.lost_before_forwarding() + self.members.iter().map(|m| m.lost).sum::<u64>();
        if lost > self.reported_lost {
            tracing::warn!(
                "{} messages lost since the last report; statistics say by whom",
                lost - self.reported_lost
            );
            report(Report::Lost(lost - self.reported_lost));
        }
        self.reported_lost = lost;
    }

    /// One line for the broker and one per client.
    pub fn statistics(&self) -> Vec<String> {
        let ([high, normal, low], refused) = (self.forwarded, self.refused);
        let lost = self.lost_before_forwarding();
        let broker = format!(
            "broker: forwarded {high} high, {normal} normal, {low} low; refused {refused}; lost {lost} before that"
        );
        std::iter::once(broker).chain(self.members.iter().map(Member::describe)).collect()
    }
}
