//! The thread that reads topics: it waits for a robot, shows it to every page, and waits for the next one.
//!
//! It looks sixty times a second while pages are there, and ten times while none is. Each topic keeps so many records that
//! none is missed in between; nothing that writes them knows.

use std::collections::{BTreeMap, VecDeque};
use std::error::Error;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::Duration;

use axum::extract::ws::Utf8Bytes;
use broker::observation::Observation;
use config::Setup;
use ipc::{IpcError, Reader, Run, Space};
use messages::topics::{CONTROLLER_STATE, EVENTS, PLAN, POWER, SENSORS, SIM_STATE};
use messages::{ControllerState, Event, Plan, Power, Process, Sensors, SimState};
use realtime::clock::{SECOND, now};
use serde_json::json;
use tokio::sync::watch;

use crate::description::{RobotFiles, hello, model};
use crate::health::Health;
use crate::operator;
use crate::picture::{NewestRecords, Picture, parameter_message};
use crate::plotting::{Plot, PlotField, Taps, catalogue};
use crate::requests::RecordingRequest;
use crate::subscribers::{FrameKind, Outbox, Subscriber};

/// Between two looks while pages are there, and while none is \[ns\].
const LOOK: u64 = SECOND / 60;
const IDLE: u64 = SECOND / 10;
/// Between two looks whether a robot is there, between two messages about processes, and two states of a robot that stands
/// still in time \[ns\].
const SEARCH: u64 = SECOND / 4;
const HEALTH: u64 = SECOND / 2;
/// Events that a page is told which comes later.
const REMEMBERED: usize = 50;

/// Notices of others to the observer.
#[derive(Debug)]
pub enum Notice {
    /// A page has come.
    Arrived(u64, Outbox),
    /// A page is gone.
    Left(u64),
    /// A page wants other samples: names of fields, and rate \[1/s\].
    Plot(u64, Vec<String>, f64),
    /// A page wants to see a recording at an instant, or samples of it.
    Recording(u64, RecordingRequest),
    /// Holder of the command lease; empty: nobody.
    Lease(String),
    /// Presence of the broker, or why it is not there.
    Broker(Result<(), String>),
    /// The message `scenes`: what a page can start.
    Scenes(Utf8Bytes),
    /// The message `run`: state of the run that was started from here.
    Run(Utf8Bytes),
    /// The server ends.
    End,
}

/// The thread's state.
pub struct Observer {
    dir: PathBuf,
    notices: Receiver<Notice>,
    files: watch::Sender<RobotFiles>,
    subscribers: Vec<Subscriber<Plot>>,
    session: Option<Session>,
    /// Runs seen so far.
    runs: u64,
    /// Why no robot is seen.
    why: String,
    broker: Result<(), String>,
    /// The message `link` as it was told last.
    link: Utf8Bytes,
    holder: String,
    /// Messages `scenes` and `run`; empty: runs are not started here.
    scenes: Utf8Bytes,
    run: Utf8Bytes,
    next_search: u64,
}

impl Observer {
    /// Of the robot in `dir`; its files are given to `files`.
    pub fn new(dir: PathBuf, notices: Receiver<Notice>, files: watch::Sender<RobotFiles>) -> Self {
        let (why, broker) = (String::new(), Err("the broker has not answered yet".into()));
        let (subscribers, link) = (Vec::new(), Utf8Bytes::default());
        let holder = String::new();
        Self {
            dir,
            notices,
            files,
            subscribers,
            session: None,
            runs: 0,
            why,
            broker,
            link,
            holder,
            scenes: Utf8Bytes::default(),
            run: Utf8Bytes::default(),
            next_search: 0,
        }
    }

    /// Until the server ends.
    pub fn run(mut self) {
        let mut next = now();
        loop {
            let wait = Duration::from_nanos(next.saturating_sub(now()));
            match self.notices.recv_timeout(wait) {
                Ok(Notice::End) | Err(RecvTimeoutError::Disconnected) => return,
                Ok(notice) => self.hear(notice),
                Err(RecvTimeoutError::Timeout) => {
                    self.look();
                    let pause = if self.subscribers.is_empty() { IDLE } else { LOOK };
                    // Cycles that a busy machine missed are not caught up on.
                    next = (next + pause).max(now());
                }
            }
        }
    }

    fn hear(&mut self, notice: Notice) {
        match notice {
            // A new page gets the complete state: one that comes again asks for nothing.
            Notice::Arrived(number, outbox) => {
                let mut subscriber = Subscriber::new(number, outbox);
                if let Some(session) = &self.session {
                    session.greet(&mut subscriber);
                }
                subscriber.text(&self.link_message());
                subscriber.text(&lease_message(&self.holder, number));
                let started = [&self.scenes, &self.run].into_iter().filter(|text| !text.is_empty());
                started.for_each(|text| subscriber.text(text));
                self.subscribers.push(subscriber);
            }
            Notice::Left(number) => {
                self.subscribers.retain(|subscriber| subscriber.number != number);
                self.follow_plots();
            }
            Notice::Plot(number, fields, rate) => self.plot(number, fields, rate),
            Notice::Lease(holder) => {
                self.holder = holder;
                let holder = &self.holder;
                self.subscribers
                    .iter_mut()
                    .for_each(|subscriber| subscriber.text(&lease_message(holder, subscriber.number)));
            }
            Notice::Broker(state) => {
                self.broker = state;
                self.tell_link();
            }
            Notice::Scenes(text) => {
                self.subscribers.iter_mut().for_each(|subscriber| subscriber.text(&text));
                self.scenes = text;
            }
            Notice::Run(text) => {
                self.subscribers.iter_mut().for_each(|subscriber| subscriber.text(&text));
                self.run = text;
            }
            // A running robot is only seen as it is now.
            Notice::Recording(..) | Notice::End => {}
        }
    }

    fn look(&mut self) {
        let now = now();
        if now >= self.next_search {
            self.next_search = now + SEARCH;
            self.search();
        }
        if let Some(session) = &mut self.session {
            session.show(&mut self.subscribers, now);
        }
        let before = self.subscribers.len();
        self.subscribers.retain(|subscriber| !subscriber.is_gone());
        if self.subscribers.len() < before {
            self.follow_plots();
        }
    }

    /// Looks whether the robot is still there, or a new one.
    fn search(&mut self) {
        let supervisor = ipc::supervisor(&self.dir);
        if self.session.as_ref().is_some_and(|session| supervisor != Some(session.supervisor)) {
            // Its ports go before the next run makes others in their place.
            self.session = None;
            self.files.send_replace(RobotFiles::default());
            self.subscribers.iter_mut().for_each(|subscriber| subscriber.plot = Plot::default());
        }
        if self.session.is_none() {
            let number = self.runs + 1;
            match ipc::find_robot(&self.dir, |pid, run| Session::open(pid, run, number)) {
                Ok((session, files)) => {
                    self.runs = number;
                    self.why.clear();
                    self.files.send_replace(files);
                    self.subscribers.iter_mut().for_each(|subscriber| session.greet(subscriber));
                    self.session = Some(session);
                }
                Err(why) => self.why = why.to_string(),
            }
        }
        self.tell_link();
    }

    fn link_message(&self) -> Utf8Bytes {
        let why = match (&self.session, &self.broker) {
            (None, _) => self.why.as_str(),
            (_, Err(why)) => why,
            _ => "",
        };
        let (robot, broker) = (self.session.is_some(), self.session.is_some() && self.broker.is_ok());
        json!({"type": "link", "robot": robot, "broker": broker, "why": why}).to_string().into()
    }

    fn tell_link(&mut self) {
        let link = self.link_message();
        if link != self.link {
            self.subscribers.iter_mut().for_each(|subscriber| subscriber.text(&link));
            self.link = link;
        }
    }

    fn plot(&mut self, number: u64, fields: Vec<String>, rate: f64) {
        let Some(subscriber) = self.subscribers.iter_mut().find(|subscriber| subscriber.number == number)
        else {
            return;
        };
        let answer = match &self.session {
            None => json!({"type": "plotting", "fields": [], "rate": 0.0, "why": "no robot runs"}),
            Some(session) => match Plot::new(fields, rate, session.cycle, &session.fields) {
                Ok(plot) => {
                    let rate = plot.rate(session.cycle);
                    let answer = json!({"type": "plotting", "fields": plot.fields, "rate": rate});
                    subscriber.plot = plot;
                    answer
                }
                // What it plotted before goes on.
                Err(why) => {
                    let (fields, rate) = (&subscriber.plot.fields, subscriber.plot.rate(session.cycle));
                    json!({"type": "plotting", "fields": fields, "rate": rate, "why": why})
                }
            },
        };
        let refused = answer.get("why").is_some();
        subscriber.text(&answer.to_string().into());
        self.follow_plots();
        let subscriber = self.subscribers.iter_mut().find(|subscriber| subscriber.number == number);
        if let (Some(session), Some(subscriber), false) = (&self.session, subscriber, refused) {
            session.taps.begin(&mut subscriber.plot);
        }
    }

    fn follow_plots(&mut self) {
        let Some(session) = &mut self.session else { return };
        let plots = self.subscribers.iter().map(|subscriber| &subscriber.plot);
        if let Err(e) = session.taps.follow(&session.space, plots) {
            tracing::warn!("a topic cannot be plotted: {e}");
        }
    }
}

fn lease_message(holder: &str, number: u64) -> Utf8Bytes {
    let mine = operator::is_page(holder, number);
    json!({"type": "lease", "holder": holder, "mine": mine}).to_string().into()
}

/// One run, as long as it lasts.
struct Session {
    dir: PathBuf,
    supervisor: u32,
    cycle: f64,
    hello: Utf8Bytes,
    fields: Vec<PlotField>,
    picture: Picture,
    sensors: Reader<Sensors>,
    controller: Reader<ControllerState>,
    plans: Reader<Plan>,
    power: Reader<Power>,
    /// None on a real robot.
    sim: Option<Reader<SimState>>,
    events: Vec<(Process, Reader<Event>)>,
    parameters: Observation,
    health: Health,
    taps: Taps,
    remembered: VecDeque<Utf8Bytes>,
    /// Parameters that have been changed since `hello` was made.
    changed: BTreeMap<String, f64>,
    /// Tick and time \[ns\] of the last state that was sent.
    shown: (u64, u64),
    next_health: u64,
    odd: bool,
    // Dropped last, after its readers.
    space: Space,
}

impl Session {
    fn open(supervisor: u32, run: &Run, number: u64) -> Result<(Self, RobotFiles), Box<dyn Error>> {
        // Everything that a page is told once.
        let space = run.enter(Process::Observer)?;
        let setup = Setup::load(&run.config, &run.scene)?;
        let robot = &setup.robot;
        let joints: Vec<String> = robot.joints.iter().map(|joint| joint.name.clone()).collect();
        let picture = Picture::new(&setup, run.robot)?;
        let fields = catalogue(&joints, run.robot);
        let mut parameters = Observation::open(&space, Some(&setup))?;
        let hello = hello(number, run, &setup, &picture.layout, &fields, &parameters.all())?;
        let events = EVENTS.into_iter().map(|topic| Ok((topic.writer, space.reader(topic)?)));
        let events = events.collect::<Result<Vec<_>, IpcError>>()?;
        // Readers of the topics that it shows; those that are plotted are opened when they are asked for.
        let session = Self {
            dir: run.dir.clone(),
            supervisor,
            cycle: setup.scene.cycle,
            hello: hello.to_string().into(),
            fields,
            picture,
            sensors: space.reader(&SENSORS)?,
            controller: space.reader(&CONTROLLER_STATE)?,
            plans: space.reader(&PLAN)?,
            power: space.reader(&POWER)?,
            sim: run.robot.then(|| space.reader(&SIM_STATE)).transpose()?,
            events,
            parameters,
            health: Health::open(&space, model(run, &setup), run.method_error)?,
            taps: Taps::default(),
            remembered: VecDeque::new(),
            changed: BTreeMap::new(),
            shown: (0, 0),
            next_health: 0,
            odd: false,
            space,
        };
        let files = RobotFiles::of(robot, &run.config.join("robots").join(&robot.name));
        Ok((session, files))
    }

    /// Everything a page needs that has just come.
    fn greet(&self, subscriber: &mut Subscriber<Plot>) {
        subscriber.text(&self.hello);
        self.changed.iter().for_each(|(name, value)| subscriber.text(&parameter_message(name, *value)));
        self.remembered.iter().for_each(|event| subscriber.text(event));
    }

    /// One look: events and parameters that are new, state, samples, and from time to time processes.
    fn show(&mut self, subscribers: &mut [Subscriber<Plot>], now: u64) {
        while let Some(plan) = self.plans.follow() {
            self.picture.estimator.keep(plan);
        }
        for event in self.new_events() {
            subscribers.iter_mut().for_each(|subscriber| subscriber.text(&event));
            if self.remembered.len() == REMEMBERED {
                self.remembered.pop_front();
            }
            self.remembered.push_back(event);
        }
        for (name, value) in self.parameters.changed() {
            let message = parameter_message(&name, value);
            subscribers.iter_mut().for_each(|subscriber| subscriber.text(&message));
            self.changed.insert(name, value);
        }
        if subscribers.is_empty() {
            return;
        }
        if let Some((tick, frame)) = self.state(now) {
            subscribers
                .iter_mut()
                .for_each(|subscriber| subscriber.frame(FrameKind::State, tick, &frame, now));
        }
        // Samples at half the rate: a frame then holds some rows.
        self.odd = !self.odd;
        if self.odd {
            self.taps.look();
            for subscriber in subscribers.iter_mut() {
                if let Some((tick, frame)) = self.taps.samples(&mut subscriber.plot, self.cycle) {
                    subscriber.frame(FrameKind::Samples, tick, &frame, now);
                }
            }
        }
        if now >= self.next_health {
            self.next_health = now + HEALTH;
            let told = self.health.tell(&self.dir, self.shown.0, now, self.cycle).to_string().into();
            subscribers.iter_mut().for_each(|subscriber| subscriber.text(&told));
        }
    }

    fn new_events(&mut self) -> Vec<Utf8Bytes> {
        let mut new = Vec::new();
        for (process, reader) in &mut self.events {
            while let Some(event) = reader.follow() {
                let message = self.picture.event(*process, event);
                new.push((event.header.tick, message.to_string().into()));
            }
        }
        // What several processes said between two looks, in the order of its time.
        new.sort_by_key(|(tick, _)| *tick);
        new.into_iter().map(|(_, message)| message).collect()
    }

    /// The state frame and its tick; none: nothing has changed since the last one.
    fn state(&mut self, now: u64) -> Option<(u64, Vec<u8>)> {
        let sensors = self.sensors.latest()?;
        let tick = sensors.header.tick;
        if tick == self.shown.0 && now < self.shown.1 + SEARCH {
            return None;
        }
        self.shown = (tick, now);
        let newest = NewestRecords {
            sensors,
            controller: self.controller.latest(),
            power: self.power.latest(),
            sim: self.sim.as_mut().and_then(Reader::latest),
        };
        Some((tick, self.picture.frame(newest)))
    }
}
