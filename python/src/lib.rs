//! Gangwerk for Python: native half of the package `gangwerk`, whose other half is in `python/gangwerk`.
//!
//! | file | Python |
//! |---|---|
//! | `chain.rs`, on `observed.rs` and `walk.rs` | `Chain`: a whole robot in one process; `State`, `Event` |
//! | `observation.rs`, `columns.rs` | fields of records by name, as arrays |
//! | `command.rs`, `parameters.rs` | commands and parameters, answered as by the broker |
//! | `plan.rs` | `plan`, `Plan` |
//! | `model.rs`, `matrix.rs` | `Model`: kinematics and dynamics |
//! | `log.rs` | `Log` |
//! | `configuration.rs` | `scenes`, and what a scene is made of |
//!
//! Everything from Python is checked in `arguments.rs` first: a panic leaves a chain in the middle of a cycle (docs/python.md).

mod arguments;
mod chain;
mod columns;
mod command;
mod configuration;
mod log;
mod matrix;
mod model;
mod observation;
mod observed;
mod parameters;
mod plan;
mod walk;

use std::path::PathBuf;

use pyo3::prelude::*;

/// Names of all scenes with what they show.
#[pyfunction]
#[pyo3(signature = (*, config=None))]
fn scenes(config: Option<PathBuf>) -> PyResult<std::collections::BTreeMap<String, String>> {
    Ok(configuration::scenes(&configuration::directory(config)?)?.into_iter().collect())
}

/// The module.
#[pymodule(name = "_native")]
fn native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    config::embed(cli::shipped::files());
    module.add("version", cli::VERSION)?;
    module.add_function(wrap_pyfunction!(scenes, module)?)?;
    chain::register(module)?;
    plan::register(module)?;
    model::register(module)?;
    log::register(module)
}
