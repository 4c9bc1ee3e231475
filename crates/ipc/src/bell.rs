//! Wake-ups: a bell per process that sleeps until its input is there.
//!
//! All topics that wake a process ring the same bell; the process then looks at its topics. Ringing an awake process
//! costs one system call and is never waited for; many rings before it looks are one wake-up.

use crate::error::{IpcError, because};
use iceoryx2::port::listener::Listener;
use iceoryx2::port::notifier::Notifier;
use iceoryx2::prelude::*;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use std::os::fd::BorrowedFd;
use std::time::Duration;

/// Ports per bell: every process may ring, a few may listen (a killed listener is counted until it is cleared away).
const MAX_NOTIFIERS: usize = 128;
const MAX_LISTENERS: usize = 16;
const MAX_NODES: usize = 64;

/// Period at which a long wait checks whether to end.
const LOOK: Duration = Duration::from_millis(20);

pub(crate) type RealTime = ipc::Service;
type Events<S> = iceoryx2::service::port_factory::event::PortFactory<S>;

/// Opens the bell of `name`, and makes it if nobody has.
pub(crate) fn service<S: Service>(node: &Node<S>, name: &str) -> Result<Events<S>, IpcError> {
    let full: ServiceName = format!("bell/{name}").as_str().try_into().map_err(|e| because(name, e))?;
    let mut tries = 0;
    loop {
        let made = node
            .service_builder(&full)
            .event()
            .max_notifiers(MAX_NOTIFIERS)
            .max_listeners(MAX_LISTENERS)
            .max_nodes(MAX_NODES)
            .event_id_max_value(0)
            .disable_notifier_created_event()
            .disable_notifier_dropped_event()
            .disable_notifier_dead_event()
            .open_or_create();
        match made {
            Ok(service) => return Ok(service),
            // Another process may be just making the same bell.
            Err(e) if tries >= 50 => return Err(because(format!("bell of {name}"), e)),
            Err(_) => tries += 1,
        }
        rustix::thread::sched_yield();
    }
}

/// The end of one bell that rings.
#[derive(Debug)]
pub(crate) struct Ringing<S: Service>(Notifier<S>);

impl<S: Service> Ringing<S> {
    pub(crate) fn new(node: &Node<S>, name: &str) -> Result<Self, IpcError> {
        let notifier = service(node, name)?
            .notifier_builder()
            .default_event_id(EventId::new(0))
            .create()
            .map_err(|e| because(format!("bell of {name}"), e))?;
        Ok(Self(notifier))
    }

    pub(crate) fn ring(&self) {
        // Whoever is dead does not hear it; that is noticed by the age of what it no longer writes.
        let _ = self.0.notify();
    }

    pub(crate) fn connect(&self) {
        self.0.for_each_listener(|_, _| CallbackProgression::Continue);
        // The first datagram of a connection makes its socket one that does not block: two system calls.
        self.ring();
    }
}

/// The end of one bell that hears.
#[derive(Debug)]
pub(crate) struct Listening<S: Service>(Listener<S>);

impl<S: Service> Listening<S>
where
    Listener<S>: FileDescriptorBased,
{
    pub(crate) fn new(node: &Node<S>, name: &str) -> Result<Self, IpcError> {
        let listener = service(node, name)?
            .listener_builder()
            .create()
            .map_err(|e| because(format!("waiter of {name}"), e))?;
        Ok(Self(listener))
    }

    pub(crate) fn heard(&self) -> bool {
        // Draining is what keeps the next wait from returning at once.
        self.0.try_wait(|_| {}).is_ok_and(|rings| rings > 0)
    }

    pub(crate) fn wait(&self, timeout: Duration, spins: u32) -> bool {
        self.wait_also(timeout, spins, None)
    }

    /// The same; wakes as well when `other` can be read.
    pub(crate) fn wait_also(&self, timeout: Duration, spins: u32, other: Option<BorrowedFd<'_>>) -> bool {
        for _ in 0..spins {
            if self.heard() {
                return true;
            }
            std::hint::spin_loop();
        }
        // Own poll: iceoryx2's timed wait sets a socket time-out, which the kernel rounds up to whole ticks of 4 ms.
        // SAFETY: the descriptor belongs to the listener, which outlives this borrow; nobody closes it meanwhile.
        let fd = unsafe { BorrowedFd::borrow_raw(self.0.file_descriptor().native_handle()) };
        let limit = Timespec { tv_sec: timeout.as_secs() as i64, tv_nsec: i64::from(timeout.subsec_nanos()) };
        let mut watched = [fd, other.unwrap_or(fd)].map(|fd| PollFd::from_borrowed_fd(fd, PollFlags::IN));
        let _ = poll(&mut watched, Some(&limit));
        self.heard()
    }
}

/// Wakes the processes that wait for a topic.
#[derive(Debug)]
pub struct Bell(Vec<Ringing<RealTime>>);

impl Bell {
    pub(crate) fn new(node: &Node<RealTime>, names: &[&str]) -> Result<Self, IpcError> {
        names.iter().map(|name| Ringing::new(node, name)).collect::<Result<_, _>>().map(Self)
    }

    /// Wakes them; those already awake see it when they wait next.
    pub fn ring(&self) {
        for bell in &self.0 {
            bell.ring();
        }
    }

    /// Connects to everyone who waits by now, and wakes them once. To be called before arming: the first ring after
    /// somebody new began to wait would otherwise make the connection, and allocate.
    pub fn connect(&self) {
        for bell in &self.0 {
            bell.connect();
        }
    }
}

/// Outcome of a wait.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Woken {
    /// What was waited for is there.
    Ready,
    /// The process was asked to end.
    Stopped,
    /// Nobody rang for as long as the patience lasted.
    Silent,
}

/// Wait of one process.
#[derive(Debug)]
pub struct Waiter {
    bell: Listening<RealTime>,
    spins: u32,
}

impl Waiter {
    pub(crate) fn new(node: &Node<RealTime>, name: &str) -> Result<Self, IpcError> {
        Ok(Self { bell: Listening::new(node, name)?, spins: 0 })
    }

    /// Looks `spins` times (about 1.5 µs each) before going to sleep: less latency for a core of one's own.
    pub fn with_spins(self, spins: u32) -> Self {
        Self { spins, ..self }
    }

    /// `true`: somebody rang since the last wait; `false`: time is up.
    pub fn wait(&self, timeout: Duration) -> bool {
        self.bell.wait(timeout, self.spins)
    }

    /// Sleeps until `ready` is true; looks first, and then after every ring. For lockstep: a missing peer is named
    /// after `patience`, never waited for in silence, and a request to end is seen within 20 ms.
    pub fn wait_until(
        &self,
        patience: Duration,
        stopped: impl Fn() -> bool,
        mut ready: impl FnMut() -> bool,
    ) -> Woken {
        let mut quiet = Duration::ZERO;
        while !ready() {
            if stopped() {
                return Woken::Stopped;
            }
            if quiet >= patience {
                return Woken::Silent;
            }
            quiet = if self.wait(LOOK) { Duration::ZERO } else { quiet + LOOK };
        }
        Woken::Ready
    }
}
