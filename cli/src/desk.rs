//! The operator's page beside a run: `gangwerk dashboard` as its child, which ends with it.

use std::io;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use rustix::process::{Pid, Signal, kill_process};
use terminal::{Console, Feed};

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
        let _ = self.0.wait();
    }
}
