//! Help of every subcommand.

use clap::Command;

use super::begin;

/// The page.
pub(super) fn page(mut command: Command) -> String {
    command.build();
    let mut text = begin(
        "Command line",
        "Help of every command, as `--help` prints it. `gangwerk man DIR` writes man pages, `gangwerk completions SHELL` completions.",
    );
    one(&mut command, &mut text);
    text
}

fn one(command: &mut Command, text: &mut String) {
    let name = command.get_bin_name().unwrap_or("gangwerk").to_owned();
    let help = match name.as_str() {
        // Answers before the command line is read.
        "gangwerk estop" => cli::estop::HELP.to_owned(),
        _ => command.render_long_help().to_string(),
    };
    // Where a run directory is depends on who asks.
    let here = ipc::default_dir().display().to_string();
    let help = help.replace(&here, "$XDG_RUNTIME_DIR/gangwerk, or /dev/shm/gangwerk-UID");
    let help: Vec<&str> = help.lines().map(str::trim_end).collect();
    *text += &format!("\n## {name}\n\n```text\n{}\n```\n", help.join("\n").trim());
    let inner = command.get_subcommands_mut();
    inner.filter(|c| !c.is_hide_set() && c.get_name() != "help").for_each(|c| one(c, text));
}
