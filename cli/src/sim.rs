//! `gangwerk sim SCENE`: all steps in one process, as fast as possible.

use std::error::Error;
use std::path::Path;

use config::Setup;

use crate::can::record::Traffic;
use crate::exit::Exit;
use chain::ending::Ending;
use chain::figures::{Figures, Gatherer};
use chain::{Chain, LogWriter};
use sim_backend::external_plant::ExternalPlant;

/// Runs a scene to its end, or until [`AFTER_FALL`](chain::ending::AFTER_FALL) after a fall; writes a log, and the traffic of the bus, if asked to.
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
    let mut record = log.map(|path| LogWriter::create(path, setup, &chain, crate::COMMIT)).transpose()?;
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
        ending.follow(time, cycle);
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
        if ending.is_over(time) {
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
