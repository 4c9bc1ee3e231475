//! One owner per place: a lock file with the owner's process id. The kernel lets go when the owner dies.

use crate::IpcError;
use crate::run_dir::RunDir;
use rustix::fs::{FlockOperation, OFlags, flock};
use std::fs::File;
use std::io::{Read, Write};
use std::path::Path;
use std::time::Duration;

/// Number and interval of attempts before a lock counts as somebody else's.
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
        let name = format!("{who}.lock");
        let path = dir.join(&name);
        let place = RunDir::open(dir)?;
        let open = || place.file(&name, OFlags::RDWR | OFlags::CREATE);
        let mut file = open()?;
        // A process that was just forked holds a copy of a lock that was let go, until it becomes another program.
        let taken = (0..TRIES).any(|_| {
            let taken = flock(&file, FlockOperation::NonBlockingLockExclusive).is_ok();
            // An owner that ended removes the file: what is locked then is one that nobody else will find.
            if taken && place.holds(&name, &file) {
                return true;
            }
            if taken && let Ok(again) = open() {
                file = again;
            } else {
                std::thread::park_timeout(PAUSE);
            }
            false
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
        let mut file = RunDir::open(dir).ok()?.file(&format!("{who}.lock"), OFlags::RDONLY).ok()?;
        if flock(&file, FlockOperation::NonBlockingLockShared).is_ok() {
            return None;
        }
        let mut text = String::new();
        file.read_to_string(&mut text).ok()?;
        Some(text.trim().parse().unwrap_or(0))
    }
}
