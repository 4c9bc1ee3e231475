//! A process's connection to the global broker.
//!
//! A thread of the ordinary scheduler, the courier, moves messages between the inter-process queues and the rings of the
//! control cycle, which touches nothing else: commands in and out (urgent and other), verdicts out, answers in. What the
//! cycle hands over rings the courier's doorbell, one system call that never blocks. The courier renews the registration
//! all the time: so a broker that was started again knows its clients after one period, and one that hears nothing of a
//! client lets go of its queue.
//!
//! Age and lease of a command are looked at in [`Client::next`], in the cycle in which it takes effect: a stalled courier
//! or a stalled cycle lets no old command through.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering::Relaxed};
use std::thread::JoinHandle;
use std::time::Duration;

use ipc::{Doorbell, QueueReceiver, QueueSender, QueueWaiter, Space};
use messages::command::{Domain, Priority};
use messages::command_answer::code;
use messages::{Command, CommandSource, Lease, Live, Reason, Stamp, Verdict};
use realtime::clock::{SECOND, now};
use rtrb::{Consumer, Producer, RingBuffer};

use crate::message::{
    BROKER_BELL, MAX_BYTES, Message, PUBLISH, REGISTRATION, SERVICE, client_queue, domain_mask, service,
    service_message, split_u32, split_u64, write_command,
};

/// Room in each ring; more than the broker sends without an answer.
const RING: usize = 128;
/// Interval at which the thread looks whether it shall end; what comes in or goes out wakes it.
const POLL: Duration = Duration::from_millis(10);
/// Time from one renewal of the registration to the next \[ns\].
const RENEW: u64 = SECOND / 5;
/// Renewals without an answer after which the broker counts as gone.
const SILENT: u32 = 4;
/// End of a lease in the shared word: low bits, in units of 2^20 ns.
const UNTIL_BITS: u32 = 40;

/// The real-time side of the connection. Dropping it leaves the broker.
#[derive(Debug)]
pub struct Client {
    urgent: Ends,
    other: Ends,
    verdicts: Producer<(Live, Verdict)>,
    answers: Consumer<Answered>,
    doorbell: Doorbell,
    /// Of the last command sent.
    sequence: u64,
    /// Name without process id: which commands this process decides about.
    role: String,
    /// Commands that were too old or had lost their lease.
    left_out: VecDeque<(Live, Reason)>,
    shared: Arc<ConnectionState>,
    thread: Option<JoinHandle<()>>,
}

/// One pair of rings, as the control cycle sees it.
#[derive(Debug)]
struct Ends {
    out: Producer<(Live, Priority)>,
    received: Consumer<Live>,
}

/// The same pair, as the thread sees it.
struct FarEnds {
    out: Consumer<(Live, Priority)>,
    received: Producer<Live>,
}

/// Answer to a command that this client sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Answered {
    /// Number that [`Client::publish`] gave it.
    pub sequence: u64,
    /// 0: accepted; otherwise the reason, as in the protocol.
    pub code: u8,
}

#[derive(Debug, Default)]
struct ConnectionState {
    connected: AtomicBool,
    end: AtomicBool,
    lost_out: AtomicU64,
    lost_in: AtomicU64,
    refused: AtomicU64,
    /// The lease: grant above [`UNTIL_BITS`], its end below; one word, so that both are of one moment.
    lease: AtomicU64,
}

/// Messages a client has read so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClientStatistics {
    /// Whether the broker answers.
    pub connected: bool,
    /// Messages published that did not reach the broker.
    pub lost_out: u64,
    /// Messages that were on their way to this client and did not reach its control cycle.
    pub lost_in: u64,
    /// Messages received that were no commands, out of range, too old, or without the lease.
    pub refused: u64,
}

impl Client {
    /// Starts the thread and registers as `name` for `domains`. Whether there is a broker yet, and whether there
    /// still is one, makes no difference. Allocates: before arming.
    ///
    /// # Errors
    /// A queue cannot be opened or the thread cannot be started.
    pub fn start(name: &str, domains: &[Domain], space: &Space) -> Result<Self, String> {
        Self::open(name, domains, space)
            .map_err(|e| format!("{name} cannot connect to the broker's queues: {e}"))
    }

    fn open(role: &str, domains: &[Domain], space: &Space) -> Result<Self, Box<dyn std::error::Error>> {
        let (urgent, far_urgent) = rings();
        let (other, far_other) = rings();
        let (verdicts, given) = RingBuffer::new(2 * RING);
        let (answered, answers) = RingBuffer::new(2 * RING);
        let shared = Arc::new(ConnectionState::default());
        let name = unique(role);
        let inbox = client_queue(&name);
        let [high, normal, low] = PUBLISH.map(|queue| space.queue_sender(queue, BROKER_BELL));
        let bell = space.queue_waiter(&inbox)?;
        let doorbell = bell.doorbell();
        let courier = Courier {
            domains: domain_mask(domains),
            rings: [far_urgent, far_other],
            verdicts: given,
            answers: answered,
            shared: shared.clone(),
            publish: [high?, normal?, low?],
            registration: space.queue_sender(REGISTRATION, BROKER_BELL)?,
            inbox: space.queue_receiver(&inbox)?,
            bell,
            no_room: 0,
            link: BrokerLink::Unknown,
            unanswered: 0,
            token: token(&name),
            name,
        };
        let thread = std::thread::Builder::new().name("courier".into()).spawn(move || courier.run())?;
        let (role, thread) = (role.into(), Some(thread));
        let left_out = VecDeque::with_capacity(RING);
        Ok(Self { urgent, other, verdicts, answers, doorbell, sequence: 0, role, left_out, shared, thread })
    }

    /// Sends a command to the other processes; the number under which it will be [answered](Client::answered). None, and
    /// counted, if the ring is full. Never waits.
    pub fn publish(&mut self, command: &Command) -> Option<u64> {
        self.publish_as(command, command.priority())
    }

    /// The same with another priority; an emergency stop is always High and nothing else is.
    pub fn publish_as(&mut self, command: &Command, priority: Priority) -> Option<u64> {
        let urgent = command.priority() == Priority::High;
        let priority = if urgent { Priority::High } else { priority.max(Priority::Normal) };
        let ends = if urgent { &mut self.urgent } else { &mut self.other };
        self.sequence += 1;
        let stamp = Stamp { sequence: self.sequence, sent_ns: now(), ..Stamp::default() };
        let sent = ends.out.push((Live { command: *command, stamp }, priority)).is_ok();
        if sent {
            self.doorbell.ring();
        } else {
            self.shared.lost_out.fetch_add(1, Relaxed);
        }
        sent.then_some(self.sequence)
    }

    /// The next answer to a command that this client sent.
    pub fn answered(&mut self) -> Option<Answered> {
        self.answers.pop().ok()
    }

    /// The commands that came and may take effect now, urgent ones first, each accepted if this process decides about it.
    /// At most what the rings hold at the time of the call.
    pub fn received(&mut self) -> impl Iterator<Item = Command> + '_ {
        let waiting = self.waiting();
        std::iter::from_fn(|| self.accept().map(|live| live.command)).take(waiting)
    }

    /// Number of messages waiting.
    pub fn waiting(&self) -> usize {
        self.urgent.received.slots() + self.other.received.slots()
    }

    /// Messages this client has read so far.
    pub fn statistics(&self) -> ClientStatistics {
        let s = &self.shared;
        ClientStatistics {
            connected: s.connected.load(Relaxed),
            lost_out: s.lost_out.load(Relaxed),
            lost_in: s.lost_in.load(Relaxed),
            refused: s.refused.load(Relaxed),
        }
    }
}

impl CommandSource for Client {
    fn next(&mut self) -> Option<Live> {
        loop {
            let live = self.urgent.received.pop().or_else(|_| self.other.received.pop()).ok()?;
            match live.check(self.lease(), now()) {
                Ok(()) => return Some(live),
                Err(reason) => {
                    self.shared.refused.fetch_add(1, Relaxed);
                    self.answer(&live, Err(reason));
                    if self.left_out.len() < RING {
                        self.left_out.push_back((live, reason));
                    }
                }
            }
        }
    }

    fn answer(&mut self, live: &Live, verdict: Verdict) {
        // A verdict that finds no room is missed by the broker, which then says that this process did not answer.
        if live.stamp.origin != 0
            && live.command.decided_by() == self.role
            && self.verdicts.push((*live, verdict)).is_ok()
        {
            self.doorbell.ring();
        }
    }

    fn left_out(&mut self) -> Option<(Live, Reason)> {
        self.left_out.pop_front()
    }

    fn lease(&self) -> Lease {
        let word = self.shared.lease.load(Relaxed);
        let until = word & ((1 << UNTIL_BITS) - 1);
        Lease { grant: (word >> UNTIL_BITS) as u32, until_ns: until << 20 }
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        self.shared.end.store(true, Relaxed);
        self.doorbell.ring();
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn rings() -> (Ends, FarEnds) {
    let (out, far_out) = RingBuffer::new(RING);
    let (far_received, received) = RingBuffer::new(RING);
    (Ends { out, received }, FarEnds { out: far_out, received: far_received })
}

/// A name that no other client, alive or dead, has: a restarted process gets a fresh queue.
fn unique(name: &str) -> String {
    static CLIENTS: AtomicU32 = AtomicU32::new(0);
    format!("{name}-{}-{}", std::process::id(), CLIENTS.fetch_add(1, Relaxed))
}

/// Number of a client in the queues to the broker; numbers with the highest bit set are streams.
fn token(name: &str) -> u32 {
    let hash = name.bytes().fold(0x811c_9dc5u32, |h, b| (h ^ u32::from(b)).wrapping_mul(0x0100_0193));
    (hash & 0x7fff_ffff).max(1)
}

/// State of the thread.
struct Courier {
    name: String,
    token: u32,
    domains: u32,
    rings: [FarEnds; 2],
    verdicts: Consumer<(Live, Verdict)>,
    answers: Producer<Answered>,
    shared: Arc<ConnectionState>,
    publish: [QueueSender; 3],
    registration: QueueSender,
    inbox: QueueReceiver,
    bell: QueueWaiter,
    /// Messages for which the rings had no room.
    no_room: u64,
    link: BrokerLink,
    /// Renewals since the broker's last answer.
    unanswered: u32,
}

/// Whether the broker answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum BrokerLink {
    /// It has not had the time.
    Unknown,
    Up,
    Down,
}

impl Courier {
    fn run(mut self) {
        // Behind a busy chain on its core it would bring a stop too late, and a renewal of the lease.
        realtime::run_on_any_core();
        let mut next_renewal = 0;
        while !self.shared.end.load(Relaxed) {
            if now() >= next_renewal {
                next_renewal = now() + RENEW;
                self.register();
            }
            self.bring_in();
            self.carry_out();
            self.carry_verdicts();
            self.shared.connected.store(self.link == BrokerLink::Up, Relaxed);
            self.bell.wait(POLL);
        }
        self.carry_out();
        self.carry_verdicts();
        self.registration.send(&service_message(service::LEAVE, 0, now(), &self.token.to_le_bytes()));
    }

    fn register(&mut self) {
        self.unanswered += 1;
        if self.unanswered > SILENT {
            self.link = BrokerLink::Down;
        }
        let lost = self.shared.lost_in.load(Relaxed) as u32;
        let numbers = [self.token, self.domains, lost];
        let mut payload: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
        payload.extend(self.name.bytes());
        self.registration.send(&service_message(service::REGISTER, 0, now(), &payload));
    }

    /// From the rings to the broker. While there is none, nothing is kept for later: an old command must not move the
    /// robot. An emergency stop is sent in any case.
    fn carry_out(&mut self) {
        for (ring, urgent) in self.rings.iter_mut().zip([true, false]) {
            if self.link == BrokerLink::Unknown && !urgent {
                continue;
            }
            for _ in 0..RING {
                let Ok((live, priority)) = ring.out.pop() else { break };
                let mut buffer = [0; MAX_BYTES];
                let stamp = Stamp { origin: self.token, ..live.stamp };
                let sent = (urgent || self.link == BrokerLink::Up)
                    && write_command(&live.command, priority, &stamp, &mut buffer)
                        .is_ok_and(|bytes| self.publish[priority as usize].send(bytes));
                self.shared.lost_out.fetch_add(u64::from(!sent), Relaxed);
            }
        }
    }

    /// Verdicts of the control cycle on commands: here numbers become text.
    fn carry_verdicts(&mut self) {
        while let Ok((live, verdict)) = self.verdicts.pop() {
            let (code, text) = verdict
                .map_or_else(|reason| (reason.code(), reason.text(&live.command)), |()| (0, String::new()));
            let mut payload = self.token.to_le_bytes().to_vec();
            payload.extend(live.stamp.origin.to_le_bytes());
            payload.push(code);
            payload.extend(text.bytes());
            let message = service_message(service::VERDICT, live.stamp.sequence, now(), &payload);
            self.registration.send(&message);
        }
    }

    /// From the broker to the rings.
    fn bring_in(&mut self) {
        for _ in 0..2 * RING {
            let Some(bytes) = self.inbox.receive() else { break };
            let message = Message::parse(bytes);
            if let Ok(message) = &message
                && message.domain == SERVICE
            {
                (self.link, self.unanswered) = (BrokerLink::Up, 0);
                hear(message, &self.shared, &mut self.answers);
                continue;
            }
            let Ok(live) = message.and_then(|m| Ok(Live { command: m.command()?, stamp: m.stamp })) else {
                self.shared.refused.fetch_add(1, Relaxed);
                continue;
            };
            let ring = &mut self.rings[usize::from(live.command.priority() != Priority::High)];
            self.no_room += u64::from(ring.received.push(live).is_err());
        }
        self.shared.lost_in.store(self.no_room + self.inbox.lost(), Relaxed);
    }
}

/// Messages of the broker to this client itself.
fn hear(message: &Message<'_>, shared: &ConnectionState, answers: &mut Producer<Answered>) {
    let sequence = message.stamp.sequence;
    match message.id {
        service::LEASE => {
            let state = split_u32(message.payload)
                .and_then(|(grant, rest)| split_u64(rest).map(|(until, _)| (grant, until)));
            if let Some((grant, until)) = state {
                shared.lease.store(u64::from(grant) << UNTIL_BITS | until >> 20, Relaxed);
            }
        }
        service::ACCEPTED | service::REFUSED if sequence != 0 => {
            let refused = message.id == service::REFUSED;
            let code = if refused { message.payload.first().copied().unwrap_or(code::MALFORMED) } else { 0 };
            // A caller that does not ask for answers lets the ring run full.
            let _ = answers.push(Answered { sequence, code });
        }
        _ => {}
    }
}
