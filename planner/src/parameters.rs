//! Parameters of the planner that may be changed while the robot walks: `walk/parameter`.

use crate::Planner;
use config::parameters::PLANNER;
use messages::command::ParameterCommand;
use messages::{Detail, EventCode, Parameters, Reason};

impl Planner {
    /// Another value for a parameter, from the next step that is planned.
    ///
    /// # Errors
    /// No such parameter, a value out of its range, or a gait with a pattern, which is checked as a whole when it is loaded.
    pub(crate) fn set(&mut self, change: &ParameterCommand) -> Result<(), Reason> {
        if self.gait.pattern.is_some() {
            return Err(Reason::NotNow);
        }
        let Some(parameter) = PLANNER.get(change.number as usize) else {
            return Err(Reason::Limit { field: 0, low: 0.0, high: PLANNER.len() as f64 - 1.0 });
        };
        let [low, high] = parameter.range;
        if !parameter.set(&mut self.builder.model.step, change.value) {
            return Err(Reason::Limit { field: 1, low, high });
        }
        self.events.push(EventCode::ParameterSet, Detail::Number(change.number.into()));
        Ok(())
    }

    /// Writes the present values of all parameters.
    pub fn report_parameters(&self, record: &mut Parameters) {
        record.count = PLANNER.len() as u64;
        for (value, p) in record.values.iter_mut().zip(PLANNER) {
            *value = p.get(&self.builder.model.step);
        }
    }
}
