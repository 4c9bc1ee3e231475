//! Log of a chain: what the logger would write of the same processes.

use std::error::Error;
use std::path::Path;

use config::Setup;
use logger::Origin;
use messages::topics::{
    COMMANDS_CONTROLLER, COMMANDS_LOWLEVEL, COMMANDS_PLANNER, COMMANDS_SIM_BACKEND, COMMANDS_WATCHDOG,
    CONTROLLER_STATE, EVENTS_CONTROLLER, EVENTS_LOWLEVEL, EVENTS_PLANNER, EVENTS_SIM_BACKEND,
    EVENTS_WATCHDOG, JOINT_TARGETS, PARAMETERS_CONTROLLER, PARAMETERS_PLANNER, PLAN, POWER, SENSORS,
    SIM_STATE,
};
use messages::{CommandTaken, Detail, Event, EventCode, Header, Live, Process, Record, Topic};
use recording::Recorder;

use crate::{Chain, Cycle};

/// Log of a chain, cycle by cycle.
pub struct LogWriter {
    recorder: Recorder,
    last: Header,
}

/// Processes of the chain, with the topics of their events and of the commands that they decide.
const REPORTERS: [(Process, &Topic, &Topic); 5] = [
    (Process::Watchdog, &EVENTS_WATCHDOG, &COMMANDS_WATCHDOG),
    (Process::SimBackend, &EVENTS_SIM_BACKEND, &COMMANDS_SIM_BACKEND),
    (Process::Planner, &EVENTS_PLANNER, &COMMANDS_PLANNER),
    (Process::Controller, &EVENTS_CONTROLLER, &COMMANDS_CONTROLLER),
    (Process::Lowlevel, &EVENTS_LOWLEVEL, &COMMANDS_LOWLEVEL),
];

impl LogWriter {
    /// Begins a log of a chain that has not run yet. `commit`: git commit of the program, empty if unknown.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn create(path: &Path, setup: &Setup, chain: &Chain, commit: &str) -> Result<Self, Box<dyn Error>> {
        let origin = Origin { commit: commit.into(), simulated: true, clock: None };
        let mut record = Self { recorder: logger::recorder(path, setup, &origin)?, last: Header::default() };
        record.all(EventCode::Started)?;
        let [planner, stabilizer] = chain.parameters();
        record.put(&PARAMETERS_PLANNER, planner)?;
        record.put(&PARAMETERS_CONTROLLER, stabilizer)?;
        Ok(record)
    }

    /// Writes a cycle.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&mut self, c: &Cycle) -> Result<(), Box<dyn Error>> {
        self.last = c.sensors.header;
        self.put(&SENSORS, c.sensors)?;
        if let Some(plan) = &c.plan {
            self.put(&PLAN, **plan)?;
        }
        self.put(&CONTROLLER_STATE, c.controller_state)?;
        self.put(&JOINT_TARGETS, c.joint_targets)?;
        self.put(&POWER, c.power)?;
        self.put(&SIM_STATE, c.sim_state)?;
        for (command, verdict) in &c.answers {
            let decides = REPORTERS.iter().find(|(p, ..)| p.name() == command.decided_by());
            if let Some((.., topic)) = decides {
                let live = Live::of_scene(*command);
                self.put(topic, CommandTaken::new(self.last, self.last.tick, &live, verdict, true))?;
            }
        }
        for &(process, code, detail) in &c.events {
            if let Some((_, topic, _)) = REPORTERS.iter().find(|(p, ..)| *p == process) {
                self.put(topic, Event::new(self.last, code, detail))?;
            }
        }
        Ok(())
    }

    /// A record as the first writer of its topic writes it.
    fn put<T: Record>(&mut self, topic: &Topic, mut record: T) -> Result<(), Box<dyn Error>> {
        record.header_mut().epoch = 1;
        Ok(self.recorder.write(topic, &record)?)
    }

    fn all(&mut self, code: EventCode) -> Result<(), Box<dyn Error>> {
        for (_, topic, _) in REPORTERS {
            self.put(topic, Event::new(self.last, code, Detail::Nothing))?;
        }
        Ok(())
    }

    /// Ends the log with its index.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn finish(mut self) -> Result<(), Box<dyn Error>> {
        self.all(EventCode::Ended)?;
        Ok(self.recorder.finish()?)
    }
}
