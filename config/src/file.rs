//! Files of a configuration: read from a directory or from the set inside the executable, and hashed for every log.

use std::borrow::Cow;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use messages::{FNV1A, fnv1a};

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

/// Reader of the files of a configuration, which keeps what it read.
pub(crate) struct ConfigReader {
    /// FNV-1a, 64 bits, over the bytes of all files, in the order in which they were read.
    pub(crate) hash: u64,
    /// Those files.
    pub(crate) files: Vec<Read>,
    /// Files that are read instead of those on the disk.
    replaced: Vec<Read>,
}

impl Default for ConfigReader {
    fn default() -> Self {
        Self::of_files(Vec::new())
    }
}

impl ConfigReader {
    /// One that reads these files instead of those on the disk.
    pub(crate) fn of_files(replaced: Vec<Read>) -> Self {
        Self { hash: FNV1A, files: Vec::new(), replaced }
    }

    /// One of those files has other numbers at these keys.
    pub(crate) fn edit(&mut self, path: &Path, numbers: &[(String, f64)]) -> Result<(), ConfigError> {
        let Some((_, bytes)) = self.replaced.iter_mut().find(|(known, _)| known == path) else {
            return Err(ConfigError::of_file(path, "was not read"));
        };
        let numbers = numbers.iter().map(|(key, number)| (key.as_str(), *number));
        let edited = edit::with_numbers(&String::from_utf8_lossy(bytes), numbers);
        *bytes = edited.map_err(|e| ConfigError::of_file(path, e))?.into_bytes();
        Ok(())
    }

    /// A file was read.
    pub(crate) fn keep(&mut self, path: &Path, bytes: &[u8]) {
        self.hash = fnv1a(self.hash, bytes.iter().copied());
        self.files.push((path.into(), bytes.into()));
    }
}

/// The hash of files that were read in this order.
pub(crate) fn hash_of<'a>(files: impl Iterator<Item = &'a [u8]>) -> u64 {
    files.fold(FNV1A, |hash, bytes| fnv1a(hash, bytes.iter().copied()))
}

/// The text of a file; an error says what lies beside it instead.
pub(crate) fn text(path: &Path, reader: &mut ConfigReader) -> Result<String, ConfigError> {
    let bytes = include(path, reader)?;
    String::from_utf8(bytes).map_err(|_| ConfigError::of_file(path, "cannot be read: is not UTF-8 text"))
}

/// The bytes of a file that another part makes sense of.
pub(crate) fn include(path: &Path, reader: &mut ConfigReader) -> Result<Vec<u8>, ConfigError> {
    let bytes = match reader.replaced.iter().find(|(known, _)| known == path) {
        Some((_, bytes)) => bytes.clone(),
        None => bytes(path).map_err(|e| unreadable(path, &e))?.into_owned(),
    };
    reader.keep(path, &bytes);
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
