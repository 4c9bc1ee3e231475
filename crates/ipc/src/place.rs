//! Place of a space: run directory, prefix in /dev/shm, and the iceoryx2 configuration made from them.

use crate::error::{IpcError, because};
use iceoryx2::prelude::*;
use std::os::unix::fs::DirBuilderExt;
use std::path::{Path as StdPath, PathBuf};

/// Shared memory objects appear here.
const SHM: &str = "/dev/shm";

/// One run directory and the names derived from it.
#[derive(Clone, Debug)]
pub(crate) struct RunPlace {
    pub(crate) dir: PathBuf,
    pub(crate) prefix: String,
}

/// 48 bits of hash (FNV-1a) of a run directory's full path.
pub(crate) fn key(dir: &StdPath) -> u64 {
    let bytes = dir.as_os_str().as_encoded_bytes().iter();
    bytes.fold(0xcbf2_9ce4_8422_2325u64, |hash, b| (hash ^ u64::from(*b)).wrapping_mul(0x100_0000_01b3)) >> 16
}

/// The full path of a directory, whether it is still there or not.
pub(crate) fn resolved(dir: &StdPath) -> PathBuf {
    dir.canonicalize().or_else(|_| std::path::absolute(dir)).unwrap_or_else(|_| dir.into())
}

impl RunPlace {
    /// `dir` must exist. The prefix is a hash of its full path, so that a new supervisor finds what the last one left.
    pub(crate) fn of(dir: &StdPath) -> Result<Self, IpcError> {
        let dir = dir
            .canonicalize()
            .map_err(|e| IpcError::Other(format!("run directory {}: {e}", dir.display())))?;
        // 48 bits: root, prefix, a 39-digit number and a suffix must fit into the 107 bytes of a socket's path.
        Ok(Self { prefix: format!("gangwerk_{:012x}_", key(&dir)), dir })
    }

    /// Root of iceoryx2's own files: on the tmpfs, because it syncs each of them, and short, because some are sockets.
    pub(crate) fn root(&self) -> PathBuf {
        StdPath::new(SHM).join(self.prefix.trim_end_matches('_'))
    }

    /// The black box of a process.
    pub(crate) fn box_of(&self, process: messages::Process) -> PathBuf {
        self.root().join(format!("box_{}", process.name()))
    }

    /// Makes the root, for this user only.
    pub(crate) fn make_root(&self) -> Result<(), IpcError> {
        let root = self.root();
        let made = std::fs::DirBuilder::new().mode(0o700).create(&root);
        made.map_err(|e| IpcError::Other(format!("{}: {e}", root.display())))
    }

    /// Own configuration: never the process-wide one, no clean-up behind a control process's back.
    pub(crate) fn config(&self) -> Result<Config, IpcError> {
        let mut config = Config::default();
        let root = self.root();
        let bytes = root.as_os_str().as_encoded_bytes();
        config.global.set_root_path(&Path::new(bytes).map_err(|e| because(root.display(), e))?);
        config.global.prefix = FileName::new(self.prefix.as_bytes()).map_err(|e| because(&self.prefix, e))?;
        config.global.service.cleanup_dead_nodes_on_open = false;
        config.global.node.cleanup_dead_nodes_on_creation = false;
        config.global.node.cleanup_dead_nodes_on_destruction = false;
        Ok(config)
    }

    /// Removes what a former run of this very space left behind. Only under the supervisor's lock.
    pub(crate) fn wipe(&self) -> Result<(), IpcError> {
        let root = self.root();
        if root.exists() {
            std::fs::remove_dir_all(&root)
                .map_err(|e| IpcError::Other(format!("{}: {e}", root.display())))?;
        }
        for entry in std::fs::read_dir(SHM).map_err(|e| IpcError::Other(format!("{SHM}: {e}")))?.flatten() {
            if entry.file_name().as_encoded_bytes().starts_with(self.prefix.as_bytes()) {
                let path = entry.path();
                std::fs::remove_file(&path)
                    .map_err(|e| IpcError::Other(format!("{}: {e}", path.display())))?;
            }
        }
        Ok(())
    }

    /// Bytes free in shared memory.
    pub(crate) fn free() -> Result<u64, IpcError> {
        let s = rustix::fs::statvfs(SHM).map_err(|e| IpcError::Other(format!("{SHM}: {e}")))?;
        Ok(s.f_bavail * s.f_frsize)
    }
}
