//! Where configuration lies, and what it was: lookup of the shipped directory and the hash that goes into every log.

use std::path::{Path, PathBuf};

use crate::error::ConfigError;

/// The configuration directory: the one asked for, else the one of the source tree this program was built from.
pub fn root(asked: Option<&Path>) -> PathBuf {
    asked.map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")), Path::to_owned)
}

/// A file as it was read.
pub(crate) type Read = (PathBuf, Vec<u8>);

/// FNV-1a, 64 bits, over the bytes of all files that went into a configuration, in the order they were read; and the files.
pub(crate) struct Hash(pub(crate) u64, pub(crate) Vec<Read>);

impl Default for Hash {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325, Vec::new())
    }
}

impl Hash {
    fn read(&mut self, path: &Path, bytes: &[u8]) {
        self.add(bytes);
        self.1.push((path.into(), bytes.into()));
    }

    fn add(&mut self, bytes: &[u8]) {
        self.0 = bytes.iter().fold(self.0, |h, b| (h ^ u64::from(*b)).wrapping_mul(0x0000_0100_0000_01b3));
    }
}

/// The text of a file; an error says what lies beside it instead.
pub(crate) fn text(path: &Path, hash: &mut Hash) -> Result<String, ConfigError> {
    let text = std::fs::read_to_string(path).map_err(|e| unreadable(path, &e))?;
    hash.read(path, text.as_bytes());
    Ok(text)
}

/// Adds a file that another part reads to the hash.
pub(crate) fn include(path: &Path, hash: &mut Hash) -> Result<(), ConfigError> {
    hash.read(path, &std::fs::read(path).map_err(|e| unreadable(path, &e))?);
    Ok(())
}

fn unreadable(path: &Path, e: &std::io::Error) -> ConfigError {
    let hint = if e.kind() == std::io::ErrorKind::NotFound { neighbours(path) } else { String::new() };
    ConfigError::of_file(path, format!("cannot be read: {e}{hint}"))
}

fn neighbours(path: &Path) -> String {
    let wanted = path.extension();
    let Some(directory) = path.parent() else { return String::new() };
    let directory = if directory.as_os_str().is_empty() { Path::new(".") } else { directory };
    let Ok(entries) = std::fs::read_dir(directory) else {
        return format!("; {} is no directory either, so check --config", directory.display());
    };
    let mut names: Vec<String> = entries
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| path.extension() == wanted)
        .filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()))
        .collect();
    names.sort();
    if names.is_empty() { String::new() } else { format!("; there is {}", names.join(", ")) }
}

#[cfg(test)]
mod tests {
    use super::Hash;

    /// Published test vectors of FNV-1a, 64 bits.
    #[test]
    fn hash_of_known_strings() {
        let hash = |text: &str| {
            let mut hash = Hash::default();
            hash.add(text.as_bytes());
            hash.0
        };
        assert_eq!(hash(""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(hash("a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(hash("foobar"), 0x8594_4171_f739_67e8);
    }
}
