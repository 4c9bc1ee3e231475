//! The way from the streams into the broker: queues inside the process, and a doorbell that wakes it.

use std::sync::mpsc as queue;

use ipc::Doorbell;
use messages::command::Priority;
use tokio::sync::oneshot;

use crate::members::Outgoing;

/// Request of a connection, mostly with the sequence of its frame. It is answered on the connection.
#[allow(missing_docs, reason = "fields are the token of a connection and the contents of its frame")]
pub enum Request {
    /// A command that came as one of this class.
    Command { token: u32, class: Priority, bytes: Vec<u8> },
    /// The client said who it is.
    Join { token: u32, name: String, may: u32, out: Outgoing, done: oneshot::Sender<()> },
    /// Sets the domains of a client.
    Subscribe { token: u32, sequence: u64, domains: u32 },
    /// Asks for a table.
    Lines { token: u32, sequence: u64, table: BrokerTable },
    /// Wants to see the robot: times per second, and whether events.
    Watch { token: u32, sequence: u64, rate: u16, events: bool },
    /// Gives a parameter another value.
    Set { token: u32, sequence: u64, sent_ns: u64, value: f64, name: String },
    /// The client is there.
    Alive { token: u32, sent_ns: u64 },
    /// Wants the lease; over whoever holds it.
    TakeLease { token: u32, sequence: u64, sent_ns: u64, over: bool },
    /// Gives the lease back.
    GiveLease { token: u32, sequence: u64 },
    /// The client closed its end: it commands nothing any more, and still gets its answers.
    Closing { token: u32 },
    /// The connection is closed.
    Leave { token: u32 },
}

/// Tables that a client can ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BrokerTable {
    /// Commands.
    Commands,
    /// Parameters of all processes.
    Parameters,
    /// Messages sent and lost, of the broker and its clients.
    Statistics,
}

/// Where the broker finds what connections hand in. How much that is, is limited by what each of them may have
/// unanswered.
pub struct Inlet {
    /// Commands by class; among those of class Normal, in the order in which they came, what commands depend on.
    pub publish: [queue::Receiver<Request>; 3],
    /// Everything else.
    pub requests: queue::Receiver<Request>,
}

/// The other end, for the connections.
#[derive(Clone)]
pub struct Gate {
    publish: [queue::Sender<Request>; 3],
    requests: queue::Sender<Request>,
    doorbell: Option<Doorbell>,
}

/// A gate to the broker and its inlet.
pub fn gate() -> (Gate, Inlet) {
    let [(high, h), (normal, n), (low, l)] = [(); 3].map(|()| queue::channel());
    let (requests, asked) = queue::channel();
    let gate = Gate { publish: [high, normal, low], requests, doorbell: None };
    (gate, Inlet { publish: [h, n, l], requests: asked })
}

impl Gate {
    /// The gate that rings the broker whenever something is handed in.
    pub(crate) fn ringing(self, doorbell: Doorbell) -> Self {
        Self { doorbell: Some(doorbell), ..self }
    }

    pub(crate) fn publish(&self, token: u32, priority: Priority, bytes: &[u8]) {
        let command = Request::Command { token, class: priority, bytes: bytes.to_vec() };
        let _ = self.publish[priority as usize].send(command);
        self.ring();
    }

    /// Hands in what is no command. Who may command, and what becomes a command, keeps its place among the commands; whoever
    /// only asks waits behind them.
    pub(crate) fn ask(&self, request: Request) {
        let queue = match request {
            Request::Join { .. }
            | Request::Set { .. }
            | Request::Alive { .. }
            | Request::TakeLease { .. }
            | Request::GiveLease { .. } => &self.publish[Priority::Normal as usize],
            _ => &self.requests,
        };
        let _ = queue.send(request);
        self.ring();
    }

    fn ring(&self) {
        if let Some(doorbell) = &self.doorbell {
            doorbell.ring();
        }
    }
}
