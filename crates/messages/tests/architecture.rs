//! ARCHITECTURE.md shows the data plane as the table of topics has it. When this fails, it prints what belongs there.

use messages::{Process, TOPICS, Topic};
use std::fmt::Write;

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../ARCHITECTURE.md");
const MARKS: [&str; 2] = ["<!-- topics -->\n", "<!-- /topics -->"];

/// Columns of the drawing: the chain in the order in which data flow, then who stands beside it.
const COLUMNS: [Process; 6] = [
    Process::Planner,
    Process::Controller,
    Process::Lowlevel,
    Process::SimBackend,
    Process::Watchdog,
    Process::Logger,
];
const WIDTH: usize = 13;
/// Position of the first column's line.
const FIRST: usize = 22;

/// Topics between processes of the chain as arrows between their lines.
fn drawing() -> String {
    let mut heads = vec![' '; FIRST + WIDTH * COLUMNS.len()];
    for (i, process) in COLUMNS.iter().enumerate() {
        let begin = FIRST + WIDTH * i - process.name().len() / 2;
        heads.splice(begin..begin + process.name().len(), process.name().chars());
    }
    let mut text = line(&heads);
    for topic in TOPICS.iter().filter(|t| !t.readers.is_empty()) {
        text += &line(&arrow(topic));
    }
    text
}

fn arrow(topic: &Topic) -> Vec<char> {
    let column =
        |p: Process| FIRST + WIDTH * COLUMNS.iter().position(|c| *c == p).expect("a process of the drawing");
    let mut row = vec![' '; column(Process::Logger) + 1];
    row.splice(..topic.name.len(), topic.name.chars());
    COLUMNS.iter().for_each(|p| row[column(*p)] = '│');
    let from = column(topic.writer);
    for to in topic.readers.iter().map(|p| column(*p)) {
        for place in &mut row[from.min(to) + 1..from.max(to)] {
            *place = if *place == '│' {
                '┼'
            } else if *place == ' ' {
                '─'
            } else {
                *place
            };
        }
    }
    for reader in topic.readers {
        let (to, wakes) = (column(*reader), topic.wakes.contains(reader));
        row[to] = match (to > from, wakes) {
            (true, true) => '▶',
            (true, false) => '▷',
            (false, true) => '◀',
            (false, false) => '◁',
        };
    }
    row[from] = '●';
    row
}

fn line(row: &[char]) -> String {
    format!("{}\n", row.iter().collect::<String>().trim_end())
}

/// One row per topic; those that every process has for itself share one.
fn table() -> String {
    let mut text = String::from(
        "| topic | record | from | read by | wakes | rate | stale after | in the log |\n|---|---|---|---|---|---|---|---|\n",
    );
    let group = |t: &Topic| t.name.split_once('/').map(|(prefix, _)| prefix);
    let mut done = None;
    for t in TOPICS.iter().filter(|t| {
        group(t).is_none()
            || done != group(t) && {
                done = group(t);
                true
            }
    }) {
        let names = |list: &[Process]| list.iter().map(|p| p.name()).collect::<Vec<_>>().join(", ");
        let name = group(t).map_or_else(|| t.name.to_string(), |prefix| format!("{prefix}/PROCESS"));
        let writers: Vec<_> = TOPICS
            .iter()
            .filter(|o| o.name == t.name || group(t).is_some() && group(o) == group(t))
            .collect();
        let from = names(&writers.iter().map(|o| o.writer).collect::<Vec<_>>());
        let rate = if t.rate_hz == 0 { "when new".into() } else { format!("{} Hz", t.rate_hz) };
        let stale = if t.stale_after == 0 { "-".into() } else { format!("{} cycles", t.stale_after) };
        let logged = if t.logged { "yes" } else { "no" };
        let (readers, wakes) = (names(t.readers), names(t.wakes));
        writeln!(
            text,
            "| `{name}` | `{}` | {from} | {readers} | {wakes} | {rate} | {stale} | {logged} |",
            t.type_name
        )
        .expect("a string");
    }
    text
}

#[test]
fn drawing_and_table_are_those_of_the_topics() {
    let page = std::fs::read_to_string(PAGE).expect("ARCHITECTURE.md");
    let found =
        page.split_once(MARKS[0]).and_then(|(_, rest)| rest.split_once(MARKS[1])).map(|(text, _)| text);
    let expected = format!("```text\n{}```\n\n{}", drawing(), table());
    assert!(
        found == Some(&expected),
        "ARCHITECTURE.md is not what crates/messages/src/topics.rs says. Between its marks {MARKS:?} belongs:\n{expected}"
    );
}
