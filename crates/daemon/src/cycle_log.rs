//! What a cycle began with, on its way into the log: one record at the end of each cycle, one for each command.

use ipc::{Space, Writer};
use messages::cycle_inputs::Used;
use messages::topics::Process;
use messages::{CommandSource, CommandTaken, CycleInputs, Header, Live, Verdict};
use std::error::Error;

/// Writes `cycle_inputs/PROCESS` and `commands/PROCESS`.
pub struct CycleLog {
    inputs: Writer<CycleInputs>,
    commands: Writer<CommandTaken>,
    now: CycleInputs,
}

impl CycleLog {
    pub(crate) fn new(process: Process, space: &Space) -> Result<Self, Box<dyn Error>> {
        Ok(Self {
            inputs: space.writer(super::topic(process, "cycle_inputs")?)?,
            commands: space.writer(super::topic(process, "commands")?)?,
            now: CycleInputs { cycle: 1, ..CycleInputs::default() },
        })
    }

    /// The step uses the record with this header of the topic at that place of [`messages::cycle_inputs::inputs_of`].
    pub fn uses(&mut self, place: usize, header: Option<&Header>) {
        self.now.used[place] = Used::of(header);
    }

    /// The step took a command.
    pub fn took(&mut self, header: Header, live: &Live, verdict: &Verdict) {
        self.put(header, live, verdict, true);
    }

    /// Commands that did not come to the step, as too old or without the lease.
    pub fn left_out(&mut self, header: Header, commands: &mut dyn CommandSource) {
        while let Some((live, reason)) = commands.left_out() {
            self.put(header, &live, &Err(reason), false);
        }
    }

    fn put(&mut self, header: Header, live: &Live, verdict: &Verdict, seen: bool) {
        self.now.commands += 1;
        self.commands.write(&CommandTaken::new(header, self.now.cycle, live, verdict, seen));
    }

    /// The rest of what the cycle began with, to be filled in before its end.
    pub fn now(&mut self) -> &mut CycleInputs {
        &mut self.now
    }

    pub(crate) fn end(&mut self, header: Header) {
        self.now.header = header;
        self.inputs.write(&self.now);
        self.now = CycleInputs { cycle: self.now.cycle + 1, ..CycleInputs::default() };
    }
}
