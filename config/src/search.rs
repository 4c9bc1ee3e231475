//! Search for the configuration directory: which one a command takes, and why.
//!
//! | order | place | taken if |
//! |---|---|---|
//! | 1 | `--config DIR` | given |
//! | 2 | `$GANGWERK_CONFIG` | set |
//! | 3 | `./config` | it holds `system.toml` |
//! | 4 | `$XDG_CONFIG_HOME/gangwerk`, or `~/.config/gangwerk` | the same |
//! | 5 | the set inside the executable | always |

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use crate::error::ConfigError;
use crate::file::{self, BUILT_IN};

/// File by which a directory is known as a configuration.
const MARK: &str = "system.toml";
/// Variable of the environment that names the directory.
const VARIABLE: &str = "GANGWERK_CONFIG";

/// A configuration directory, and why it is this one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConfigDirectory {
    /// The directory, or [`BUILT_IN`].
    pub dir: PathBuf,
    /// Reason for taking it.
    pub why: String,
}

/// Configuration directory of a command, in the order of this module's table; `asked` is its `--config`.
///
/// # Errors
/// The directory named by `--config` or the environment is no configuration; nothing else is taken instead.
pub fn find(asked: Option<&Path>) -> Result<ConfigDirectory, ConfigError> {
    search(asked, |name| std::env::var_os(name).filter(|value| !value.is_empty()), Path::new(""))
}

/// The same with the environment `variable` in the working directory `here`.
fn search(
    asked: Option<&Path>,
    variable: impl Fn(&str) -> Option<OsString>,
    here: &Path,
) -> Result<ConfigDirectory, ConfigError> {
    let found = |dir: &Path, why: &str| ConfigDirectory { dir: dir.into(), why: why.into() };
    // What somebody has named is taken, or refused.
    if let Some(dir) = asked {
        return named(dir, "--config").map(|()| found(dir, "named by --config"));
    }
    if let Some(dir) = variable(VARIABLE).map(PathBuf::from) {
        let why = format!("named by ${VARIABLE}");
        return named(&dir, &format!("${VARIABLE}")).map(|()| found(&dir, &why));
    }
    // What may be there is taken if it is a configuration.
    let is_one = |dir: &PathBuf| file::exists(&dir.join(MARK));
    let local = Some(here.join("config")).filter(is_one);
    if let Some(dir) = local {
        return Ok(found(&dir, "lies in the working directory"));
    }
    let home = || variable("HOME").map(|home| PathBuf::from(home).join(".config"));
    let own = variable("XDG_CONFIG_HOME").map(PathBuf::from).filter(|dir| dir.is_absolute()).or_else(home);
    if let Some(dir) = own.map(|dir| dir.join("gangwerk")).filter(is_one) {
        return Ok(found(&dir, "this user's own"));
    }
    Ok(found(Path::new(BUILT_IN), "neither ./config nor this user's own directory holds a system.toml"))
}

/// A directory that somebody named is a configuration.
fn named(dir: &Path, by: &str) -> Result<(), ConfigError> {
    if file::exists(&dir.join(MARK)) {
        return Ok(());
    }
    let text = format!(
        "is no configuration: it has no {MARK}; check {by}, or make one with `gangwerk config copy {}`",
        dir.display()
    );
    Err(ConfigError::of_file(dir, text))
}

/// Configuration of the source tree, for its tests and tools, which run in the folder of their crate: `asked`, else `config`
/// in the working directory or the nearest one above it, else [`BUILT_IN`]. Commands take [`find`].
pub fn root(asked: Option<&Path>) -> PathBuf {
    let here = std::env::current_dir().unwrap_or_default();
    let above = || here.ancestors().map(|dir| dir.join("config")).find(|dir| file::exists(&dir.join(MARK)));
    asked.map(Path::to_owned).or_else(above).unwrap_or_else(|| BUILT_IN.into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    /// Each place is taken before all that stand below it, and what is named but wrong is refused.
    #[test]
    fn the_order_is_that_of_the_table() {
        let place = std::env::temp_dir().join(format!("gangwerk-search-{}", std::process::id()));
        let _ = fs::remove_dir_all(&place);
        let make = |name: &str| {
            fs::create_dir_all(place.join(name)).unwrap();
            fs::write(place.join(name).join(MARK), "").unwrap();
            place.join(name)
        };
        let (asked, named) = (make("asked"), make("named"));
        let variables = |set: &'static [(&str, &str)], place: PathBuf| {
            move |name: &str| {
                let value = set.iter().find(|(known, _)| *known == name).map(|(_, value)| value)?;
                Some(place.join(value).into_os_string())
            }
        };
        let all =
            variables(&[(VARIABLE, "named"), ("XDG_CONFIG_HOME", "xdg"), ("HOME", "home")], place.clone());
        let two = variables(&[("XDG_CONFIG_HOME", "xdg"), ("HOME", "home")], place.clone());
        let one = variables(&[("HOME", "home")], place.clone());
        // Nothing is there yet but what is named.
        assert_eq!(search(Some(&asked), &all, &place).unwrap().dir, asked);
        assert_eq!(search(None, &all, &place).unwrap().dir, named);
        assert_eq!(search(None, &two, &place).unwrap().dir, Path::new(BUILT_IN));
        // From the bottom of the table to its top.
        let home = make("home/.config/gangwerk");
        assert_eq!(search(None, &one, &place).unwrap().dir, home);
        assert_eq!(search(None, &two, &place).unwrap().dir, Path::new(BUILT_IN), "XDG stands for ~/.config");
        let xdg = make("xdg/gangwerk");
        assert_eq!(search(None, &two, &place).unwrap().dir, xdg);
        let local = make("config");
        assert_eq!(search(None, &two, &place).unwrap().dir, local);
        // What is named and no configuration is refused, whatever else there is.
        fs::remove_file(named.join(MARK)).unwrap();
        let text = search(None, &all, &place).unwrap_err().to_string();
        assert!(
            text.contains("named: is no configuration") && text.contains("check $GANGWERK_CONFIG"),
            "{text}"
        );
        let text = search(Some(Path::new("nowhere")), &all, &place).unwrap_err().to_string();
        assert!(
            text.starts_with("nowhere: is no configuration: it has no system.toml; check --config"),
            "{text}"
        );
        fs::remove_dir_all(place).unwrap();
    }
}
