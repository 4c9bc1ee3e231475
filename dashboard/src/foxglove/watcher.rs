//! The thread that reads topics for viewers: only those that somebody has subscribed to, and nothing while nobody has.
//!
//! Viewers outlive robots: channels are the same for every run, so a subscription goes on with the next one.

use std::collections::BTreeSet;
use std::error::Error;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::Duration;

use axum::extract::ws::Utf8Bytes;
use broker::observation::Observation;
use config::Setup;
use ipc::{IpcError, Reader, Run, Space};
use logger::Origin;
use messages::topics::{ForType, with_type};
use messages::{Process, Record, Topic};
use realtime::clock::{SECOND, now};
use recording::composer::{Out, channels};
use recording::{Composer, LogChannel, LogTime};

use crate::foxglove::replies::{StatusLevel, advertise, parameter_values, server_info};
use crate::foxglove::requests::ViewerRequest;
use crate::foxglove::viewer::{Setting, TimedMessage, Viewer};
use crate::subscribers::Outbox;

/// Between two looks while viewers are there, and while none is \[ns\].
const LOOK: u64 = SECOND / 60;
const IDLE: u64 = SECOND / 10;
/// Between two looks whether a robot is there \[ns\].
const SEARCH: u64 = SECOND / 4;

/// Notices of viewers' sockets and operators to the watcher.
#[derive(Debug)]
pub enum ViewerNotice {
    /// A viewer has come.
    Arrived(u64, Outbox),
    /// A viewer is gone.
    Left(u64),
    /// A viewer asks for something that moves nothing.
    Asked(u64, ViewerRequest),
    /// A viewer sets parameters: orders that its operator is given.
    Setting(u64, Setting),
    /// Answer to an order of a viewer: who accepted it, or why nobody did.
    Answered(u64, u64, Result<String, String>),
    /// A sentence for whoever sits in front of the viewer.
    Status(u64, StatusLevel, String),
    /// The server ends.
    End,
}

/// The thread's state.
pub struct Watcher {
    dir: PathBuf,
    notices: Receiver<ViewerNotice>,
    viewers: Vec<Viewer>,
    channels: Vec<LogChannel>,
    /// Messages that every viewer is told first.
    greeting: [Utf8Bytes; 2],
    session: Option<Session>,
    /// Why no robot is seen.
    why: String,
    next_search: u64,
}

impl Watcher {
    /// Of the robot in `dir`.
    pub fn new(dir: PathBuf, notices: Receiver<ViewerNotice>) -> Self {
        let channels = channels();
        let greeting = [server_info(&now().to_string()), advertise(&channels)].map(Utf8Bytes::from);
        let (viewers, session, why) = (Vec::new(), None, String::new());
        Self { dir, notices, viewers, channels, greeting, session, why, next_search: 0 }
    }

    /// Until the server ends.
    pub fn run(mut self) {
        // The first one who comes is told whether a robot is there.
        self.look();
        let mut next = now();
        loop {
            let wait = Duration::from_nanos(next.saturating_sub(now()));
            match self.notices.recv_timeout(wait) {
                Ok(ViewerNotice::End) | Err(RecvTimeoutError::Disconnected) => return,
                Ok(notice) => self.hear(notice),
                Err(RecvTimeoutError::Timeout) => {
                    self.look();
                    let pause = if self.viewers.is_empty() { IDLE } else { LOOK };
                    // Cycles that a busy machine missed are not caught up on.
                    next = (next + pause).max(now());
                }
            }
        }
    }

    fn hear(&mut self, notice: ViewerNotice) {
        match notice {
            ViewerNotice::Arrived(number, outbox) => {
                let mut viewer = Viewer::new(number, outbox);
                self.greeting.iter().for_each(|text| viewer.text(text.clone()));
                if self.session.is_none() {
                    viewer.status(StatusLevel::Warning, &self.why);
                }
                self.viewers.push(viewer);
            }
            ViewerNotice::Left(number) => {
                self.viewers.retain(|viewer| viewer.number() != number);
                self.follow();
            }
            ViewerNotice::Asked(number, request) => self.ask(number, request),
            // Parameters and commands.
            ViewerNotice::Setting(number, setting) => {
                self.with(number, |viewer, _| viewer.set(setting));
                self.settle(number);
            }
            ViewerNotice::Answered(number, order, result) => {
                self.with(number, |viewer, _| viewer.answered(order, result));
                self.settle(number);
            }
            ViewerNotice::Status(number, level, text) => {
                self.with(number, |viewer, _| viewer.status(level, &text));
            }
            ViewerNotice::End => {}
        }
    }

    /// Does something with a viewer, if it is still there, and the robot, if one runs.
    fn with(&mut self, number: u64, act: impl FnOnce(&mut Viewer, Option<&mut Session>)) {
        if let Some(viewer) = self.viewers.iter_mut().find(|viewer| viewer.number() == number) {
            act(viewer, self.session.as_mut());
        }
    }

    fn ask(&mut self, number: u64, request: ViewerRequest) {
        match request {
            ViewerRequest::Subscribe(wanted) => {
                wanted.into_iter().for_each(|(id, channel)| self.subscribe(number, id, channel));
                self.follow();
            }
            ViewerRequest::Unsubscribe(ids) => {
                self.with(number, |viewer, _| viewer.unsubscribe(&ids));
                self.follow();
            }
            // No name stands for all parameters.
            ViewerRequest::Parameters(names, id) => self.with(number, |viewer, session| {
                let wanted = |name: &str| names.is_empty() || names.iter().any(|known| known == name);
                let values = session.map_or(Vec::new(), |session| session.values(wanted));
                viewer.text(parameter_values(&values, id.as_deref()));
            }),
            ViewerRequest::Follow(names) => self.with(number, |viewer, session| {
                let wanted = |name: &str| names.is_empty() || names.iter().any(|known| known == name);
                let values = session.map_or(Vec::new(), |session| session.values(wanted));
                viewer.follows.extend(values.into_iter().map(|(name, _)| name));
            }),
            ViewerRequest::Leave(names) => self.with(number, |viewer, _| {
                viewer.follows.retain(|name| !names.is_empty() && !names.contains(name));
            }),
            // Of these the socket takes care.
            ViewerRequest::Advertise(_)
            | ViewerRequest::Unadvertise(_)
            | ViewerRequest::Set(..)
            | ViewerRequest::Unknown(_) => {}
        }
    }

    fn subscribe(&mut self, number: u64, id: u32, channel: u32) {
        let channels = &self.channels;
        let Some(viewer) = self.viewers.iter_mut().find(|viewer| viewer.number() == number) else { return };
        match viewer.subscribe(id, channel, channels.len()) {
            Err(why) => viewer.status(StatusLevel::Error, &why),
            Ok(place) => {
                // What is said once is said to everybody who comes.
                let once = self.session.as_mut().filter(|_| channels[place].sources.is_empty());
                let described = once.map_or(Vec::new(), Session::describe);
                described.iter().filter(|m| m.channel == place).for_each(|m| viewer.show(m, now()));
            }
        }
    }

    /// Answers requests that are decided on: the values that were accepted, and those that are still there of the others.
    fn settle(&mut self, number: u64) {
        self.with(number, |viewer, mut session| {
            for Setting { id, names, accepted, .. } in viewer.settled() {
                let wanted = |name: &str| names.iter().any(|known| known == name);
                let mut values = session.as_mut().map_or(Vec::new(), |session| session.values(wanted));
                for (name, value) in &mut values {
                    *value = accepted.get(name).copied().unwrap_or(*value);
                }
                viewer.text(parameter_values(&values, id.as_deref()));
            }
        });
    }

    fn look(&mut self) {
        let now = now();
        if now >= self.next_search {
            self.next_search = now + SEARCH;
            self.search();
        }
        if let Some(session) = &mut self.session {
            session.show(&mut self.viewers, now);
        }
        let before = self.viewers.len();
        self.viewers.retain(|viewer| !viewer.is_gone());
        if self.viewers.len() < before {
            self.follow();
        }
    }

    /// Looks whether the robot is still there, or a new one.
    fn search(&mut self) {
        let supervisor = ipc::supervisor(&self.dir);
        // Its ports go before the next run makes others in their place.
        let gone = self.session.take_if(|session| supervisor != Some(session.supervisor)).is_some();
        if self.session.is_none() {
            match ipc::find_robot(&self.dir, Session::open) {
                Ok(session) => self.begin(session),
                Err(why) => self.why = why.to_string(),
            }
        }
        if gone && self.session.is_none() {
            let why = &self.why;
            self.viewers.iter_mut().for_each(|viewer| viewer.status(StatusLevel::Warning, why));
        }
    }

    /// Shows another run to viewers that are there.
    fn begin(&mut self, mut session: Session) {
        for viewer in &mut self.viewers {
            viewer.begin();
            for message in session.describe() {
                viewer.show(&message, now());
            }
            let values = session.values(|name| viewer.follows.contains(name));
            if !values.is_empty() {
                viewer.text(parameter_values(&values, None));
            }
        }
        self.session = Some(session);
        self.follow();
    }

    /// Follows the topics that messages of subscribed channels are made from, and no others.
    fn follow(&mut self) {
        let Some(session) = &mut self.session else { return };
        let channels = self.viewers.iter().flat_map(Viewer::channels);
        let wanted = channels.flat_map(|place| self.channels[place].sources.iter().copied()).collect();
        if let Err(e) = session.follow(&wanted) {
            tracing::warn!("a topic cannot be shown in Foxglove: {e}");
        }
    }
}

/// One run, as long as it lasts.
struct Session {
    supervisor: u32,
    composer: Composer,
    time: LogTime,
    parameters: Observation,
    taps: Vec<(&'static str, Box<dyn Tap>)>,
    // Dropped last, after its readers.
    space: Space,
}

impl Session {
    fn open(supervisor: u32, run: &Run) -> Result<Self, Box<dyn Error>> {
        let space = run.enter(Process::Observer)?;
        let (setup, origin) = (Setup::load(&run.config, &run.scene)?, Origin::of(run));
        Ok(Self {
            supervisor,
            composer: logger::composer(&setup, &origin),
            time: LogTime::new(origin.clock),
            parameters: Observation::open(&space, Some(&setup))?,
            taps: Vec::new(),
            space,
        })
    }

    /// Follows these topics, and no others.
    fn follow(&mut self, wanted: &BTreeSet<&'static str>) -> Result<(), IpcError> {
        self.taps.retain(|(name, _)| wanted.contains(name));
        for name in wanted {
            if self.taps.iter().all(|(known, _)| known != name)
                && let Some(tap) = with_type(name, OpenTap { space: &self.space })
            {
                let mut tap = tap?;
                // What was before is not shown, but the plan that is walked may be among it.
                tap.read(&mut self.composer, &mut |_| {});
                self.taps.push((*name, tap));
            }
        }
        Ok(())
    }

    /// Messages that are said once.
    fn describe(&mut self) -> Vec<TimedMessage> {
        let mut messages = Vec::new();
        self.composer.describe(&mut |message| {
            let time = self.time.next(message.channel, message.stamp_ns);
            let (channel, payload) = (message.channel, message.payload.into());
            messages.push(TimedMessage { time, channel, payload });
        });
        messages
    }

    /// Parameters of which `wanted` is true, and their present values.
    fn values(&mut self, wanted: impl Fn(&str) -> bool) -> Vec<(String, f64)> {
        let all = self.parameters.all().into_iter().map(|(entry, value)| (entry.full_name(), value));
        all.filter(|(name, value)| wanted(name) && value.is_finite()).collect()
    }

    /// One look: messages since the last one, in the order of time, and parameters that have changed.
    fn show(&mut self, viewers: &mut [Viewer], now: u64) {
        let mut messages = Vec::new();
        for (_, tap) in &mut self.taps {
            tap.read(&mut self.composer, &mut |message| {
                self.time.hear(message.stamp_ns);
                let (channel, payload) = (message.channel, message.payload.into());
                let time = self.time.next(channel, message.stamp_ns);
                messages.push(TimedMessage { time, channel, payload });
            });
        }
        messages.sort_by_key(|message| message.time);
        for viewer in &mut *viewers {
            messages.iter().for_each(|message| viewer.show(message, now));
        }
        // Parameters, to those that follow them.
        let changed = self.parameters.changed();
        for viewer in viewers {
            let own: Vec<_> =
                changed.iter().filter(|(name, _)| viewer.follows.contains(name)).cloned().collect();
            if !own.is_empty() {
                viewer.text(parameter_values(&own, None));
            }
        }
    }
}

/// A topic that somebody has subscribed to, whatever its type.
trait Tap {
    /// Messages of all records since the last look.
    fn read(&mut self, composer: &mut Composer, out: &mut Out<'_>);
}

/// A topic and its reader.
struct TopicTap<T: Record> {
    topic: &'static Topic,
    reader: Reader<T>,
}

impl<T: Record> Tap for TopicTap<T> {
    fn read(&mut self, composer: &mut Composer, out: &mut Out<'_>) {
        // No more than the ring holds: a run in simulated time may write as fast as this reads.
        for _ in 0..self.topic.depth {
            let Some(record) = self.reader.follow() else { return };
            composer.compose(self.topic, record, out);
        }
    }
}

struct OpenTap<'a> {
    space: &'a Space,
}

impl ForType<Result<Box<dyn Tap>, IpcError>> for OpenTap<'_> {
    fn call<T: Record>(self, topic: &'static Topic) -> Result<Box<dyn Tap>, IpcError> {
        Ok(Box::new(TopicTap::<T> { topic, reader: self.space.reader(topic)? }))
    }
}
