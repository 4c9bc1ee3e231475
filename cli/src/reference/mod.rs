//! Pages of the book's reference, made from what the program works with: topics, commands, parameters, events, keys of files, exit
//! codes, help. `gangwerk reference docs/reference` writes them; a test compares them with what is committed.

mod help;
mod keys;
mod records;
mod tables;

use std::error::Error;
use std::path::Path;

use clap::Command;

/// A page: name of its file, and its text.
pub(crate) type Page = (&'static str, String);

/// Every page, for the command line `command`.
///
/// # Errors
/// The shipped configuration or its readers' sources are not there: it is made in a clone of the repository.
pub(crate) fn pages(command: Command) -> Result<Vec<Page>, Box<dyn Error>> {
    let root = config::root(None);
    let source = root.join("src");
    let keys = config::keys::all(&root, &source)?;
    let mut all = vec![
        ("topics.md", records::topics()),
        ("commands.md", tables::commands()),
        ("parameters.md", tables::parameters(&root)?),
        ("events.md", tables::events()),
    ];
    all.extend(keys::pages(&keys));
    all.push(("exit_codes.md", tables::exit_codes()));
    all.push(("command_line.md", help::page(command)));
    Ok(all)
}

/// Writes every page into `dir`.
///
/// # Errors
/// As of [`pages`]; or the directory cannot be written.
pub(crate) fn write(dir: &Path, command: Command) -> Result<(), Box<dyn Error>> {
    let told = |e: std::io::Error| format!("{}: {e}; choose another directory", dir.display());
    std::fs::create_dir_all(dir).map_err(told)?;
    for (name, text) in pages(command)? {
        std::fs::write(dir.join(name), text).map_err(told)?;
        println!("{}", dir.join(name).display());
    }
    Ok(())
}

/// Begin of a page.
fn begin(title: &str, about: &str) -> String {
    format!(
        "<!-- Made by `gangwerk reference docs/reference`; a test compares it. -->\n# {title}\n\n{about}\n"
    )
}

/// Head of a table.
fn head(columns: &[&str]) -> String {
    format!("\n| {} |\n|{}\n", columns.join(" | "), "---|".repeat(columns.len()))
}

/// Row of a table.
fn row(cells: &[&str]) -> String {
    format!("| {} |\n", cells.join(" | "))
}

/// Text as a cell of a table: nothing in it is markup.
fn cell(text: &str) -> String {
    let mut cell = String::new();
    for (i, part) in text.split('`').enumerate() {
        cell += if i > 0 { "`" } else { "" };
        // Between backticks only the bar means something.
        let special: &[char] = if i % 2 == 0 { &['|', '<', '*', '[', ']'] } else { &['|'] };
        for c in part.chars() {
            if special.contains(&c) {
                cell.push('\\');
            }
            cell.push(c);
        }
    }
    cell
}

/// Name as code.
fn code(text: &str) -> String {
    format!("`{}`", text.replace('|', "\\|"))
}

/// Number as people write it.
fn number(x: f64) -> String {
    if x == 0.0 || (1e-4..1e7).contains(&x.abs()) { format!("{x}") } else { format!("{x:e}") }
}

/// Range in words, `-` for none.
fn range([low, high]: [f64; 2]) -> String {
    match (low.abs() < 1e9, high.abs() < 1e9) {
        (true, true) => format!("{} to {}", number(low), number(high)),
        (true, false) => format!("from {}", number(low)),
        (false, true) => format!("to {}", number(high)),
        (false, false) => "any".into(),
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    /// The committed pages are what the code says.
    #[test]
    fn the_reference_is_what_the_code_says() {
        let folder = harness::root().join("docs/reference");
        let pages = super::pages(crate::Arguments::command()).unwrap();
        for (name, text) in &pages {
            let committed = std::fs::read_to_string(folder.join(name)).unwrap_or_default();
            let differs = text.lines().zip(committed.lines()).find(|(new, old)| new != old);
            assert!(
                *text == committed,
                "docs/reference/{name} is not what the code says: run `gangwerk reference docs/reference`; {differs:?}"
            );
        }
        let files = std::fs::read_dir(folder).unwrap().count();
        assert_eq!(files, pages.len(), "docs/reference holds a page that nobody makes");
    }
}
