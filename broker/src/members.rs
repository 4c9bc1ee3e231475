//! Clients of the broker: who they are, what they subscribed to, and the way to each of them.

use ipc::QueueSender;
use messages::command::Domain;
use tokio::sync::mpsc;

use crate::admission::Sender;

/// The way to a client.
pub(crate) enum MemberExit {
    /// A process of the run: queue, and when it last renewed its registration \[ns\].
    Queue { sender: Box<QueueSender>, renewed: u64 },
    /// A stream.
    Stream(Outgoing),
}

/// The way to a client on a stream. Answers are never lost: there are no more of them than commands that the connection
/// may have on their way. Everything else is, when the client does not read.
#[derive(Clone)]
pub struct Outgoing {
    /// Answers.
    pub answers: mpsc::UnboundedSender<Vec<u8>>,
    /// Commands of the domains subscribed to, and news of the lease.
    pub frames: mpsc::Sender<Vec<u8>>,
}

/// One client.
pub(crate) struct Member {
    pub(crate) name: String,
    pub(crate) sender: Sender,
    pub(crate) domains: u32,
    pub(crate) exit: MemberExit,
    pub(crate) sent: u64,
    pub(crate) lost: u64,
    pub(crate) watch: Watch,
}

/// Subscription of a client to the robot's state and events.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Watch {
    /// It has asked.
    pub(crate) asked: bool,
    /// It gets events.
    pub(crate) events: bool,
    /// Time from one state to the next \[ns\]; 0: none.
    pub(crate) period: u64,
    /// Time of the next one \[ns\].
    pub(crate) due: u64,
}

impl Member {
    /// A client that does not keep up loses its own messages; the broker never waits for it.
    pub(crate) fn deliver(&mut self, bytes: &[u8]) {
        self.sent += 1;
        match &mut self.exit {
            // The receiving end counts what is lost and tells it with its registration.
            MemberExit::Queue { sender, .. } => _ = sender.send(bytes),
            MemberExit::Stream(out) => self.lost += u64::from(out.frames.try_send(bytes.to_vec()).is_err()),
        }
    }

    /// Answers a frame of this client.
    pub(crate) fn answer(&mut self, bytes: Vec<u8>) {
        match &mut self.exit {
            MemberExit::Queue { sender, .. } => _ = sender.send(&bytes),
            MemberExit::Stream(out) => _ = out.answers.send(bytes),
        }
    }

    pub(crate) fn hears(&self, domain: Domain) -> bool {
        self.domains & 1 << domain as u16 != 0
    }

    pub(crate) fn is_process(&self) -> bool {
        matches!(self.exit, MemberExit::Queue { .. })
    }

    /// Whether it is the process of that name: its own name is `NAME-PID-COUNT`.
    pub(crate) fn is_called(&self, process: &str) -> bool {
        let rest = self.name.strip_prefix(process).and_then(|rest| rest.strip_prefix('-'));
        self.is_process() && rest.is_some_and(|rest| rest.split('-').all(|n| n.parse::<u32>().is_ok()))
    }

    /// One line of the statistics.
    pub(crate) fn describe(&self) -> String {
        let subscribed = Domain::ALL.into_iter().filter(|d| self.hears(*d));
        let domains = subscribed.map(Domain::name).collect::<Vec<_>>().join(", ");
        format!("{}: sent {}, lost {}; subscribed to {domains}", self.name, self.sent, self.lost)
    }
}
