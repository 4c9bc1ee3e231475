//! The operator's page beside a run: `gangwerk dashboard` as its child, which ends with it.

use std::io;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use realtime::clock;
use rustix::process::{Pid, Signal, kill_process};
use terminal::{Console, Feed};

/// A page that was asked to end gets this long.
const PATIENCE: u64 = 5 * clock::SECOND;
/// Between two looks at it.
const LOOK: Duration = Duration::from_millis(10);

/// A page that is served while this lives.
pub(crate) struct Desk(Child);

impl Desk {
    /// Serves the robot of `dir`; the address goes to `console`, and to a browser where there is a desktop.
    ///
    /// # Errors
    /// The process cannot be started.
    pub(crate) fn open(dir: &Path, console: &Console) -> io::Result<Self> {
        let [(page, address), (errors, complaints)] = [Feed::new()?, Feed::new()?];
        let child = Command::new(std::env::current_exe()?)
            .args(["dashboard", "--with-parent", "--dir"])
            .arg(dir)
            .stdin(Stdio::null())
            .stdout(address)
            .stderr(complaints)
            .process_group(0) // the terminal's Ctrl-C is the run's to hear
            .spawn()?;
        console.say("see and steer the robot in a browser; Ctrl-C ends the run");
        page.into_lines(console.clone())?;
        errors.into_lines(console.clone())?;
        Ok(Self(child))
    }
}

impl Drop for Desk {
    fn drop(&mut self) {
        let _ = kill_process(Pid::from_child(&self.0), Signal::TERM);
        let until = clock::now() + PATIENCE;
        while matches!(self.0.try_wait(), Ok(None)) && clock::now() < until {
            std::thread::park_timeout(LOOK);
        }
        // One that is stopped or hangs holds up no run; one that has ended is not there to be killed.
        let _ = self.0.kill();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run never ended beside a page that was stopped.
    #[test]
    fn a_page_that_is_stopped_is_not_waited_for() {
        let child = Command::new("sleep").arg("1000").spawn().unwrap();
        kill_process(Pid::from_child(&child), Signal::STOP).unwrap();
        let begun = clock::now();
        drop(Desk(child));
        let took = clock::now() - begun;
        assert!(took < 2 * PATIENCE, "{took} ns");
    }
}
