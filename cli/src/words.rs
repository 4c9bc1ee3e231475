//! Shell completions and man pages.

use std::error::Error;
use std::io::Write;
use std::path::Path;

use clap::Command;
use clap_complete::Shell;

/// Prints the completions of a shell.
///
/// # Errors
/// They cannot be printed.
pub(crate) fn completions(shell: Shell, mut command: Command) -> Result<(), Box<dyn Error>> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut command, "gangwerk", &mut text);
    std::io::stdout().write_all(&text)?;
    Ok(())
}

/// Writes a man page for the command and each of its subcommands.
///
/// # Errors
/// The directory cannot be written.
pub(crate) fn man_pages(dir: &Path, command: Command) -> Result<(), Box<dyn Error>> {
    let told = |e: std::io::Error| format!("{}: {e}; choose another directory", dir.display());
    std::fs::create_dir_all(dir).map_err(told)?;
    clap_mangen::generate_to(command, dir).map_err(told)?;
    println!("man pages are in {0}: man {0}/gangwerk.1", dir.display());
    Ok(())
}

#[cfg(test)]
mod tests {
    use clap::{Command, CommandFactory};

    /// Documentation comments escape brackets for rustdoc; on a terminal `\\[s\\]` is noise.
    #[test]
    fn no_help_shows_an_escape() {
        fn look(command: &mut Command, path: &str) {
            let (name, text) =
                (format!("{path} {}", command.get_name()), command.render_long_help().to_string());
            assert!(!text.contains('\\'), "{name}: {text}");
            command.get_subcommands_mut().for_each(|inner| look(inner, &name));
        }
        look(&mut crate::Arguments::command(), "");
    }
}
