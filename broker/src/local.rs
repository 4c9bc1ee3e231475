//! The local broker: inside one process, objects subscribe to message ids and publishing calls them directly.
//!
//! Subscribers are functions on the process's state `C`. After the subscriptions nothing is allocated. A subscriber
//! may publish on; such messages are delivered after the present one, in order, and a chain of them is bounded, so
//! that two state machines that answer each other cannot hold up a control cycle.

use messages::Command;
use messages::command::Domain;

use crate::Client;

/// Messages waiting behind the one that is being delivered.
const MAX_WAITING: usize = 16;
/// Messages delivered for one call from outside.
const MAX_CHAIN: usize = 64;

/// How far a message goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// This process.
    Local,
    /// This process, and every other one that subscribed to the domain.
    Global,
}

/// What a subscriber publishes on.
#[derive(Debug)]
pub struct Outbox {
    waiting: Vec<(Command, Reach)>,
    lost: u64,
}

impl Outbox {
    /// Delivers `command` after the present message; false, and counted as lost, if too many wait.
    pub fn publish(&mut self, command: Command, reach: Reach) -> bool {
        let room = self.waiting.len() < MAX_WAITING;
        if room {
            self.waiting.push((command, reach));
        } else {
            self.lost += 1;
        }
        room
    }
}

/// A function that is called with the process's state and the message.
pub type Subscriber<C> = fn(&mut C, &Command, &mut Outbox);

/// The local broker of a process with state `C`.
pub struct LocalBroker<C> {
    subscribers: Vec<(Domain, u16, Subscriber<C>)>,
    outbox: Outbox,
    client: Option<Client>,
}

impl<C> LocalBroker<C> {
    /// A broker that delivers global messages through `client`; without one they stay in the process.
    pub fn new(client: Option<Client>) -> Self {
        let outbox = Outbox { waiting: Vec::with_capacity(MAX_WAITING), lost: 0 };
        Self { subscribers: Vec::new(), outbox, client }
    }

    /// Calls `subscriber` for every message of that address from now on. Allocates: before the first cycle.
    pub fn subscribe(&mut self, (domain, id): (Domain, u16), subscriber: Subscriber<C>) {
        self.subscribers.push((domain, id, subscriber));
    }

    /// Calls the subscribers of the message, in the order of their subscription.
    pub fn publish(&mut self, state: &mut C, command: &Command, reach: Reach) {
        self.outbox.publish(*command, reach);
        for _ in 0..MAX_CHAIN {
            if self.outbox.waiting.is_empty() {
                return;
            }
            let (command, reach) = self.outbox.waiting.remove(0);
            if let (Reach::Global, Some(client)) = (reach, &mut self.client) {
                client.publish(&command);
            }
            let address = command.address();
            for (_, _, call) in self.subscribers.iter().filter(|(d, id, _)| (*d, *id) == address) {
                call(state, &command, &mut self.outbox);
            }
        }
        self.outbox.lost += self.outbox.waiting.len() as u64;
        self.outbox.waiting.clear();
    }

    /// Delivers what came from other processes: once per cycle, at its boundary.
    pub fn deliver_received(&mut self, state: &mut C) {
        let waiting = self.client.as_ref().map_or(0, Client::waiting);
        for _ in 0..waiting {
            let Some(command) = self.client.as_mut().and_then(Client::receive) else { return };
            self.publish(state, &command, Reach::Local);
        }
    }

    /// Messages lost because subscribers published too much.
    pub fn lost(&self) -> u64 {
        self.outbox.lost
    }

    /// The connection to the global broker.
    pub fn client(&self) -> Option<&Client> {
        self.client.as_ref()
    }
}
