//! Operator's console: position, activity, and everything out of the ordinary.

use std::error::Error;

use config::Setup;
use ipc::{Reader, Space};
use messages::topics::{CONTROLLER_STATE, SENSORS, SIM_STATE, STATS_LOWLEVEL, TOPICS, Topic};
use messages::{
    CommandTaken, ControllerState, CycleStats, Detail, Event, EventCode, GaitState, Process, Record, Sensors,
    SimState, StartUp, Words,
};
use terminal::Console;

use super::tally::Tally;
use chain::ending::{AFTER_FALL, Ending};

/// Operator's console.
pub(super) struct View {
    state: Reader<ControllerState>,
    sim: Reader<SimState>,
    sensors: Reader<Sensors>,
    events: Vec<(Process, Reader<Event>)>,
    stats: Reader<CycleStats>,
    words: Words,
    tally: Tally,
    /// The run comes to its end.
    ends: bool,
    /// The supply was cut, or the robot was stopped, because processes came too late.
    late: bool,
    start_up: StartUp,
    console: Console,
    gait: GaitState,
    missing: u64,
    taken: Vec<Reader<CommandTaken>>,
    /// \[s\] Bus cycle.
    cycle: f64,
    /// Ending of the walk.
    pub(super) ending: Ending,
}

impl View {
    pub(super) fn new(space: &Space, setup: &Setup, console: Console) -> Result<Self, Box<dyn Error>> {
        let events = |p: Process| -> Result<_, Box<dyn Error>> {
            let name = format!("events/{}", p.name());
            let topic = Topic::find(&name).ok_or_else(|| format!("there is no topic {name}"))?;
            Ok((p, space.reader(topic)?))
        };
        // Nothing has been seen yet: the robot is taken for off and idle.
        Ok(Self {
            state: space.reader(&CONTROLLER_STATE)?,
            sim: space.reader(&SIM_STATE)?,
            sensors: space.reader(&SENSORS)?,
            events: Process::ALL.into_iter().map(events).collect::<Result<_, _>>()?,
            stats: space.reader(&STATS_LOWLEVEL)?,
            words: crate::topic::words(setup),
            tally: Tally::default(),
            ends: false,
            late: false,
            start_up: StartUp::Off,
            gait: GaitState::Idle,
            missing: 0,
            taken: TOPICS
                .iter()
                .filter(|t| t.type_name == CommandTaken::NAME)
                .map(|t| space.reader(t))
                .collect::<Result<_, _>>()?,
            cycle: setup.scene.cycle,
            ending: Ending::default(),
            console,
        })
    }

    /// Records that the logger says are missing from the log.
    pub(super) fn missing(&self) -> u64 {
        self.missing
    }

    /// Whether the robot stands, or nobody can tell.
    pub(super) fn standing(&mut self) -> bool {
        self.state.latest().is_none_or(|s| GaitState::from(s.gait).rests())
    }

    /// Time of the robot \[ns\], by its bus cycles; 0 before the first one.
    pub(super) fn robot_time(&mut self) -> u64 {
        self.sensors.latest().map_or(0, |sensors| (sensors.header.tick as f64 * self.cycle * 1e9) as u64)
    }

    /// One look.
    pub(super) fn update(&mut self) {
        self.tell_events();
        self.judge();
        self.tell_start_up();
        let Some(sim) = self.sim.latest() else { return };
        let (t, [x, y, _]) = (sim.time, sim.position);
        if let Some(state) = self.state.latest() {
            let gait = GaitState::from(state.gait);
            let [ex, ey] = state.inclination_error;
            let tilt = 1e3 * ex.hypot(ey);
            let message = format!("{t:5.1} s  {gait:?}  x {x:5.2} m  y {y:5.2} m  tilt {tilt:4.1} mrad");
            self.console.progress((t * 10.0) as u64, message);
            if gait != self.gait {
                self.gait = gait;
                self.console.say(format!("{t:7.3} s  {gait:?}"));
            }
        }
    }

    /// Whether the robot still does what it is told to.
    fn judge(&mut self) {
        for taken in &mut self.taken {
            while let Some(taken) = taken.follow() {
                self.ending.refused += u64::from(taken.origin == 0 && taken.refused != 0);
            }
        }
        let (Some(sensors), Some(state)) = (self.sensors.latest(), self.state.latest()) else { return };
        let fallen = self.sim.latest().is_some_and(|sim| sim.fallen == 1);
        let gait = if fallen { GaitState::Fallen } else { state.gait.into() };
        self.ending.see(sensors.header.tick as f64 * self.cycle, sensors.power == 1, gait);
    }

    /// Whether the simulated robot has fallen, so long ago that it lies still.
    pub(super) fn lies(&mut self) -> bool {
        let fell = self.ending.fell().or(self.ending.diverged());
        self.sim.latest().is_some_and(|sim| fell.is_some_and(|fell| sim.time > fell + AFTER_FALL))
    }

    /// State of the start-up, and the operator's next action.
    fn tell_start_up(&mut self) {
        let Some(sensors) = self.sensors.latest() else { return };
        let (now, tick) = (StartUp::from_number(sensors.start_up), sensors.header.tick);
        if self.start_up != now {
            self.start_up = now;
            if !self.ends {
                let time = tick as f64 * self.cycle;
                self.console.say(format!("{time:7.3} s  {}", now.advice()));
            }
        }
    }

    /// Everything that is no routine.
    fn tell_events(&mut self) {
        for (process, events) in &mut self.events {
            while let Some(e) = events.follow() {
                let code = EventCode::from_number(e.code).unwrap_or(EventCode::None);
                self.ending.tell(e.header.tick as f64 * self.cycle, code, code.detail(e.detail));
                if code == EventCode::LogDropped {
                    self.missing += e.detail;
                }
                if matches!(code, EventCode::Started | EventCode::Ended | EventCode::PlanActive) {
                    continue;
                }
                if self.ends && *process == Process::Watchdog && code == EventCode::PowerOff {
                    continue; // the joint loop ended first, as it should
                }
                self.late |= is_of_lateness(code, code.detail(e.detail));
                let sentence = self.words.sentence(e.code, e.detail);
                if let Some(text) = self.tally.tell(*process, &sentence) {
                    let time = e.header.tick as f64 * self.cycle;
                    self.console.say(format!("{time:7.3} s  {}: {text}", process.name()));
                }
            }
        }
    }

    /// The end of a run: from now on it is normal that the supply goes off.
    pub(super) fn end(&mut self) {
        self.ends = true;
    }

    /// Repeated events, reported once.
    pub(super) fn sum_up(&mut self) {
        self.tally.summary().for_each(|line| self.console.say(line));
    }

    /// Longest delay of the joint loop \[ms\], if the supply was cut or the robot was stopped because this machine was late.
    pub(super) fn late_ms(&mut self) -> Option<f64> {
        let most = self.stats.latest().map_or(0, |s| s.lateness_ns[3].max(s.execution_ns[3]));
        self.late.then_some(most as f64 * 1e-6)
    }
}

/// Whether a supply that was cut, or a stop, has its cause in processes that came too late.
fn is_of_lateness(code: EventCode, detail: Detail) -> bool {
    use EventCode::{PowerOff, ResetMissed, SafeStop, TargetsStale, TooManyOverruns, WatchdogSilent};
    match (code, detail) {
        (PowerOff | SafeStop, Detail::Cause(cause)) => {
            matches!(cause, ResetMissed | TooManyOverruns | TargetsStale | WatchdogSilent)
        }
        (WatchdogSilent, _) => true,
        _ => false,
    }
}
