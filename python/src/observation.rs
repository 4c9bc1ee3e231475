//! Fields of a cycle by topic and name: `sim_state.com`.

use chain::Cycle;
use config::Setup;
use messages::{ControllerState, JointTargets, Power, Sensors, SimState};
use pyo3::prelude::*;

use crate::arguments::unknown_name;
use crate::columns::{self, Columns, RecordField};

/// Topics that every cycle writes.
const TOPICS: [&str; 5] = ["sim_state", "sensors", "controller_state", "joint_targets", "power"];

/// Place of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FieldPlace {
    /// Place in [`TOPICS`].
    pub(crate) topic: usize,
    field: usize,
}

/// The fields of all topics of a cycle, for a robot.
#[derive(Clone)]
pub(crate) struct CycleFields {
    topics: [Vec<RecordField>; TOPICS.len()],
}

impl CycleFields {
    /// Those of the robot of a scene.
    pub(crate) fn new(setup: &Setup) -> Self {
        let joints: Vec<String> = setup.robot.joints.iter().map(|joint| joint.name.clone()).collect();
        Self {
            topics: [
                columns::fields::<SimState>(&joints),
                columns::fields::<Sensors>(&joints),
                columns::fields::<ControllerState>(&joints),
                columns::fields::<JointTargets>(&joints),
                columns::fields::<Power>(&joints),
            ],
        }
    }

    /// The field `topic.name`.
    pub(crate) fn find(&self, name: &str) -> PyResult<FieldPlace> {
        let (topic, rest) = name.split_once('.').unwrap_or((name, ""));
        let hint = format!("a field is named TOPIC.FIELD, with one of {}", TOPICS.join(", "));
        let at = TOPICS.iter().position(|known| *known == topic);
        let at = at.ok_or_else(|| unknown_name("topic", topic, &TOPICS, &hint))?;
        let fields = &self.topics[at];
        let field = columns::find(fields, topic, rest)?;
        let place = fields.iter().position(|other| other.name == field.name).unwrap_or_default();
        Ok(FieldPlace { topic: at, field: place })
    }

    /// A field.
    pub(crate) fn field(&self, place: FieldPlace) -> &RecordField {
        &self.topics[place.topic][place.field]
    }

    /// Numbers of a row of these fields.
    pub(crate) fn width(&self, names: &[String]) -> PyResult<usize> {
        names.iter().map(|name| Ok(self.field(self.find(name)?).width())).sum()
    }

    /// Names, units and shapes of all of them.
    pub(crate) fn all(&self) -> Vec<(String, String, Vec<usize>)> {
        let of = |(topic, fields): (&str, &Vec<RecordField>)| -> Vec<_> {
            let row = |f: &RecordField| (format!("{topic}.{}", f.name), f.unit.clone(), f.shape.clone());
            fields.iter().map(row).collect()
        };
        TOPICS.into_iter().zip(&self.topics).flat_map(of).collect()
    }

    /// Empty columns for these fields, by topic.
    pub(crate) fn columns(&self, names: &[String]) -> PyResult<Vec<(&'static str, Columns)>> {
        let mut chosen: [Vec<RecordField>; TOPICS.len()] = Default::default();
        for name in names {
            let place = self.find(name)?;
            let (field, fields) = (self.field(place), &mut chosen[place.topic]);
            if !fields.iter().any(|other| other.name == field.name) {
                fields.push(field.clone());
            }
        }
        let asked = TOPICS.into_iter().zip(chosen).filter(|(_, fields)| !fields.is_empty());
        Ok(asked.map(|(topic, fields)| (topic, Columns::new(fields))).collect())
    }

    /// Adds what a cycle wrote to columns of a topic.
    pub(crate) fn add(&self, topic: usize, cycle: &Cycle, columns: &mut Columns) {
        match topic {
            0 => columns.add(&cycle.sim_state),
            1 => columns.add(&cycle.sensors),
            2 => columns.add(&cycle.controller_state),
            3 => columns.add(&cycle.joint_targets),
            _ => columns.add(&cycle.power),
        }
    }

    /// The same to columns of several topics.
    pub(crate) fn add_all(&self, cycle: &Cycle, all: &mut [(&'static str, Columns)]) {
        for (topic, columns) in all {
            let at = TOPICS.iter().position(|known| known == topic).unwrap_or_default();
            self.add(at, cycle, columns);
        }
    }
}
