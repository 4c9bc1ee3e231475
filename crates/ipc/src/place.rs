//! Place of a space: run directory, prefix in /dev/shm, and the iceoryx2 configuration made from them.

use crate::error::{IpcError, because};
use crate::run_dir::{NAMES, RunDir};
use iceoryx2::prelude::*;
use messages::{FNV1A, fnv1a};
use rustix::fs::OFlags;
use rustix::rand::{GetRandomFlags, getrandom};
use std::io::{Read, Write};
use std::os::unix::fs::{DirBuilderExt, MetadataExt, OpenOptionsExt};
use std::path::{Path as StdPath, PathBuf};

/// Shared memory objects appear here.
const SHM: &str = "/dev/shm";

/// One run directory and the names derived from it.
#[derive(Clone, Debug)]
pub(crate) struct RunPlace {
    pub(crate) dir: PathBuf,
    /// First part of all names in shared memory, of whatever run in this directory.
    base: String,
    /// First part of the names of one run, after [`RunPlace::begin`] or [`RunPlace::join`].
    pub(crate) prefix: String,
}

/// 48 bits of hash (FNV-1a) of a run directory's full path.
pub(crate) fn key(dir: &StdPath) -> u64 {
    fnv1a(FNV1A, dir.as_os_str().as_encoded_bytes().iter().copied()) >> 16
}

/// The full path of a directory, whether it is still there or not.
pub(crate) fn resolved(dir: &StdPath) -> PathBuf {
    dir.canonicalize().or_else(|_| std::path::absolute(dir)).unwrap_or_else(|_| dir.into())
}

impl RunPlace {
    /// `dir` must exist. The base is a hash of its full path, so that a new supervisor finds what the last one left.
    pub(crate) fn of(dir: &StdPath) -> Result<Self, IpcError> {
        let dir = dir
            .canonicalize()
            .map_err(|e| IpcError::Other(format!("run directory {}: {e}", dir.display())))?;
        // 48 bits, and 24 for the run: root, prefix, a 39-digit number and ".event" must fit into the 107 bytes of a socket's path.
        let base = format!("gangwerk_{:012x}_", key(&dir));
        Ok(Self { prefix: base.clone(), base, dir })
    }

    /// Names of a new run, drawn and left for the other processes. Only under the supervisor's lock.
    ///
    /// Each run has its own, because an observer that lets go of a run long after its end removes files by their names.
    pub(crate) fn begin(&mut self) -> Result<(), IpcError> {
        let mut drawn = [0; 4];
        getrandom(&mut drawn[1..], GetRandomFlags::empty()).map_err(|e| because("random numbers", e))?;
        let run = format!("{:06x}", u32::from_be_bytes(drawn));
        let (dir, unfinished) = (RunDir::open(&self.dir)?, format!("{NAMES}.new"));
        let written = dir.new_file(&unfinished)?.write_all(run.as_bytes());
        written.map_err(|e| because(self.dir.join(NAMES).display(), e))?;
        dir.rename(&unfinished, NAMES)?;
        self.prefix = format!("{}{run}_", self.base);
        Ok(())
    }

    /// Names of the run that is there.
    pub(crate) fn join(&mut self) -> Result<(), IpcError> {
        let mut run = String::new();
        let read = RunDir::open(&self.dir)?.file(NAMES, OFlags::RDONLY)?.take(6).read_to_string(&mut run);
        read.map_err(|e| because(self.dir.join(NAMES).display(), e))?;
        self.prefix = format!("{}{run}_", self.base);
        Ok(())
    }

    /// Root of iceoryx2's own files: on the tmpfs, because it syncs each of them, and short, because some are sockets.
    pub(crate) fn root(&self) -> PathBuf {
        StdPath::new(SHM).join(self.base.trim_end_matches('_'))
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

    /// After the first node: makes private what iceoryx2 makes for everybody, its count of nodes. Who cuts it to nothing hangs whoever
    /// makes a node, or clears up after one.
    ///
    /// In its place comes a copy, because somebody may have opened it by now.
    pub(crate) fn close_to_others(&self) -> Result<(), IpcError> {
        let user = rustix::process::geteuid().as_raw();
        let is_open = |path: &StdPath| {
            let found = path.symlink_metadata();
            found.is_ok_and(|m| m.is_file() && m.uid() == user && m.mode() & 0o077 != 0)
        };
        let told = |path: &StdPath, e: std::io::Error| IpcError::Other(format!("{}: {e}", path.display()));
        for entry in std::fs::read_dir(SHM).map_err(|e| told(StdPath::new(SHM), e))?.flatten() {
            let path = entry.path();
            if !entry.file_name().as_encoded_bytes().starts_with(self.prefix.as_bytes()) || !is_open(&path) {
                continue;
            }
            let (copy, mut options) = (path.with_extension("closed"), std::fs::OpenOptions::new());
            let made = options.write(true).create_new(true).mode(0o600).open(&copy);
            let written = made.and_then(|mut file| file.write_all(&std::fs::read(&path)?));
            written.and_then(|()| std::fs::rename(&copy, &path)).map_err(|e| told(&path, e))?;
        }
        Ok(())
    }

    /// Removes what former runs in this directory left behind. Only under the supervisor's lock.
    pub(crate) fn wipe(&self) -> Result<(), IpcError> {
        let root = self.root();
        if root.exists() {
            std::fs::remove_dir_all(&root)
                .map_err(|e| IpcError::Other(format!("{}: {e}", root.display())))?;
        }
        for entry in std::fs::read_dir(SHM).map_err(|e| IpcError::Other(format!("{SHM}: {e}")))?.flatten() {
            if entry.file_name().as_encoded_bytes().starts_with(self.base.as_bytes()) {
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
