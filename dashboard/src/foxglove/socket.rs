//! One WebSocket of a viewer: what it asks for goes to the watcher, what it commands to an operator of its own.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::mpsc::Sender;

use axum::extract::ws::{Message, WebSocket, close_code};
use futures_util::StreamExt;
use futures_util::stream::SplitStream;
use tokio::sync::{OwnedSemaphorePermit, Semaphore};

use crate::arrival::Arrivals;
use crate::foxglove::replies::StatusLevel;
use crate::foxglove::requests::{ENCODING, OwnChannel, VELOCITY, ViewerRequest, published, velocity};
use crate::foxglove::viewer::Setting;
use crate::foxglove::watcher::ViewerNotice;
use crate::operator::Answers;
use crate::requests::Order;
use crate::socket::{Budget, Closing, Commanding, Sockets, converse, shortened, unreadable};
use crate::subscribers::Outbox;

/// Viewers at once.
pub const MOST_VIEWERS: usize = 16;
/// Messages that wait for one viewer: 0.1 s of every channel at once, or 2 s of one.
const ROOM: usize = 4096;
/// Channels of one viewer's own.
const MOST_OWN: usize = 16;

/// Common state of the sockets of viewers.
#[derive(Debug)]
pub struct Lobby {
    sockets: Arc<Sockets>,
    watcher: Sender<ViewerNotice>,
    /// Places for viewers.
    pub places: Arc<Semaphore>,
    /// Number of the last viewer.
    viewers: AtomicU64,
}

impl Lobby {
    /// Of a server to which no viewer has come yet.
    pub fn new(sockets: Arc<Sockets>, watcher: Sender<ViewerNotice>) -> Self {
        let places = Arc::new(Semaphore::new(MOST_VIEWERS));
        Self { sockets, watcher, places, viewers: AtomicU64::new(0) }
    }
}

/// Serves a viewer until one of both ends goes. Its place is free again then.
pub async fn serve(socket: WebSocket, lobby: &Lobby, may_command: bool, _place: OwnedSemaphorePermit) {
    let number = lobby.viewers.fetch_add(1, Relaxed) + 1;
    let (outbox, fed) = Outbox::with_room(ROOM);
    let watcher = lobby.watcher.clone();
    if watcher.send(ViewerNotice::Arrived(number, outbox.clone())).is_err() {
        return;
    }
    let (sink, stream) = socket.split();
    let mut client = ViewerSocket {
        number,
        may_command,
        sockets: lobby.sockets.clone(),
        watcher: watcher.clone(),
        channels: BTreeMap::new(),
        operator: None,
        orders: 0,
        since: 0,
    };
    let left = || _ = watcher.send(ViewerNotice::Left(number));
    // With the viewer goes its operator, and the command lease.
    converse(sink, fed, &outbox, async move { client.listen(stream).await }, left).await;
}

/// Viewer as its socket knows it.
struct ViewerSocket {
    number: u64,
    may_command: bool,
    sockets: Arc<Sockets>,
    watcher: Sender<ViewerNotice>,
    /// Channels of its own, by number: all of them for walking commands.
    channels: BTreeMap<u32, OwnChannel>,
    operator: Option<Commanding>,
    /// Number of the last order.
    orders: u64,
    /// Time since when the message that is taken may have waited \[ns\].
    since: u64,
}

impl ViewerSocket {
    /// Takes the viewer's messages until it goes, or is to go for a reason.
    async fn listen(&mut self, stream: SplitStream<WebSocket>) -> Closing {
        let mut budget = Budget::new();
        let mut arrivals = Arrivals::new(stream, self.sockets.beats.clone());
        loop {
            // How old it may be goes with whatever comes of it.
            let (message, since) = arrivals.next().await?;
            self.since = since;
            let message = match message {
                Ok(Message::Close(_)) => return None,
                Ok(message) => message,
                Err(e) => return unreadable(&e),
            };
            if let Some(flood) = budget.spend() {
                return Some(flood);
            }
            let taken = match &message {
                Message::Text(text) => ViewerRequest::parse(text).map(|request| self.take(request)),
                Message::Binary(bytes) => {
                    published(bytes).map(|(channel, content)| self.publish(channel, content))
                }
                _ => Ok(Some(())),
            };
            match taken {
                Ok(served) => served?,
                Err(why) => return Some((close_code::POLICY, shortened(why))),
            }
        }
    }

    /// Passes a request on; none: the server ends.
    fn take(&mut self, request: ViewerRequest) -> Option<()> {
        match request {
            ViewerRequest::Advertise(channels) => {
                channels.into_iter().try_for_each(|channel| self.advertise(channel))
            }
            ViewerRequest::Unadvertise(ids) => {
                self.channels.retain(|id, _| !ids.contains(id));
                Some(())
            }
            ViewerRequest::Set(values, id) => self.set(values, id),
            ViewerRequest::Unknown(op) => {
                self.status(StatusLevel::Warning, format!("{op}: this server has no answer to it"))
            }
            request => self.tell(ViewerNotice::Asked(self.number, request)),
        }
    }

    /// Takes a channel of the viewer's own, or says why not.
    fn advertise(&mut self, channel: OwnChannel) -> Option<()> {
        let OwnChannel { topic, encoding, .. } = &channel;
        let refusal = if !self.may_command {
            needs_token(topic)
        } else if topic.trim_start_matches('/') != VELOCITY {
            format!("{topic}: only {VELOCITY} can be published; docs/foxglove.md has its fields")
        } else if encoding != ENCODING {
            format!("{topic}: encoding {encoding} is not understood; publish it as {ENCODING}")
        } else if self.channels.len() == MOST_OWN {
            format!("{topic}: {MOST_OWN} channels are published already; unadvertise one")
        } else {
            self.channels.insert(channel.id, channel);
            return Some(());
        };
        self.status(StatusLevel::Error, refusal)
    }

    /// Takes a message on a channel of the viewer's own: a walking command.
    fn publish(&mut self, channel: u32, content: &[u8]) -> Option<()> {
        if !self.channels.contains_key(&channel) {
            let why = format!("channel {channel} is not published: advertise it first");
            return self.status(StatusLevel::Error, why);
        }
        let number = self.number_of_order();
        self.order(Order::Command(number, velocity(content)), number)
    }

    /// Sets parameters; the answer comes when all of them are decided on, and says what they are then.
    fn set(&mut self, values: Vec<(String, Option<f64>)>, id: Option<String>) -> Option<()> {
        let mut setting = Setting { id, ..Setting::default() };
        for (name, value) in values {
            setting.names.push(name.clone());
            match value {
                _ if !self.may_command => self.status(StatusLevel::Error, needs_token(&name))?,
                None => self.status(StatusLevel::Error, format!("{name}: a number is needed"))?,
                Some(value) => _ = setting.orders.insert(self.number_of_order(), (name, value)),
            }
        }
        // Known to the watcher before the first answer can be there.
        let orders = setting.orders.clone();
        self.tell(ViewerNotice::Setting(self.number, setting))?;
        orders
            .into_iter()
            .try_for_each(|(number, (name, value))| self.order(Order::Set(number, name, value), number))
    }

    /// Gives an order to the operator, who comes with the first one.
    fn order(&mut self, order: Order, number: u64) -> Option<()> {
        if self.operator.is_none() {
            let (viewer, watcher) = (self.number, self.watcher.clone());
            let answers: Answers = Box::new(move |order, result| {
                // A watcher that is gone needs no answers.
                let _ = watcher.send(ViewerNotice::Answered(viewer, order, result.clone()));
            });
            match self.sockets.operator(format!("Foxglove viewer {viewer}"), answers) {
                Ok(operator) => self.operator = Some(operator),
                Err(why) => return self.tell(ViewerNotice::Answered(viewer, number, Err(why))),
            }
        }
        if let Some((operator, _)) = &self.operator {
            operator.give(order, self.since);
        }
        Some(())
    }

    fn number_of_order(&mut self) -> u64 {
        self.orders += 1;
        self.orders
    }

    /// A sentence for whoever sits in front of the viewer.
    fn status(&self, level: StatusLevel, text: String) -> Option<()> {
        self.tell(ViewerNotice::Status(self.number, level, text))
    }

    /// Tells the watcher; none: the server ends.
    fn tell(&self, notice: ViewerNotice) -> Option<()> {
        self.watcher.send(notice).ok()
    }
}

/// Refusal of what only an operator may do.
fn needs_token(what: &str) -> String {
    format!(
        "{what}: refused without the operator's token; connect with ?token=TOKEN, as in the address that `gangwerk dashboard \
         --foxglove` printed"
    )
}
