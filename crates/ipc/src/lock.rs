//! One owner per place: a lock file with the owner's process id. The kernel lets go when the owner dies.

use crate::IpcError;
use rustix::fs::{FlockOperation, flock};
use std::fs::{File, OpenOptions};
use std::io::{Read, Write};
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;
use std::time::Duration;

/// How often, and how long after one another, a lock is tried before it counts as somebody else's.
const TRIES: u32 = 20;
const PAUSE: Duration = Duration::from_millis(5);

/// Held as long as it lives.
#[derive(Debug)]
pub(crate) struct Lock {
    _file: File,
}

impl Lock {
    /// Takes `dir/who.lock`, or tells who has it.
    pub(crate) fn take(dir: &Path, who: &str) -> Result<Self, IpcError> {
        let path = dir.join(format!("{who}.lock"));
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .mode(0o600)
            .open(&path)
            .map_err(|e| IpcError::Other(format!("{}: {e}", path.display())))?;
        // A process that was just forked holds a copy of a lock that was let go, until it becomes another program.
        let taken = (0..TRIES).any(|_| {
            let taken = flock(&file, FlockOperation::NonBlockingLockExclusive).is_ok();
            if !taken {
                std::thread::park_timeout(PAUSE);
            }
            taken
        });
        if !taken {
            let mut text = String::new();
            let _ = file.read_to_string(&mut text);
            return Err(IpcError::AlreadyRunning {
                who: who.into(),
                pid: text.trim().parse().unwrap_or(0),
                dir: dir.display().to_string(),
            });
        }
        let write = |file: &mut File| {
            file.set_len(0)?;
            file.write_all(format!("{}\n", std::process::id()).as_bytes())
        };
        write(&mut file).map_err(|e| IpcError::Other(format!("{}: {e}", path.display())))?;
        Ok(Self { _file: file })
    }

    /// The owner of `dir/who.lock`, if it has one.
    pub(crate) fn owner(dir: &Path, who: &str) -> Option<u32> {
        let mut file = File::open(dir.join(format!("{who}.lock"))).ok()?;
        if flock(&file, FlockOperation::NonBlockingLockShared).is_ok() {
            return None;
        }
        let mut text = String::new();
        file.read_to_string(&mut text).ok()?;
        Some(text.trim().parse().unwrap_or(0))
    }
}
