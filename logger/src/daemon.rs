//! The logger process: `gangwerk logger --run DIR`.
//!
//! Not a real-time process: it looks at all rings again and again under the ordinary scheduler. Nobody waits for it
//! in real time; in lockstep the joint loop does not run further ahead than half a ring.

use crate::{Follower, LogOutput, Logging, Open, Origin, Parts, Pass, recorder};
use config::Setup;
use ipc::{Bell, IpcError, Mode, Run, Space, Writer};
use messages::topics::{EVENTS_LOGGER, ForType, LOG_TICK, with_type};
use messages::{Event, EventCode, Process, Record, TOPICS, Topic};
use realtime::{Stop, clock};
use std::error::Error;
use std::path::Path;
use std::time::Duration;

/// The attachment of a log that says how the scene was run, as [`ipc::Run::parse`] reads it.
pub const RUN: &str = "run";

/// Between two looks at empty rings: a ring holds 256 cycles. In lockstep half of them, without anybody's sleep, take longer
/// than this on any machine; more looks only take time from those that work.
const NAP_REAL_TIME: Duration = Duration::from_millis(5);
const NAP_LOCKSTEP: Duration = Duration::from_millis(2);

/// Part of the log that the death of this very process may cost.
const FLUSH_NS: u64 = 500_000_000;

/// At the end: writers that go on writing are not waited for longer than this.
const LAST_WORDS_NS: u64 = 2_000_000_000;

/// The process: to be called first in `main`.
///
/// # Errors
/// See [`run`]; the run directory is not that of a run.
pub fn main(dir: &Path) -> Result<(), Box<dyn Error>> {
    let stop = Stop::on_signals()?;
    run(&Run::load(dir)?, &stop)?;
    Ok(())
}

/// Logs until the process is asked to end, then writes what is left and closes the log.
///
/// # Errors
/// The configuration cannot be read, or another logger serves this run. A log that cannot be written is said once and
/// counted, and tried again every half second; at the end it is an error, so that nobody takes it for the whole run. Nothing
/// begins with a log that another run writes.
pub fn run(run: &Run, stop: &Stop) -> Result<(), String> {
    let space = run.enter(Process::Logger).map_err(|e| e.to_string())?;
    let mut output = LogOutput::new(open(run, again(&space))?);
    if output.is_anothers() {
        return Err(output.complaint().unwrap_or_default());
    }
    let ended = serve(&space, output, run.mode, stop).map_err(|e| e.to_string())?;
    if ended.broken {
        return Err(format!(
            "the log is not complete: {} records are missing, and the disk failed",
            ended.lost
        ));
    }
    Ok(())
}

/// Whether this run had a logger before.
fn again(space: &Space) -> bool {
    let events = space.reader::<Event>(&EVENTS_LOGGER);
    events.is_ok_and(|mut events| events.latest().is_some())
}

/// Parts of the log. A logger that was restarted leaves existing parts alone.
fn open(run: &Run, again: bool) -> Result<Open, String> {
    let setup = Setup::load(&run.config, &run.scene).map_err(|e| e.to_string())?;
    let parts = Parts::new(run.log.as_deref().ok_or("this run has no log")?);
    let mut before =
        if again { (1..).take_while(|&part| parts.path(part).exists()).count() as u32 } else { 0 };
    let (text, origin) = (run.to_text(), Origin::of(run));
    let mut first = !again;
    Ok(Box::new(move |part| {
        // What another run writes stays its own, also when it has finished it: the next part goes beyond.
        while !first && recording::is_being_written(&parts.path(before + part)) {
            before += 1;
        }
        first = false;
        let mut recorder = recorder(&parts.path(before + part), &setup, &origin)?;
        recorder.attach(RUN, text.as_bytes())?;
        Ok(recorder)
    }))
}

/// Outcome of a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Logged {
    /// Records that are missing.
    pub lost: u64,
    /// Whether the disk failed.
    pub broken: bool,
}

/// Follows all logged topics of a space until asked to stop.
///
/// # Errors
/// A topic cannot be opened.
pub fn serve(space: &Space, output: LogOutput, mode: Mode, stop: &Stop) -> Result<Logged, IpcError> {
    let mut logging = Logging::new(output);
    for topic in TOPICS.iter().filter(|t| t.logged && t.name != EVENTS_LOGGER.name) {
        with_type(topic.name, FollowTopic { space, logging: &mut logging }).unwrap_or(Ok(()))?;
    }
    // Until asked to stop: a pass over all rings, and the disk now and then.
    let mut signals = Signals::open(space, mode)?;
    let nap = if mode == Mode::Lockstep { NAP_LOCKSTEP } else { NAP_REAL_TIME };
    let mut flushed = clock::now();
    signals.say(EventCode::Started);
    while !stop.asked() {
        let pass = logging.pass();
        signals.after(&pass);
        report(&mut logging, &pass);
        if clock::now() - flushed >= FLUSH_NS {
            logging.output().retry();
            logging.output().flush();
            flushed = clock::now();
        }
        if pass.records == 0 {
            std::thread::park_timeout(nap);
        }
    }
    drain(&mut logging, &mut signals);
    logging.output().finish();
    report(&mut logging, &Pass::default());
    Ok(Logged { lost: logging.missing(), broken: logging.output().is_broken() })
}

/// Writes what is left in the rings.
fn drain(logging: &mut Logging, signals: &mut Signals) {
    let begun = clock::now();
    loop {
        let pass = logging.pass();
        signals.after(&pass);
        if pass.records == 0 || clock::now() - begun > LAST_WORDS_NS {
            return;
        }
    }
}

fn report(logging: &mut Logging, pass: &Pass) {
    if let Some(complaint) = logging.output().complaint() {
        tracing::error!("{complaint}; the run goes on, what is not logged is counted");
    }
    if let Some(event) = pass.lost {
        tracing::warn!(
            "{} records are missing from the log, {} since the beginning",
            event.detail,
            logging.lost()
        );
    }
}

struct FollowTopic<'a> {
    space: &'a Space,
    logging: &'a mut Logging,
}

impl ForType<Result<(), IpcError>> for FollowTopic<'_> {
    fn call<T: Record>(self, topic: &'static Topic) -> Result<(), IpcError> {
        let reader = self.space.reader::<T>(topic)?;
        self.logging.follow(Follower::new(topic, reader));
        Ok(())
    }
}

/// Reports of the logger to others.
struct Signals {
    mode: Mode,
    tick: Writer<Event>,
    bell: Bell,
    events: Writer<Event>,
    said: Option<u64>,
}

impl Signals {
    fn open(space: &Space, mode: Mode) -> Result<Self, IpcError> {
        Ok(Self {
            mode,
            tick: space.writer(&LOG_TICK)?,
            bell: space.bell(&LOG_TICK)?,
            events: space.writer(&EVENTS_LOGGER)?,
            said: None,
        })
    }

    fn say(&mut self, code: EventCode) {
        self.events.write(&Event { code: code as u64, ..Event::default() });
    }

    /// Progress and losses of the log.
    fn after(&mut self, pass: &Pass) {
        // In lockstep the joint loop waits until all is written; in real time nobody waits, and a logger that falls behind lives.
        let progress = if self.mode == Mode::Lockstep { pass.caught_up } else { pass.newest };
        if let Some(header) = progress.filter(|h| self.said != Some(h.tick)) {
            self.said = Some(header.tick);
            self.tick.write(&Event { header, ..Event::default() });
            self.bell.ring();
        }
        if let Some(event) = pass.lost {
            self.events.write(&event);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::Header;
    use recording::{Recorder, RecordingError, RobotInfo, RunInfo};

    /// A second run that began in the same instant waited for the log of the first one to be finished, and emptied it.
    #[test]
    fn a_log_that_another_run_writes_is_refused_before_the_start() {
        let dir = std::env::temp_dir().join(format!("gangwerk-log-of-another-{}", std::process::id()));
        let (space, path) = (Space::create(&dir).unwrap(), dir.with_extension("mcap"));
        let other = Recorder::create(&path, &RobotInfo::default(), &RunInfo::default()).unwrap();
        let (scene, config) = ("stand".into(), config::root(None));
        let second = Run { scene, config, log: Some(path.clone()), ..Run::bare(&dir) };
        let stop = Stop::default();
        stop.ask();
        let error = run(&second, &stop).unwrap_err();
        assert!(error.contains("it is being written"), "{error}");
        assert!(!again(&space), "it said that it has started");
        // One that goes on tries again when the other has ended, elsewhere.
        let mut parts = open(&second, false).unwrap();
        assert!(matches!(parts(1), Err(RecordingError::BeingWritten(_))));
        drop(parts(1).unwrap());
        other.finish().unwrap();
        let length = std::fs::metadata(&path).unwrap().len();
        drop(parts(1).unwrap());
        assert_eq!(std::fs::metadata(&path).unwrap().len(), length);
        for part in 1..4 {
            let _ = std::fs::remove_file(Parts::new(&path).path(part));
        }
    }

    /// A logger that never caught up was silent, and killed as one that hangs.
    #[test]
    fn a_logger_that_falls_behind_shows_in_real_time_that_it_lives() {
        let behind = Pass { newest: Some(Header { tick: 7, ..Header::default() }), ..Pass::default() };
        for (mode, ticks) in [(Mode::RealTime, Some(7)), (Mode::Lockstep, None)] {
            let dir = std::env::temp_dir().join(format!("gangwerk-log-tick-{}", std::process::id()));
            let space = Space::create(&dir).unwrap();
            Signals::open(&space, mode).unwrap().after(&behind);
            let mut tick = space.reader::<Event>(&LOG_TICK).unwrap();
            assert_eq!(tick.latest().map(|t| t.header.tick), ticks, "{mode:?}");
        }
    }
}
