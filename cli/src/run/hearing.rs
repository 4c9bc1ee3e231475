//! Processes that have written lately, for [`super::pulse`].

use std::error::Error;

use ipc::{Mode, Reader, Space};
use messages::topics::{CONTROLLER_STATE, LOG_TICK, PLANNER_TICK, POWER, SIM_STATE, WATCHDOG_RESET};
use messages::{ControllerState, Event, Power, Process, SimState, WatchdogReset};

/// Processes that wrote since the last check.
pub(super) struct Hearing {
    power: Reader<Power>,
    reset: Reader<WatchdogReset>,
    sim: Reader<SimState>,
    planner: Reader<Event>,
    controller: Reader<ControllerState>,
    log: Reader<Event>,
    heard: Vec<Process>,
    mode: Mode,
}

impl Hearing {
    /// Everything that processes write in every cycle.
    pub(super) fn new(space: &Space, mode: Mode) -> Result<Self, Box<dyn Error>> {
        Ok(Self {
            power: space.reader(&POWER)?,
            reset: space.reader(&WATCHDOG_RESET)?,
            sim: space.reader(&SIM_STATE)?,
            planner: space.reader(&PLANNER_TICK)?,
            controller: space.reader(&CONTROLLER_STATE)?,
            log: space.reader(&LOG_TICK)?,
            heard: Vec::with_capacity(Process::ALL.len()),
            mode,
        })
    }

    /// One look; `broker`: it answers.
    pub(super) fn listen(&mut self, broker: bool) {
        self.heard.clear();
        // In lockstep all wait for each other, and who waits in vain names the one that he waits for.
        if self.mode == Mode::Lockstep {
            return;
        }
        let fresh = [
            (Process::Broker, broker),
            (Process::Watchdog, self.power.refresh()),
            (Process::Lowlevel, self.reset.refresh()),
            (Process::SimBackend, self.sim.refresh()),
            (Process::Planner, self.planner.refresh()),
            (Process::Controller, self.controller.refresh()),
            (Process::Logger, self.log.refresh()),
        ];
        self.heard.extend(fresh.into_iter().filter(|(_, fresh)| *fresh).map(|(process, _)| process));
    }

    /// Whether this process wrote something before the last look.
    pub(super) fn heard(&self, process: Process) -> bool {
        self.heard.contains(&process)
    }
}
