//! `gangwerk sim SCENE`: all steps in one process, as fast as possible.

use std::error::Error;
use std::path::Path;

use config::Setup;
use logger::Origin;
use messages::topics::{
    CONTROLLER_STATE, EVENTS_CONTROLLER, EVENTS_LOWLEVEL, EVENTS_PLANNER, EVENTS_SIM_BACKEND,
    EVENTS_WATCHDOG, JOINT_TARGETS, PARAMETERS_CONTROLLER, PARAMETERS_PLANNER, PLAN, POWER, SENSORS,
    SIM_STATE,
};
use messages::{Detail, Event, EventCode, GaitState, Header, Process, Record, Topic};
use recording::Recorder;

use crate::can::record::Traffic;
use crate::exit::Exit;
use chain::ending::Ending;
use chain::figures::{Figures, Gatherer};
use chain::{Chain, Cycle};
use sim_backend::external_plant::ExternalPlant;

/// \[s\] For so long a run of a simulated robot goes on after it fell: it then lies still.
pub const AFTER_FALL: f64 = 2.0;

/// Runs a scene to its end, or until [`AFTER_FALL`] after a fall; writes a log, and the traffic of the bus, if asked to.
///
/// `plant`: socket of another simulator, which has the robot instead of ours. `progress` is told the simulated time \[s\] once per simulated second.
///
/// # Errors
/// The robot's description is wrong, the log cannot be written, or the other simulator fails; then what was logged is there.
pub fn run(
    setup: &Setup,
    plant: Option<&Path>,
    log: Option<&Path>,
    traffic: Option<&Path>,
    mut progress: impl FnMut(f64),
) -> Result<(Figures, Exit), Box<dyn Error>> {
    let mut chain = Chain::new(setup)?;
    let mut plant = plant.map(|socket| ExternalPlant::connect(socket, setup)).transpose()?;
    let mut traffic = traffic.map(|path| Traffic::create(path, Some(&setup.robot.layout))).transpose()?;
    if let Some(traffic) = &mut traffic {
        // Where the joints are before the first cycle.
        traffic.write(plant.as_ref().map_or(chain.answer(), ExternalPlant::frames))?;
    }
    let mut record = log.map(|path| LogWriter::create(path, setup, &chain)).transpose()?;
    let (mut gatherer, mut ending, mut failed) = (Gatherer::default(), Ending::default(), None);
    let cycles = (setup.scene.duration / setup.scene.cycle).round() as u64;
    let per_second = (1.0 / setup.scene.cycle).round() as u64;
    let begun = realtime::clock::processor_time();
    for i in 1..=cycles {
        let cycle = match &mut plant {
            None => chain.step(),
            Some(plant) => match chain.step_with(plant) {
                Ok(cycle) => cycle,
                Err(problem) => {
                    failed = Some(problem);
                    break;
                }
            },
        };
        let time = i as f64 * setup.scene.cycle;
        cycle.events.iter().for_each(|&(_, code, detail)| ending.tell(time, code, detail));
        ending.refused += cycle.refused;
        ending.see(time, cycle.sensors.power == 1, gait(cycle));
        gatherer.add(&cycle.sim_state, &cycle.controller_state);
        if let Some(record) = &mut record {
            record.write(cycle)?;
        }
        if let Some(traffic) = &mut traffic {
            traffic.write(chain.told())?;
            traffic.write(chain.answer())?;
        }
        if i % per_second == 0 {
            progress(i as f64 * setup.scene.cycle);
        }
        if ending.fell().or(ending.diverged()).is_some_and(|fell| time > fell + AFTER_FALL) {
            break;
        }
    }
    let cpu = (realtime::clock::processor_time() - begun) as f64 * 1e-9;
    if let Some(record) = record {
        record.finish()?;
    }
    if let Some(traffic) = traffic {
        traffic.finish()?;
    }
    if let Some(problem) = failed {
        return Err(problem.into());
    }
    let mut figures = gatherer.figures(setup, cpu, log.map(|p| p.display().to_string()));
    if plant.is_some() {
        figures.depth = "external plant".into();
    }
    Ok((figures.ended(&ending), Exit::of(&ending, false)))
}

/// State of the walk; the simulation knows of a fall that the robot does not notice.
fn gait(cycle: &Cycle) -> GaitState {
    if cycle.sim_state.fallen == 1 { GaitState::Fallen } else { cycle.controller_state.gait.into() }
}

/// Writes what the logger would write.
struct LogWriter {
    recorder: Recorder,
    last: Header,
}

/// Processes of the chain whose events are logged.
const REPORTERS: [(Process, &Topic); 5] = [
    (Process::Watchdog, &EVENTS_WATCHDOG),
    (Process::SimBackend, &EVENTS_SIM_BACKEND),
    (Process::Planner, &EVENTS_PLANNER),
    (Process::Controller, &EVENTS_CONTROLLER),
    (Process::Lowlevel, &EVENTS_LOWLEVEL),
];

impl LogWriter {
    fn create(path: &Path, setup: &Setup, chain: &Chain) -> Result<Self, Box<dyn Error>> {
        let origin = Origin { commit: crate::COMMIT.into(), simulated: true, clock: None };
        let mut record = Self { recorder: logger::recorder(path, setup, &origin)?, last: Header::default() };
        record.all(EventCode::Started)?;
        let [planner, stabilizer] = chain.parameters();
        record.put(&PARAMETERS_PLANNER, planner)?;
        record.put(&PARAMETERS_CONTROLLER, stabilizer)?;
        Ok(record)
    }

    fn write(&mut self, c: &Cycle) -> Result<(), Box<dyn Error>> {
        self.last = c.sensors.header;
        self.put(&SENSORS, c.sensors)?;
        if let Some(plan) = &c.plan {
            self.put(&PLAN, **plan)?;
        }
        self.put(&CONTROLLER_STATE, c.controller_state)?;
        self.put(&JOINT_TARGETS, c.joint_targets)?;
        self.put(&POWER, c.power)?;
        self.put(&SIM_STATE, c.sim_state)?;
        for &(process, code, detail) in &c.events {
            let topic = REPORTERS.iter().find(|(p, _)| *p == process).map(|(_, topic)| *topic);
            if let Some(topic) = topic {
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
        for (_, topic) in REPORTERS {
            self.put(topic, Event::new(self.last, code, Detail::Nothing))?;
        }
        Ok(())
    }

    fn finish(mut self) -> Result<(), Box<dyn Error>> {
        self.all(EventCode::Ended)?;
        Ok(self.recorder.finish()?)
    }
}
