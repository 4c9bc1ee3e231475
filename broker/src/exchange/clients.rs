//! Clients that come, ask, hold the lease and go.

use messages::command::Domain;
use messages::{Command, Reason, Stamp};

use super::{BrokerEvent, Exchange, FIRST_STREAM, LEASE_ROUND, MAX_PROCESSES, SILENCE};
use crate::admission::{self, Denied, Sender};
use crate::inlet::{BrokerTable, Request};
use crate::members::{Member, MemberExit, Watch};
use crate::message::{Message, client_queue, describe, domain_mask, service, service_message, split_u32};
use crate::observation::Observation;
use crate::refusal::Refusal;

impl Exchange<'_> {
    /// Serves one request that need not keep its place among the commands; false if none waits.
    pub(super) fn serve_question(&mut self, report: &mut dyn FnMut(BrokerEvent)) -> bool {
        let request = self.inlet.requests.try_recv();
        request.map(|request| self.serve_stream(request, report)).is_ok()
    }

    /// Serves what a stream handed in.
    pub(super) fn serve_stream(&mut self, request: Request, report: &mut dyn FnMut(BrokerEvent)) {
        match request {
            Request::Command { token, class, mut bytes } => {
                self.forward(token, class as usize, &mut bytes, report);
            }
            Request::Join { token, name, may, out, done } => {
                // HELLO sent twice must not make two members of one connection.
                self.members.retain(|m| m.sender.token != token);
                let sender = Sender { token, may, last: [0; 3] };
                let exit = MemberExit::Stream(out);
                self.members.push(Member {
                    name,
                    sender,
                    domains: 0,
                    exit,
                    sent: 0,
                    lost: 0,
                    watch: Watch::default(),
                });
                let _ = done.send(());
            }
            Request::Subscribe { token, sequence, domains } => {
                let known = self.members.iter_mut().find(|m| m.sender.token == token);
                if let Some(member) = known {
                    member.domains = domains;
                }
                self.show_lease(token);
                self.accept(token, sequence, "");
            }
            Request::Lines { token, sequence, table } => {
                let lines = match table {
                    BrokerTable::Commands => describe(),
                    BrokerTable::Parameters => {
                        self.robot.as_mut().map_or(Vec::new(), Observation::parameters)
                    }
                    BrokerTable::Statistics => self.statistics(),
                };
                self.answer_lines(token, sequence, lines);
            }
            Request::Watch { token, sequence, rate, events } => self.watch(token, sequence, rate, events),
            Request::Set { token, sequence, sent_ns, value, name } => {
                let stamp = Stamp { origin: token, sequence, sent_ns, grant: 0 };
                self.set_parameter(&stamp, &name, value, report);
            }
            // The lease: renewed by a heartbeat, taken, given back; a closing link gives it up.
            Request::Alive { token, sent_ns } => self.lease.renew(token, sent_ns, self.now),
            Request::TakeLease { token, sequence, sent_ns, over } => {
                self.take_lease(&Stamp { origin: token, sequence, sent_ns, grant: 0 }, over);
            }
            Request::GiveLease { token, sequence } => {
                self.give_back(token);
                self.accept(token, sequence, "");
            }
            Request::Closing { token } => self.end_of_commands(token),
            Request::Leave { token } => self.leave(token),
        }
    }

    fn take_lease(&mut self, stamp: &Stamp, over: bool) {
        let token = stamp.origin;
        let known = self.members.iter().find(|m| m.sender.token == token).ok_or(Denied::NoAccess);
        let taken =
            known.and_then(|m| admission::take_lease(&m.sender, &mut self.lease, stamp, over, self.now));
        match taken {
            Ok(Some(former)) => {
                tracing::warn!(
                    "{} takes the command lease over from {}",
                    self.name(token),
                    self.name(former)
                );
            }
            Ok(None) => tracing::info!("{} has the command lease", self.name(token)),
            Err(denied) => {
                let refusal = self.no_lease(denied, over);
                return self.answer(token, refusal.to_message(stamp.sequence, self.now));
            }
        }
        self.tell_lease();
        self.accept(token, stamp.sequence, "");
    }

    /// Why a request for the lease is refused.
    fn no_lease(&self, denied: Denied, over: bool) -> Refusal {
        match denied {
            // The text of an age is the same for every command.
            Denied::Reason(reason) => {
                Refusal::Reason(reason, "request for the command lease", reason.text(&Command::Stop))
            }
            Denied::NoAccess => Refusal::NoAccess("this connection may not hold the command lease".into()),
            Denied::LeaseHeld(holder) if over => Refusal::NoAccess(format!(
                "{} holds the command lease; only a connection that may command `walk` takes it over",
                self.name(holder)
            )),
            Denied::LeaseHeld(holder) => Refusal::LeaseHeld(self.name(holder)),
        }
    }

    fn give_back(&mut self, token: u32) {
        if self.lease.release(token) {
            tracing::info!("{} gives the command lease back", self.name(token));
            self.tell_lease();
        }
    }

    /// Nothing comes from this client any more: what it commanded comes to a stop, and what it had waiting is dropped.
    fn end_of_commands(&mut self, token: u32) {
        for (sequence, command) in self.pending.drop_of(token) {
            let refusal = Refusal::because(Reason::LeaseLost, &command);
            self.answer(token, refusal.to_message(sequence, self.now));
        }
        self.give_back(token);
    }

    pub(super) fn leave(&mut self, token: u32) {
        self.end_of_commands(token);
        self.members.retain(|m| m.sender.token != token);
    }

    pub(super) fn register(&mut self, message: &Message<'_>) -> Option<()> {
        let (token, rest) = split_u32(message.payload)?;
        let (domains, rest) = split_u32(rest)?;
        let (lost, name) = split_u32(rest)?;
        let name = std::str::from_utf8(name).ok()?;
        if token >= FIRST_STREAM || token == 0 {
            return None;
        }
        let known = self.members.iter().position(|m| m.sender.token == token);
        let Some(index) = known.or_else(|| self.join(token, name)) else { return Some(()) };
        let (now, sent) = (self.now, message.stamp.sent_ns);
        let member = &mut self.members[index];
        (member.domains, member.lost) = (domains, lost.into());
        if let MemberExit::Queue { renewed, .. } = &mut member.exit {
            *renewed = now;
        }
        member.answer(service_message(service::ACCEPTED, 0, now, &[]));
        self.lease.renew(token, sent, now);
        if known.is_none() {
            self.tell_processes_lease();
        }
        Some(())
    }

    /// A new client by queue; none if there is no more room or its queue cannot be opened.
    fn join(&mut self, token: u32, name: &str) -> Option<usize> {
        if self.members.iter().filter(|m| m.is_process()).count() >= MAX_PROCESSES {
            if self.log.admit(self.now).is_some() {
                tracing::warn!("{name} is refused: {MAX_PROCESSES} clients are connected");
            }
            return None;
        }
        let queue = client_queue(name);
        let opened = self.space.queue_sender(&queue, &queue);
        let sender = opened.inspect_err(|e| tracing::warn!("{name} is refused: {e}")).ok()?;
        tracing::info!("{name} joined");
        self.members.push(Member {
            name: name.into(),
            // A process of the run: shared memory is its user's.
            sender: Sender { token, may: domain_mask(&Domain::ALL), last: [0; 3] },
            domains: 0,
            exit: MemberExit::Queue { sender: Box::new(sender), renewed: self.now },
            sent: 0,
            lost: 0,
            watch: Watch::default(),
        });
        Some(self.members.len() - 1)
    }

    /// Lets go of clients that were killed or hang; one that comes back registers again.
    pub(super) fn release_silent(&mut self) {
        let now = self.now;
        let silent = |m: &Member| match &m.exit {
            MemberExit::Queue { renewed, .. } => now.saturating_sub(*renewed) > SILENCE,
            MemberExit::Stream(_) => false,
        };
        let gone: Vec<u32> = self.members.iter().filter(|m| silent(m)).map(|m| m.sender.token).collect();
        for token in gone {
            tracing::warn!("{} is silent: its queue is released", self.name(token));
            self.leave(token);
        }
    }

    /// Tells everybody who holds the lease: it has just changed.
    pub(super) fn tell_lease(&mut self) {
        self.tell_processes_lease();
        let news = self.lease_message();
        for member in self.members.iter_mut().filter(|m| !m.is_process()) {
            member.deliver(&news);
        }
    }

    pub(super) fn tell_processes_lease(&mut self) {
        self.next_lease = self.now + LEASE_ROUND;
        let news = self.lease_message();
        for member in self.members.iter_mut().filter(|m| m.is_process()) {
            if let MemberExit::Queue { sender, .. } = &mut member.exit {
                sender.send(&news);
            }
        }
    }

    pub(super) fn lease_message(&self) -> Vec<u8> {
        let lease = self.lease.state(self.now);
        let holder = self.lease.holder(self.now).map_or(String::new(), |token| self.name(token));
        let mut payload = lease.grant.to_le_bytes().to_vec();
        payload.extend(lease.until_ns.to_le_bytes());
        payload.extend(holder.bytes());
        service_message(service::LEASE, 0, self.now, &payload)
    }
}
