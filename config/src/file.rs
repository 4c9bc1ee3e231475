//! Files of a configuration: read from a directory or from the set inside the executable, and hashed for every log.

use std::borrow::Cow;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::edit;
use crate::error::ConfigError;

/// Directory under which the set inside the executable is read, as if it lay on disk.
pub const BUILT_IN: &str = "(built in)";

/// A file of that set: its path below the configuration directory, and its bytes.
pub type Embedded = (PathBuf, &'static [u8]);

static EMBEDDED: OnceLock<Vec<Embedded>> = OnceLock::new();

/// Makes `files` what [`BUILT_IN`] stands for in this program; the first call holds.
pub fn embed(files: Vec<Embedded>) {
    let _ = EMBEDDED.set(files);
}

/// Files of the set inside the executable; none in a program without one, such as a test.
pub(crate) fn embedded() -> &'static [Embedded] {
    EMBEDDED.get().map_or(&[], Vec::as_slice)
}

/// A file as it was read.
pub(crate) type Read = (PathBuf, Vec<u8>);

/// FNV-1a, 64 bits, over the bytes of all files that went into a configuration, in the order they were read; the files; and those
/// that are read instead of what is on the disk.
pub(crate) struct Hash(pub(crate) u64, pub(crate) Vec<Read>, Vec<Read>);

impl Default for Hash {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325, Vec::new(), Vec::new())
    }
}

impl Hash {
    /// That of files which were read in this order.
    pub(crate) fn of<'a>(files: impl Iterator<Item = &'a [u8]>) -> u64 {
        let mut hash = Self::default();
        files.for_each(|bytes| hash.add(bytes));
        hash.0
    }

    /// One that reads these files instead of those on the disk.
    pub(crate) fn of_files(files: Vec<Read>) -> Self {
        Self(Self::default().0, Vec::new(), files)
    }

    /// One of those files has other numbers at these keys.
    pub(crate) fn edit(&mut self, path: &Path, numbers: &[(String, f64)]) -> Result<(), ConfigError> {
        let Some((_, bytes)) = self.2.iter_mut().find(|(known, _)| known == path) else {
            return Err(ConfigError::of_file(path, "was not read"));
        };
        let numbers = numbers.iter().map(|(key, number)| (key.as_str(), *number));
        let edited = edit::with_numbers(&String::from_utf8_lossy(bytes), numbers);
        *bytes = edited.map_err(|e| ConfigError::of_file(path, e))?.into_bytes();
        Ok(())
    }

    pub(crate) fn read(&mut self, path: &Path, bytes: &[u8]) {
        self.add(bytes);
        self.1.push((path.into(), bytes.into()));
    }

    fn add(&mut self, bytes: &[u8]) {
        self.0 = bytes.iter().fold(self.0, |h, b| (h ^ u64::from(*b)).wrapping_mul(0x0000_0100_0000_01b3));
    }
}

/// The text of a file; an error says what lies beside it instead.
pub(crate) fn text(path: &Path, hash: &mut Hash) -> Result<String, ConfigError> {
    let bytes = include(path, hash)?;
    String::from_utf8(bytes).map_err(|_| ConfigError::of_file(path, "cannot be read: is not UTF-8 text"))
}

/// The bytes of a file that another part makes sense of; they are added to the hash.
pub(crate) fn include(path: &Path, hash: &mut Hash) -> Result<Vec<u8>, ConfigError> {
    let bytes = match hash.2.iter().find(|(known, _)| known == path) {
        Some((_, bytes)) => bytes.clone(),
        None => bytes(path).map_err(|e| unreadable(path, &e))?.into_owned(),
    };
    hash.read(path, &bytes);
    Ok(bytes)
}

/// The bytes of a file on disk or of the set inside the executable.
fn bytes(path: &Path) -> io::Result<Cow<'static, [u8]>> {
    let Ok(name) = path.strip_prefix(BUILT_IN) else { return std::fs::read(path).map(Cow::Owned) };
    let found = embedded().iter().find(|(file, _)| file == name);
    found.map(|(_, bytes)| Cow::Borrowed(*bytes)).ok_or_else(|| io::ErrorKind::NotFound.into())
}

/// Whether there is such a file.
pub(crate) fn exists(path: &Path) -> bool {
    match path.strip_prefix(BUILT_IN) {
        Ok(name) => embedded().iter().any(|(file, _)| file == name),
        Err(_) => path.is_file(),
    }
}

/// Names of the files with this ending in a directory, without it, in alphabetical order; none if there is no such directory.
pub(crate) fn names(directory: &Path, ending: &str) -> Option<Vec<String>> {
    let paths: Vec<PathBuf> = match directory.strip_prefix(BUILT_IN) {
        Ok(within) => {
            let all = embedded().iter().map(|(file, _)| file);
            all.filter(|file| file.parent() == Some(within)).cloned().collect()
        }
        Err(_) => std::fs::read_dir(directory).ok()?.flatten().map(|entry| entry.path()).collect(),
    };
    let paths = paths.into_iter().filter(|path| path.extension().unwrap_or_default() == ending);
    let mut names: Vec<String> =
        paths.filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned())).collect();
    names.sort();
    Some(names)
}

/// Names of the folders in a directory, in alphabetical order.
pub(crate) fn folders(directory: &Path) -> Vec<String> {
    let paths: Vec<PathBuf> = match directory.strip_prefix(BUILT_IN) {
        // Of files two levels below.
        Ok(within) => {
            let parents = embedded().iter().filter_map(|(file, _)| file.parent());
            parents.filter(|folder| folder.parent() == Some(within)).map(Path::to_owned).collect()
        }
        Err(_) => {
            let entries = std::fs::read_dir(directory).into_iter().flatten().flatten();
            entries.map(|entry| entry.path()).filter(|path| path.is_dir()).collect()
        }
    };
    let names = paths.iter().filter_map(|path| Some(path.file_name()?.to_str()?.to_owned()));
    names.collect::<std::collections::BTreeSet<String>>().into_iter().collect()
}

fn unreadable(path: &Path, e: &io::Error) -> ConfigError {
    let hint = if e.kind() == io::ErrorKind::NotFound { neighbours(path) } else { String::new() };
    ConfigError::of_file(path, format!("cannot be read: {e}{hint}"))
}

fn neighbours(path: &Path) -> String {
    let Some(directory) = path.parent() else { return String::new() };
    let directory = if directory.as_os_str().is_empty() { Path::new(".") } else { directory };
    match names(directory, &path.extension().unwrap_or_default().to_string_lossy()) {
        None => format!("; {} is no directory either, so check --config", directory.display()),
        Some(names) if names.is_empty() => String::new(),
        Some(names) => format!("; there is {}", names.join(", ")),
    }
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
