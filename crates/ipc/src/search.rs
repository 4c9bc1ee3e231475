//! Search for the robot of a run directory, by programs beside it that come and go as they like: dashboard, gateway, joystick.

use std::fmt::{Display, Formatter};
use std::path::{Path, PathBuf};

use messages::Process;

use crate::run::Run;
use crate::space::{owner, supervisor};

/// Reason why no robot is found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoRobot {
    /// None runs in this directory.
    Absent(PathBuf),
    /// It is not complete yet.
    Starting(PathBuf),
    /// It runs, and what the program needs of it cannot be had: why.
    Unusable(PathBuf, String),
}

impl Display for NoRobot {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Absent(dir) => {
                let dir = dir.display();
                write!(f, "no robot runs in {dir}: start one with `gangwerk run demo --dir {dir}`")
            }
            Self::Starting(dir) => write!(f, "the robot in {} is starting", dir.display()),
            Self::Unusable(dir, why) => write!(f, "the robot in {} cannot be reached: {why}", dir.display()),
        }
    }
}

impl std::error::Error for NoRobot {}

/// Robot that runs in `dir`, as `open` makes it of its supervisor and its run.
///
/// # Errors
/// Why there is none.
pub fn find_robot<T, E: Display>(
    dir: &Path,
    open: impl FnOnce(u32, &Run) -> Result<T, E>,
) -> Result<T, NoRobot> {
    let supervisor = supervisor(dir).ok_or_else(|| NoRobot::Absent(dir.into()))?;
    // The clock of all others is started last: what it is part of is complete.
    if owner(dir, Process::Lowlevel).is_none() {
        return Err(NoRobot::Starting(dir.into()));
    }
    let run = Run::load(dir).map_err(|e| NoRobot::Unusable(dir.into(), e.to_string()))?;
    open(supervisor, &run).map_err(|e| NoRobot::Unusable(dir.into(), e.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn where_none_runs_it_is_said_how_to_start_one() {
        let found = find_robot(Path::new("/nowhere"), |supervisor, _| Ok::<u32, String>(supervisor));
        let why = found.unwrap_err().to_string();
        assert_eq!(why, "no robot runs in /nowhere: start one with `gangwerk run demo --dir /nowhere`");
    }
}
