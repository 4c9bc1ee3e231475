//! One WebSocket: what the page asks for goes to observer, operator, starter and emergency stop; what they have for it goes out.

use std::error::Error;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::mpsc::Sender;
use std::time::Duration;

use axum::extract::ws::{CloseCode, CloseFrame, Message, WebSocket, close_code};
use futures_util::stream::{SplitSink, SplitStream};
use futures_util::{SinkExt, StreamExt};
use realtime::Bucket;
use realtime::clock::now;
use tokio::sync::{OwnedSemaphorePermit, Semaphore, mpsc};
use tokio::time::timeout;
use tungstenite::error::CapacityError;

use crate::arrival::{Arrivals, Beats, too_old};
use crate::observer::Notice;
use crate::operator::{self, Answers, Operator, answer};
use crate::requests::{Order, PageRequest, RunTask};
use crate::starter::{NO_STARTER, Starter, StarterCall};
use crate::subscribers::Outbox;

/// Sockets at once.
pub const MOST_SOCKETS: usize = 64;
/// Of them, those that command: the broker keeps places for others, too.
const MOST_OPERATORS: usize = 32;
/// Messages of a page per second, and at once.
const MOST_MESSAGES: u64 = 200;
/// Time in which a page must take a message, or something of an answer.
pub(crate) const PATIENCE: Duration = Duration::from_secs(2);

/// Answer to everything that would move a robot.
pub const RECORDING: &str = "this is a recording: there is no robot to command";

/// Shared state of all sockets.
#[derive(Debug)]
pub struct Sockets {
    /// Run directory; none: what is shown is a recording, and nothing can be commanded.
    pub dir: Option<PathBuf>,
    /// Way to the observer.
    pub observer: Sender<Notice>,
    /// Way to the emergency stop.
    pub stops: Sender<(u64, Outbox)>,
    /// Starter of runs; none: nobody allowed them.
    pub starter: Option<Starter>,
    /// Beats of the thread that reads the sockets.
    pub beats: Arc<Beats>,
    /// Places for sockets.
    pub places: Arc<Semaphore>,
    /// Places for those that command.
    desks: Arc<Semaphore>,
    /// Number of the last page.
    pages: AtomicU64,
}

impl Sockets {
    /// Of a server to which no page has come yet.
    pub fn new(
        dir: Option<PathBuf>,
        observer: Sender<Notice>,
        stops: Sender<(u64, Outbox)>,
        starter: Option<Starter>,
    ) -> Self {
        let places = Arc::new(Semaphore::new(MOST_SOCKETS));
        let desks = Arc::new(Semaphore::new(MOST_OPERATORS));
        let beats = Arc::new(Beats::new(now()));
        Self { dir, observer, stops, starter, beats, places, desks, pages: AtomicU64::new(0) }
    }

    /// An operator of this name, with the place that he takes.
    ///
    /// # Errors
    /// There is no robot to command, no place is free, or no thread.
    pub(crate) fn operator(&self, name: String, answers: Answers) -> Result<Commanding, String> {
        let dir = self.dir.as_deref().ok_or(RECORDING)?;
        let desk = self.desks.clone().try_acquire_owned();
        let desk = desk.map_err(|_| {
            format!("{MOST_OPERATORS} pages and viewers command already; close one that does not need to")
        })?;
        Ok((Operator::start(dir, name, answers)?, desk))
    }
}

/// An operator and his place.
pub(crate) type Commanding = (Operator, OwnedSemaphorePermit);

/// Serves a page until one of both ends goes. Its place is free again then.
pub async fn serve(socket: WebSocket, sockets: Arc<Sockets>, _place: OwnedSemaphorePermit) {
    let number = sockets.pages.fetch_add(1, Relaxed) + 1;
    let (outbox, fed) = Outbox::new();
    if sockets.observer.send(Notice::Arrived(number, outbox.clone())).is_err() {
        return;
    }
    let (sink, stream) = socket.split();
    let mut page =
        Page { number, outbox: outbox.clone(), operator: None, sockets: sockets.clone(), since: 0 };
    let left = || _ = sockets.observer.send(Notice::Left(number));
    // With the page goes its operator, and the command lease.
    converse(sink, fed, &outbox, async move { page.listen(stream).await }, left).await;
}

/// Sends what is in the queue and listens at the same time, until one of both ends or nobody feeds the queue any more: a page
/// that does not read its frames can still stop the robot. Whoever listens is gone when `left` is called.
pub(crate) async fn converse(
    sink: SplitSink<WebSocket, Message>,
    fed: mpsc::Receiver<Message>,
    outbox: &Outbox,
    listening: impl Future<Output = Closing>,
    left: impl FnOnce(),
) {
    let mut feeding = std::pin::pin!(feed(sink, fed));
    let why = tokio::select! {
        why = listening => why,
        () = &mut feeding => None,
        () = outbox.ended() => None,
    };
    left();
    if let Some((code, why)) = why
        && outbox.close(CloseFrame { code, reason: why.into() })
    {
        let _ = timeout(PATIENCE, feeding).await;
    }
}

/// Sends what is in the queue, until the page is gone or does not take a message.
async fn feed(mut sink: SplitSink<WebSocket, Message>, mut fed: mpsc::Receiver<Message>) {
    while let Some(message) = fed.recv().await {
        let last = matches!(message, Message::Close(_));
        // Of many small messages that wait the last one takes the others along.
        let more = !last && !fed.is_empty();
        let sending = async { if more { sink.feed(message).await } else { sink.send(message).await } };
        if !matches!(timeout(PATIENCE, sending).await, Ok(Ok(()))) || last {
            return;
        }
    }
}

/// Reason for closing a connection.
pub(crate) type Closing = Option<(CloseCode, String)>;

/// Messages that may still come.
pub(crate) struct Budget(Bucket);

impl Budget {
    /// Of a client that has just come.
    pub(crate) fn new() -> Self {
        Self(Bucket::full(MOST_MESSAGES, MOST_MESSAGES))
    }

    /// Reason for closing, if a message is one too many.
    pub(crate) fn spend(&mut self) -> Closing {
        (!self.0.take(now())).then(|| (close_code::POLICY, "too many messages".into()))
    }
}

/// Reason for closing after a message that cannot be read; none: the connection is lost.
pub(crate) fn unreadable(error: &axum::Error) -> Closing {
    let inner = error.source().and_then(|inner| inner.downcast_ref::<tungstenite::Error>());
    let too_long = matches!(inner, Some(tungstenite::Error::Capacity(CapacityError::MessageTooLong { .. })));
    too_long.then(|| (close_code::SIZE, "a frame is too long".into()))
}

struct Page {
    number: u64,
    outbox: Outbox,
    operator: Option<Commanding>,
    sockets: Arc<Sockets>,
    /// Time since when the message that is taken may have waited \[ns\].
    since: u64,
}

impl Page {
    /// Takes the page's messages until it goes, or is to go for a reason.
    async fn listen(&mut self, stream: SplitStream<WebSocket>) -> Closing {
        let mut budget = Budget::new();
        let mut arrivals = Arrivals::new(stream, self.sockets.beats.clone());
        loop {
            // How old it may be goes with whatever comes of it.
            let (message, since) = arrivals.next().await?;
            self.since = since;
            let text = match message {
                Ok(Message::Text(text)) => text,
                Ok(Message::Binary(_)) => return Some((close_code::POLICY, "a frame is no text".into())),
                Ok(Message::Ping(_) | Message::Pong(_)) => "".into(),
                Ok(Message::Close(_)) => return None,
                Err(e) => return unreadable(&e),
            };
            if let Some(flood) = budget.spend() {
                return Some(flood);
            }
            if text.is_empty() {
                continue;
            }
            match PageRequest::parse(&text) {
                Ok(request) => self.take(request)?,
                Err(why) => return Some((close_code::POLICY, shortened(why))),
            }
        }
    }

    /// Passes a message on; none: the server ends.
    fn take(&mut self, request: PageRequest) -> Option<()> {
        match request {
            PageRequest::Plot(fields, rate) => {
                self.sockets.observer.send(Notice::Plot(self.number, fields, rate)).ok()
            }
            PageRequest::Recording(what) => {
                self.sockets.observer.send(Notice::Recording(self.number, what)).ok()
            }
            PageRequest::EmergencyStop(id) if self.sockets.dir.is_none() => {
                answer(&self.outbox, id, &Err(RECORDING.into()));
                Some(())
            }
            PageRequest::Run(id, task) => self.run(id, task),
            PageRequest::EmergencyStop(id) => self.sockets.stops.send((id, self.outbox.clone())).ok(),
            PageRequest::Order(order) => {
                self.order(order);
                Some(())
            }
        }
    }

    /// Gives a task to the starter; none: the server ends.
    fn run(&self, id: u64, task: Result<RunTask, String>) -> Option<()> {
        // She walks by a start, too; an end only brings her to rest.
        let old = if matches!(task, Ok(RunTask::Start(_))) { too_old(self.since) } else { None };
        let refused = match (&self.sockets.starter, task) {
            (Some(starter), Ok(task)) => match old {
                None => return starter.call(StarterCall::Page(id, self.outbox.clone(), task)),
                Some(why) => why,
            },
            (Some(_), Err(why)) => why,
            (None, _) if self.sockets.dir.is_none() => RECORDING.into(),
            (None, _) => NO_STARTER.into(),
        };
        answer(&self.outbox, id, &Err(refused));
        Some(())
    }

    /// Gives an order to the operator, who comes with the first one.
    fn order(&mut self, order: Order) {
        // A page that only lives needs no operator.
        let Some(id) = order.id().or(self.operator.is_some().then_some(0)) else { return };
        if self.operator.is_none() {
            let outbox = self.outbox.clone();
            let answers: Answers = Box::new(move |id, result| answer(&outbox, id, result));
            match self.sockets.operator(operator::name(self.number), answers) {
                Ok(operator) => self.operator = Some(operator),
                Err(why) => return answer(&self.outbox, id, &Err(why)),
            }
        }
        if let Some((operator, _)) = &self.operator {
            operator.give(order, self.since);
        }
    }
}

/// A reason as long as a close frame holds.
pub(crate) fn shortened(mut text: String) -> String {
    const LONGEST: usize = 120;
    if text.len() > LONGEST {
        text.truncate((0..=LONGEST).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0));
    }
    text
}
