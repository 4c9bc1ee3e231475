//! A `gangwerk` at work, and what it said.

use crate::place::Site;
use ipc::Space;
use messages::Process;
use realtime::clock;
use rustix::process::{Pid, Signal, kill_process};
use std::fs::{self, File};
use std::io::PipeWriter;
use std::path::PathBuf;
use std::process::{Child, Command};
use std::sync::atomic::{AtomicU32, Ordering};

/// No command of a test takes longer \[s\].
const PATIENCE: f64 = 120.0;

/// A test that cannot be done here says so; where `CI` is `true` everything can be, and it fails.
pub fn left_out(why: &str) {
    assert_ne!(std::env::var("CI").as_deref(), Ok("true"), "left out: {why}");
    println!("left out: {why}");
}

/// Waits a little; only where nothing rings.
pub fn doze(seconds: f64) {
    clock::sleep_until(clock::now() + (seconds * 1e9) as u64);
}

/// Exit of a command.
#[derive(Clone, Debug)]
pub struct Said {
    /// Exit code; none: ended by a signal.
    pub code: Option<i32>,
    /// Standard output.
    pub out: String,
    /// Standard error.
    pub err: String,
}

impl Said {
    /// This, if the command ended well.
    #[track_caller]
    pub fn well(self) -> Self {
        assert_eq!(self.code, Some(0), "{self:#?}");
        self
    }
}

/// A started `gangwerk`. Killed when dropped.
pub struct Running {
    child: Child,
    run_dir: PathBuf,
    out: PathBuf,
    err: PathBuf,
}

impl Running {
    pub(crate) fn start(command: &mut Command, site: &Site) -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let n = COUNT.fetch_add(1, Ordering::Relaxed);
        // Files, not pipes: nobody waits for a reader.
        let (out, err) = (site.path(&format!("{n}.out")), site.path(&format!("{n}.err")));
        command.stdout(File::create(&out).expect("the place is ours"));
        command.stderr(File::create(&err).expect("the place is ours"));
        Self::spawn(command, site, out, err)
    }

    /// The same with another standard error, and standard output, than files.
    pub(crate) fn start_into(command: &mut Command, site: &Site, errors: PipeWriter) -> Self {
        command.stdout(errors.try_clone().expect("a descriptor is free")).stderr(errors);
        Self::spawn(command, site, PathBuf::new(), PathBuf::new())
    }

    fn spawn(command: &mut Command, site: &Site, out: PathBuf, err: PathBuf) -> Self {
        let child = command.spawn().expect("the executable was built for this test");
        Self { child, run_dir: site.run_dir(), out, err }
    }

    /// Standard output so far.
    pub fn out(&self) -> String {
        fs::read_to_string(&self.out).unwrap_or_default()
    }

    /// Standard error so far.
    pub fn err(&self) -> String {
        fs::read_to_string(&self.err).unwrap_or_default()
    }

    /// Whether it is still at work.
    pub fn is_alive(&mut self) -> bool {
        self.child.try_wait().is_ok_and(|status| status.is_none())
    }

    /// Waits for its end.
    #[track_caller]
    pub fn end(self) -> Said {
        self.try_end().unwrap_or_else(|e| panic!("{e}"))
    }

    /// Waits for its end.
    ///
    /// # Errors
    /// It does not end in time; what it said.
    pub fn try_end(mut self) -> Result<Said, String> {
        let begun = clock::now();
        while self.is_alive() {
            if clock::now() - begun > (PATIENCE * 1e9) as u64 {
                return Err(format!("did not end within {PATIENCE} s: {}", self.err()));
            }
            doze(0.005);
        }
        let code = self.child.wait().expect("it has ended").code();
        Ok(Said { code, out: fs::read_to_string(&self.out).unwrap_or_default(), err: self.err() })
    }

    /// Asks it to end, as Ctrl-C does.
    pub fn interrupt(&self) {
        signal(self.child.id(), Signal::INT);
    }

    /// SIGKILL to one process of the run.
    pub fn kill(&self, process: Process) {
        self.signal(process, Signal::KILL);
    }

    /// A signal to one process of the run.
    pub fn signal(&self, process: Process, what: Signal) {
        signal(self.pid(process), what);
    }

    /// A signal to the program itself, which in a run is the supervisor.
    pub fn signal_supervisor(&self, what: Signal) {
        signal(self.child.id(), what);
    }

    /// Stops one process of the run for so long \[s\], as a host does that has no time for it.
    pub fn pause(&self, process: Process, seconds: f64) {
        let pid = self.pid(process);
        signal(pid, Signal::STOP);
        doze(seconds);
        signal(pid, Signal::CONT);
    }

    /// Process id of the program itself.
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// Process id of one process of the run.
    pub fn pid(&self, process: Process) -> u32 {
        let path = self.run_dir.join(format!("{}.lock", process.name()));
        let text = fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        text.trim().parse().unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    }

    /// The shared memory of the run, as soon as all its processes are there.
    #[track_caller]
    pub fn space(&mut self) -> Space {
        self.try_space().unwrap_or_else(|e| panic!("{e}"))
    }

    /// The same.
    ///
    /// # Errors
    /// It does not start; what it said.
    pub fn try_space(&mut self) -> Result<Space, String> {
        let begun = clock::now();
        let last = Process::Lowlevel.name();
        while !self.run_dir.join(format!("{last}.lock")).exists() {
            if !self.is_alive() || clock::now() - begun > 30 * clock::SECOND {
                return Err(format!("did not start: {}", self.err()));
            }
            doze(0.005);
        }
        Space::open(&self.run_dir, Process::Observer).map_err(|e| e.to_string())
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if self.is_alive() {
            signal(self.child.id(), Signal::CONT);
            // The second one ends at once, and clears up; a killed one would leave its shared memory behind.
            let late = clock::now() + 8 * clock::SECOND;
            while self.is_alive() && clock::now() < late {
                signal(self.child.id(), Signal::TERM);
                doze(0.2);
            }
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
    }
}

/// A robot in real time has the machine for itself: holds up all other tests that ask, until it is dropped.
pub fn turn() -> File {
    let file = turns();
    file.lock().expect("a file can be locked");
    file
}

/// Robots in simulated time run beside each other, and beside none in real time.
pub fn shared_turn() -> File {
    let file = turns();
    file.lock_shared().expect("a file can be locked");
    file
}

fn turns() -> File {
    File::create(std::env::temp_dir().join("gangwerk-test-turn")).expect("a file can be made")
}

/// A signal to a process.
pub fn signal(pid: u32, signal: Signal) {
    let pid = Pid::from_raw(pid as i32).expect("no process has id 0");
    // One that is gone has ended.
    let _ = kill_process(pid, signal);
}
