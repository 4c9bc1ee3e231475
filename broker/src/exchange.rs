//! The global broker without its loop: admission, forwarding, answers, and what each client has lost.
//!
//! Urgency: before every message that it forwards, the broker looks into the queues of the higher classes; so a
//! message of High waits for one message of a lower class at most, however many there are of those.

mod clients;
mod watchers;

use std::time::Duration;

use ipc::{Doorbell, IpcError, QueueReceiver, QueueWaiter, Space};
use messages::command::Priority;
use messages::{Command, Live, Stamp};
use realtime::clock::SECOND;

use crate::admission::{Denied, Sender, admit};
use crate::inlet::Inlet;
use crate::lease::LeaseKeeper;
use crate::log_gate::LogGate;
use crate::members::Member;
use crate::message::{
    BROKER_BELL, Message, PUBLISH, REGISTRATION, service, service_message, split_u32, write_stamp,
};
use crate::observation::Observation;
use crate::pending::{Pending, Queued};
use crate::refusal::Refusal;

/// Numbers of connections by stream begin here; those below belong to processes of the run.
pub const FIRST_STREAM: u32 = 0x8000_0000;
/// Clients by queue that have not renewed their registration for this long are let go \[ns\].
const SILENCE: u64 = 2 * SECOND;
/// Clients by queue, at most.
const MAX_PROCESSES: usize = 32;
/// Messages forwarded before the service queue and the leases get their turn, and the other way round.
const AT_ONCE: usize = 64;
/// Commands of one process that are on their way at once; a stream has a limit of its own.
const UNANSWERED: usize = 256;
/// Period of the check for silent clients and losses \[ns\].
const ROUND: u64 = SECOND / 4;
/// Period at which the state of the lease is sent \[ns\].
const LEASE_ROUND: u64 = SECOND / 20;

/// The broker's events, for the log.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BrokerEvent {
    /// A command was refused by the broker itself; number of the reason.
    Denied(Live, u8),
    /// A message was refused; its (domain, id) as one number, domain first.
    Refused(u32),
    /// Clients have lost this many messages more.
    Lost(u64),
}

/// The broker's state.
pub struct Exchange<'a> {
    space: &'a Space,
    publish: [QueueReceiver; 3],
    registration: QueueReceiver,
    bell: QueueWaiter,
    inlet: Inlet,
    members: Vec<Member>,
    lease: LeaseKeeper,
    pending: Pending,
    /// Robot that clients watch; none: nothing of this run is known.
    robot: Option<Observation>,
    forwarded: [u64; 3],
    refused: u64,
    reported_lost: u64,
    next_round: u64,
    next_lease: u64,
    log: LogGate,
    now: u64,
}

impl<'a> Exchange<'a> {
    /// Opens the broker's ends of the queues. `inlet` is where streams hand in their messages.
    ///
    /// # Errors
    /// A queue cannot be opened.
    pub fn new(space: &'a Space, inlet: Inlet, now_ns: u64) -> Result<Self, IpcError> {
        let [high, normal, low] = PUBLISH.map(|queue| space.queue_receiver(queue));
        Ok(Self {
            publish: [high?, normal?, low?],
            registration: space.queue_receiver(REGISTRATION)?,
            bell: space.queue_waiter(BROKER_BELL)?,
            space,
            inlet,
            members: Vec::new(),
            lease: LeaseKeeper::new(now_ns >> 20),
            pending: Pending::default(),
            robot: None,
            forwarded: [0; 3],
            refused: 0,
            reported_lost: 0,
            next_round: now_ns,
            next_lease: now_ns,
            log: LogGate::default(),
            now: now_ns,
        })
    }

    /// Shows the robot to clients that want to watch it.
    pub(crate) fn showing(self, robot: Observation) -> Self {
        Self { robot: Some(robot), ..self }
    }

    /// Sleeps until a queue or a stream has something, at most `limit`.
    pub fn wait(&self, limit: Duration) {
        self.bell.wait(limit);
    }

    /// Wake-up that a stream rings after handing something in.
    pub fn doorbell(&self) -> Doorbell {
        self.bell.doorbell()
    }

    /// [`Exchange::turn_by`] with a clock that stands still at `now_ns`.
    pub fn turn(&mut self, now_ns: u64, report: &mut dyn FnMut(BrokerEvent)) -> bool {
        self.turn_by(&|| now_ns, report)
    }

    /// Forwards what waits, at most a bounded number of messages, then serves registrations and answers. Returns
    /// whether there was anything to do; never waits. `clock` is read again for each message: what came while a turn goes
    /// on would be from the future by the time at which the turn began.
    pub fn turn_by(&mut self, clock: &dyn Fn() -> u64, report: &mut dyn FnMut(BrokerEvent)) -> bool {
        self.now = clock();
        let mut busy = false;
        for _ in 0..AT_ONCE {
            if !self.forward_next(clock, report) {
                break;
            }
            busy = true;
        }
        for _ in 0..AT_ONCE {
            let (registered, asked) = (self.serve_queue(report), self.serve_question(report));
            if !(registered || asked) {
                break;
            }
            busy = true;
        }
        self.now = clock();
        // Answers have made room for what waits behind.
        for _ in 0..AT_ONCE {
            let Some(queued) = self.pending.next_in_line() else { break };
            self.resume(queued, report);
        }
        self.look_around(report);
        self.show();
        busy
    }

    /// Everything that is a matter of time.
    fn look_around(&mut self, report: &mut dyn FnMut(BrokerEvent)) {
        while let Some(asked) = self.pending.overdue(self.now) {
            let refusal = Refusal::NoAnswer(asked.command.decided_by());
            let stamp = Stamp { origin: asked.origin, sequence: asked.sequence, ..Stamp::default() };
            report(BrokerEvent::Denied(Live { command: asked.command, stamp }, refusal.code()));
            self.refuse(asked.origin, asked.sequence, address(&asked.command), &refusal, report);
        }
        if let Some(former) = self.lease.expire(self.now) {
            tracing::warn!("{} is silent: its command lease is over", self.name(former));
            self.tell_lease();
        }
        if self.now >= self.next_lease && self.lease.holder(self.now).is_some() {
            self.tell_processes_lease();
        }
        if self.now >= self.next_round {
            self.next_round = self.now + ROUND;
            self.release_silent();
            self.report_losses(report);
        }
    }

    /// Forwards the most urgent message; false if none waits.
    fn forward_next(&mut self, clock: &dyn Fn() -> u64, report: &mut dyn FnMut(BrokerEvent)) -> bool {
        for class in 0..Priority::ALL.len() {
            if let Some(bytes) = self.publish[class].receive() {
                let mut bytes = bytes.to_vec();
                let token = Message::parse(&bytes).map_or(0, |m| m.stamp.origin);
                self.now = clock();
                // A number of a stream cannot come out of a queue.
                self.forward(token & (FIRST_STREAM - 1), class, &mut bytes, report);
                return true;
            }
            if let Ok(request) = self.inlet.publish[class].try_recv() {
                self.now = clock();
                self.serve_stream(request, report);
                return true;
            }
        }
        false
    }

    /// Checks a message and gives it to every client but its sender that subscribed to its domain.
    fn forward(&mut self, from: u32, class: usize, bytes: &mut [u8], report: &mut dyn FnMut(BrokerEvent)) {
        let checked =
            Message::parse(bytes).and_then(|m| m.command_of_class(class).map(|command| (command, m.stamp)));
        let sequence = Message::parse(bytes).map_or(0, |m| m.stamp.sequence);
        let admitted = checked.and_then(|(command, stamp)| {
            let stamp = Stamp { origin: from, ..stamp };
            let admitted = self.admit(from, &command, Priority::ALL[class], &stamp);
            let admitted = admitted
                .inspect_err(|refusal| report(BrokerEvent::Denied(Live { command, stamp }, refusal.code())));
            Ok((command, Stamp { grant: admitted?, ..stamp }))
        });
        let (command, stamp) = match admitted {
            Ok(admitted) => admitted,
            Err(refusal) => {
                let address =
                    bytes.first_chunk().map_or(u32::MAX, |&[a, b, c, d]| u32::from_le_bytes([c, d, a, b]));
                return self.refuse(from, sequence, address, &refusal, report);
            }
        };
        write_stamp(bytes, &stamp);
        let name = command.decided_by();
        // The newest of that name: one that was started again stands behind the one that died.
        let found = self.members.iter().rfind(|m| m.sender.token != from && m.is_called(name));
        let Some(decider) = found.map(|m| m.sender.token) else {
            // What is refused has no effect; only a stop goes to whoever may still hear it.
            if command.always_passes() {
                self.deliver(from, class, &command, bytes);
            }
            let refusal = Refusal::NobodyListens(name);
            report(BrokerEvent::Denied(Live { command, stamp }, refusal.code()));
            return self.refuse(from, stamp.sequence, address(&command), &refusal, report);
        };
        if command == Command::EmergencyStop || self.pending.has_room(decider, class) {
            self.pending.ask(from, stamp.sequence, command, decider, self.now);
            self.deliver(from, class, &command, bytes);
        } else {
            let (bytes, sequence) = (bytes.to_vec(), stamp.sequence);
            self.pending.wait_in_line(Queued { origin: from, sequence, class, decider, command, bytes });
        }
    }

    /// The turn of a command that waited for room: it may have become too old.
    fn resume(&mut self, queued: Queued, report: &mut dyn FnMut(BrokerEvent)) {
        let Queued { origin, sequence, class, decider, command, bytes } = queued;
        let stamp = Message::parse(&bytes).map(|m| m.stamp).unwrap_or_default();
        if !command.always_passes()
            && let Err(reason) = stamp.check_age(self.now)
        {
            let refusal = Refusal::because(reason, &command);
            report(BrokerEvent::Denied(Live { command, stamp }, refusal.code()));
            return self.refuse(origin, sequence, address(&command), &refusal, report);
        }
        self.pending.ask(origin, sequence, command, decider, self.now);
        self.deliver(origin, class, &command, &bytes);
    }

    fn deliver(&mut self, from: u32, class: usize, command: &Command, bytes: &[u8]) {
        self.forwarded[class] += 1;
        let domain = command.address().0;
        for member in self.members.iter_mut().filter(|m| m.sender.token != from && m.hears(domain)) {
            member.deliver(bytes);
        }
    }

    fn admit(
        &mut self,
        from: u32,
        command: &Command,
        class: Priority,
        stamp: &Stamp,
    ) -> Result<u32, Refusal> {
        let before = self.lease.state(self.now).grant;
        // Somebody whose connection is closed, or who never registered, may still stop the robot.
        let mut stranger = Sender { token: from, may: 0, last: [0; 3] };
        let known = self.members.iter_mut().find(|m| m.sender.token == from).map(|m| &mut m.sender);
        let sender = match known {
            Some(sender) => sender,
            None if command.always_passes() => &mut stranger,
            None => return Err(Refusal::NoAccess("its connection is closed, or not registered".into())),
        };
        if from < FIRST_STREAM && !command.always_passes() && self.pending.of(from) >= UNANSWERED {
            return Err(Refusal::Busy(format!("{UNANSWERED} commands have not been answered yet")));
        }
        let admitted = admit(sender, &mut self.lease, command, class, stamp, self.now);
        let granted = admitted.map_err(|denied| match denied {
            Denied::Reason(reason) => Refusal::because(reason, command),
            Denied::LeaseHeld(holder) => Refusal::LeaseHeld(self.name(holder)),
            Denied::NoAccess => {
                let domain = command.address().0.name();
                Refusal::NoAccess(format!(
                    "{}: this connection may not command `{domain}`; use the socket of the run directory, or a key",
                    command.name()
                ))
            }
        })?;
        if granted != 0 && granted != before {
            tracing::info!("{} has the command lease", self.name(from));
            self.tell_lease();
        }
        Ok(granted)
    }

    fn refuse(
        &mut self,
        from: u32,
        sequence: u64,
        address: u32,
        refusal: &Refusal,
        report: &mut dyn FnMut(BrokerEvent),
    ) {
        self.refused += 1;
        if let Some(folded) = self.log.admit(self.now) {
            let who = self.name(from);
            tracing::warn!(code = refusal.code(), folded, "message of {who} refused: {refusal}");
        }
        report(BrokerEvent::Refused(address));
        let answer = refusal.to_message(sequence, self.now);
        self.answer(from, answer);
    }

    fn answer(&mut self, to: u32, bytes: Vec<u8>) {
        if let Some(member) = self.members.iter_mut().find(|m| m.sender.token == to) {
            member.answer(bytes);
        }
    }

    fn accept(&mut self, to: u32, sequence: u64, text: &str) {
        self.answer(to, service_message(service::ACCEPTED, sequence, self.now, text.as_bytes()));
    }

    /// Serves one registration or verdict; false if none waits.
    fn serve_queue(&mut self, report: &mut dyn FnMut(BrokerEvent)) -> bool {
        let Some(bytes) = self.registration.receive() else { return false };
        let bytes = bytes.to_vec();
        let message = Message::parse(&bytes);
        let served = match message.as_ref().map(|m| m.id) {
            Ok(service::VERDICT) => message.ok().and_then(|m| self.verdict(&m, report)),
            Ok(service::LEAVE) => {
                message.ok().and_then(|m| split_u32(m.payload)).map(|(token, _)| self.leave(token))
            }
            Ok(service::REGISTER) => message.ok().and_then(|m| self.register(&m)),
            _ => None,
        };
        if served.is_none() {
            self.refused += 1;
            if self.log.admit(self.now).is_some() {
                tracing::warn!("a registration of {} bytes makes no sense", bytes.len());
            }
        }
        true
    }

    /// The process that decides has answered.
    fn verdict(&mut self, message: &Message<'_>, report: &mut dyn FnMut(BrokerEvent)) -> Option<()> {
        let (decider, rest) = split_u32(message.payload)?;
        let (origin, rest) = split_u32(rest)?;
        let (&code, text) = rest.split_first()?;
        // Given up before, or from somebody who was not asked: neither is an error of the answering process.
        let Some(asked) = self.pending.answered(decider, origin, message.stamp.sequence) else {
            return Some(());
        };
        let process = asked.command.decided_by();
        if code == 0 {
            self.accept(origin, asked.sequence, process);
        } else {
            self.refused += 1;
            report(BrokerEvent::Refused(address(&asked.command)));
            let text = String::from_utf8_lossy(text);
            let payload =
                [&[code], format!("{} refused by {process}: {text}", asked.command.name()).as_bytes()]
                    .concat();
            self.answer(origin, service_message(service::REFUSED, asked.sequence, self.now, &payload));
        }
        Some(())
    }

    fn name(&self, token: u32) -> String {
        let known = self.members.iter().find(|m| m.sender.token == token);
        known.map_or_else(|| format!("connection {token:#x}"), |m| m.name.clone())
    }

    fn lost_before_forwarding(&self) -> u64 {
        self.publish.iter().map(QueueReceiver::lost).sum()
    }

    fn report_losses(&mut self, report: &mut dyn FnMut(BrokerEvent)) {
        let lost = self.lost_before_forwarding() + self.members.iter().map(|m| m.lost).sum::<u64>();
        if lost > self.reported_lost {
            tracing::warn!(
                "{} messages lost since the last report; statistics say by whom",
                lost - self.reported_lost
            );
            report(BrokerEvent::Lost(lost - self.reported_lost));
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

/// (domain, id) as one number, domain first.
fn address(command: &Command) -> u32 {
    let (domain, id) = command.address();
    (domain as u32) << 16 | u32::from(id)
}
