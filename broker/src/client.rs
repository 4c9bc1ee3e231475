//! A process's connection to the global broker.
//!
//! A thread of the ordinary scheduler moves messages between the inter-process queues and two pairs of rings (urgent
//! and other); the control cycle only touches the rings. It renews the registration all the time: so a broker that
//! was started again knows its clients after one period, and one that hears nothing of a client lets go of its queue.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering::Relaxed};
use std::thread::JoinHandle;
use std::time::Duration;

use ipc::{QueueReceiver, QueueSender, QueueWaiter, Space};
use messages::Command;
use messages::command::{Domain, Priority};
use realtime::clock::{SECOND, now};
use rtrb::{Consumer, Producer, RingBuffer};

use crate::message::{
    BROKER_BELL, MAX_BYTES, Message, PUBLISH, REGISTRATION, SERVICE, client_queue, domain_mask, service,
    service_message, write_command,
};

/// Room in each ring.
const RING: usize = 128;
/// How often the thread looks for what the control cycle publishes; what comes in wakes it.
const POLL: Duration = Duration::from_millis(10);
/// Time from one renewal of the registration to the next \[ns\].
const RENEW: u64 = SECOND / 5;
/// Renewals without an answer after which the broker counts as gone.
const SILENT: u32 = 4;

/// The real-time side of the connection. Dropping it leaves the broker.
#[derive(Debug)]
pub struct Client {
    urgent: Ends,
    other: Ends,
    counts: Arc<Counts>,
    thread: Option<JoinHandle<()>>,
}

/// One pair of rings, as the control cycle sees it.
#[derive(Debug)]
struct Ends {
    out: Producer<(Command, Priority)>,
    received: Consumer<Command>,
}

/// The same pair, as the thread sees it.
struct FarEnds {
    out: Consumer<(Command, Priority)>,
    received: Producer<Command>,
}

#[derive(Debug, Default)]
struct Counts {
    connected: AtomicBool,
    end: AtomicBool,
    lost_out: AtomicU64,
    lost_in: AtomicU64,
    refused: AtomicU64,
}

/// What a client has seen so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClientStatistics {
    /// Whether the broker answers.
    pub connected: bool,
    /// Messages published that did not reach the broker.
    pub lost_out: u64,
    /// Messages that were on their way to this client and did not reach its control cycle.
    pub lost_in: u64,
    /// Messages received that were no commands or out of range.
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

    fn open(name: &str, domains: &[Domain], space: &Space) -> Result<Self, Box<dyn std::error::Error>> {
        let (urgent, far_urgent) = rings();
        let (other, far_other) = rings();
        let counts = Arc::new(Counts::default());
        let name = unique(name);
        let inbox = client_queue(&name);
        let [high, normal, low] = PUBLISH.map(|queue| space.queue_sender(queue, BROKER_BELL));
        let courier = Courier {
            domains: domain_mask(domains),
            rings: [far_urgent, far_other],
            counts: counts.clone(),
            publish: [high?, normal?, low?],
            registration: space.queue_sender(REGISTRATION, BROKER_BELL)?,
            inbox: space.queue_receiver(&inbox)?,
            bell: space.queue_waiter(&inbox)?,
            no_room: 0,
            link: Link::Unknown,
            unanswered: 0,
            name,
        };
        let thread = std::thread::Builder::new().name("courier".into()).spawn(move || courier.run())?;
        Ok(Self { urgent, other, counts, thread: Some(thread) })
    }

    /// Sends a command to the other processes. False, and counted, if the ring is full. Never waits.
    pub fn publish(&mut self, command: &Command) -> bool {
        self.publish_as(command, command.priority())
    }

    /// The same with another priority; an emergency stop is always High and nothing else is.
    pub fn publish_as(&mut self, command: &Command, priority: Priority) -> bool {
        let urgent = command.priority() == Priority::High;
        let priority = if urgent { Priority::High } else { priority.max(Priority::Normal) };
        let ends = if urgent { &mut self.urgent } else { &mut self.other };
        let sent = ends.out.push((*command, priority)).is_ok();
        if !sent {
            self.counts.lost_out.fetch_add(1, Relaxed);
        }
        sent
    }

    /// The next message that waits, urgent ones first. Never waits.
    pub fn receive(&mut self) -> Option<Command> {
        self.urgent.received.pop().or_else(|_| self.other.received.pop()).ok()
    }

    /// What came since the last call, urgent messages first. At most what the rings hold at the time of the call.
    pub fn received(&mut self) -> impl Iterator<Item = Command> + '_ {
        let waiting = self.waiting();
        std::iter::from_fn(|| self.receive()).take(waiting)
    }

    /// How many messages wait.
    pub fn waiting(&self) -> usize {
        self.urgent.received.slots() + self.other.received.slots()
    }

    /// What this client has seen so far.
    pub fn statistics(&self) -> ClientStatistics {
        let c = &self.counts;
        ClientStatistics {
            connected: c.connected.load(Relaxed),
            lost_out: c.lost_out.load(Relaxed),
            lost_in: c.lost_in.load(Relaxed),
            refused: c.refused.load(Relaxed),
        }
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        self.counts.end.store(true, Relaxed);
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

/// Number of a client in the queues to the broker; numbers with the highest bit set are TCP connections.
fn token(name: &str) -> u32 {
    let hash = name.bytes().fold(0x811c_9dc5u32, |h, b| (h ^ u32::from(b)).wrapping_mul(0x0100_0193));
    hash & 0x7fff_ffff
}

/// What the thread owns.
struct Courier {
    name: String,
    domains: u32,
    rings: [FarEnds; 2],
    counts: Arc<Counts>,
    publish: [QueueSender; 3],
    registration: QueueSender,
    inbox: QueueReceiver,
    bell: QueueWaiter,
    /// Messages for which the rings had no room.
    no_room: u64,
    link: Link,
    /// Renewals since the broker's last answer.
    unanswered: u32,
}

/// Whether the broker answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Link {
    /// It has not had the time.
    Unknown,
    Up,
    Down,
}

impl Courier {
    fn run(mut self) {
        let mut next_renewal = 0;
        while !self.counts.end.load(Relaxed) {
            if now() >= next_renewal {
                next_renewal = now() + RENEW;
                self.register();
            }
            self.bring_in();
            self.carry_out();
            self.counts.connected.store(self.link == Link::Up, Relaxed);
            self.bell.wait(POLL);
        }
        self.carry_out();
        self.registration.send(&service_message(service::LEAVE, &token(&self.name).to_le_bytes()));
    }

    fn register(&mut self) {
        self.unanswered += 1;
        if self.unanswered > SILENT {
            self.link = Link::Down;
        }
        let lost = self.counts.lost_in.load(Relaxed) as u32;
        let numbers = [token(&self.name), self.domains, lost];
        let mut payload: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
        payload.extend(self.name.bytes());
        self.registration.send(&service_message(service::REGISTER, &payload));
    }

    /// From the rings to the broker. While there is none, nothing is kept for later: an old command must not move the
    /// robot. An emergency stop is sent in any case.
    fn carry_out(&mut self) {
        for (ring, urgent) in self.rings.iter_mut().zip([true, false]) {
            if self.link == Link::Unknown && !urgent {
                continue;
            }
            for _ in 0..RING {
                let Ok((command, priority)) = ring.out.pop() else { break };
                let mut buffer = [0; MAX_BYTES];
                let sent = (urgent || self.link == Link::Up)
                    && write_command(&command, priority, token(&self.name), &mut buffer)
                        .is_ok_and(|bytes| self.publish[priority as usize].send(bytes));
                self.counts.lost_out.fetch_add(u64::from(!sent), Relaxed);
            }
        }
    }

    /// From the broker to the rings.
    fn bring_in(&mut self) {
        for _ in 0..2 * RING {
            let Some(bytes) = self.inbox.receive() else { break };
            let message = Message::parse(bytes);
            if message.as_ref().is_ok_and(|m| m.domain == SERVICE) {
                (self.link, self.unanswered) = (Link::Up, 0);
                continue;
            }
            let Ok(command) = message.and_then(|m| m.command()) else {
                self.counts.refused.fetch_add(1, Relaxed);
                continue;
            };
            let ring = &mut self.rings[usize::from(command.priority() != Priority::High)];
            self.no_room += u64::from(ring.received.push(command).is_err());
        }
        self.counts.lost_in.store(self.no_room + self.inbox.lost(), Relaxed);
    }
}
