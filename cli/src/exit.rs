//! Exit codes of `gangwerk run` and `gangwerk sim`: a robot that fell or did not do what it was told is no success.

use std::process::ExitCode;

use chain::ending::{Ending, WalkEnd};

/// Command-line options of the faults.
pub const HELP: &str = "\
Exit codes:
  0    the scene was done, or ended in order by system/end
  1    an error; a process died or hung; the log is not complete because its disk failed; the simulation diverged
  2    the command line is wrong
  3    the robot fell, whatever came before
  4    the motor supply was lost, the joints were stopped, or a command of the scene was refused
  130  Ctrl-C, or another signal that asks for the end";

/// Exit of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// As it was told to.
    Done = 0,
    /// With an error that was said.
    Error = 1,
    /// The robot fell.
    Fell = 3,
    /// The robot lost its supply, was stopped, or refused a command of the scene.
    NotDone = 4,
    /// A signal asked for the end.
    Interrupted = 130,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}

impl Exit {
    /// Of a run without errors; `signal`: one asked for the end.
    pub fn of(ending: &Ending, signal: bool) -> Self {
        match ending.end().0 {
            WalkEnd::Diverged => Self::Error,
            _ if ending.fell().is_some() => Self::Fell,
            _ if signal => Self::Interrupted,
            WalkEnd::PowerOff(_) | WalkEnd::Stopped(_) => Self::NotDone,
            _ if ending.unfinished || ending.refused > 0 => Self::NotDone,
            WalkEnd::Done | WalkEnd::Asked | WalkEnd::Fell => Self::Done,
        }
    }
}
