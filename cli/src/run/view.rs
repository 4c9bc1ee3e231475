//! What the operator sees: where the robot is, what it does, and everything that is no routine.

use std::error::Error;

use config::Setup;
use drives::cia402::Fault;
use ipc::{Reader, Space};
use messages::topics::{CONTROLLER_STATE, SENSORS, SIM_STATE, TOPICS, Topic};
use messages::{
    CommandTaken, ControllerState, Event, EventCode, GaitState, Process, Record, Sensors, SimState, StartUp,
};
use terminal::Console;

use crate::ending::Ending;
use crate::sim::AFTER_FALL;

/// What the operator sees.
pub(super) struct View {
    state: Reader<ControllerState>,
    sim: Reader<SimState>,
    sensors: Reader<Sensors>,
    events: Vec<(Process, Reader<Event>)>,
    joints: Vec<String>,
    start_up: StartUp,
    console: Console,
    gait: GaitState,
    missing: u64,
    taken: Vec<Reader<CommandTaken>>,
    /// \[s\] Bus cycle.
    cycle: f64,
    /// How the walk ends.
    pub(super) ending: Ending,
}

impl View {
    pub(super) fn new(space: &Space, setup: &Setup, console: Console) -> Result<Self, Box<dyn Error>> {
        let events = |p: Process| -> Result<_, Box<dyn Error>> {
            let name = format!("events/{}", p.name());
            let topic = Topic::find(&name).ok_or_else(|| format!("there is no topic {name}"))?;
            Ok((p, space.reader(topic)?))
        };
        Ok(Self {
            state: space.reader(&CONTROLLER_STATE)?,
            sim: space.reader(&SIM_STATE)?,
            sensors: space.reader(&SENSORS)?,
            events: Process::ALL.into_iter().map(events).collect::<Result<_, _>>()?,
            joints: setup.robot.joints.iter().map(|joint| joint.name.clone()).collect(),
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
        let fell = self.ending.fell();
        self.sim.latest().is_some_and(|sim| fell.is_some_and(|fell| sim.time > fell + AFTER_FALL))
    }

    /// Where the start-up is, and what the operator does next.
    fn tell_start_up(&mut self) {
        let Some(sensors) = self.sensors.latest() else { return };
        let (now, tick) = (StartUp::from_number(sensors.start_up), sensors.header.tick);
        if self.start_up != now {
            self.start_up = now;
            self.console.say(format!("tick {tick:6}  {}", now.advice()));
        }
    }

    /// Everything that is no routine.
    fn tell_events(&mut self) {
        let mut lines = Vec::new();
        for (process, events) in &mut self.events {
            while let Some(e) = events.follow() {
                let code = EventCode::from_number(e.code).unwrap_or(EventCode::None);
                self.ending.tell(e.header.tick as f64 * self.cycle, code, e.detail);
                if code == EventCode::LogDropped {
                    self.missing += e.detail;
                }
                if !matches!(code, EventCode::Started | EventCode::Ended | EventCode::PlanActive) {
                    let detail = match code {
                        EventCode::PowerOff | EventCode::SafeStop => {
                            format!("{:?}", EventCode::from_number(e.detail).unwrap_or(EventCode::None))
                        }
                        EventCode::DriveTripped | EventCode::DriveHeld => {
                            let (joint, error) =
                                (self.joints.get((e.detail & 0xFFFF) as usize), e.detail >> 16);
                            let text = Fault::from_code(error as u16).map_or("", Fault::text);
                            format!("{}: error {error:#06x} {text}", joint.map_or("?", String::as_str))
                        }
                        EventCode::EmergencyStop => {
                            format!("asked for by pid {} of user {}", e.detail as u32, e.detail >> 32)
                        }
                        EventCode::NotHomed | EventCode::DriveNotEnabled => {
                            self.joints.get(e.detail as usize).cloned().unwrap_or_default()
                        }
                        _ => e.detail.to_string(),
                    };
                    lines.push(format!("tick {:6}  {}: {code:?} ({detail})", e.header.tick, process.name()));
                }
            }
        }
        lines.into_iter().for_each(|line| self.console.say(line));
    }
}
