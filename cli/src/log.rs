//! `gangwerk log`: what stands in a log besides the walk, and a log whose writer died made whole.

use std::error::Error;
use std::path::Path;

use messages::topics::TOPICS;
use messages::{CommandTaken, EventCode};
use recording::{Log, Repaired, repair};

/// Gives a log its end and index, if it lacks them.
///
/// # Errors
/// The file is no log, or there is no room beside it.
pub fn mend(path: &Path) -> Result<String, Box<dyn Error>> {
    let Repaired { messages, found } = repair(path)?;
    Ok(match found {
        Some(why) => format!("{}: {why}; repaired, with {messages} messages", path.display()),
        None => format!("{}: complete, with {messages} messages; left as it is", path.display()),
    })
}

/// Tells what a log is of; of a crash record, how the process ended; of a run, every command with sender and answer.
///
/// # Errors
/// The file is no log.
pub fn show(path: &Path) -> Result<(), Box<dyn Error>> {
    let log = Log::open(path)?;
    let run = log.run();
    println!(
        "scene {}, robot {}, configuration {:016x}, {}",
        run.scene,
        log.robot().name,
        run.config_hash,
        run.software
    );
    println!("commit {}, seed {}", if run.commit.is_empty() { "unknown" } else { &run.commit }, run.seed);
    if let Some(clock) = &run.clock {
        println!("started {} on {}", clock.date(), clock.host);
    }
    let mut crash = None;
    log.each_attachment(|name, bytes| {
        if name == crate::run::CRASH_TEXT {
            crash = Some(String::from_utf8_lossy(bytes).into_owned());
        }
    })?;
    if let Some(text) = crash {
        println!("{text}");
    }
    for topic in TOPICS.iter().filter(|t| t.type_name == "CommandTaken") {
        log.each_record(topic, |taken: &CommandTaken| {
            println!("tick {:8}  {}", taken.header.tick, line(taken, topic.writer.name()));
        })?;
    }
    Ok(())
}

/// Who wanted what, and the answer.
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
        (33, Some(code)) => format!("refused: {code:?} ({})", taken.detail),
        (code, _) => format!("refused: reason {code}"),
    };
    format!("{process}: {name}, from {sender}: {answer}")
}
