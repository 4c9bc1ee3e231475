//! A walk that is looked at: stepped without the interpreter's lock, seen through arrays, written to a log.
#![allow(clippy::disallowed_types)] // never locked: it makes a log, which one thread writes, fit for an object of Python

use std::error::Error;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use chain::LogWriter;
use numpy::{PyArrayDyn, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arguments::{MOST_NUMBERS, real, wrong};
use crate::columns::Columns;
use crate::observation::{CycleFields, FieldPlace};
use crate::walk::Walk;

/// Cycles between two looks at Ctrl-C.
const AT_ONCE: u64 = 500;
/// Most cycles of one call: eleven days.
pub(crate) const MOST_CYCLES: u64 = 1_000_000_000;
/// \[s\] Latest instant.
pub(crate) const LATEST: f64 = 1e6;

/// Array that every step writes anew.
struct LiveView {
    place: FieldPlace,
    array: Py<PyArrayDyn<f64>>,
}

/// A walk with its fields, views and log.
pub(crate) struct ObservedWalk {
    /// The walk.
    pub(crate) walk: Walk,
    /// Fields of its cycles.
    pub(crate) fields: CycleFields,
    views: Vec<LiveView>,
    /// Its log, if it is written.
    log: Option<Mutex<LogWriter>>,
}

impl ObservedWalk {
    /// Nobody looks yet.
    pub(crate) fn new(walk: Walk) -> Self {
        Self { fields: CycleFields::new(&walk.setup), walk, views: Vec::new(), log: None }
    }

    /// Runs up to `cycles` cycles without the interpreter's lock, until `each`, called after each of them, is false.
    pub(crate) fn advance(
        &mut self,
        py: Python<'_>,
        cycles: u64,
        mut each: impl FnMut(&Walk) -> bool + Send,
    ) -> PyResult<()> {
        let (mut left, mut going) = (cycles, true);
        while left > 0 && going {
            let now = left.min(AT_ONCE);
            left -= now;
            let Self { walk, log, .. } = self;
            // In lots, so that Ctrl-C is heard.
            let stepped: Result<(), String> = py.detach(|| {
                for _ in 0..now {
                    walk.step();
                    if let Some(log) = log.as_mut().map(own) {
                        log.write(walk.chain.last()).map_err(|error| error.to_string())?;
                    }
                    going = each(walk);
                    if !going {
                        break;
                    }
                }
                Ok(())
            });
            stepped.map_err(|text| wrong(format!("log: {text}")))?;
            if left > 0 {
                py.check_signals()?;
            }
        }
        self.refresh(py)
    }

    /// Writes the views anew.
    pub(crate) fn refresh(&self, py: Python<'_>) -> PyResult<()> {
        for view in &self.views {
            let columns = self.read(view.place);
            let mut array = view.array.bind(py).try_readwrite().map_err(wrong)?;
            array.as_slice_mut().map_err(wrong)?.copy_from_slice(columns.reals());
        }
        Ok(())
    }

    /// Cycles until `until` \[s\], or the end of the scene.
    pub(crate) fn cycles_until(&self, until: Option<&Bound<'_, PyAny>>) -> PyResult<u64> {
        let until = match until {
            None => self.walk.setup.scene.duration,
            Some(until) => real("until", until, [self.walk.time(), LATEST], "s")?,
        };
        let tick = (until / self.walk.chain.cycle()).round() as u64;
        Ok(tick.saturating_sub(self.walk.chain.tick()))
    }

    /// Runs as [`ObservedWalk::advance`], and gathers these fields of every `every`-th cycle.
    pub(crate) fn trace<'py>(
        &mut self,
        py: Python<'py>,
        names: &[String],
        until: Option<&Bound<'py, PyAny>>,
        every: u64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let cycles = self.cycles_until(until)?;
        let mut columns = self.fields.columns(names)?;
        let rows = cycles / every;
        let most = MOST_NUMBERS as u64 / self.fields.width(names)?.max(1) as u64;
        if rows > most {
            return Err(wrong(format!(
                "until: these are {rows} rows, at most {most} of these fields; take a larger `every`"
            )));
        }
        let (mut times, mut count) = (Vec::new(), 0);
        let fields = self.fields.clone();
        self.advance(py, cycles, |walk| {
            count += 1;
            if count % every == 0 {
                times.push(walk.time());
                fields.add_all(walk.chain.last(), &mut columns);
            }
            !walk.is_over()
        })?;
        // Arrays take over what was gathered; nothing is copied.
        let found = PyDict::new(py);
        found.set_item("time", numpy::PyArray1::from_vec(py, times))?;
        for (topic, columns) in columns {
            for (name, array) in columns.arrays(py)? {
                found.set_item(format!("{topic}.{name}"), array)?;
            }
        }
        Ok(found)
    }

    /// Writes a log from now on.
    ///
    /// # Errors
    /// The walk has begun, or the file cannot be written.
    pub(crate) fn begin_log(&mut self, path: &Path) -> Result<(), Box<dyn Error>> {
        self.end_log()?;
        if self.walk.chain.tick() > 0 {
            return Err(
                format!("path = {}: the walk has begun, and a log has all of it", path.display()).into()
            );
        }
        let log = LogWriter::create(path, &self.walk.setup, &self.walk.chain, cli::COMMIT)?;
        self.log = Some(Mutex::new(log));
        Ok(())
    }

    /// Ends the log, if there is one.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(crate) fn end_log(&mut self) -> Result<(), Box<dyn Error>> {
        self.log
            .take()
            .map_or(Ok(()), |log| log.into_inner().unwrap_or_else(PoisonError::into_inner).finish())
    }

    /// True while a log is being written.
    pub(crate) fn is_logged(&self) -> bool {
        self.log.is_some()
    }

    /// Present value of the field of that name: an array of its own, or a number.
    pub(crate) fn named<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        self.read(self.fields.find(name)?).value(py)
    }

    fn read(&self, place: FieldPlace) -> Columns {
        let mut columns = Columns::new(vec![self.fields.field(place).clone()]);
        self.fields.add(place.topic, self.walk.chain.last(), &mut columns);
        columns
    }

    /// Array of a field that follows the walk.
    pub(crate) fn view<'py>(&mut self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let place = self.fields.find(name)?;
        let field = self.fields.field(place);
        if field.is_whole || field.shape.is_empty() {
            let why = if field.is_whole { "is counted, not measured" } else { "is one number" };
            return Err(wrong(format!("field = '{name}' {why}: read it with get(\"{name}\")")));
        }
        let known = self.views.iter().position(|view| view.place == place);
        let at = known.unwrap_or_else(|| {
            let array = PyArrayDyn::zeros(py, field.shape.clone(), false).unbind();
            self.views.push(LiveView { place, array });
            self.views.len() - 1
        });
        self.refresh(py)?;
        // Read only for who looks at it.
        let view = self.views[at].array.bind(py).call_method0("view")?;
        let flags = PyDict::new(py);
        flags.set_item("write", false)?;
        view.call_method("setflags", (), Some(&flags))?;
        Ok(view)
    }
}

/// The log that nobody else has.
fn own(log: &mut Mutex<LogWriter>) -> &mut LogWriter {
    log.get_mut().unwrap_or_else(PoisonError::into_inner)
}

impl Drop for ObservedWalk {
    /// A log that nobody has ended gets its index all the same.
    fn drop(&mut self) {
        let _ = self.end_log();
    }
}
