//! The configuration of a log, as files again.

use std::error::Error;
use std::path::{Component, Path, PathBuf};

use config::Setup;
use config::method::Method;
use ipc::Run;
use recording::Log;

/// A directory with the configuration of a log; gone when dropped.
pub struct Unpacked {
    /// The directory.
    pub path: PathBuf,
    /// Run that wrote it; none: the log does not say it, as that of `gangwerk sim`.
    pub run: Option<Run>,
    files: usize,
}

impl Unpacked {
    /// The files in this log.
    ///
    /// # Errors
    /// The log is damaged, or there is no room for them.
    pub fn of(log: &Log) -> Result<Self, Box<dyn Error>> {
        let mut place = Self::new()?;
        let (mut run, mut failed) = (None, None);
        log.each_attachment(|name, bytes| match name.strip_prefix(logger::CONFIG) {
            Some(name) => failed = failed.take().or(place.put(Path::new(name), bytes).err()),
            None if name == logger::daemon::RUN => run = Some(String::from_utf8_lossy(bytes).into_owned()),
            None => {}
        })?;
        if let Some(error) = failed {
            return Err(error.into());
        }
        place.run = run.map(|run| Run::parse(&place.path, &run)).transpose()?;
        Ok(place)
    }

    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.files == 0
    }

    /// The configuration that the log was run with.
    ///
    /// # Errors
    /// A file is missing, or is not of this version.
    pub fn setup(&self, log: &Log) -> Result<Setup, Box<dyn Error>> {
        let run = self.run.as_ref();
        let method: Option<Method> = run.and_then(|run| run.method.as_deref()).map(str::parse).transpose()?;
        let setup = Setup::load(&self.path, run.map_or(&log.run().scene, |run| &run.scene))?;
        let setup = if run.is_some() { setup.with_method(method)? } else { setup };
        let classic = run.map(|run| run.bus.parse::<config::BusAddress>()).transpose()?;
        Ok(setup.on_bus(classic.is_some_and(|bus| bus.is_classic()))?)
    }

    fn new() -> Result<Self, String> {
        static COUNT: std::sync::atomic::AtomicU32 = std::sync::atomic::AtomicU32::new(0);
        let n = COUNT.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("gangwerk-replay-{}-{n}", std::process::id()));
        std::fs::create_dir(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        Ok(Self { path, run: None, files: 0 })
    }

    fn put(&mut self, name: &Path, bytes: &[u8]) -> Result<(), String> {
        if !name.components().all(|part| matches!(part, Component::Normal(_))) {
            return Err(format!("the log holds a file with the name {}", name.display()));
        }
        let path = self.path.join(name);
        let made = path.parent().map_or(Ok(()), std::fs::create_dir_all);
        self.files += 1;
        made.and_then(|()| std::fs::write(&path, bytes)).map_err(|e| format!("{}: {e}", path.display()))
    }
}

impl Drop for Unpacked {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.path);
    }
}
