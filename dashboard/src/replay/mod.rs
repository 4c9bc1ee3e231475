//! Replay of a log, or of two side by side, in place of a running robot: `gangwerk dashboard --replay LOG`.
//!
//! - `film.rs`: one log, as hello, state frames and events.
//! - `window.rs`: samples of a stretch of it.
//!
//! Each page has its own instant, and asks for it: what nobody asks for is not read. Of many requests of a page only the newest
//! is answered, so that neither a long log nor a page in a hurry takes memory.

mod film;
mod window;

use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::Duration;

use axum::extract::ws::Utf8Bytes;
use realtime::clock::{SECOND, now};
use recording::RecordingError;
use serde_json::{Value, json};

use crate::observer::Notice;
use crate::plotting::Plot;
use crate::requests::RecordingRequest;
use crate::subscribers::{FrameKind, Subscriber};

pub use film::{Film, Recorded};
use window::Window;

/// Between two looks while nobody asks for anything, and while a page has no room for what it asked for.
const IDLE: Duration = Duration::from_millis(100);
const FULL: Duration = Duration::from_millis(4);
/// Between two looks whether a log has grown \[ns\].
const GROWTH: u64 = SECOND / 2;
/// Most events that are told, and those of one message.
const MOST_EVENTS: usize = 20_000;
const AT_ONCE: usize = 1000;
/// Chunks that are searched for events before pages are looked at again.
const SEARCHED: usize = 4;

/// View of one page: its fields, instants and stretches.
#[derive(Default)]
struct Desk {
    fields: Vec<String>,
    rate: f64,
    /// Instants of both logs that it waits for \[s\].
    seek: Option<(f64, Option<f64>)>,
    /// Stretches that it waits for, and that are on their way.
    asked: [Option<[f64; 2]>; 2],
    windows: [Option<Window>; 2],
}

/// A log, and perhaps another one beside it.
///
/// # Errors
/// One of them cannot be shown, or their robots have different joints.
pub fn side_by_side(log: Recorded, other: Option<Recorded>) -> Result<Vec<Film>, String> {
    let film = Film::new(log)?;
    let other = other.map(Film::new).transpose()?;
    if let Some(other) = other.as_ref().filter(|other| other.joints != film.joints) {
        let (mine, theirs) = (film.about(), other.about());
        return Err(format!(
            "--against {}: its robot has other joints ({}) than that of {} ({}); only logs of one robot lie side by side",
            theirs["log"],
            other.joints.len(),
            mine["log"],
            film.joints.len()
        ));
    }
    Ok(std::iter::once(film).chain(other).collect())
}

/// Thread that shows one log or two to every page.
pub struct Player {
    films: Vec<Film>,
    notices: Receiver<Notice>,
    subscribers: Vec<Subscriber<Desk>>,
    hello: Utf8Bytes,
    /// Events of the first log so far, as they are told, and its next chunk.
    events: Vec<Value>,
    told: usize,
    searched: usize,
    /// Why something cannot be shown; empty: all can.
    why: String,
    next_look: u64,
}

impl Player {
    /// Of films that go side by side.
    pub fn new(films: Vec<Film>, notices: Receiver<Notice>) -> Self {
        let mut player = Self {
            films,
            notices,
            subscribers: Vec::new(),
            hello: Utf8Bytes::default(),
            events: Vec::new(),
            told: 0,
            searched: 0,
            why: String::new(),
            next_look: 0,
        };
        player.describe();
        player
    }

    fn describe(&mut self) {
        let mut hello = self.films[0].hello().clone();
        hello["replay"] = self.recording();
        self.hello = hello.to_string().into();
    }

    /// Description of the logs for a page.
    fn recording(&self) -> Value {
        let mut about = self.films[0].about();
        about["other"] = self.films.get(1).map_or(Value::Null, Film::about);
        about
    }

    /// Until the server ends.
    pub fn run(mut self) {
        loop {
            match self.notices.recv_timeout(self.pause()) {
                Ok(Notice::End) | Err(RecvTimeoutError::Disconnected) => return,
                Ok(notice) => {
                    self.hear(notice);
                    while let Ok(notice) = self.notices.try_recv() {
                        if matches!(notice, Notice::End) {
                            return;
                        }
                        self.hear(notice);
                    }
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
            match self.work() {
                Err(why) => self.complain(why.to_string()),
                Ok(true) => self.complain(String::new()),
                Ok(false) => {}
            }
            self.subscribers.retain(|subscriber| !subscriber.is_gone());
        }
    }

    /// Time to wait for a notice: none with work left.
    fn pause(&self) -> Duration {
        let pause = |subscriber: &Subscriber<Desk>| {
            let desk = &subscriber.plot;
            let windows = desk.asked.iter().any(Option::is_some) || desk.windows.iter().any(Option::is_some);
            match windows {
                _ if desk.seek.is_some() => Duration::ZERO,
                true if subscriber.has_room() => Duration::ZERO,
                true => FULL,
                false => IDLE,
            }
        };
        let least = self.subscribers.iter().map(pause).min().unwrap_or(IDLE);
        if self.has_events_left() { Duration::ZERO } else { least }
    }

    fn has_events_left(&self) -> bool {
        !self.subscribers.is_empty()
            && self.searched < self.films[0].chunks()
            && self.events.len() < MOST_EVENTS
    }

    fn hear(&mut self, notice: Notice) {
        match notice {
            Notice::Arrived(number, outbox) => {
                // The same words as of a running robot, of which nobody can take the lease; then the events found so far.
                let mut subscriber = Subscriber::new(number, outbox);
                subscriber.text(&self.hello);
                subscriber.text(&link_message(&self.why));
                subscriber.text(&json!({"type": "lease", "holder": "", "mine": false}).to_string().into());
                self.events[..self.told]
                    .chunks(AT_ONCE)
                    .for_each(|some| subscriber.text(&events_message(some)));
                self.subscribers.push(subscriber);
            }
            Notice::Left(number) => self.subscribers.retain(|subscriber| subscriber.number != number),
            Notice::Plot(number, fields, rate) => self.plot(number, fields, rate),
            Notice::Recording(number, what) => {
                let Some(subscriber) =
                    self.subscribers.iter_mut().find(|subscriber| subscriber.number == number)
                else {
                    return;
                };
                match what {
                    RecordingRequest::Seek(time, other) => subscriber.plot.seek = Some((time, other)),
                    RecordingRequest::Window(log, stretch) => subscriber.plot.asked[log] = Some(stretch),
                }
            }
            // News of a running robot.
            Notice::Lease(_) | Notice::Broker(_) | Notice::Scenes(_) | Notice::Run(_) | Notice::End => {}
        }
    }

    /// Takes the fields of a page; samples come when it asks for a stretch.
    fn plot(&mut self, number: u64, fields: Vec<String>, rate: f64) {
        let Some(subscriber) = self.subscribers.iter_mut().find(|subscriber| subscriber.number == number)
        else {
            return;
        };
        let cycle = self.films[0].cycle();
        let known = |film: &Film| -> Vec<String> {
            let has = |name: &&String| film.fields.iter().any(|field| field.name == **name);
            fields.iter().filter(has).cloned().collect()
        };
        let answer = match Plot::new(fields.clone(), rate, cycle, &self.films[0].fields) {
            Ok(plot) => {
                (subscriber.plot.fields, subscriber.plot.rate) = (plot.fields.clone(), rate);
                // What was asked for before is of other columns.
                (subscriber.plot.asked, subscriber.plot.windows) = ([None; 2], [None, None]);
                let other = self.films.get(1).map_or(Vec::new(), known);
                json!({"type": "plotting", "fields": fields, "rate": plot.rate(cycle), "other": other})
            }
            Err(why) => {
                json!({"type": "plotting", "fields": subscriber.plot.fields, "rate": subscriber.plot.rate, "why": why})
            }
        };
        subscriber.text(&answer.to_string().into());
    }

    /// One round of requests: instants first, then a chunk of each stretch, then some of the events. True if an instant was shown.
    fn work(&mut self) -> Result<bool, RecordingError> {
        let now = now();
        let (mut result, mut shown) = (Ok(()), false);
        // A log that is damaged in one place is shown in the others: one error is told at the end.
        for subscriber in &mut self.subscribers {
            if let Some((time, other)) = subscriber.plot.seek.take() {
                let instants = [(FrameKind::State, Some(time)), (FrameKind::OtherState, other)];
                for ((kind, time), film) in instants.into_iter().zip(&mut self.films) {
                    let Some(time) = time else { continue };
                    match film.frame(film.tick(time)) {
                        Ok(Some((tick, frame))) => {
                            subscriber.frame(kind, tick, &frame, now);
                            shown = true;
                        }
                        Ok(None) => {}
                        Err(e) => result = Err(e),
                    }
                }
            }
            for log in 0..self.films.len() {
                result = result.and(advance(&mut self.films[log], subscriber, log, now));
            }
        }
        // Events come in the order of the log, and are told in messages of a thousand.
        if self.has_events_left() {
            let end = (self.searched + SEARCHED).min(self.films[0].chunks());
            for chunk in self.searched..end {
                self.searched += 1;
                self.events.extend(self.films[0].events(chunk)?);
            }
            self.events.truncate(MOST_EVENTS);
            let fresh = self.events.len() - self.told;
            if fresh >= AT_ONCE || fresh > 0 && !self.has_events_left() {
                for some in self.events[self.told..].chunks(AT_ONCE) {
                    let message = events_message(some);
                    self.subscribers.iter_mut().for_each(|subscriber| subscriber.text(&message));
                }
                self.told = self.events.len();
            }
        }
        if now >= self.next_look {
            self.next_look = now + GROWTH;
            self.grow()?;
        }
        result.map(|()| shown)
    }

    /// Tells of logs that have grown.
    fn grow(&mut self) -> Result<(), RecordingError> {
        let mut grown = false;
        for film in &mut self.films {
            grown |= film.grow()?;
        }
        if grown {
            self.describe();
            let mut recorded = self.recording();
            recorded["type"] = "recorded".into();
            let message: Utf8Bytes = recorded.to_string().into();
            self.subscribers.iter_mut().for_each(|subscriber| subscriber.text(&message));
        }
        Ok(())
    }

    fn complain(&mut self, why: String) {
        if why != self.why {
            let message = link_message(&why);
            self.subscribers.iter_mut().for_each(|subscriber| subscriber.text(&message));
            self.why = why;
        }
    }
}

/// One chunk of the stretch that a page waits for; the newest request takes the place of older ones.
fn advance(
    film: &mut Film,
    subscriber: &mut Subscriber<Desk>,
    log: usize,
    now: u64,
) -> Result<(), RecordingError> {
    let desk = &mut subscriber.plot;
    if let Some(stretch) = desk.asked[log].take() {
        let has = |name: &&String| film.fields.iter().any(|field| field.name == **name);
        let fields: Vec<String> = desk.fields.iter().filter(has).cloned().collect();
        desk.windows[log] = Window::new(film, stretch, &fields, desk.rate).ok();
    }
    let Some(mut window) = desk.windows[log].take() else { return Ok(()) };
    // A page that has not read what it was sent waits, and nobody else.
    if !subscriber.has_room() {
        subscriber.plot.windows[log] = Some(window);
        return Ok(());
    }
    match window.step(film) {
        Ok(frame) => {
            if let Some((tick, frame)) = frame {
                let kind = if log == 0 { FrameKind::Samples } else { FrameKind::OtherSamples };
                subscriber.frame(kind, tick, &frame, now);
            }
            subscriber.plot.windows[log] = Some(window);
            Ok(())
        }
        Err(why) => {
            let ([from, to], rows) = (window.asked, window.rows);
            let done = json!({"type": "window", "log": log, "from": from, "to": to, "rows": rows});
            subscriber.text(&done.to_string().into());
            why.map_or(Ok(()), Err)
        }
    }
}

fn events_message(events: &[Value]) -> Utf8Bytes {
    json!({"type": "events", "events": events}).to_string().into()
}

fn link_message(why: &str) -> Utf8Bytes {
    json!({"type": "link", "robot": true, "broker": false, "why": why}).to_string().into()
}
