//! Commands from Python: `command("walk/velocity", forward=0.3)`.

use messages::Command;
use messages::command_text::CommandInfo;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arguments::wrong;

/// The command of this name with these numbers, in their ranges.
pub(crate) fn of(name: &str, values: Option<&Bound<'_, PyDict>>) -> PyResult<Command> {
    let mut text = String::new();
    for (field, value) in values.into_iter().flat_map(|values| values.iter()) {
        let field: String = field.extract()?;
        if field.contains(['=', ' ', ',', '\t', '\n']) {
            return Err(wrong(format!("{name}: there is no field `{field}`")));
        }
        let number = value.extract::<f64>().map_err(|_| {
            let fields = CommandInfo::find(name).map_or(&[][..], |info| info.fields);
            let range =
                fields.iter().find(|known| known.name == field).map(|known| (known.range, known.unit));
            let limits =
                range.map_or(String::new(), |([low, high], unit)| format!(" in [{low}, {high}] {unit}"));
            wrong(format!("{name}: {field} is of type {}: must be a number{limits}", value.get_type()))
        })?;
        text += &format!("{field}={number:?} ");
    }
    Command::parse(name, &text).map_err(wrong)
}

/// The exception `gangwerk.Refused` of the client, as its broker would have it raised.
pub(crate) fn refused(py: Python<'_>, command: &Command, code: u8, text: &str) -> PyErr {
    let text = format!("{} refused by {}: {text}", command.name(), command.decided_by());
    refusal(py, code, &text)
}

/// `gangwerk.Refused` with number and text of the reason.
pub(crate) fn refusal(py: Python<'_>, code: u8, text: &str) -> PyErr {
    let made = py
        .import("gangwerk.client")
        .and_then(|client| client.getattr("Refused"))
        .and_then(|class| class.call1((code, text)));
    made.map_or_else(|_| PyRuntimeError::new_err(text.to_owned()), PyErr::from_value)
}
