//! Starts the processes, looks after them, ends them.

use std::error::Error;
use std::fs::File;
use std::os::unix::process::CommandExt;
use std::path::PathBuf;
use std::process::{Child, Command as Spawn, ExitStatus, Stdio};
use std::time::Duration;

use config::Setup;
use ipc::{Mode, Run, Space};
use messages::command::Domain;
use messages::topics::Topic;
use messages::{Command, CycleStats, Event, EventCode, Process};
use realtime::{Stop, black_box, clock};
use terminal::{Console, Feed};

use super::backoff::Backoff;
use super::course::{Act, Course, CourseObservation};
use super::crash::{self, Crashes};
use super::hearing::Hearing;
use super::manager::{ENVIRONMENT, Manager};
use super::pulse::Pulse;
use super::view::View;
use super::{Cause, EndedWhileStarting, RunOutcome};

/// Between two looks at the processes.
const LOOK: Duration = Duration::from_millis(10);
/// A process that has not reported within this time after its start does not start any more.
const START_PATIENCE: u64 = 20 * clock::SECOND;
/// A process that was asked to end gets this long, and one that was killed then.
const END_PATIENCE: u64 = 5 * clock::SECOND;
/// Period at which ports of dead observers are removed.
const CLEAR_EVERY: u64 = 2 * clock::SECOND;
/// A process that hangs gets this long to say where.
const FAREWELL: u64 = clock::SECOND / 10;
/// A killed process has this long to be gone; one that waits for a disk in the kernel takes as long as the disk.
const DEATH_PATIENCE: u64 = clock::SECOND / 10;
/// Delay for the last words of a dead process to pass its pipe.
const LAST_WORDS: Duration = Duration::from_millis(50);

/// Runs the processes of `run` to their end.
///
/// # Errors
/// A process does not start, or has another configuration.
pub(super) fn supervise(
    run: Run,
    space: Space,
    setup: &Setup,
    rt_required: bool,
    stop: Stop,
    console: &Console,
) -> Result<RunOutcome, Box<dyn Error>> {
    let course = Course::new(run.mode);
    let mut view = View::new(&space, setup, console.clone())?;
    let mut supervisor = Supervisor {
        children: Vec::new(),
        dying: Vec::new(),
        restarts: [Process::Broker, Process::Logger].map(|p| (p, Backoff::new(ipc::writers(p)))),
        pulse: Pulse::default(),
        crashes: Crashes::new(setup, &run, console),
        memories: Vec::new(),
        manager: Manager::new(),
        outcome: RunOutcome::default(),
        console: console.clone(),
        patience: (setup.system.peer_timeout * 1e9) as u64,
        rt_required: rt_required && run.mode == Mode::RealTime,
        course,
        run,
        space,
        stop,
    };
    let result = supervisor.start(setup).and_then(|()| supervisor.watch(&mut view));
    view.update();
    supervisor.outcome.ending = view.ending.clone();
    // Whatever became of it: nobody is left alive, and what was said last is heard.
    supervisor.manager.stopping();
    view.update();
    view.end();
    supervisor.end();
    view.update();
    view.sum_up();
    supervisor.outcome.missing = view.missing();
    // In simulated time nobody is late.
    supervisor.outcome.late_ms = view.late_ms().filter(|_| supervisor.run.mode == Mode::RealTime);
    result.map(|()| std::mem::take(&mut supervisor.outcome))
}

struct Supervisor {
    children: Vec<(Process, Child)>,
    /// Killed and lost, but not gone yet.
    dying: Vec<(Process, Child)>,
    /// Processes without which the robot walks on.
    restarts: [(Process, Backoff); 2],
    pulse: Pulse,
    crashes: Crashes,
    /// Black boxes of the processes.
    memories: Vec<(Process, File)>,
    manager: Manager,
    course: Course,
    outcome: RunOutcome,
    console: Console,
    /// Timeout between processes in lockstep \[ns\].
    patience: u64,
    rt_required: bool,
    run: Run,
    space: Space,
    stop: Stop,
}

impl Supervisor {
    /// Starts the processes one after the other, in the order of `start_order`; each has built everything before the next begins.
    /// A longer wait for peers, `peer_timeout`, is a longer wait for their start, too.
    fn start(&mut self, setup: &Setup) -> Result<(), Box<dyn Error>> {
        let patience = START_PATIENCE.max(self.patience);
        for &process in &setup.system.start_order {
            let wanted = match process {
                Process::Logger => self.run.log.is_some(),
                Process::SimBackend => self.run.robot,
                _ => true,
            };
            if wanted {
                self.end_if_asked()?;
                self.spawn(process)?;
                self.wait_until_started(process, patience)?;
                self.compare(process, setup.hash)?;
            }
        }
        Ok(())
    }

    /// Nobody waits for a robot that is not there yet: who asks for the end while it starts has it at once.
    fn end_if_asked(&self) -> Result<(), Box<dyn Error>> {
        if self.stop.asked() { Err(EndedWhileStarting.into()) } else { Ok(()) }
    }

    fn spawn(&mut self, process: Process) -> Result<(), Box<dyn Error>> {
        let (feed, errors) = Feed::new()?;
        let memory = black_box::memory()?;
        // Before the child: what fails from here on leaves none behind that nobody looks after.
        feed.into_lines(self.console.clone())?;
        let mut child = Spawn::new(own_program());
        ENVIRONMENT.iter().for_each(|name| _ = child.env_remove(name));
        let child = child
            .arg(process.name())
            .arg("--run")
            .arg(&self.run.dir)
            .stdin(memory.try_clone()?)
            .stdout(Stdio::null())
            .stderr(errors)
            .process_group(0) // the terminal's Ctrl-C is the supervisor's to hear
            .spawn()?;
        self.children.push((process, child));
        self.memories.retain(|(p, _)| *p != process);
        self.memories.push((process, memory));
        Ok(())
    }

    fn wait_until_started(&mut self, process: Process, patience: u64) -> Result<(), Box<dyn Error>> {
        let mut events = self.space.reader::<Event>(topic("events", process)?)?;
        let begun = clock::now();
        while events.follow().is_none_or(|e| e.code != EventCode::Started as u64) {
            let child = self.children.last_mut().map(|(_, child)| child);
            if let Some(status) = child.and_then(|c| c.try_wait().ok().flatten()) {
                std::thread::park_timeout(LAST_WORDS);
                let name = process.name();
                return Err(format!("{name} did not start ({status}); its own message stands above").into());
            }
            if clock::now() - begun > patience {
                let seconds = patience / clock::SECOND;
                return Err(format!("{} did not start within {seconds} s", process.name()).into());
            }
            self.end_if_asked()?;
            std::thread::park_timeout(LOOK / 2);
        }
        Ok(())
    }

    /// A process that walks with another configuration than the others is not let near a robot; nor, if that is required, one
    /// without real time.
    fn compare(&self, process: Process, hash: u64) -> Result<(), Box<dyn Error>> {
        let Ok(topic) = topic("cycle_stats", process) else { return Ok(()) }; // reads none
        let mut stats = self.space.reader::<CycleStats>(topic)?;
        let stats = stats.latest();
        match stats.map(|stats| stats.config_hash) {
            Some(theirs) if theirs == hash && self.rt_required && stats.is_some_and(|s| s.degraded != 0) => {
                Err(format!(
                    "{} does not get the scheduling or the locked memory that it asks for, and --rt required is asked for: \
                     nothing was armed; `gangwerk doctor` says what is missing and how to get it",
                    process.name()
                )
                .into())
            }
            Some(theirs) if theirs == hash => Ok(()),
            theirs => Err(format!(
                "{} has another configuration (hash {:016x}) than the supervisor ({hash:016x}): nothing was armed; start \
                 all processes from one build",
                process.name(),
                theirs.unwrap_or(0)
            )
            .into()),
        }
    }

    /// Until the joint loop has done the scene, somebody asks to end, or the aftermath of a death is over.
    fn watch(&mut self, view: &mut View) -> Result<(), Box<dyn Error>> {
        let mut operator = broker::Client::start("supervisor", &[Domain::System], &self.space)?;
        // Whether the broker answers: a client that it has to answer anew. It takes what was published before it answers, and
        // this client subscribes to nothing, so that nobody counts it among those that a command reaches.
        let mut witness: Option<broker::Client> = None;
        let mut hearing = Hearing::new(&self.space, self.run.mode)?;
        let mut cleared = clock::now();
        self.manager.ready();
        loop {
            std::thread::park_timeout(LOOK);
            view.update();
            let now = clock::now();
            self.manager.look(now);
            let mut seen = CourseObservation { finished: self.bury(now), ..CourseObservation::default() };
            // A process that hangs is treated as one that died.
            hearing.listen(operator.statistics().connected);
            // The last records of a process are heard after its death.
            let Self { pulse, children, .. } = self;
            let alive = |p: Process| children.iter().any(|(child, _)| *child == p);
            if let Some((process, ns)) = pulse.look(now, |p| alive(p) && hearing.heard(p)) {
                let seen = self.kill(process);
                self.lose(process, Cause::Hung(ns), &seen, now);
            }
            self.restart(now);
            if now > cleared + CLEAR_EVERY {
                self.space.clear_dead();
                cleared = now;
            }
            let signal = self.stop.taken();
            self.outcome.interrupted |= signal;
            seen.asked = signal || operator.received().any(|c| c == Command::End);
            seen.finished |= self.outcome.lost.is_empty() && view.lies();
            seen.passed = witness.as_ref().is_some_and(|witness| witness.statistics().connected);
            seen.stands = view.standing();
            seen.robot_time = view.robot_time();
            match self.course.step(now, seen) {
                Act::GoOn => {}
                Act::Stand => {
                    self.manager.stopping();
                    view.ending.asked = true;
                    self.console.say(
                        "asked to end: the robot stops and stands first; once more: emergency stop, and the end at once",
                    );
                    operator.publish(&Command::Stop);
                    witness = broker::Client::start("supervisor-witness", &[], &self.space).ok();
                }
                Act::EndPlanner => {
                    self.console.say("the broker does not pass the stop on: the planner is ended, its plan walked to its end");
                    self.terminate(|p| p == Process::Planner);
                }
                Act::EmergencyStop => {
                    for line in crate::estop::report(&crate::estop::stop_own(&self.run.dir)) {
                        self.console.say(line);
                    }
                    view.ending.unfinished = true;
                    return Ok(());
                }
                Act::Finish => {
                    view.ending.unfinished |= view.ending.asked && !view.standing();
                    return Ok(());
                }
            }
        }
    }

    /// Takes note of children that have ended since the last look; whether the run is finished with that.
    fn bury(&mut self, now: u64) -> bool {
        let mut finished = false;
        for (process, status) in self.ended() {
            if status.success() && (process == Process::Lowlevel || self.course.is_ending(process)) {
                finished |= process != Process::Planner;
            } else {
                self.find_stopped(now);
                self.lose(process, Cause::Died(status), "", now);
            }
        }
        finished
    }

    /// In lockstep who waits in vain gives up, and may not know for whom everybody waits: it is a process that was stopped.
    fn find_stopped(&mut self, now: u64) {
        if self.run.mode == Mode::RealTime {
            return;
        }
        let stopped =
            self.children.iter().find(|(_, child)| is_stopped(child.id())).map(|(process, _)| *process);
        if let Some(process) = stopped {
            let seen = self.kill(process);
            self.lose(process, Cause::Hung(self.patience), &seen, now);
        }
    }

    /// Children that have ended since the last look.
    fn ended(&mut self) -> Vec<(Process, ExitStatus)> {
        let mut ended = Vec::new();
        self.dying.retain_mut(|(_, child)| !is_gone(child));
        self.children.retain_mut(|(process, child)| match child.try_wait() {
            Ok(Some(status)) => {
                ended.push((*process, status));
                false
            }
            _ => true,
        });
        ended
    }

    fn lose(&mut self, process: Process, cause: Cause, seen: &str, now: u64) {
        self.console.say(format!("{} {cause}", process.name()));
        if let Some((_, memory)) = self.memories.iter().find(|(p, _)| *p == process) {
            self.crashes.save(memory, process, &cause, seen);
        }
        self.outcome.lost.push((process, cause));
        self.pulse.forget(process);
        self.course.lost(process, now);
        self.back_off(process, now);
    }

    /// A process without which the robot walks on is started again later, or is left dead.
    fn back_off(&mut self, process: Process, now: u64) {
        let Some((_, backoff)) = self.restarts.iter_mut().find(|(p, _)| *p == process) else { return };
        let text = match backoff.died(now) {
            Some(pause) => format!("is started again in {:.1} s", pause as f64 / clock::SECOND as f64),
            None => "is not started again: it died too often".into(),
        };
        self.console.say(format!("{} {text}; the robot goes on", process.name()));
    }

    /// Starts again whose pause is over. A machine that has no room for it at the moment is no reason to end a walk.
    fn restart(&mut self, now: u64) {
        for i in 0..self.restarts.len() {
            let process = self.restarts[i].0;
            // One that is not gone yet keeps its place.
            if self.dying.iter().any(|(p, _)| *p == process) || !self.restarts[i].1.is_due(now) {
                continue;
            }
            // Its ports would be in the way of its successor's.
            self.space.clear_dead();
            if let Err(error) = self.spawn(process) {
                self.console.say(format!("{} does not start: {error}", process.name()));
                self.back_off(process, now);
            }
        }
    }

    /// Ends a process that hangs; returns what was to be seen of it. Unless it is stopped, it may first say where it is.
    fn kill(&mut self, process: Process) -> String {
        let Some(i) = self.children.iter().position(|(p, _)| *p == process) else { return String::new() };
        let (process, mut child) = self.children.remove(i);
        let seen = crash::look(child.id());
        if !is_stopped(child.id()) {
            realtime::last_words::abort(child.id());
            ends_within(&mut child, FAREWELL);
        }
        let _ = child.kill();
        if !ends_within(&mut child, DEATH_PATIENCE) {
            self.dying.push((process, child));
        }
        seen
    }

    /// Asks those to end.
    fn terminate(&self, which: impl Fn(Process) -> bool) {
        self.children
            .iter()
            .filter(|(p, _)| which(*p))
            .for_each(|(_, child)| realtime::terminate(child.id()));
    }

    /// Ends all processes: the joint loop first, so that the watchdog cuts the supply; the logger last.
    fn end(&mut self) {
        let turn_of = |p: Process| match p {
            Process::Lowlevel => 0,
            Process::Logger => 2,
            _ => 1,
        };
        for turn in 0..3 {
            self.terminate(|p| turn_of(p) == turn);
            let begun = clock::now();
            for (process, child) in self.children.iter_mut().filter(|(p, _)| turn_of(*p) == turn) {
                let left = (begun + END_PATIENCE).saturating_sub(clock::now());
                if !ends_within(child, left) {
                    let _ = child.kill();
                    if !ends_within(child, END_PATIENCE) {
                        self.console
                            .say(format!("{} was killed and is not gone: it is left behind", process.name()));
                    }
                }
                let status = child.try_wait().ok().flatten();
                let failed = *process == Process::Logger && status.is_none_or(|s| !s.success());
                self.outcome.log_broken |= failed;
            }
            if turn == 0 {
                // The watchdog sees the silence and the robot its power line: a few cycles for the log.
                std::thread::park_timeout(LAST_WORDS);
            }
        }
        self.children.clear();
        self.crashes.finish(END_PATIENCE);
    }
}

/// This program. One that was removed or replaced since has no name any more, but the kernel still has it.
fn own_program() -> PathBuf {
    std::env::current_exe().ok().filter(|path| path.exists()).unwrap_or_else(|| "/proc/self/exe".into())
}

/// True of a child that has ended, or cannot be waited for.
fn is_gone(child: &mut Child) -> bool {
    !matches!(child.try_wait(), Ok(None))
}

/// Waits for the end of a child, at most so long \[ns\]; whether it is gone.
fn ends_within(child: &mut Child, patience: u64) -> bool {
    let until = clock::now() + patience;
    while !is_gone(child) {
        if clock::now() > until {
            return false;
        }
        std::thread::park_timeout(LOOK / 5);
    }
    true
}

/// Whether the process was stopped by a signal, as /proc says.
fn is_stopped(pid: u32) -> bool {
    let status = std::fs::read_to_string(format!("/proc/{pid}/stat")).unwrap_or_default();
    // The name before the state may hold anything, parentheses too.
    status.rsplit_once(") ").is_some_and(|(_, rest)| rest.starts_with(['T', 't']))
}

impl Drop for Supervisor {
    fn drop(&mut self) {
        self.end();
    }
}

/// The topic `prefix/PROCESS`.
fn topic(prefix: &str, process: Process) -> Result<&'static Topic, String> {
    let name = format!("{prefix}/{}", process.name());
    Topic::find(&name).ok_or_else(|| format!("there is no topic {name}"))
}
