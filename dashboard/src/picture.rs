//! State frames and events of one run, whether its records come from a running robot or from a log.

use axum::extract::ws::Utf8Bytes;
use config::Setup;
use config::terrain::{TerrainObject, TerrainPose};
use drives::cia402::DriveFault;
use environment::{Pose, Schedule};
use messages::{ControllerState, Event, EventCode, Power, Process, Sensors, SimState, Words};
use serde_json::{Value, json};

use crate::estimate::PoseEstimator;
use crate::state::{self, LayoutEntry, Moment};

/// The newest records at one instant; none: not written yet, or by nobody.
#[derive(Clone, Copy, Debug)]
pub struct NewestRecords<'a> {
    /// Measured.
    pub sensors: &'a Sensors,
    /// Of the stabilizer.
    pub controller: Option<&'a ControllerState>,
    /// Motor supply.
    pub power: Option<&'a Power>,
    /// Truth about a simulated robot.
    pub sim: Option<&'a SimState>,
}

/// Maker of a run's frames and events: all that they need besides its records.
pub struct Picture {
    /// \[s\] Bus cycle.
    pub cycle: f64,
    /// Layout of its frames.
    pub layout: Vec<LayoutEntry>,
    /// Estimate of the robot's pose; keeps the plans that it is given.
    pub estimator: PoseEstimator,
    weight: f64,
    objects: Vec<Schedule>,
    words: Words,
}

impl Picture {
    /// Of this configuration; `simulated`: in the world in which the scene puts the robot.
    ///
    /// # Errors
    /// The robot's files do not fit together.
    pub fn new(setup: &Setup, simulated: bool) -> Result<Self, String> {
        Ok(Self {
            cycle: setup.scene.cycle,
            layout: state::layout(setup.robot.joints.len(), setup.scene.objects.len()),
            estimator: PoseEstimator::new(setup, simulated)?,
            weight: setup.robot.weight(),
            objects: setup.scene.objects.iter().map(schedule).collect(),
            words: words(setup),
        })
    }

    /// Content of the state frame.
    pub fn frame(&mut self, newest: NewestRecords<'_>) -> Vec<u8> {
        let NewestRecords { sensors, controller, power, sim } = newest;
        let estimate = controller.map(|controller| self.estimator.see(sensors, controller));
        let moment = Moment {
            cycle: self.cycle,
            weight: self.weight,
            sensors,
            controller,
            estimate: estimate.as_ref(),
            power,
            sim,
            pushed_at: sim.map(|sim| self.estimator.pushed_at(&state::truth(sim))),
            objects: &self.objects,
        };
        state::frame(&moment, &self.layout)
    }

    /// The message `event`.
    pub fn event(&self, process: Process, event: &Event) -> Value {
        let tick = event.header.tick;
        let name = EventCode::from_number(event.code).map(|code| format!("{code:?}"));
        let text = self.words.sentence(event.code, event.detail);
        json!({
            "type": "event", "tick": tick, "time": tick as f64 * self.cycle, "process": process.name(),
            "name": name, "text": text,
        })
    }
}

/// The message `parameter`.
pub fn parameter_message(name: &str, value: f64) -> Utf8Bytes {
    json!({"type": "parameter", "name": name, "value": value}).to_string().into()
}

/// When and where an object of the scene is.
pub(crate) fn schedule(object: &TerrainObject) -> Schedule {
    let pose = |p: &TerrainPose| Pose::new(p.position, p.rotation);
    let later: Vec<(f64, Pose)> = object.poses.iter().map(|(time, p)| (*time, pose(p))).collect();
    Schedule::new(object.appears, object.vanishes, pose(&object.pose), &later)
}

/// Words of a robot's events.
fn words(setup: &Setup) -> Words {
    Words {
        joints: setup.robot.joints.iter().map(|joint| joint.name.clone()).collect(),
        nodes: setup.robot.layout.nodes.clone(),
        fault: Some(|code| DriveFault::from_code(code).map_or("", DriveFault::text)),
    }
}
