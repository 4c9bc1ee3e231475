//! A run directory of one's own for each test.

use std::os::unix::fs::DirBuilderExt;
use std::path::{Path, PathBuf};

/// Removed at the end of the test.
pub(crate) struct RunDir(PathBuf);

impl RunDir {
    pub(crate) fn new(name: &str) -> Self {
        let dir = std::env::temp_dir().join(format!("gangwerk-ipc-{}-{name}", std::process::id()));
        let _ = std::fs::remove_dir_all(&dir);
        Self(dir)
    }

    /// Makes it, for this user only.
    #[allow(dead_code)] // not every test needs it before the space does
    pub(crate) fn make(&self) {
        std::fs::DirBuilder::new().mode(0o700).create(&self.0).unwrap();
    }

    pub(crate) fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for RunDir {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
