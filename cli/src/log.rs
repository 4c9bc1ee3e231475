//! `gangwerk log`: what stands in a log, as overview, as table, against another one; a log whose writer died made whole.

use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;

use messages::topics::{ForType, TOPICS, Topic, with_type};
use messages::{CommandTaken, Event, EventCode, Record, Words};
use recording::{Log, Repaired, repair};

use crate::topic::{Echo, EchoTable};
use messages::fields::{first_difference, numbers};

/// Gives a log its end and index, if it lacks them, and takes out what is damaged.
///
/// # Errors
/// The file is no log, or there is no room beside it.
pub fn mend(path: &Path) -> Result<String, Box<dyn Error>> {
    let Repaired { messages, found, original } = repair(path)?;
    let kept = original.map_or(String::new(), |at| format!("; as it was: {}", at.display()));
    Ok(match found {
        Some(why) => format!("{}: {why}; repaired, with {messages} messages{kept}", path.display()),
        None => format!("{}: complete, with {messages} messages; left as it is", path.display()),
    })
}

/// Prints what a log is of, how long it is, and what it holds.
///
/// # Errors
/// The file is no log.
pub fn info(path: &Path) -> Result<(), Box<dyn Error>> {
    let log = Log::open(path)?;
    head(&log);
    let (mut all, mut channels) = (Traffic::default(), BTreeMap::<String, Traffic>::new());
    let end = log.each(|message| {
        all.add(message.log_time_ns);
        channels.entry(message.channel.to_owned()).or_default().add(message.log_time_ns);
    })?;
    let (seconds, messages) = (all.seconds(), all.messages);
    let size = std::fs::metadata(path)?.len() as f64 * 1e-6;
    println!("{seconds:.3} s, {messages} messages, {size:.1} MB, {} joints", log.robot().joints.len());
    if recording::is_being_written(path) {
        println!("it is being written: this is its beginning");
    } else if end != recording::LogEnd::Complete {
        println!("it has no end: `gangwerk log repair {}` makes it whole", path.display());
    }
    for (channel, of) in channels {
        let rate = of.rate().map_or(String::new(), |rate| format!("{rate:9.1} Hz"));
        println!("  {channel:36} {:8} {rate}", of.messages);
    }
    println!("`gangwerk dashboard --replay {}` shows it in a browser", path.display());
    Ok(())
}

/// Messages of a channel, or of all of them.
#[derive(Default)]
struct Traffic {
    messages: u64,
    /// Of which have a time: what was written before the first cycle has none.
    timed: u64,
    /// \[ns\] First and last time.
    span: Option<[u64; 2]>,
}

impl Traffic {
    fn add(&mut self, time_ns: u64) {
        self.messages += 1;
        if time_ns > 0 {
            self.timed += 1;
            let [first, last] = self.span.unwrap_or([time_ns; 2]);
            self.span = Some([first.min(time_ns), last.max(time_ns)]);
        }
    }

    fn seconds(&self) -> f64 {
        self.span.map_or(0.0, |[first, last]| (last - first) as f64 * 1e-9)
    }

    /// \[Hz\] Between n messages there are n - 1 periods.
    fn rate(&self) -> Option<f64> {
        let seconds = self.seconds();
        (self.timed > 1 && seconds > 0.0).then(|| (self.timed - 1) as f64 / seconds)
    }
}

/// The line about what a log is of.
fn head(log: &Log) {
    let (run, robot) = (log.run(), &log.robot().name);
    println!("scene {}, robot {robot}, configuration {:016x}, {}", run.scene, run.config_hash, run.software);
    println!("commit {}, seed {}", if run.commit.is_empty() { "unknown" } else { &run.commit }, run.seed);
    if let Some(clock) = &run.clock {
        println!("started {} on {}", clock.date(), clock.host);
    }
}

/// Prints the records of a topic as a table; see [`Echo`].
///
/// # Errors
/// The file is no log, there is no such topic or field, or no record of it.
pub fn export(path: &Path, topic: &str, how: &Echo) -> Result<(), Box<dyn Error>> {
    let log = Log::open(path)?;
    let known: Vec<&str> = TOPICS.iter().map(|t| t.name).collect();
    let hint = "`gangwerk log info` shows what is in the log";
    with_type(topic, Export { log: &log, how })
        .unwrap_or_else(|| Err(messages::unknown("topic", topic, &known, hint).into()))
}

struct Export<'a> {
    log: &'a Log,
    how: &'a Echo,
}

impl ForType<Result<(), Box<dyn Error>>> for Export<'_> {
    fn call<T: Record>(self, topic: &'static Topic) -> Result<(), Box<dyn Error>> {
        let joints = &self.log.robot().joints;
        let mut table = EchoTable::new(self.how, &numbers(&T::empty(), joints))?;
        let (mut failed, mut count) = (Ok(()), 0u64);
        self.log.each_record(topic, |record: &T| {
            count += 1;
            if failed.is_ok() {
                failed = table.print(&numbers(record, joints));
            }
        })?;
        failed?;
        if count == 0 {
            return Err(format!("the log holds no record of {}", topic.name).into());
        }
        Ok(())
    }
}

/// Holds every topic of two logs against the other's, bit for bit, and prints where they differ first; whether they are equal.
///
/// Cycle statistics are left out: no two runs have the same.
///
/// # Errors
/// One of the files is no log, or no topic has a record in both of them.
pub fn compare(a: &Path, b: &Path) -> Result<bool, Box<dyn Error>> {
    let (a, b) = (Log::open(a)?, Log::open(b)?);
    let (ours, theirs) = (a.run().config_hash, b.run().config_hash);
    if ours != theirs {
        println!("configurations differ: {ours:016x} and {theirs:016x}");
    }
    let (mut same, mut different) = (0, 0);
    for topic in TOPICS.iter().filter(|t| t.logged && !t.name.starts_with("cycle_stats/")) {
        match with_type(topic.name, Compare { a: &a, b: &b }).unwrap_or(Ok(Compared::Empty))? {
            Compared::Empty => {}
            Compared::Equal => same += 1,
            Compared::Different(how) => {
                println!("{}: {how}", topic.name);
                different += 1;
            }
        }
    }
    if same + different == 0 {
        return Err("neither log holds a record: there is nothing to compare".into());
    }
    println!("{same} topics are equal, bit for bit");
    Ok(different == 0)
}

/// A topic of two logs.
enum Compared {
    /// Neither has a record of it.
    Empty,
    Equal,
    Different(String),
}

struct Compare<'a> {
    a: &'a Log,
    b: &'a Log,
}

impl ForType<Result<Compared, Box<dyn Error>>> for Compare<'_> {
    /// The records of a topic, up to the first difference.
    fn call<T: Record>(self, topic: &'static Topic) -> Result<Compared, Box<dyn Error>> {
        let (a, b) = (self.a.records::<T>(topic)?, self.b.records::<T>(topic)?);
        let differs =
            a.iter().zip(&b).enumerate().find_map(|(i, (a, b))| Some((i, a, first_difference(a, b)?)));
        Ok(match differs {
            Some((i, record, (field, ours, theirs))) => Compared::Different(format!(
                "record {i}, tick {}, {field}: {ours} and {theirs}; {} and {} records",
                record.header().tick,
                a.len(),
                b.len()
            )),
            None if a.len() != b.len() => {
                Compared::Different(format!("equal as far as it goes, {} and {} records", a.len(), b.len()))
            }
            None if a.is_empty() => Compared::Empty,
            None => Compared::Equal,
        })
    }
}

/// Tells what a log is of; of a crash record, how the process ended; of a run, every command with sender and answer, and every
/// event, in the order of their ticks.
///
/// # Errors
/// The file is no log.
pub fn show(path: &Path) -> Result<(), Box<dyn Error>> {
    let log = Log::open(path)?;
    head(&log);
    let mut crash = None;
    log.each_attachment(|name, bytes| {
        if name == crate::run::CRASH_TEXT {
            crash = Some(String::from_utf8_lossy(bytes).into_owned());
        }
    })?;
    if let Some(text) = crash {
        println!("{text}");
    }
    let mut lines: Vec<(u64, String)> = Vec::new();
    for topic in TOPICS {
        let process = topic.writer.name();
        match topic.type_name {
            "CommandTaken" => {
                log.each_record(topic, |taken: &CommandTaken| {
                    lines.push((taken.header.tick, line(taken, process)));
                })?;
            }
            "Event" if topic.name.starts_with("events/") => {
                let words = words_of(&log);
                log.each_record(topic, |event: &Event| {
                    let text = words.sentence(event.code, event.detail);
                    lines.push((event.header.tick, format!("{process}: {text}")));
                })?;
            }
            _ => {}
        }
    }
    lines.sort_by_key(|(tick, _)| *tick);
    lines.iter().for_each(|(tick, line)| println!("tick {tick:8}  {line}"));
    Ok(())
}

/// Words of the events of a log.
fn words_of(log: &Log) -> Words {
    Words { joints: log.robot().joints.clone(), ..Words::default() }
}

/// Command with sender and answer.
fn line(taken: &CommandTaken, process: &str) -> String {
    let name = taken.command().map_or_else(
        || "?".into(),
        |command| {
            let fields = command.info().fields.iter().enumerate();
            let values: String = fields.map(|(i, f)| format!(" {}={}", f.name, command.value(i))).collect();
            format!("{}{values}", command.name())
        },
    );
    let sender = match taken.origin {
        0 => "the scene".into(),
        n => format!("connection {n}, its {}th", taken.sequence),
    };
    let answer = match (taken.refused, EventCode::from_number(taken.about)) {
        (0, _) => "accepted".into(),
        (8, _) => "refused: no right to command this".into(),
        (9, _) => "refused: somebody else holds the command lease".into(),
        (10 | 11, _) => "refused: the process that decides is not there, or has not answered".into(),
        (20, _) if taken.about == 0 => "refused: too old".into(),
        (20, _) => format!("refused: {} ms old", taken.about / 1_000_000),
        (23, _) => "refused: its sender has lost the command lease".into(),
        (30, _) => format!("refused: field {} must lie in {:?}", taken.about, taken.limits),
        (33, Some(code)) => format!("refused: {}", Words::default().sentence(code as u64, taken.detail)),
        (code, _) => format!("refused: reason {code}"),
    };
    format!("{process}: {name}, from {sender}: {answer}")
}
