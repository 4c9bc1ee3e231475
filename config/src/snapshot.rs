//! A copy of a configuration: read once, so that all processes of a run walk with the same one, whatever is saved meanwhile.

use std::fs;
use std::path::Path;

use crate::System;
use crate::error::ConfigError;
use crate::file::{BUILT_IN, embedded};

/// Files that belong to a configuration; sources and notes beside them do not.
const PARTS: [&str; 7] = ["system.toml", "joystick.toml", "robots", "gaits", "scenes", "gears", "objects"];
/// Deepest folder, and most bytes: beyond them it is no configuration (a link in a circle, somebody's home).
const DEEPEST: u32 = 8;
const MOST: u64 = 256 << 20;

/// Copies the configuration directory `root`, or the set inside the executable, to `to`, which must not exist. Links are
/// copied as what they lead to.
///
/// # Errors
/// A file cannot be read or written, or there is more than any configuration has.
pub fn snapshot(root: &Path, to: &Path) -> Result<(), ConfigError> {
    let mut left = MOST;
    if let Some(parent) = to.parent() {
        fs::create_dir_all(parent).map_err(|e| failed(parent, &e))?;
    }
    fs::create_dir(to).map_err(|e| failed(to, &e))?;
    if root == Path::new(BUILT_IN) {
        return embedded().iter().try_for_each(|(name, bytes)| put(&to.join(name), bytes));
    }
    for part in PARTS {
        let (from, to) = (root.join(part), to.join(part));
        if from.exists() {
            copy(&from, &to, DEEPEST, &mut left)?;
        }
    }
    // Keys of clients on the network, if the system names any; what is wrong with the file is told by who reads it.
    if let Ok(system) = System::load(&root.join("system.toml"))
        && !system.tcp_keys.is_empty()
        && Path::new(&system.tcp_keys).is_relative()
        && root.join(&system.tcp_keys).exists()
    {
        copy(&root.join(&system.tcp_keys), &to.join(&system.tcp_keys), DEEPEST, &mut left)?;
    }
    Ok(())
}

/// Writes a file of the set inside the executable.
fn put(file: &Path, bytes: &[u8]) -> Result<(), ConfigError> {
    let made = file.parent().map_or(Ok(()), fs::create_dir_all);
    made.and_then(|()| fs::write(file, bytes)).map_err(|e| failed(file, &e))
}

fn copy(from: &Path, to: &Path, depth: u32, left: &mut u64) -> Result<(), ConfigError> {
    let found = fs::metadata(from).map_err(|e| failed(from, &e))?;
    if found.is_file() {
        *left = left.checked_sub(found.len()).ok_or_else(|| beyond(from))?;
        fs::copy(from, to).map_err(|e| failed(to, &e))?;
    } else if found.is_dir() {
        let depth = depth.checked_sub(1).ok_or_else(|| beyond(from))?;
        fs::create_dir(to).map_err(|e| failed(to, &e))?;
        for entry in fs::read_dir(from).map_err(|e| failed(from, &e))? {
            let entry = entry.map_err(|e| failed(from, &e))?;
            copy(&entry.path(), &to.join(entry.file_name()), depth, left)?;
        }
    }
    Ok(())
}

fn beyond(path: &Path) -> ConfigError {
    let text =
        format!("more than {} MiB or {DEEPEST} folders deep: no configuration; check --config", MOST >> 20);
    ConfigError::of_file(path, text)
}

fn failed(path: &Path, e: &std::io::Error) -> ConfigError {
    ConfigError::of_file(path, format!("the configuration cannot be copied here: {e}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Setup;
    use std::os::unix::fs::symlink;

    #[test]
    fn a_copy_is_the_same_configuration_and_stays_so() {
        let place = std::env::temp_dir().join(format!("gangwerk-snapshot-{}", std::process::id()));
        let _ = fs::remove_dir_all(&place);
        fs::create_dir(&place).unwrap();
        let (theirs, ours) = (place.join("theirs"), place.join("ours"));
        snapshot(&crate::root(None), &theirs).unwrap();
        snapshot(&theirs, &ours).unwrap();
        let hash = |root: &Path| Setup::load(root, "demo").unwrap().hash;
        let before = hash(&crate::root(None));
        let gait = theirs.join("gaits/lola.toml");
        fs::write(&gait, fs::read_to_string(&gait).unwrap() + "\n# saved during the start\n").unwrap();
        assert_ne!(hash(&theirs), before);
        assert_eq!(hash(&ours), before);
        // A link in a circle ends.
        symlink(&theirs, theirs.join("gaits/again")).unwrap();
        let text = snapshot(&theirs, &place.join("endless")).unwrap_err().to_string();
        assert!(text.contains("no configuration"), "{text}");
        fs::remove_dir_all(place).unwrap();
    }
}
