//! Topics and the fields of their records.

use messages::record::{Record, Visit};
use messages::topics::{ForType, TOPICS, Topic, with_type};
use messages::{MAX_JOINTS, Process};

use super::{begin, cell, code, head, row};

/// The page.
pub(super) fn topics() -> String {
    let mut text = begin(
        "Topics",
        "What a running robot publishes, one record of fixed size per bus cycle or when there is something new. `gangwerk topic list`, \
         `info`, `echo`, `hz` show the same of a robot that runs. Logger and observers may read every topic; *read by* names the \
         processes that need it. Rates are those of a cycle of 1 ms.",
    );
    text +=
        &head(&["topic", "record", "content", "written by", "read by", "rate", "stale after", "in the log"]);
    for t in TOPICS {
        let names = t.readers.iter().map(|p: &Process| p.name()).collect::<Vec<_>>().join(", ");
        let rate = if t.rate_hz == 0 { "when new".into() } else { format!("{} Hz", t.rate_hz) };
        let stale = if t.stale_after == 0 { "never".into() } else { format!("{} cycles", t.stale_after) };
        let record = format!("[{0}](#{1})", t.type_name, t.type_name.to_lowercase());
        let logged = if t.logged { "yes" } else { "no" };
        let about = cell(t.about.trim());
        text += &row(&[&code(t.name), &record, &about, t.writer.name(), &names, &rate, &stale, logged]);
    }
    // Each record once: several topics have the same.
    let mut done: Vec<&str> = Vec::new();
    for t in TOPICS {
        if !done.contains(&t.type_name) {
            done.push(t.type_name);
            let fields = with_type(t.name, Fields).unwrap_or_default();
            text += &format!("\n## {}\n{}{fields}", t.type_name, head(&["field", "type", "unit", "meaning"]));
        }
    }
    text
}

struct Fields;

impl ForType<String> for Fields {
    fn call<T: Record>(self, _: &'static Topic) -> String {
        let mut lister = Lister { open: Vec::new(), about: "", rows: Vec::new() };
        T::empty().visit(&mut lister);
        lister.rows.concat()
    }
}

/// Rows of a table, one for each number; of an array one for all.
struct Lister {
    /// Name and documentation of each part that has begun; of an array its length in brackets.
    open: Vec<(String, &'static str)>,
    about: &'static str,
    rows: Vec<String>,
}

impl Lister {
    fn number(&mut self, kind: &str) {
        let is_field = |part: &(String, &str)| !part.0.starts_with('[');
        // Parts of a curve have no words of their own: the curve is one row.
        let own = self.open.iter().rposition(is_field).unwrap_or(0);
        let told = self.open.iter().rposition(|(_, about)| !about.trim().is_empty()).unwrap_or(own);
        let is_curve = told < own;
        let depth = if is_curve { told + 1 } else { self.open.len() };
        let mut name = String::new();
        for part in &self.open[..depth] {
            name += if name.is_empty() || !is_field(part) { "" } else { "." };
            name += &part.0;
        }
        // Unit of the innermost part that has one, words of the innermost that has some.
        let split = |about: &&'static str| -> (&'static str, &'static str) {
            let unit = about.trim().strip_prefix("\\[").and_then(|rest| rest.split_once("\\]"));
            unit.map_or(("", about.trim()), |(unit, words)| (unit, words.trim()))
        };
        let about = || self.open.iter().rev().map(|(_, about)| split(about));
        let unit = about().map(|(unit, _)| unit).find(|unit| !unit.is_empty()).unwrap_or_default();
        let words = about().map(|(_, words)| words).find(|words| !words.is_empty()).unwrap_or_default();
        let kind = if is_curve { "curve" } else { kind };
        let row = row(&[&code(&name), kind, &cell(unit), &cell(&plain(words))]);
        // Elements of an array say the same.
        if !self.rows.contains(&row) {
            self.rows.push(row);
        }
    }
}

/// Words of a documentation comment without their links.
fn plain(words: &str) -> String {
    let mut parts = words.split("](");
    let first = parts.next().unwrap_or_default().to_owned();
    let text = parts.fold(first, |text, part| text + part.split_once(')').map_or("", |(_, rest)| rest));
    text.replace("[`", "`").replace("`]", "`").replace('\\', "")
}

impl Visit for Lister {
    fn f64(&mut self, _: f64) {
        self.number("f64");
    }
    fn u64(&mut self, _: u64) {
        self.number("u64");
    }
    fn u32(&mut self, _: u32) {
        self.number("u32");
    }
    fn i32(&mut self, _: i32) {
        self.number("i32");
    }
    fn u8(&mut self, _: u8) {
        self.number("u8");
    }
    fn about(&mut self, text: &'static str) {
        self.about = text;
    }
    fn field(&mut self, name: &'static str) {
        self.open.push((name.into(), std::mem::take(&mut self.about)));
    }
    fn array(&mut self, length: usize) {
        // Of contact points there is room for as many as of joints.
        let of_joints =
            length == MAX_JOINTS && matches!(&self.open[..], [(name, _)] if !name.starts_with("contact"));
        let length = if of_joints { "joint".into() } else { length.to_string() };
        self.open.push((format!("[{length}]"), ""));
    }
    fn end(&mut self) {
        self.open.pop();
    }
}
