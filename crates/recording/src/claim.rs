//! Files that one program at a time writes: who writes a log holds its lock, so that nobody else empties or repairs it meanwhile.

use crate::error::RecordingError;
use std::fs::{File, OpenOptions, TryLockError};
use std::path::Path;

/// A new file, or an old one emptied, locked until it is closed.
///
/// # Errors
/// It cannot be made, or another program, or another log of this one, is being written there.
pub(crate) fn create(path: &Path) -> Result<File, RecordingError> {
    let failed = |e| RecordingError::Create(path.into(), e);
    // Not emptied before it is ours.
    let mut options = OpenOptions::new();
    let file = options.write(true).create(true).truncate(false).open(path).map_err(failed)?;
    claim(&file, path)?;
    // A device has no length to set.
    if file.metadata().map_err(failed)?.is_file() {
        file.set_len(0).map_err(failed)?;
    }
    Ok(file)
}

/// Locks a file that is open. File systems without locks lock nothing.
///
/// # Errors
/// Somebody writes it.
pub(crate) fn claim(file: &File, path: &Path) -> Result<(), RecordingError> {
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => Err(RecordingError::BeingWritten(path.into())),
        Ok(()) | Err(TryLockError::Error(_)) => Ok(()),
    }
}

/// True of a log that somebody writes now. To open a pipe would wait for who writes it.
pub fn is_being_written(path: &Path) -> bool {
    path.is_file()
        && File::open(path).is_ok_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
}
