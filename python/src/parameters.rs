//! Parameters of the processes of a walk, as the broker's registry has them.

use config::Setup;
use config::registry::{self, Change, ParameterEntry};
use messages::Command;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arguments::{GREATEST, real, wrong};
use crate::command::refusal;
use crate::walk::Walk;

/// Numbers of the broker's refusals of a value and of a parameter that cannot be changed, as in docs/protocol.md.
const OUT_OF_RANGE: u8 = 5;
const NO_PARAMETER: u8 = 13;

/// Present value of a parameter.
fn present(walk: &Walk, entry: &ParameterEntry) -> f64 {
    let Change::Live(number) = entry.change else { return entry.default };
    let set = &walk.chain.parameters()[usize::from(entry.process != "planner")];
    set.values.get(number as usize).copied().unwrap_or(entry.default)
}

/// All of them by name, as the client's `Parameter`.
pub(crate) fn all<'py>(py: Python<'py>, walk: &Walk) -> PyResult<Bound<'py, PyDict>> {
    let class = py.import("gangwerk.client")?.getattr("Parameter")?;
    let found = PyDict::new(py);
    for entry in registry::entries(&walk.setup) {
        let change = match entry.change {
            Change::Live(_) => "live",
            Change::File(_) => "fixed",
            Change::Constant => "constant",
        };
        let (name, [low, high]) = (entry.full_name(), entry.range);
        let row = (&name, entry.unit, low, high, entry.default, present(walk, &entry), change, entry.about);
        found.set_item(&name, class.call1(row)?)?;
    }
    Ok(found)
}

/// The value of one.
pub(crate) fn value(walk: &Walk, name: &str) -> PyResult<f64> {
    let entries = registry::entries(&walk.setup);
    registry::find(&entries, name).map(|entry| present(walk, entry)).map_err(wrong)
}

/// The command that gives it another value.
pub(crate) fn command(
    py: Python<'_>,
    setup: &Setup,
    name: &str,
    value: &Bound<'_, PyAny>,
) -> PyResult<Command> {
    let entries = registry::entries(setup);
    let entry = registry::find(&entries, name).map_err(wrong)?;
    let value = real("value", value, [-GREATEST * 1e3, GREATEST * 1e3], entry.unit)?;
    let code = if let Change::Live(_) = entry.change { OUT_OF_RANGE } else { NO_PARAMETER };
    entry.command(value).map_err(|text| refusal(py, code, &text))
}
