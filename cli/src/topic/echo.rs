//! `gangwerk topic echo`: records as they come, for people or as a table; events as sentences.

use std::error::Error;
use std::path::Path;
use std::time::Duration;

use drives::cia402::DriveFault;
use ipc::Reader;
use messages::topics::{ForType, Topic, with_type};
use messages::{Event, Process, Record, TOPICS, Words};

use super::{EVENTS, ObservedRobot, find};
use messages::fields::{Number, numbers};

/// Between two looks.
const LOOK: Duration = Duration::from_millis(1);

/// Printed part of a topic.
#[derive(Clone, Debug, Default)]
pub struct Echo {
    /// Only these fields, or those inside of them; none: all.
    pub fields: Vec<String>,
    /// A table of comma-separated values, its first line their names.
    pub csv: bool,
    /// So many records; none: for ever.
    pub count: Option<u64>,
}

/// Prints the records of a topic of the robot in `dir` as they come, the newest one first of all; of events in sentences.
///
/// # Errors
/// No such topic or field, or no robot runs in `dir`.
pub fn echo(dir: &Path, name: &str, how: &Echo) -> Result<(), Box<dyn Error>> {
    let sentences = how.fields.is_empty() && !how.csv;
    let reports = |t: &&'static Topic| t.type_name == "Event" && t.name.starts_with("events/");
    let wanted: Vec<&Topic> = match name {
        EVENTS => TOPICS.iter().filter(reports).collect(),
        name => vec![find(name)?],
    };
    if sentences && wanted.iter().all(reports) {
        return tell(&ObservedRobot::open(dir)?, &wanted, how.count);
    }
    let [topic] = wanted[..] else {
        return Err("--field and --csv take the events of one process: events/lowlevel".into());
    };
    with_type(topic.name, Records { robot: &ObservedRobot::open(dir)?, how }).unwrap_or(Ok(()))
}

/// Prints events as sentences: first those that are still kept, then new ones.
fn tell(robot: &ObservedRobot, topics: &[&'static Topic], count: Option<u64>) -> Result<(), Box<dyn Error>> {
    let mut readers = Vec::new();
    for &topic in topics {
        readers.push((topic.writer, robot.space.reader::<Event>(topic)?));
    }
    let (words, cycle) = (words(&robot.setup), robot.setup.scene.cycle);
    let mut left = count;
    loop {
        // What several processes said between two looks, in the order of its time.
        let mut lines: Vec<(u64, String)> = Vec::new();
        for (process, reader) in &mut readers {
            while let Some(event) = reader.follow() {
                lines.push((event.header.tick, sentence(&words, cycle, *process, event)));
            }
        }
        lines.sort_by_key(|(tick, _)| *tick);
        for (_, line) in lines {
            if left == Some(0) {
                return Ok(());
            }
            println!("{line}");
            left = left.map(|n| n - 1);
        }
        if left == Some(0) {
            return Ok(());
        }
        std::thread::park_timeout(LOOK);
    }
}

/// Words of a robot's events.
pub(crate) fn words(setup: &config::Setup) -> Words {
    Words {
        joints: setup.robot.joints.iter().map(|joint| joint.name.clone()).collect(),
        nodes: setup.robot.layout.nodes.clone(),
        fault: Some(|code| DriveFault::from_code(code).map_or("", DriveFault::text)),
    }
}

/// One line of an event: time \[s\], process, sentence.
fn sentence(words: &Words, cycle: f64, process: Process, event: &Event) -> String {
    let time = event.header.tick as f64 * cycle;
    format!("{time:8.3} s  {}: {}", process.name(), words.sentence(event.code, event.detail))
}

struct Records<'a> {
    robot: &'a ObservedRobot,
    how: &'a Echo,
}

impl ForType<Result<(), Box<dyn Error>>> for Records<'_> {
    fn call<T: Record>(self, topic: &'static Topic) -> Result<(), Box<dyn Error>> {
        let joints = self.robot.joints();
        let mut table = EchoTable::new(self.how, &numbers(&T::empty(), &joints))?;
        let mut reader: Reader<T> = self.robot.space.reader(topic)?;
        let mut left = self.how.count;
        let mut print = |record: &T| -> Result<bool, Box<dyn Error>> {
            table.print(&numbers(record, &joints))?;
            left = left.map(|n| n.saturating_sub(1));
            Ok(left == Some(0))
        };
        // The newest that is there, then all that come.
        let mut newest = None;
        while let Some(record) = reader.follow() {
            newest = Some(*record);
        }
        if let Some(record) = newest
            && print(&record)?
        {
            return Ok(());
        }
        let lost = reader.lost();
        loop {
            match reader.follow() {
                Some(record) if print(record)? => break,
                Some(_) => {}
                None => std::thread::park_timeout(LOOK),
            }
        }
        match reader.lost() - lost {
            0 => {}
            n => eprintln!("{n} records were not printed: they came faster than they could be written"),
        }
        Ok(())
    }
}

/// Numbers of records as lines or as a table.
pub(crate) struct EchoTable<'a> {
    how: &'a Echo,
    /// Names of the columns of the table; none before its first line.
    columns: Option<Vec<String>>,
}

impl<'a> EchoTable<'a> {
    /// A table of what is wanted of `all` fields.
    ///
    /// # Errors
    /// There is no such field: which are near.
    pub(crate) fn new(how: &'a Echo, all: &[Number]) -> Result<Self, String> {
        for field in &how.fields {
            if !all.iter().any(|number| is_in(&number.name, field)) {
                // Whole fields first, then what is inside of them.
                let whole = |name: &'_ str| name.split(['.', '[']).next().unwrap_or_default().to_owned();
                let mut names: Vec<String> = all.iter().map(|number| whole(&number.name)).collect();
                names.dedup();
                names.extend(all.iter().map(|number| number.name.clone()));
                let names: Vec<&str> = names.iter().map(String::as_str).collect();
                return Err(messages::unknown(
                    "field",
                    field,
                    &names,
                    "`gangwerk topic info` shows them all",
                ));
            }
        }
        Ok(Self { how, columns: None })
    }

    /// Selected numbers of a record, in its order.
    fn wanted<'n>(&self, all: &'n [Number]) -> Vec<&'n Number> {
        let fields = &self.how.fields;
        let wanted = |n: &&Number| fields.is_empty() || fields.iter().any(|field| is_in(&n.name, field));
        all.iter().filter(wanted).collect()
    }

    /// Prints a record.
    ///
    /// # Errors
    /// It has other columns than the first one.
    pub(crate) fn print(&mut self, all: &[Number]) -> Result<(), String> {
        let wanted = self.wanted(all);
        if !self.how.csv {
            let mut page = page(&wanted);
            // Whole records are told apart by a line; fields alone are lines enough.
            page += if self.how.fields.is_empty() { "---" } else { "" };
            println!("{}", page.trim_end());
            return Ok(());
        }
        let row = |cell: fn(&Number) -> String| wanted.iter().map(|n| cell(n)).collect::<Vec<_>>();
        let names = row(|n| n.name.clone());
        match &self.columns {
            None => println!("{}", names.join(",")),
            Some(columns) if *columns != names => {
                return Err("its records are of different lengths and make no table: without --csv".into());
            }
            Some(_) => {}
        }
        self.columns = Some(names);
        println!("{}", row(|n| n.value.exact()).join(","));
        Ok(())
    }
}

/// Whether a number is a field, or lies inside of it.
fn is_in(name: &str, field: &str) -> bool {
    name.strip_prefix(field).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

/// One line per number, and per array without names: `joint_angle.right_knee_flexion 0.93 rad`.
fn page(numbers: &[&Number]) -> String {
    let mut text = String::new();
    let mut rest = numbers;
    while let Some(first) = rest.first() {
        let array = |n: &Number| {
            n.name.rsplit_once('[').filter(|_| n.name.ends_with(']')).map(|(name, _)| name.to_owned())
        };
        let same = rest.iter().take_while(|n| array(n).is_some() && array(n) == array(first)).count();
        let (line, others) = rest.split_at(same.max(1));
        text += &array(first).unwrap_or_else(|| first.name.clone());
        line.iter().for_each(|n| text += &format!(" {}", n.value.short()));
        // Of "m, rad" each has its own.
        let mut units: Vec<&str> = line.iter().map(|n| n.unit).collect();
        units.dedup();
        text += &format!(" {}", units.join(", "));
        text.truncate(text.trim_end().len());
        text.push('\n');
        rest = others;
    }
    text
}
