//! One log as a page sees it: the same frames, events and samples that the running robot would have given.

use std::path::Path;
use std::sync::Arc;

use config::Setup;
use config::registry;
use ipc::{Mode, Run};
use messages::topics::{CONTROLLER_STATE, EVENTS, PLAN, POWER, SENSORS, SIM_STATE, TOPICS};
use messages::{ControllerState, Event, Plan, Power, Sensors, SimState, Topic};
use recording::{IndexedLog, LogChunk, RecordingError};
use serde_json::{Value, json};

use crate::description::{RobotFiles, hello};
use crate::picture::{NewestRecords, Picture};
use crate::plotting::{PlotField, catalogue};

/// Log and configuration, before the page's part is made of them.
#[derive(Debug)]
pub struct Recorded {
    /// The log.
    pub log: IndexedLog,
    /// Its configuration, from the files in it.
    pub setup: Setup,
    /// Run that wrote it; none: the log does not say it.
    pub run: Option<Run>,
    /// Outlines of the robot.
    pub files: RobotFiles,
    /// Differences from the recorded run, in words.
    pub missing: Vec<String>,
}

/// One log that is shown.
pub struct Film {
    log: IndexedLog,
    picture: Picture,
    /// Fields of the topics that are in the log.
    pub fields: Vec<PlotField>,
    hello: Value,
    name: String,
    missing: Vec<String>,
    /// First and last tick.
    span: (u64, u64),
    /// Outlines of the robot.
    pub files: RobotFiles,
    /// Names of the joints.
    pub joints: Vec<String>,
}

impl Film {
    /// Of a log with its configuration.
    ///
    /// # Errors
    /// The log has no state of a robot in it, another robot than its configuration, or is damaged.
    pub fn new(recorded: Recorded) -> Result<Self, String> {
        let Recorded { mut log, setup, run, files, mut missing } = recorded;
        let told = |e: RecordingError| e.to_string();
        let path = log.about().path().display().to_string();
        let span = log.span().map_err(told)?;
        let Some(span) = span else {
            let why = match log.other_layouts().iter().find(|topic| topic.name == SENSORS.name) {
                Some(topic) => log.about().other_layout(topic).to_string(),
                None => format!(
                    "{path}: no record of topic sensors in it; `gangwerk log info {path}` shows what it holds"
                ),
            };
            return Err(why);
        };
        // Whatever a topic of the page is missing in the log is said once, and is NaN in its frames.
        let joints: Vec<String> = setup.robot.joints.iter().map(|joint| joint.name.clone()).collect();
        if joints != log.about().robot().joints {
            return Err(format!(
                "{path}: its joints are not those of robot {} in its configuration",
                setup.robot.name
            ));
        }
        let simulated = run.as_ref().map_or_else(|| has(&log, &SIM_STATE), |run| run.robot);
        missing.extend(log.other_layouts().iter().map(|topic| log.about().other_layout(topic).to_string()));
        let expected = [&CONTROLLER_STATE, &PLAN, &POWER, &SIM_STATE];
        let absent = expected.into_iter().filter(|topic| simulated || topic.name != SIM_STATE.name);
        let absent: Vec<&str> = absent.filter(|topic| !has(&log, topic)).map(|topic| topic.name).collect();
        if !absent.is_empty() {
            missing.push(format!("the log holds no record of {}", absent.join(", ")));
        }
        // Everything that a page is told once.
        let picture = Picture::new(&setup, simulated)?;
        let mut fields = catalogue(&joints, simulated);
        fields.retain(|field| has(&log, field.topic));
        let parameters: Vec<_> =
            registry::entries(&setup).into_iter().map(|entry| (entry.clone(), entry.default)).collect();
        let run = run.unwrap_or_else(|| Run {
            mode: Mode::Lockstep,
            scene: setup.scene.name.clone(),
            robot: simulated,
            ..Run::bare(Path::new("."))
        });
        let hello = hello(1, &run, &setup, &picture.layout, &fields, &parameters)?;
        let name =
            Path::new(&path).file_name().map_or(path.clone(), |name| name.to_string_lossy().into_owned());
        Ok(Self { log, picture, fields, hello, name, missing, span, files, joints })
    }

    /// The message `hello`, with this film's part of `replay` in it.
    pub fn hello(&self) -> &Value {
        &self.hello
    }

    /// Description of the log for a page.
    pub fn about(&self) -> Value {
        let cycle = self.picture.cycle;
        let [first, last] = [self.span.0, self.span.1].map(|tick| tick as f64 * cycle);
        let about = self.log.about();
        json!({
            "log": self.name, "first": first, "last": last, "cycle": cycle, "complete": self.log.is_complete(),
            "started": about.run().clock.as_ref().map(recording::WallClock::date),
            "missing": self.missing, "state": self.hello["state"],
        })
    }

    /// \[s\] Bus cycle.
    pub fn cycle(&self) -> f64 {
        self.picture.cycle
    }

    /// The tick of an instant \[s\], within the log.
    pub fn tick(&self, time: f64) -> u64 {
        let (first, last) = self.span;
        ((time / self.picture.cycle).round().clamp(first as f64, last as f64)) as u64
    }

    /// The state frame at a tick, and the tick of its sensors: of each topic the newest record that is not later.
    ///
    /// # Errors
    /// The file has become shorter, or is damaged there.
    pub fn frame(&mut self, tick: u64) -> Result<Option<(u64, Vec<u8>)>, RecordingError> {
        let log = &mut self.log;
        let Some(sensors) = log.newest::<Sensors>(&SENSORS, tick, |_| true)? else { return Ok(None) };
        let tick = sensors.header.tick;
        let controller = log.newest::<ControllerState>(&CONTROLLER_STATE, tick, |_| true)?;
        let power = log.newest::<Power>(&POWER, tick, |_| true)?;
        let sim = log.newest::<SimState>(&SIM_STATE, tick, |_| true)?;
        let estimator = &mut self.picture.estimator;
        estimator.forget();
        // The plan that the stabilizer followed, which may be some seconds old.
        if let Some(state) = &controller
            && let Some(plan) = log.newest::<Plan>(&PLAN, tick, |plan| plan.id == state.plan_id)?
        {
            estimator.keep(&plan);
        }
        let newest = NewestRecords {
            sensors: &sensors,
            controller: controller.as_ref(),
            power: power.as_ref(),
            sim: sim.as_ref(),
        };
        Ok(Some((tick, self.picture.frame(newest))))
    }

    /// Number of chunks.
    pub fn chunks(&self) -> usize {
        self.log.len()
    }

    /// Events of a chunk, in the order of their time.
    ///
    /// # Errors
    /// The file has become shorter, or is damaged there.
    pub fn events(&mut self, chunk: usize) -> Result<Vec<Value>, RecordingError> {
        if !EVENTS.iter().any(|topic| self.log.holds(chunk, topic)) {
            return Ok(Vec::new());
        }
        let chunk = self.log.chunk(chunk)?;
        let mut found: Vec<(u64, Value)> = Vec::new();
        for topic in EVENTS {
            for (tick, payload) in chunk.payloads(topic) {
                if let Some(event) = recording::cdr::decode::<Event>(payload) {
                    found.push((tick, self.picture.event(topic.writer, &event)));
                }
            }
        }
        found.sort_by_key(|(tick, _)| *tick);
        Ok(found.into_iter().map(|(_, event)| event).collect())
    }

    /// The chunk in which the cycle of a tick begins.
    pub fn chunk_at(&mut self, tick: u64) -> usize {
        self.log.chunk_at(tick)
    }

    /// A chunk.
    ///
    /// # Errors
    /// The file has become shorter, or is damaged there.
    pub fn chunk(&mut self, chunk: usize) -> Result<Arc<LogChunk>, RecordingError> {
        self.log.chunk(chunk)
    }

    /// Looks whether the log has grown.
    ///
    /// # Errors
    /// The file cannot be read, or is damaged.
    pub fn grow(&mut self) -> Result<bool, RecordingError> {
        if self.log.is_complete() || !self.log.grow()? {
            return Ok(false);
        }
        self.span = self.log.span()?.unwrap_or(self.span);
        Ok(true)
    }
}

/// True if a log holds records of a topic.
fn has(log: &IndexedLog, topic: &Topic) -> bool {
    debug_assert!(TOPICS.iter().any(|other| other.name == topic.name));
    (0..log.len()).any(|chunk| log.holds(chunk, topic))
}
