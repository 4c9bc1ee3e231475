//! `gangwerk topic list|echo|hz`: looking at the topics of a running robot.

use std::error::Error;
use std::path::Path;
use std::time::Duration;

use ipc::Space;
use messages::command_text::COMMANDS;
use messages::topics::{ForType, Topic, with_type};
use messages::{Process, Record, TOPICS, Visit};
use realtime::clock;

/// Prints both tables: what can be read, and what can be sent.
pub fn list() {
    println!("topics (gangwerk topic echo NAME)");
    for t in TOPICS {
        let rate = if t.rate_hz == 0 { "-".into() } else { format!("{} Hz", t.rate_hz) };
        println!("  {:26} {:16} {:>8}  from {}", t.name, t.type_name, rate, t.writer.name());
    }
    println!("\ncommands (gangwerk topic pub NAME field=number ...)");
    for c in COMMANDS {
        println!("  {:26} {}", c.name, c.about);
        for f in c.fields {
            let default = f.default.map_or("must be given".into(), |d| format!("default {d}"));
            println!(
                "      {:10} [{}, {}] {:6} {default}: {}",
                f.name, f.range[0], f.range[1], f.unit, f.about
            );
        }
    }
}

fn find(name: &str) -> Result<&'static Topic, String> {
    Topic::find(name).ok_or_else(|| {
        let near = TOPICS
            .iter()
            .map(|t| t.name)
            .filter(|n| n.contains(name) || name.contains(n))
            .collect::<Vec<_>>();
        let hint =
            if near.is_empty() { String::new() } else { format!("; did you mean {}?", near.join(" or ")) };
        format!("there is no topic {name}{hint} `gangwerk topic list` shows them all")
    })
}

/// Prints the records of a topic as they come; `count` of them, or for ever.
///
/// # Errors
/// No such topic, or no robot runs in `dir`.
pub fn echo(dir: &Path, name: &str, count: Option<u64>) -> Result<(), Box<dyn Error>> {
    let topic = find(name)?;
    let space = Space::open(dir, Process::Observer)?;
    with_type(topic.name, Echo { space: &space, count }).unwrap_or(Ok(()))
}

struct Echo<'a> {
    space: &'a Space,
    count: Option<u64>,
}

impl ForType<Result<(), Box<dyn Error>>> for Echo<'_> {
    fn call<T: Record>(self, topic: &'static Topic) -> Result<(), Box<dyn Error>> {
        let mut reader = self.space.reader::<T>(topic)?;
        let mut left = self.count;
        while left != Some(0) {
            match reader.newer() {
                Some(record) => {
                    print(record);
                    left = left.map(|n| n - 1);
                }
                None => std::thread::park_timeout(Duration::from_millis(1)),
            }
        }
        Ok(())
    }
}

/// One line per number or array, and a separator.
fn print<T: Record>(record: &T) {
    let mut page = Page { text: String::new(), path: Vec::new(), in_array: 0 };
    record.visit(&mut page);
    println!("{}---", page.text);
}

/// Writes `path: value`, arrays on one line.
struct Page {
    text: String,
    path: Vec<&'static str>,
    /// Depth of arrays of scalars or of arrays begun.
    in_array: usize,
}

impl Page {
    fn value(&mut self, text: &str) {
        if self.in_array == 0 {
            self.text += &format!("{}: {text}\n", self.path.join("."));
        } else {
            self.text += &format!(" {text}");
        }
    }
}

impl Visit for Page {
    fn f64(&mut self, value: f64) {
        self.value(&format!("{value}"));
    }
    fn u64(&mut self, value: u64) {
        self.value(&value.to_string());
    }
    fn u32(&mut self, value: u32) {
        self.value(&value.to_string());
    }
    fn u8(&mut self, value: u8) {
        self.value(&value.to_string());
    }
    fn field(&mut self, name: &'static str) {
        self.path.push(name);
    }
    fn array(&mut self, _len: usize) {
        if self.in_array == 0 {
            self.text += &format!("{}:", self.path.join("."));
        }
        self.in_array += 1;
        self.path.push("");
    }
    fn end(&mut self) {
        if self.path.pop() == Some("") {
            self.in_array -= 1;
            if self.in_array == 0 {
                self.text.push('\n');
            }
        }
    }
}

/// Counts the records of a topic for `seconds` and prints rate and age.
///
/// # Errors
/// No such topic, or no robot runs in `dir`.
pub fn hz(dir: &Path, name: &str, seconds: f64) -> Result<(), Box<dyn Error>> {
    let topic = find(name)?;
    let space = Space::open(dir, Process::Observer)?;
    with_type(topic.name, Hz { space: &space, seconds }).unwrap_or(Ok(()))
}

struct Hz<'a> {
    space: &'a Space,
    seconds: f64,
}

impl ForType<Result<(), Box<dyn Error>>> for Hz<'_> {
    fn call<T: Record>(self, topic: &'static Topic) -> Result<(), Box<dyn Error>> {
        let mut reader = self.space.reader::<T>(topic)?;
        while reader.follow().is_some() {}
        let lost = reader.lost();
        let begun = clock::now();
        let mut count = 0u64;
        while clock::now() - begun < (self.seconds * 1e9) as u64 {
            while reader.follow().is_some() {
                count += 1;
            }
            std::thread::park_timeout(Duration::from_millis(2));
        }
        let seconds = (clock::now() - begun) as f64 * 1e-9;
        let all = count + (reader.lost() - lost);
        println!("{}: {:.1} Hz over {seconds:.1} s ({all} records)", topic.name, all as f64 / seconds);
        Ok(())
    }
}
