//! One client of the broker for each page or viewer that commands: orders out, answers back, and heartbeats that only the page gives.
//!
//! A thread each, started with its first order, because the client of the broker waits. When the page goes, so does the
//! connection, and with it the command lease: the robot comes to a stand.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::Duration;

use broker::identity::is_own;
use broker::stream_client::{IDLE, News};
use broker::{Awaited, StreamClient};
use realtime::clock::now;
use serde_json::json;

use crate::arrival::too_old;
use crate::observer::Notice;
use crate::requests::Order;
use crate::subscribers::Outbox;

/// Between two looks for an answer that is awaited, and for news otherwise.
const AWAIT: Duration = Duration::from_millis(2);
const LOOK: Duration = Duration::from_millis(200);

/// Receiver of answers: number of an order, and who accepted it, or why nobody did.
pub type Answers = Box<dyn Fn(u64, &Result<String, String>) + Send>;

/// Name under which a page commands.
pub fn name(page: u64) -> String {
    format!("dashboard page {page}")
}

/// True if the holder of the lease, as the broker names it, is this page of this server.
pub fn is_page(holder: &str, page: u64) -> bool {
    is_own(holder, &name(page))
}

/// The answer to an order, for its page.
pub fn answer(outbox: &Outbox, id: u64, result: &Result<String, String>) {
    let (accepted, text) = match result {
        Ok(text) => (true, text),
        Err(text) => (false, text),
    };
    outbox.text(json!({"type": "answer", "id": id, "accepted": accepted, "text": text}).to_string());
}

/// The way to an operator. Dropping it ends its connection.
#[derive(Debug)]
pub struct Operator {
    orders: Sender<(Order, u64)>,
}

impl Operator {
    /// Starts an operator of the robot in `dir`, who has this name at the broker.
    ///
    /// # Errors
    /// The thread cannot be started.
    pub fn start(dir: &Path, name: String, answers: Answers) -> Result<Self, String> {
        let (orders, heard) = channel();
        let thread = std::thread::Builder::new().name(name.clone());
        let desk = Desk { dir: dir.into(), name, answers, client: None, awaited: Awaited::default() };
        thread.spawn(move || desk.run(&heard)).map_err(|e| format!("a thread for the operator: {e}"))?;
        Ok(Self { orders })
    }

    /// Gives an order that may have waited since then \[ns\]; it is answered.
    pub fn give(&self, order: Order, since: u64) {
        // The thread ends only after this.
        let _ = self.orders.send((order, since));
    }
}

/// The thread's state.
struct Desk {
    dir: PathBuf,
    name: String,
    answers: Answers,
    client: Option<StreamClient>,
    /// Numbers of orders that are not answered yet.
    awaited: Awaited<u64>,
}

impl Desk {
    fn run(mut self, orders: &Receiver<(Order, u64)>) {
        loop {
            let wait = if self.awaited.is_empty() { LOOK } else { AWAIT };
            match orders.recv_timeout(wait) {
                Ok((order, since)) => {
                    self.carry_out(order, since);
                    while let Ok((order, since)) = orders.try_recv() {
                        self.carry_out(order, since);
                    }
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
            if let Err(why) = self.listen() {
                self.lose(&why);
            }
        }
    }

    /// Sends an order to the broker, over a new connection if there is none. The broker takes it for one of now: what is old by then
    /// must not come so far.
    fn carry_out(&mut self, order: Order, since: u64) {
        if !order.only_stops()
            && let Some(why) = too_old(since)
        {
            // A pulse of that time is no heartbeat any more.
            return order.id().map_or((), |id| (self.answers)(id, &Err(why)));
        }
        let Some(id) = order.id() else { return self.live() };
        if let Order::Command(_, Err(why)) = &order {
            return (self.answers)(id, &Err(why.clone()));
        }
        let Some(client) = &mut self.client else {
            // The first order of a page makes it a client of the broker, which may take its time.
            return match StreamClient::connect(&self.dir, &self.name) {
                Ok(client) => {
                    self.client = Some(client);
                    self.carry_out(order, since);
                }
                Err(why) => (self.answers)(id, &Err(why)),
            };
        };
        let sent = match order {
            Order::Command(_, Ok(command)) => client.send(&command),
            Order::Set(_, name, value) => client.set(&name, value),
            Order::TakeLease(_, over) => client.ask_lease(over),
            _ => client.give_lease(),
        };
        match sent {
            Ok(sequence) => self.awaited.insert(sequence, id, now()),
            Err(why) => {
                (self.answers)(id, &Err(why.clone()));
                self.lose(&why);
            }
        }
    }

    /// The page lives; one that only lives needs no connection.
    fn live(&mut self) {
        if let Some(Err(why)) = self.client.as_mut().map(StreamClient::ping) {
            self.lose(&why);
        }
    }

    /// Passes answers on.
    fn listen(&mut self) -> Result<(), String> {
        let Some(client) = &mut self.client else { return Ok(()) };
        // A millisecond, in which this client says nothing by itself: the page's life is not ours to claim.
        while let Some(news) = client.news(Duration::from_millis(1))? {
            let News::Answer(reply) = news else { continue };
            if let Some(id) = self.awaited.take(&reply) {
                (self.answers)(id, &reply.accepted());
            }
        }
        client.keep_alive(IDLE)?;
        self.awaited.check(now())
    }

    /// The connection is over: whatever waits for an answer has this one.
    fn lose(&mut self, why: &str) {
        self.client = None;
        for id in std::mem::take(&mut self.awaited).into_requests() {
            (self.answers)(id, &Err(why.to_owned()));
        }
    }
}

/// Looks who holds the command lease and whether the broker is there, until the observer is gone.
pub fn watch_lease(dir: &Path, observer: &Sender<Notice>) {
    let mut told = None;
    loop {
        let lost = match watch_one_broker(dir, observer, &mut told) {
            Ok(()) => return,
            Err(why) => why,
        };
        if told.as_ref() != Some(&lost) {
            let known = observer.send(Notice::Broker(Err(lost.clone())));
            let known = known.and_then(|()| observer.send(Notice::Lease(String::new())));
            if known.is_err() {
                return;
            }
            told = Some(lost);
        }
        std::thread::park_timeout(LOOK);
    }
}

/// The same for as long as one broker lives; `Ok`: the observer is gone.
fn watch_one_broker(dir: &Path, observer: &Sender<Notice>, told: &mut Option<String>) -> Result<(), String> {
    let mut client = StreamClient::connect(dir, "dashboard")?;
    client.watch(0, false)?;
    *told = None;
    if observer.send(Notice::Broker(Ok(()))).is_err() {
        return Ok(());
    }
    loop {
        if let Some(News::Lease(_, holder)) = client.news(Duration::from_millis(100))?
            && observer.send(Notice::Lease(holder)).is_err()
        {
            return Ok(());
        }
        client.keep_alive(IDLE)?;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::Command;
    use messages::command::VelocityCommand;

    /// She walked by an order that had waited for 4 s in a server that stood still, because the broker was told of it as one of now.
    #[test]
    fn what_waited_too_long_is_refused_and_stops_are_not() {
        let (answers, answered) = channel();
        let answers: Answers = Box::new(move |id, result| answers.send((id, result.clone())).unwrap());
        let (dir, name) = (PathBuf::from("/nonexistent"), "test".to_owned());
        let mut desk = Desk { dir, name, answers, client: None, awaited: Awaited::default() };
        let velocity = |forward| Command::Velocity(VelocityCommand { forward, left: 0.0, turn: 0.0 });
        let moves = [
            Order::Command(1, Ok(velocity(0.3))),
            Order::Command(1, Ok(Command::Stand)),
            Order::Set(1, "planner.swing_height".into(), 0.06),
            Order::TakeLease(1, true),
        ];
        let stops = [
            Order::Command(1, Ok(velocity(0.0))),
            Order::Command(1, Ok(Command::Stop)),
            Order::Command(1, Ok(Command::EmergencyStop)),
            Order::GiveLease(1),
        ];
        // No broker is there; who asks for it has passed.
        let mut passes = |order: &Order, since| {
            desk.carry_out(order.clone(), since);
            let (_, result) = answered.try_recv().unwrap();
            let why = result.unwrap_err();
            assert!(why.contains("stood still") != why.contains("no broker"), "{why}");
            why.contains("no broker")
        };
        for order in moves {
            assert!(!passes(&order, 0), "{order:?}");
            assert!(passes(&order, now()), "{order:?}");
        }
        for order in stops {
            assert!(passes(&order, 0), "{order:?}");
        }
    }
}
