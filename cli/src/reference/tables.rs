//! Commands, parameters, events, exit codes.

use std::error::Error;
use std::path::Path;

use config::Setup;
use config::registry::{Change, ParameterEntry, entries};
use messages::EventCode;
use messages::command_text::COMMANDS;

use super::{begin, cell, code, head, number, range, row};

/// Scenes whose configurations have all parameters between them: a balanced gait, and a pattern.
const SCENES: [&str; 2] = ["demo", "archie_static"];

/// Commands with their fields.
pub(super) fn commands() -> String {
    let mut text = begin(
        "Commands",
        "What can be asked of a running robot: `gangwerk topic pub NAME field=number ...`, the page in the browser, a program that \
         speaks [the broker's protocol](../protocol.md), or a `[[command]]` of a scene. Ranges are those of any robot; the gait of a \
         robot narrows them ([keys of a gait](gait_keys.md)). A command that needs the lease takes it, or is refused while \
         somebody else holds it.",
    );
    text += &head(&["command", "task", "answered by", "lease"]);
    for info in COMMANDS {
        let example = info.example();
        let lease = match (example.always_passes(), example.needs_lease()) {
            (true, _) => "always passes",
            (false, true) => "needs it",
            (false, false) => "none",
        };
        text += &row(&[&code(info.name), &cell(info.about), example.decided_by(), lease]);
    }
    // Their fields, a table for each command that has any.
    for info in COMMANDS.iter().filter(|info| !info.fields.is_empty()) {
        text += &format!(
            "\n## {}\n\n{}.\n{}",
            info.name,
            info.about,
            head(&["field", "unit", "range", "default", "meaning"])
        );
        for f in info.fields {
            let default = f.default.map_or("must be given".into(), number);
            text += &row(&[&code(f.name), f.unit, &range(f.range), &default, &cell(f.about)]);
        }
    }
    text
}

/// Parameters of every process.
///
/// # Errors
/// A scene of the configuration cannot be read.
pub(super) fn parameters(root: &Path) -> Result<String, Box<dyn Error>> {
    let mut text = begin(
        "Parameters",
        "`gangwerk param list`, `get`, `describe`, `set`, `dump`, `load`, and the page's tab *Tune* show and set them at a robot that \
         runs. *Live* ones hold from the next cycle (stabilizer) or the next step that is planned (planner); the others stand in the \
         file that is named. Defaults are those of the scenes `demo` (Lola) and, for `pattern.…`, `archie_static`.",
    );
    // Each once, with the default of the first scene that has it.
    let mut all: Vec<ParameterEntry> = Vec::new();
    for scene in SCENES {
        let new = entries(&Setup::load(root, scene)?);
        let unknown = |entry: &ParameterEntry| all.iter().all(|known| known.full_name() != entry.full_name());
        let new: Vec<_> = new.into_iter().filter(unknown).collect();
        all.extend(new);
    }
    all.sort_by_key(|entry| entry.process);
    let mut process = "";
    for entry in &all {
        if entry.process != process {
            process = entry.process;
            let columns = ["parameter", "unit", "range", "default", "change", "meaning"];
            text += &format!("\n## {process}\n{}", head(&columns));
        }
        let change = match entry.change {
            Change::Live(_) => "live".into(),
            Change::File(file) => code(&format!("config/{file}")),
            Change::Constant => "never".into(),
        };
        let [range, default] = [range(entry.range), number(entry.default)];
        text += &row(&[&code(&entry.full_name()), entry.unit, &range, &default, &change, &cell(entry.about)]);
    }
    Ok(text)
}

/// Events with their sentences.
pub(super) fn events() -> String {
    let mut text = begin(
        "Events",
        "What a process reports on `events/PROCESS`: `gangwerk topic echo events` while it runs, `gangwerk log show LOG` afterwards, the \
         page's tab *Events*, `/rosout` of a log. Words in braces are filled in. Numbers never change their meaning.",
    );
    text += &head(&["number", "event", "sentence", "what to do"]);
    for event in EventCode::ALL {
        let [what, detail, advice] = event.words();
        let sentence = if detail.is_empty() { what.to_owned() } else { format!("{what}: {detail}") };
        let (number, name) = ((event as u64).to_string(), format!("{event:?}"));
        text += &row(&[&number, &code(&name), &cell(&sentence), &cell(advice)]);
    }
    text
}

/// Exit codes, as the help of the commands says them.
pub(super) fn exit_codes() -> String {
    let mut text = begin(
        "Exit codes",
        "Of `gangwerk run` and `gangwerk sim`. The figures that they print say it in words, too: \
         [run a scene](../howto/scenes.md#how-a-run-ended). Other commands end with 0 if they did what they were asked, with 1 and a \
         line that begins with `error:` if not, and with 2 if the command line is wrong.",
    );
    text += &table_of(cli::exit::HELP);
    text += "\n## gangwerk estop\n";
    text += &table_of(cli::estop::HELP);
    text
}

/// Lines `CODE  words` of a help.
fn table_of(help: &str) -> String {
    let mut text = head(&["code", "meaning"]);
    for line in help.lines() {
        let line = line.trim();
        let Some((code, words)) = line.split_once("  ") else { continue };
        if code.parse::<u8>().is_ok() {
            text += &row(&[code, &cell(words.trim())]);
        }
    }
    text
}
