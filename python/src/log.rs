//! `gangwerk.Log`: the records of a log as NumPy arrays.

use std::collections::BTreeMap;
use std::path::PathBuf;

use messages::Record;
use messages::topics::{ForType, TOPICS, Topic, with_type};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arguments::{MOST_NUMBERS, real, unknown_name, wrong};
use crate::columns::{self, Columns, RecordField};

/// \[s\] Latest time of a window.
const LATEST: f64 = 1e9;

/// Records of a log, as `gangwerk run` and `gangwerk sim --log` write it.
#[pyclass(frozen, module = "gangwerk")]
struct Log {
    log: recording::Log,
    path: PathBuf,
}

/// The fields of a topic.
struct FieldsOf<'a>(&'a [String]);

impl ForType<Vec<RecordField>> for FieldsOf<'_> {
    fn call<T: Record>(self, _: &'static Topic) -> Vec<RecordField> {
        columns::fields::<T>(self.0)
    }
}

/// Times \[s\] and records of a topic in a window.
struct RecordReader<'a> {
    log: &'a recording::Log,
    fields: Vec<RecordField>,
    window: [f64; 2],
}

impl ForType<Result<(Vec<f64>, Columns), String>> for RecordReader<'_> {
    fn call<T: Record>(self, topic: &'static Topic) -> Result<(Vec<f64>, Columns), String> {
        let cycle = self.log.run().cycle_ns as f64 * 1e-9;
        let (mut times, mut columns) = (Vec::new(), Columns::new(self.fields));
        let [begin, end] = self.window;
        self.log
            .each_record(topic, |record: &T| {
                let time = record.header().tick as f64 * cycle;
                if time >= begin && time < end && columns.len() < MOST_NUMBERS {
                    times.push(time);
                    columns.add(record);
                }
            })
            .map_err(|error| error.to_string())?;
        if columns.len() < MOST_NUMBERS {
            return Ok((times, columns));
        }
        Err(format!("{} holds more than {MOST_NUMBERS} numbers: name fields, or begin and end", topic.name))
    }
}

impl Log {
    fn fields_of(&self, topic: &str) -> PyResult<Vec<RecordField>> {
        with_type(topic, FieldsOf(&self.log.robot().joints)).ok_or_else(|| {
            let known: Vec<&str> = TOPICS.iter().map(|topic| topic.name).collect();
            unknown_name("topic", topic, &known, "Log.topics() has those of this log")
        })
    }
}

#[pymethods]
impl Log {
    #[new]
    fn new(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let log = py.detach(|| recording::Log::open(&path)).map_err(wrong)?;
        Ok(Self { log, path })
    }

    /// Name of the robot.
    #[getter]
    fn robot(&self) -> &str {
        &self.log.robot().name
    }

    /// Text of its URDF.
    #[getter]
    fn urdf(&self) -> &str {
        &self.log.robot().urdf
    }

    /// Names of its joints, in the order of every array of joints.
    #[getter]
    fn joint_names(&self) -> Vec<String> {
        self.log.robot().joints.clone()
    }

    /// Name of the scene; empty of a real robot.
    #[getter]
    fn scene(&self) -> &str {
        &self.log.run().scene
    }

    /// Seed of everything random.
    #[getter]
    fn seed(&self) -> u64 {
        self.log.run().seed
    }

    /// Bus cycle [s].
    #[getter]
    fn cycle(&self) -> f64 {
        self.log.run().cycle_ns as f64 * 1e-9
    }

    /// Topics with the number of their records.
    fn topics(&self, py: Python<'_>) -> PyResult<BTreeMap<&'static str, u64>> {
        let channels: Vec<(&str, String)> =
            TOPICS.iter().map(|topic| (topic.name, recording::channel_name(topic.name))).collect();
        let mut counts = BTreeMap::new();
        let count = |message: recording::LogMessage<'_>| {
            if let Some((name, _)) = channels.iter().find(|(_, channel)| channel == message.channel) {
                *counts.entry(*name).or_insert(0) += 1;
            }
        };
        py.detach(|| self.log.each(count)).map_err(wrong)?;
        Ok(counts)
    }

    /// Units of the fields of a topic; of a last index with several units one for each; empty: none.
    fn units(&self, topic: &str) -> PyResult<BTreeMap<String, String>> {
        let fields = self.fields_of(topic)?;
        Ok(fields.into_iter().map(|field| (field.name, field.unit)).collect())
    }

    /// Fields of a topic by name, all or these, a row for each record with begin <= `time` < end [s], the time since the first cycle.
    #[pyo3(signature = (topic, fields=None, *, begin=None, end=None))]
    fn read<'py>(
        &self,
        py: Python<'py>,
        topic: &str,
        fields: Option<Vec<String>>,
        begin: Option<&Bound<'py, PyAny>>,
        end: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let all = self.fields_of(topic)?;
        let mut chosen = Vec::new();
        for name in fields.iter().flatten() {
            let field = columns::find(&all, topic, name)?;
            if !chosen.iter().any(|other: &RecordField| other.name == field.name) {
                chosen.push(field.clone());
            }
        }
        let begin = begin.map_or(Ok(0.0), |begin| real("begin", begin, [0.0, LATEST], "s"))?;
        let end = end.map_or(Ok(f64::INFINITY), |end| real("end", end, [begin, LATEST], "s"))?;
        let fields = if fields.is_some() { chosen } else { all };
        let reader = RecordReader { log: &self.log, fields, window: [begin, end] };
        let read = py.detach(|| with_type(topic, reader)).unwrap_or_else(|| Err("no such topic".into()));
        let (times, columns) = read.map_err(wrong)?;
        let found = PyDict::new(py);
        found.set_item("time", numpy::PyArray1::from_vec(py, times))?;
        for (name, array) in columns.arrays(py)? {
            // The truth has a field for it, too.
            if name != "time" {
                found.set_item(name, array)?;
            }
        }
        Ok(found)
    }

    fn __repr__(&self) -> String {
        format!("<gangwerk.Log {}: scene {}, robot {}>", self.path.display(), self.scene(), self.robot())
    }
}

/// Classes and functions of this file, added to the module.
pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Log>()
}
