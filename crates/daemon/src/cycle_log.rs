//! Inputs of a cycle, on their way into the log: one record at the end of each cycle, one for each command. The same,
//! with the records that were read and written, stays in the process's black box for as long as it has room.

use ipc::{Space, Writer};
use messages::cycle_inputs::{MAX_USED, Used};
use messages::topics::Process;
use messages::{CommandSource, CommandTaken, CycleInputs, Header, Live, Record, TOPICS, Topic, Verdict};
use realtime::black_box::BlackBox;
use std::error::Error;

/// Writes `cycle_inputs/PROCESS` and `commands/PROCESS`, and the black box. Lives as long as the process.
pub struct CycleLog {
    topics: [&'static Topic; 2],
    kept: &'static mut BlackBox,
    /// The records used that are in it.
    before: [Used; MAX_USED],
    inputs: Writer<CycleInputs>,
    commands: Writer<CommandTaken>,
    now: CycleInputs,
}

impl CycleLog {
    pub(crate) fn new(process: Process, space: &Space) -> Result<Self, Box<dyn Error>> {
        let topics = [super::topic(process, "cycle_inputs")?, super::topic(process, "commands")?];
        let path = space.box_of(process);
        let kept = BlackBox::create(&path, room(process)).map_err(|e| format!("{}: {e}", path.display()))?;
        let kept = Box::leak(Box::new(kept));
        kept.last_words().listen();
        Ok(Self {
            topics,
            kept,
            before: [Used::default(); MAX_USED],
            inputs: space.writer(topics[0])?,
            commands: space.writer(topics[1])?,
            now: CycleInputs { cycle: 1, ..CycleInputs::default() },
        })
    }

    /// The step uses this record of the topic, at that place of [`messages::cycle_inputs::inputs_of`].
    pub fn uses<T: Record>(&mut self, place: usize, topic: &Topic, record: Option<&T>) {
        let used = Used::of(record.map(Record::header));
        self.now.used[place] = used;
        if std::mem::replace(&mut self.before[place], used) != used
            && let Some(record) = record
        {
            self.keep(topic, record);
        }
    }

    /// The process wrote this record, or read one that no number names.
    pub fn keep<T: Record>(&mut self, topic: &Topic, record: &T) {
        let kind = TOPICS.iter().position(|t| t.name == topic.name).unwrap_or(TOPICS.len());
        self.kept.keep(kind as u32, record.header().tick, record);
    }

    pub(crate) fn begin(&mut self, now_ns: u64) {
        self.kept.begin(now_ns);
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
        let taken = CommandTaken::new(header, self.now.cycle, live, verdict, seen);
        self.commands.write(&taken);
        self.keep(self.topics[1], &taken);
    }

    /// The rest of what the cycle began with, to be filled in before its end.
    pub fn now(&mut self) -> &mut CycleInputs {
        &mut self.now
    }

    pub(crate) fn end(&mut self, header: Header, now_ns: u64) {
        self.now.header = header;
        let now = self.now;
        self.inputs.write(&now);
        self.keep(self.topics[0], &now);
        self.kept.end(now_ns);
        self.now = CycleInputs { cycle: self.now.cycle + 1, ..CycleInputs::default() };
    }
}

/// Room for the last two seconds \[B\]: what a process reads and writes in 2000 cycles, with some to spare.
const fn room(process: Process) -> usize {
    match process {
        Process::Lowlevel => 16 << 20,
        Process::Controller => 14 << 20,
        Process::SimBackend => 12 << 20,
        Process::Planner => 5 << 20,
        _ => 1 << 20,
    }
}
