//! Starter of simulated runs: `gangwerk run SCENE` as a child of this process, in its run directory, one at a time.
//!
//! ```text
//! none ──start──► starting ──joint loop there──► running ──end──► stopping ──► none
//!                    └──────── ends by itself: none, with its last words ────────┘
//! ```
//!
//! A run that is asked to end brings its robot to a stand first, as at Ctrl-C. It ends with this process, too, killed or not: the
//! kernel tells it ([`realtime::Stop::with_parent`]). That is bound to the thread that started it, so one thread does, as long as the process lives.

use std::collections::VecDeque;
use std::io::{BufRead, BufReader, PipeReader};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use messages::Process;
use realtime::clock::{SECOND, now};
use serde_json::json;

use crate::catalogue::Catalogue;
use crate::observer::Notice;
use crate::operator::answer;
use crate::requests::{RunTask, StartOrder};
use crate::subscribers::Outbox;

/// Between two looks at the run.
const LOOK: Duration = Duration::from_millis(100);
/// Between two looks at the scenes while none runs \[ns\].
const LIST: u64 = 5 * SECOND;
/// Timeout of a run that was asked to end \[ns\]: longer than its robot takes to come to a stand and its processes to end.
const PATIENCE: u64 = 30 * SECOND;
/// Requests to end before a run is killed.
const REQUESTS: u32 = 2;
/// Lines of a run that are told when it ends, and the longest one \[B\].
const LINES: usize = 6;
const LONGEST: usize = 300;

/// Answer of a server that starts nothing.
pub const NO_STARTER: &str =
    "this dashboard starts and ends no runs; one of `gangwerk dashboard --start` does";

/// Options of a server that starts runs.
#[derive(Clone, Debug)]
pub struct StartOptions {
    /// The command `gangwerk`.
    pub command: PathBuf,
    /// The configuration directory, whose scenes can be started.
    pub config: PathBuf,
    /// Scene that is started at once.
    pub first: Option<String>,
}

impl StartOptions {
    /// Check of the scenes, before anything is served.
    ///
    /// # Errors
    /// The configuration has no scenes, or not the one to be started at once.
    pub fn check(&self) -> Result<(), String> {
        let catalogue = Catalogue::read(&self.config)?;
        let Some(scene) = &self.first else { return Ok(()) };
        catalogue.find(scene).map_err(|why| format!("--start {scene}: {why}"))
    }
}

/// Call to the starter.
#[derive(Debug)]
pub enum StarterCall {
    /// Task of a page, with its number.
    Page(u64, Outbox, RunTask),
    /// The server ends, and its run with it; once more: at once.
    Leave,
}

/// Way to the thread that starts runs.
#[derive(Debug)]
pub struct Starter {
    calls: Sender<StarterCall>,
    thread: JoinHandle<()>,
}

impl Starter {
    /// Starts the thread for the directory `dir`; `observer` passes on to the pages what is to be told.
    ///
    /// # Errors
    /// The thread cannot be started.
    pub fn open(dir: &Path, options: &StartOptions, observer: Sender<Notice>) -> Result<Self, String> {
        let (calls, heard) = channel();
        let keeper = Keeper {
            dir: dir.into(),
            options: options.clone(),
            observer,
            catalogue: Catalogue::default(),
            run: None,
            why: String::new(),
            told: String::new(),
            next_list: 0,
            leaving: false,
        };
        let thread = std::thread::Builder::new().name("starter".into()).spawn(move || keeper.serve(&heard));
        Ok(Self { calls, thread: thread.map_err(|e| format!("thread starter: {e}"))? })
    }

    /// Passes a call on; none: the thread has ended.
    pub fn call(&self, call: StarterCall) -> Option<()> {
        self.calls.send(call).ok()
    }

    /// True if the thread has ended, which it does without a run once it was told to leave.
    pub fn is_finished(&self) -> bool {
        self.thread.is_finished()
    }
}

/// The thread's state.
struct Keeper {
    dir: PathBuf,
    options: StartOptions,
    observer: Sender<Notice>,
    catalogue: Catalogue,
    run: Option<StartedRun>,
    /// Last words of the run before, if it did not end in order.
    why: String,
    /// The message `run` as it was told last.
    told: String,
    next_list: u64,
    leaving: bool,
}

impl Keeper {
    fn serve(mut self, calls: &Receiver<StarterCall>) {
        if let Some(scene) = self.options.first.clone() {
            let order = StartOrder { scene, depth: None, integrator: None };
            self.why = self.start(&order).err().unwrap_or_default();
        }
        loop {
            match calls.recv_timeout(LOOK) {
                Ok(StarterCall::Page(id, outbox, RunTask::Start(order))) => {
                    answer(&outbox, id, &self.start(&order));
                }
                Ok(StarterCall::Page(id, outbox, RunTask::End)) => answer(&outbox, id, &self.end()),
                Ok(StarterCall::Leave) => self.leave(),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
            self.look(now());
            if self.leaving && self.run.is_none() {
                return;
            }
        }
    }

    fn start(&mut self, order: &StartOrder) -> Result<String, String> {
        self.list();
        self.catalogue.find(&order.scene)?;
        let dir = self.dir.display();
        if self.leaving {
            return Err("the dashboard is ending".into());
        }
        if let Some(run) = &self.run {
            return Err(format!("{} runs in {dir}; end it first", run.scene));
        }
        if let Some(pid) = ipc::supervisor(&self.dir) {
            return Err(format!("process {pid} runs a robot in {dir}; end it where it was started"));
        }
        self.run = Some(StartedRun::spawn(&self.dir, &self.options, order)?);
        self.why.clear();
        Ok(format!("{} is starting", order.scene))
    }

    fn end(&mut self) -> Result<String, String> {
        match &mut self.run {
            None => Err("no run was started here".into()),
            Some(run) if run.requests > 0 => {
                Err(format!("{} is ending; the emergency stop does not wait for a stand", run.scene))
            }
            Some(run) => {
                run.ask_to_end(now());
                Ok(format!("{} is ending: its robot comes to a stand first", run.scene))
            }
        }
    }

    /// The run is asked to end, once; whoever says it again is in a hurry.
    fn leave(&mut self) {
        let most = if self.leaving { REQUESTS } else { 1 };
        self.leaving = true;
        if let Some(run) = self.run.as_mut().filter(|run| run.requests < most) {
            run.ask_to_end(now());
        }
    }

    fn look(&mut self, now: u64) {
        match self.run.take() {
            None if now >= self.next_list => self.list(),
            None => {}
            Some(mut run) => match run.child.try_wait() {
                Ok(None) => {
                    run.look(&self.dir, now);
                    self.run = Some(run);
                }
                Ok(Some(status)) => self.why = run.last_words(status),
                Err(e) => self.why = format!("{}: {e}", run.scene),
            },
        }
        self.tell();
    }

    /// Reads the scenes again; a directory that cannot be read leaves them as they were.
    fn list(&mut self) {
        self.next_list = now() + LIST;
        match Catalogue::read(&self.options.config) {
            Ok(catalogue) if catalogue != self.catalogue => {
                let _ = self.observer.send(Notice::Scenes(catalogue.message().to_string().into()));
                self.catalogue = catalogue;
            }
            Ok(_) => {}
            Err(why) => tracing::warn!("{why}"),
        }
    }

    /// Tells the state of the run, if it is another one than before.
    fn tell(&mut self) {
        let (state, scene) = match &self.run {
            Some(run) => (run.state(), run.scene.as_str()),
            None if ipc::supervisor(&self.dir).is_some() => ("elsewhere", ""),
            None => ("none", ""),
        };
        let message = json!({"type": "run", "state": state, "scene": scene, "why": self.why}).to_string();
        if message != self.told {
            // The observer ends later than this thread.
            let _ = self.observer.send(Notice::Run(message.as_str().into()));
            self.told = message;
        }
    }
}

/// A run that was started here.
struct StartedRun {
    scene: String,
    child: Child,
    /// Reader of what it says.
    reader: JoinHandle<String>,
    /// True once its joint loop was there, the last one to come.
    started: bool,
    /// Requests to end, and when the next one is due \[ns\].
    requests: u32,
    due: u64,
}

impl StartedRun {
    /// Starts `gangwerk run` in lockstep at the pace of real time, without a log, until it is asked to end.
    fn spawn(dir: &Path, options: &StartOptions, order: &StartOrder) -> Result<Self, String> {
        let told = |e: std::io::Error| format!("{} cannot be started: {e}", order.scene);
        let (pipe, errors) = std::io::pipe().map_err(told)?;
        let reader = std::thread::Builder::new().name("words of a run".into());
        let reader = reader.spawn(move || last_lines(pipe)).map_err(told)?;
        let mut command = Command::new(&options.command);
        command.args(["run", "--lockstep", "--paced", "--stay", "--no-log"]);
        command.args(["--with-parent", &std::process::id().to_string()]);
        command.arg("--dir").arg(dir).arg("--config").arg(&options.config);
        if let Some(depth) = order.depth {
            command.args(["--depth", &depth.to_string()]);
        }
        if let Some(integrator) = order.integrator {
            command.args(["--integrator", integrator.word()]);
        }
        // Whatever the name looks like, it is one.
        command.args(["--", &order.scene]);
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(errors);
        command.process_group(0); // the terminal's Ctrl-C is the dashboard's to hear
        let child = command.spawn().map_err(told)?;
        Ok(Self { scene: order.scene.clone(), child, reader, started: false, requests: 0, due: 0 })
    }

    fn state(&self) -> &'static str {
        match (self.requests, self.started) {
            (0, false) => "starting",
            (0, true) => "running",
            _ => "stopping",
        }
    }

    fn look(&mut self, dir: &Path, now: u64) {
        self.started |= ipc::owner(dir, Process::Lowlevel).is_some();
        if self.requests > 0 && now > self.due {
            self.ask_to_end(now);
        }
    }

    /// First request: the robot comes to a stand, and the run ends. Second one: emergency stop, and the end at once. Then the run is
    /// killed, and its processes end with it.
    fn ask_to_end(&mut self, now: u64) {
        self.requests += 1;
        self.due = now + PATIENCE;
        match self.requests {
            1..=REQUESTS => realtime::terminate(self.child.id()),
            // It has ended, or it will be seen.
            _ => _ = self.child.kill(),
        }
    }

    /// What is to be told about its end; nothing if it ended in order.
    fn last_words(self, status: ExitStatus) -> String {
        let asked = (1..=REQUESTS).contains(&self.requests);
        // Asked before it could hear it ends by the signal.
        if status.success() || asked && matches!(status.code(), Some(130) | None) {
            return String::new();
        }
        let lines = self.reader.join().unwrap_or_default();
        format!("{} ended ({status})\n{lines}", self.scene)
    }
}

/// Reads what a run says until it ends, and passes it on; its last lines.
fn last_lines(pipe: PipeReader) -> String {
    let mut last = VecDeque::with_capacity(LINES);
    for line in BufReader::new(pipe).split(b'\n').map_while(Result::ok) {
        let line = String::from_utf8_lossy(&line[..line.len().min(LONGEST)]).into_owned();
        tracing::info!("{line}");
        if last.len() == LINES {
            last.pop_front();
        }
        last.push_back(line);
    }
    last.make_contiguous().join("\n")
}
