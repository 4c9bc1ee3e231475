//! A running robot, looked at through its topics in shared memory, where nobody waits for who looks.

use std::error::Error;
use std::path::Path;

use config::Setup;
use ipc::{Reader, Space};
use messages::topics::{CONTROLLER_STATE, PLAN, SENSORS};
use messages::{ControllerState, Plan, Process, Sensors};

use crate::sight::{Sight, Witness};

/// Robot that is looked at.
pub(crate) struct Observer {
    sensors: Reader<Sensors>,
    state: Reader<ControllerState>,
    plans: Reader<Plan>,
    witness: Witness,
    /// \[m\] Height of the newest plan's frame.
    height: f64,
    // Dropped last, after its readers.
    _space: Space,
}

impl Observer {
    /// Of the robot in this run directory.
    ///
    /// # Errors
    /// It does not run, or its files do not fit together.
    pub(crate) fn open(dir: &Path, setup: &Setup) -> Result<Self, Box<dyn Error>> {
        let space = Space::open(dir, Process::Observer)?;
        Ok(Self {
            sensors: space.reader(&SENSORS)?,
            state: space.reader(&CONTROLLER_STATE)?,
            plans: space.reader(&PLAN)?,
            witness: Witness::new(setup)?,
            height: 0.0,
            _space: space,
        })
    }

    /// The newest of it; none before stabilizer and sensors have said something.
    pub(crate) fn look(&mut self) -> Option<Sight> {
        while let Some(plan) = self.plans.follow() {
            // It is followed some cycles later: for so long the height is ahead of the place.
            self.height = plan.height;
        }
        let state = *self.state.latest()?;
        let sensors = self.sensors.latest()?;
        Some(self.witness.see(sensors, &state, self.height))
    }
}
