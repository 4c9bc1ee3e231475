//! Parameters of a process started with `gangwerk PROCESS --run DIR`.
//!
//! The supervisor writes `DIR/run` before it starts anybody: one `key = value` per line.
//!
//! ```text
//! mode = lockstep            # or real-time
//! scene = walk_1kmh
//! method = type 2, semi_implicit x 4 # chosen for a scene that leaves it open, or asked for instead of the scene's; else empty
//! config = /home/me/gangwerk/config
//! bus = can:vcan0,vcan1      # or shm, canfd:..., sercos:...
//! robot = simulated          # or elsewhere
//! stays = no                 # or yes: goes on when the scene is over
//! commit = 5c1f...           # of the software; empty: unknown
//! started = 1763812800123456789 4711000000 # [ns] since 1970, and CLOCK_MONOTONIC at that instant; empty: simulated time
//! log = /home/me/walk.mcap   # empty: no log
//! ```

use crate::IpcError;
use crate::place::RunPlace;
use crate::run_dir::RunDir;
use crate::space::Space;
use messages::Process;
use rustix::fs::OFlags;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

/// The two ways to run (design 5).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Simulated time: everybody waits for its input of tick n and answers with tick n.
    Lockstep,
    /// The bus cycle is the clock.
    RealTime,
}

/// The run a process takes part in.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// The run directory.
    pub dir: PathBuf,
    /// Lockstep or real time.
    pub mode: Mode,
    /// In lockstep: no faster than real time. A machine that is late slows the robot down, and fells nobody.
    pub paced: bool,
    /// Name of the scene.
    pub scene: String,
    /// Method of simulation, if the scene leaves it open (`depth = "auto"`) or somebody asked for another one.
    pub method: Option<String>,
    /// Largest estimated error of that method as a multiple of what the scene allows, if it was chosen by its error.
    pub method_error: Option<f64>,
    /// The configuration directory: `system.toml`, `robots/`, `scenes/`, `gaits/`.
    pub config: PathBuf,
    /// The field bus, as `config::BusAddress` reads it.
    pub bus: String,
    /// Whether a simulated robot is at the far end of the bus.
    pub robot: bool,
    /// A run that goes on when the scene is over, until it is asked to end. The first live walking command ends the scene's own.
    pub stays: bool,
    /// Path of the log; none: no log.
    pub log: Option<PathBuf>,
    /// Git commit of the software; empty: unknown.
    pub commit: String,
    /// \[ns\] Wall time since 1970 and CLOCK_MONOTONIC, once, at the start; none in simulated time.
    pub started: Option<[u64; 2]>,
}

impl Run {
    /// A run in real time of nothing but a broker: no scene, no configuration.
    pub fn bare(dir: &Path) -> Self {
        Self {
            dir: dir.into(),
            mode: Mode::RealTime,
            paced: false,
            scene: "none".into(),
            method: None,
            method_error: None,
            config: "none".into(),
            bus: "shm".into(),
            robot: true,
            stays: false,
            log: None,
            commit: String::new(),
            started: None,
        }
    }

    /// The text of `dir/run`.
    pub fn to_text(&self) -> String {
        let mode = match self.mode {
            Mode::Lockstep if self.paced => "paced",
            Mode::Lockstep => "lockstep",
            Mode::RealTime => "real-time",
        };
        let log = self.log.as_deref().unwrap_or(Path::new(""));
        let error = self.method_error.map_or(String::new(), |error| error.to_string());
        let started = self.started.map_or(String::new(), |[unix, monotonic]| format!("{unix} {monotonic}"));
        format!(
            "mode = {mode}\nscene = {}\nmethod = {}\nmethod_error = {error}\nconfig = {}\nbus = {}\nrobot = {}\nstays = {}\n\
             commit = {}\nstarted = {started}\nlog = {}\n",
            self.scene,
            self.method.as_deref().unwrap_or_default(),
            self.config.display(),
            self.bus,
            if self.robot { "simulated" } else { "elsewhere" },
            if self.stays { "yes" } else { "no" },
            self.commit,
            log.display()
        )
    }

    /// Writes `dir/run`. The directory must exist: make the space first.
    pub fn save(&self) -> Result<(), IpcError> {
        let text = self.to_text();
        // Whole or not at all: a process never reads half a file.
        let dir = RunDir::open(&self.dir)?;
        let written = dir.new_file("run.new")?.write_all(text.as_bytes());
        written.map_err(|e| IpcError::Other(format!("{}: {e}", self.dir.join("run").display())))?;
        dir.rename("run.new", "run")
    }

    /// Reads `dir/run`.
    pub fn load(dir: &Path) -> Result<Self, IpcError> {
        let path = dir.join("run");
        let mut text = String::new();
        let mut file = RunDir::open(dir)?.file("run", OFlags::RDONLY)?;
        file.read_to_string(&mut text).map_err(|e| {
            IpcError::Other(format!("{}: {e}; processes are started by `gangwerk run`", path.display()))
        })?;
        Self::parse(dir, &text)
    }

    /// The run that this text tells of.
    ///
    /// # Errors
    /// Something is missing or cannot be.
    pub fn parse(dir: &Path, text: &str) -> Result<Self, IpcError> {
        let path = dir.join("run");
        let value = |key: &str| {
            text.lines()
                .filter_map(|line| line.split_once(" = ").or(line.strip_suffix(" =").map(|k| (k, ""))))
                .find_map(|(k, v)| (k == key && !v.contains(char::is_control)).then_some(v))
                .ok_or_else(|| IpcError::Other(format!("{}: {key} is missing", path.display())))
        };
        let wrong = |key: &str, other: &str, choice: &str| {
            IpcError::Other(format!("{}: {key} = {other}: must be {choice}", path.display()))
        };
        let (mode, paced) = match value("mode")? {
            "lockstep" => (Mode::Lockstep, false),
            "paced" => (Mode::Lockstep, true),
            "real-time" => (Mode::RealTime, false),
            other => return Err(wrong("mode", other, "lockstep, paced or real-time")),
        };
        let robot = match value("robot")? {
            "simulated" => true,
            "elsewhere" => false,
            other => return Err(wrong("robot", other, "simulated or elsewhere")),
        };
        let (method, log) = (value("method")?, value("log")?);
        // Logs of earlier versions do not say these.
        let stays = match value("stays") {
            Ok("yes") => true,
            Ok("no") | Err(_) => false,
            Ok(other) => return Err(wrong("stays", other, "yes or no")),
        };
        let method_error = match value("method_error") {
            Ok("") | Err(_) => None,
            Ok(text) => match text.parse() {
                Ok(error) if (0.0..f64::INFINITY).contains(&error) => Some(error),
                _ => return Err(wrong("method_error", text, "a number from 0 on")),
            },
        };
        let (commit, started) = (value("commit").unwrap_or_default(), value("started").unwrap_or_default());
        let number = |text: &str| text.parse().ok();
        let started =
            started.split_once(' ').and_then(|(unix, monotonic)| Some([number(unix)?, number(monotonic)?]));
        Ok(Self {
            dir: dir.into(),
            mode,
            paced,
            scene: value("scene")?.into(),
            method: (!method.is_empty()).then(|| method.into()),
            method_error,
            config: value("config")?.into(),
            bus: value("bus")?.into(),
            robot,
            stays,
            log: (!log.is_empty()).then(|| log.into()),
            commit: commit.into(),
            started,
        })
    }

    /// Black box of a process: [`Space::box_of`], before it enters the space.
    ///
    /// # Errors
    /// The run directory is gone.
    pub fn box_of(&self, process: Process) -> Result<PathBuf, IpcError> {
        Ok(RunPlace::of(&self.dir)?.box_of(process))
    }

    /// Enters the space of this run.
    pub fn enter(&self, process: Process) -> Result<Space, IpcError> {
        Space::open(&self.dir, process)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Found by fuzzing: any other word was taken for a robot elsewhere, and a carriage return for part of a name.
    #[test]
    fn a_word_that_is_no_choice_and_a_control_character_are_refused() {
        let dir = Path::new("/nowhere");
        let good = Run::bare(dir).to_text();
        assert_eq!(Run::parse(dir, &good).unwrap(), Run::bare(dir));
        for (from, to) in [
            ("simulated", "sicenmulated"),
            ("real-time", "real"),
            ("method_error = ", "method_error = NaN"),
            ("method_error = ", "method_error = -1"),
            ("log = ", "log = w.mcap\r"),
        ] {
            let error =
                Run::parse(dir, &good.trim_end_matches('\n').replace(from, to)).unwrap_err().to_string();
            assert!(error.contains("must be") || error.contains("log is missing"), "{to:?}: {error}");
        }
    }
}
