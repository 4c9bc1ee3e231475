//! A log, topic by topic: what a process read, to be handed out, and what it wrote, to be compared.
//!
//! Topics lie in the log as the logger came to them, a little out of step with each other: messages wait in a queue per
//! topic until they are asked for. A thread reads ahead by a bounded number.

use std::collections::VecDeque;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};

use messages::cycle_inputs::{Used, inputs_of};
use messages::topics::{ForType, with_type};
use messages::{CommandTaken, CycleInputs, Detail, Event, EventCode, Header, Process, Record, TOPICS, Topic};
use recording::{Log, LogEnd, cdr, channel_name, definition};

use super::problem::ReplayProblem;
use messages::fields::first_difference;

/// Messages read ahead.
const AHEAD: usize = 4096;
/// Messages of other topics between two that belong together: more than all rings hold, so that it is not there.
const FAR: usize = 50_000;

enum Heard {
    Message(usize, Waiting),
    Layout(usize),
    End(Result<LogEnd, String>),
}

struct Waiting {
    number: u32,
    payload: Vec<u8>,
}

struct TapeQueue {
    topic: &'static Topic,
    waiting: VecDeque<Waiting>,
    /// Number of the last output that was compared.
    last: Option<u32>,
    output: bool,
}

/// The log as one process sees it.
pub(super) struct Tape {
    process: Process,
    heard: Receiver<Heard>,
    queues: Vec<TapeQueue>,
    end: Option<LogEnd>,
    encoder: cdr::CdrEncoder,
    cycle: u64,
    header: Header,
    records: u64,
    bytes: u64,
    /// Events that are not the step's, and may be anywhere.
    not_ours: fn(EventCode) -> bool,
}

impl Tape {
    /// Begins to read.
    pub(super) fn open(log: Log, process: Process) -> Result<Self, ReplayProblem> {
        let mut queues = Vec::new();
        for topic in TOPICS.iter().filter(|t| t.logged) {
            // Inputs are fed, own outputs compared; statistics depend on the machine and are neither.
            let input = inputs_of(process).contains(&topic.name);
            let of_statistics = topic.name.starts_with("cycle_stats/");
            let own = topic.writer == process && !of_statistics;
            if input || own {
                let of_log = topic.type_name == "CycleInputs" || topic.type_name == "CommandTaken";
                let output = own && !input && !of_log;
                queues.push(TapeQueue { topic, waiting: VecDeque::new(), last: None, output });
            }
        }
        let channels: Vec<_> =
            queues.iter().map(|q| (channel_name(q.topic.name), text_of(q.topic))).collect();
        // The log is read by a thread of its own, a bounded number of records ahead.
        let (sender, heard) = sync_channel(AHEAD);
        let reading = move || {
            let end = read(&log, &channels, &sender).map_err(|e| e.to_string());
            let _ = sender.send(Heard::End(end));
        };
        std::thread::Builder::new()
            .name("tape".into())
            .spawn(reading)
            .map_err(|e| ReplayProblem::Broken(format!("no thread to read the log: {e}")))?;
        Ok(Self {
            process,
            heard,
            queues,
            end: None,
            encoder: cdr::CdrEncoder::new(),
            cycle: 0,
            header: Header { epoch: 1, ..Header::default() },
            records: 0,
            bytes: 0,
            not_ours: |code| OF_DAEMONS.contains(&code),
        })
    }

    /// The far end of a real bus has events of its own among those of the joint loop.
    pub(super) fn on_real_bus(&mut self) {
        self.not_ours = |code| OF_DAEMONS.contains(&code) || OF_BUSES.contains(&code);
    }

    /// Inputs of the next cycle; none at the end of the log.
    pub(super) fn inputs(&mut self) -> Result<Option<CycleInputs>, ReplayProblem> {
        let at = self.queue_of("cycle_inputs/");
        let next = match self.next(at) {
            Ok(next) => next,
            Err(ReplayProblem::EndOfCut) if self.end == Some(LogEnd::Complete) => return Ok(None),
            Err(problem) => return Err(problem),
        };
        let inputs: CycleInputs = self.decode(at, &next)?;
        if inputs.header.epoch > 1 {
            let why = "the process was started again, which is not replayed".into();
            return Err(self.missing(at, inputs.header.tick, why));
        }
        self.cycle += 1;
        if inputs.cycle != self.cycle {
            let why = format!(
                "cycles {} to {} of {} are missing",
                self.cycle,
                inputs.cycle - 1,
                self.process.name()
            );
            return Err(self.missing(at, inputs.header.tick, why));
        }
        self.header = inputs.header;
        Ok(Some(inputs))
    }

    /// The commands that the step saw in this cycle.
    pub(super) fn commands(&mut self, inputs: &CycleInputs) -> Result<Vec<CommandTaken>, ReplayProblem> {
        let at = self.queue_of("commands/");
        let mut commands = Vec::new();
        for _ in 0..inputs.commands {
            let next = self.needed(at)?;
            let taken: CommandTaken = self.decode(at, &next)?;
            if taken.cycle != inputs.cycle {
                let why = format!("a command of cycle {} is missing", inputs.cycle);
                return Err(self.missing(at, inputs.header.tick, why));
            }
            commands.push(taken);
        }
        commands.retain(|taken| taken.seen == 1);
        Ok(commands)
    }

    /// Fetches the record that the cycle used into `held`; one that it used before is still there.
    pub(super) fn fetch<T: Record>(
        &mut self,
        topic: &Topic,
        used: Used,
        held: &mut Option<Box<T>>,
    ) -> Result<(), ReplayProblem> {
        if used.epoch == 0 {
            *held = None;
            return Ok(());
        }
        let wanted = (used.epoch, used.tick);
        let by_number = topic.name == "frames_in";
        let at = self.queue_of(topic.name);
        let key = |number: u32, header: &Header| {
            (header.epoch, if by_number { number.into() } else { header.tick })
        };
        if !by_number && held.as_ref().is_some_and(|held| key(0, held.header()) == wanted) {
            return Ok(());
        }
        loop {
            let next = self.needed(at)?;
            let found = key(next.number, &header_of(&next.payload));
            if found == wanted {
                *held = Some(Box::new(self.decode(at, &next)?));
                return Ok(());
            }
            if found > wanted {
                let why = format!("record {} was used and is missing", used.tick);
                return Err(self.missing(at, self.header.tick, why));
            }
        }
    }

    /// Holds what the step made against the log.
    pub(super) fn compare<T: Record>(&mut self, topic: &Topic, made: &T) -> Result<(), ReplayProblem> {
        let at = self.queue_of(topic.name);
        let logged = self.needed(at)?;
        self.compare_with(at, &logged, made)
    }

    /// The same for an event.
    pub(super) fn event(
        &mut self,
        header: Header,
        code: EventCode,
        detail: Detail,
    ) -> Result<(), ReplayProblem> {
        let at = self.queue_of("events/");
        let made = Event::new(header, code, detail);
        loop {
            let logged = self.needed(at)?;
            let theirs: Event = self.decode(at, &logged)?;
            let other = theirs.code != made.code;
            if other && EventCode::from_number(theirs.code).is_some_and(self.not_ours) {
                self.follows(at, &logged)?;
                continue;
            }
            return self.compare_with(at, &logged, &made);
        }
    }

    fn compare_with<T: Record>(
        &mut self,
        at: usize,
        logged: &Waiting,
        made: &T,
    ) -> Result<(), ReplayProblem> {
        self.follows(at, logged)?;
        let topic = self.queues[at].topic.name;
        let mut made = *made;
        made.header_mut().epoch = self.header.epoch;
        self.records += 1;
        self.bytes += logged.payload.len() as u64;
        if self.encoder.encode(&made) == logged.payload {
            return Ok(());
        }
        let theirs: T = self.decode(at, logged)?;
        let (field, logged, replayed) = first_difference(&theirs, &made).unwrap_or_default();
        let tick = made.header().tick;
        Err(ReplayProblem::Differs { process: self.process, topic, tick, field, logged, replayed })
    }

    /// Whether this is the record after the last one.
    fn follows(&mut self, at: usize, logged: &Waiting) -> Result<(), ReplayProblem> {
        let last = self.queues[at].last.replace(logged.number);
        match last.map(|last| logged.number.wrapping_sub(last)) {
            None | Some(1) => Ok(()),
            Some(gap) => {
                let why =
                    format!("{} records before number {} are missing", gap.wrapping_sub(1), logged.number);
                Err(self.missing(at, header_of(&logged.payload).tick, why))
            }
        }
    }

    /// Nothing that the process wrote before this cycle may be left.
    pub(super) fn end_of_cycle(&mut self, inputs: &CycleInputs) -> Result<(), ReplayProblem> {
        self.left_before(inputs.header.tick)
    }

    /// Nothing that it wrote may be left at the end; what a cycle that did not end wrote is of a later tick.
    pub(super) fn nothing_is_left(&mut self) -> Result<(), ReplayProblem> {
        self.left_before(self.header.tick + 1)
    }

    fn left_before(&mut self, tick: u64) -> Result<(), ReplayProblem> {
        for at in 0..self.queues.len() {
            while let Some(front) = self.queues[at].waiting.front().filter(|_| self.queues[at].output) {
                let header = header_of(&front.payload);
                if header.tick >= tick {
                    break;
                }
                let topic = self.queues[at].topic;
                let event: Option<Event> =
                    (topic.type_name == "Event").then(|| cdr::decode(&front.payload)).flatten();
                let code = event.and_then(|event| EventCode::from_number(event.code));
                if !code.is_some_and(self.not_ours) {
                    let (process, topic) = (self.process, topic.name);
                    return Err(ReplayProblem::NotMade { process, topic, tick: header.tick });
                }
                let Some(front) = self.queues[at].waiting.pop_front() else { break };
                self.follows(at, &front)?;
            }
        }
        Ok(())
    }

    /// Records compared, and their size \[B\].
    pub(super) fn compared(&self) -> (u64, u64) {
        (self.records, self.bytes)
    }

    /// The next message of a topic, which must be there.
    fn needed(&mut self, at: usize) -> Result<Waiting, ReplayProblem> {
        match self.next(at) {
            Err(ReplayProblem::EndOfCut) if self.end == Some(LogEnd::Complete) => {
                Err(self.missing(at, self.header.tick, "it is not in the rest of the log".into()))
            }
            other => other,
        }
    }

    fn next(&mut self, at: usize) -> Result<Waiting, ReplayProblem> {
        let mut passed = 0;
        while self.queues[at].waiting.is_empty() {
            if self.end.is_some() {
                return Err(ReplayProblem::EndOfCut);
            }
            if passed > FAR {
                return Err(self.missing(at, self.header.tick, "it is not where it should be".into()));
            }
            match self.heard.recv().map_err(|e| ReplayProblem::Broken(e.to_string()))? {
                Heard::Message(of, waiting) => self.queues[of].waiting.push_back(waiting),
                Heard::Layout(of) => return Err(ReplayProblem::Layout { topic: self.queues[of].topic.name }),
                Heard::End(end) => self.end = Some(end.map_err(ReplayProblem::Broken)?),
            }
            passed += 1;
        }
        self.queues[at].waiting.pop_front().ok_or(ReplayProblem::EndOfCut)
    }

    fn decode<T: Record>(&self, at: usize, waiting: &Waiting) -> Result<T, ReplayProblem> {
        cdr::decode(&waiting.payload).ok_or(ReplayProblem::Layout { topic: self.queues[at].topic.name })
    }

    fn missing(&self, at: usize, tick: u64, why: String) -> ReplayProblem {
        ReplayProblem::Missing { topic: self.queues[at].topic.name, tick, why }
    }

    /// The queue of the topic that begins like this; of `prefix/PROCESS` there is one.
    fn queue_of(&self, name: &str) -> usize {
        let begins = |q: &TapeQueue| {
            if name.ends_with('/') { q.topic.name.starts_with(name) } else { q.topic.name == name }
        };
        self.queues.iter().position(begins).expect("a topic of this process")
    }
}

/// Events of what is around the steps: start and end, time, leases, the line of the emergency stop.
const OF_DAEMONS: [EventCode; 6] = [
    EventCode::Started,
    EventCode::Ended,
    EventCode::Overrun,
    EventCode::LeaseLost,
    EventCode::EmergencyStop,
    EventCode::PlannerSilent,
];

/// Events of the field bus itself.
const OF_BUSES: [EventCode; 8] = [
    EventCode::BusWarning,
    EventCode::BusPassive,
    EventCode::BusOff,
    EventCode::BusActive,
    EventCode::RingBroken,
    EventCode::RingClosed,
    EventCode::BusRestart,
    EventCode::NodeBack,
];

fn read(
    log: &Log,
    channels: &[(String, String)],
    heard: &SyncSender<Heard>,
) -> Result<LogEnd, recording::RecordingError> {
    log.each(|message| {
        let Some(at) = channels.iter().position(|(name, _)| name == message.channel) else { return };
        // A closed channel: the listener has found what it wanted.
        let _ = match message.definition == channels[at].1.as_bytes() {
            true => heard.send(Heard::Message(
                at,
                Waiting { number: message.number, payload: message.payload.into() },
            )),
            false => heard.send(Heard::Layout(at)),
        };
    })
}

/// The header, which is the first field of every record.
fn header_of(payload: &[u8]) -> Header {
    payload.get(..4 + size_of::<Header>()).and_then(cdr::decode).unwrap_or_default()
}

fn text_of(topic: &Topic) -> String {
    struct Text;
    impl ForType<String> for Text {
        fn call<T: Record>(self, _: &'static Topic) -> String {
            definition::definition::<T>()
        }
    }
    with_type(topic.name, Text).unwrap_or_default()
}
