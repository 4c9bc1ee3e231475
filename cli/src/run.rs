//! `gangwerk run SCENE`: every process of the chain, started, watched and ended.

use std::error::Error;
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::{Path, PathBuf};
use std::process::{Child, Command as Spawn, ExitStatus, Stdio};
use std::time::Duration;

use config::Setup;
use config::tolerance::Method;
use drives::cia402::Fault;
use fieldbus::Address;
use indicatif::{ProgressBar, ProgressStyle};
use ipc::{Mode, Reader, Run, Space};
use messages::command::Domain;
use messages::topics::{CONTROLLER_STATE, SENSORS, SIM_STATE, Topic};
use messages::{Command, ControllerState, Event, EventCode, GaitState, Process, Sensors, SimState, StartUp};
use realtime::{Stop, clock};

use crate::figures::{Figures, Gatherer};

/// What to run and how.
#[derive(Clone, Debug)]
pub struct Order {
    /// Lockstep or real time.
    pub mode: Mode,
    /// Name of the scene.
    pub scene: String,
    /// How it is simulated, if it leaves that open: [`crate::choose`].
    pub method: Option<Method>,
    /// The configuration directory.
    pub config: PathBuf,
    /// The field bus.
    pub bus: Address,
    /// Whether a simulated robot is put at its far end.
    pub robot: bool,
    /// The run directory.
    pub dir: PathBuf,
    /// Where the log goes; none: no log.
    pub log: Option<PathBuf>,
    /// Whether progress is shown on the terminal.
    pub progress: bool,
}

/// How a run ended.
#[derive(Debug)]
pub struct Outcome {
    /// Processes that died before their time, and how.
    pub died: Vec<(Process, ExitStatus)>,
    /// Whether somebody asked for the end.
    pub interrupted: bool,
}

/// Between two looks at the processes.
const LOOK: Duration = Duration::from_millis(10);
/// A process that has not reported within this time after its start does not start any more.
const START_PATIENCE: u64 = 20 * clock::SECOND;
/// After the death of a process of the chain the run goes on this long, so that the log shows what the robot did.
const AFTERMATH: u64 = 3 * clock::SECOND;
/// After the death of the planner: its last plan is walked to its end, up to seven steps and the time to come to rest.
const LAST_PLAN: u64 = 12 * clock::SECOND;
/// A process that was asked to end gets this long.
const END_PATIENCE: u64 = 5 * clock::SECOND;
/// After a first request to end the robot gets this long to come to a stand.
const STAND_PATIENCE: u64 = 8 * clock::SECOND;

/// Runs a scene with all its processes.
///
/// # Errors
/// The configuration is wrong, another run uses the directory, or a process does not start.
pub fn run(order: &Order) -> Result<Outcome, Box<dyn Error>> {
    let setup = Setup::load(&order.config, &order.scene)?.with_method(order.method)?;
    multibody_check(&setup)?;
    let stop = Stop::on_signals()?;
    let space = Space::create(&order.dir)?;
    let run = Run {
        dir: order.dir.clone(),
        mode: order.mode,
        scene: order.scene.clone(),
        method: order.method.map(|method| method.to_string()),
        config: order.config.clone(),
        bus: order.bus.to_string(),
        robot: order.robot,
        log: order.log.clone(),
    };
    run.save()?;
    let mut supervisor = Supervisor { children: Vec::new(), space, order: order.clone(), stop };
    let result = supervisor.start(setup.system.peer_timeout).and_then(|()| supervisor.watch(&setup));
    supervisor.end();
    result
}

/// Builds what every process will build, so that a wrong robot is one error and not seven.
fn multibody_check(setup: &Setup) -> Result<(), Box<dyn Error>> {
    sim_backend::SimBackend::new(&setup.robot, &setup.scene)?;
    Ok(())
}

struct Supervisor {
    children: Vec<(Process, Child)>,
    space: Space,
    order: Order,
    stop: Stop,
}

impl Supervisor {
    /// Starts the processes one after the other; each has built everything before the next begins. Who waits longer for
    /// peers, `peer_timeout` \[s\], waits longer for their start, too.
    fn start(&mut self, peer_timeout: f64) -> Result<(), Box<dyn Error>> {
        for process in Process::ALL {
            let wanted = match process {
                Process::Logger => self.order.log.is_some(),
                Process::SimBackend => self.order.robot,
                _ => true,
            };
            if !wanted {
                continue;
            }
            let child = Spawn::new(std::env::current_exe()?)
                .arg(process.name())
                .arg("--run")
                .arg(&self.order.dir)
                .stdin(Stdio::null())
                .stdout(Stdio::null())
                .process_group(0) // the terminal's Ctrl-C is the supervisor's to hear
                .spawn()?;
            self.children.push((process, child));
            self.wait_until_started(process, START_PATIENCE.max((peer_timeout * 1e9) as u64))?;
        }
        Ok(())
    }

    fn wait_until_started(&mut self, process: Process, patience: u64) -> Result<(), Box<dyn Error>> {
        let mut events = self.events(process)?;
        let begun = clock::now();
        while events.follow().is_none_or(|e| e.code != EventCode::Started as u64) {
            let child = self.children.last_mut().map(|(_, child)| child);
            if let Some(status) = child.and_then(|c| c.try_wait().ok().flatten()) {
                return Err(format!(
                    "{} did not start ({status}); its own message stands above",
                    process.name()
                )
                .into());
            }
            if clock::now() - begun > patience {
                let seconds = patience / clock::SECOND;
                return Err(format!("{} did not start within {seconds} s", process.name()).into());
            }
            std::thread::park_timeout(LOOK / 2);
        }
        Ok(())
    }

    fn events(&self, process: Process) -> Result<Reader<Event>, Box<dyn Error>> {
        let name = format!("events/{}", process.name());
        let topic = Topic::find(&name).ok_or_else(|| format!("there is no topic {name}"))?;
        Ok(self.space.reader(topic)?)
    }

    /// Until the joint loop has done the scene, somebody asks to end, or the aftermath of a death is over.
    fn watch(&mut self, setup: &Setup) -> Result<Outcome, Box<dyn Error>> {
        let mut outcome = Outcome { died: Vec::new(), interrupted: false };
        let mut view = View::new(self, setup)?;
        let mut operator = broker::Client::start("supervisor", &[Domain::System], &self.space)?;
        let (mut end_at, mut asked_at) = (None, None);
        loop {
            std::thread::park_timeout(LOOK);
            view.update();
            for (process, status) in self.ended() {
                let finished = process == Process::Lowlevel && status.success();
                if finished || end_at.is_some() && status.success() {
                    return Ok(outcome);
                }
                view.say(&format!("{} died: {status}", process.name()));
                outcome.died.push((process, status));
                if !matches!(process, Process::Broker | Process::Logger) {
                    let aftermath = if process == Process::Planner { LAST_PLAN } else { AFTERMATH };
                    end_at.get_or_insert(clock::now() + aftermath);
                }
            }
            if end_at.is_some_and(|t| clock::now() > t) {
                return Ok(outcome);
            }
            let asked = self.stop.taken() || operator.received().any(|c| c == Command::End);
            if asked && asked_at.is_none() {
                asked_at = Some(clock::now());
                outcome.interrupted = true;
                view.say("asked to end: the robot stops and stands first; once more ends at once");
                operator.publish(&Command::Stop);
                continue;
            }
            let stands = asked_at.is_some() && view.standing();
            if asked || stands || asked_at.is_some_and(|t| clock::now() > t + STAND_PATIENCE) {
                return Ok(outcome);
            }
        }
    }

    /// Children that have ended since the last look.
    fn ended(&mut self) -> Vec<(Process, ExitStatus)> {
        let mut ended = Vec::new();
        self.children.retain_mut(|(process, child)| match child.try_wait() {
            Ok(Some(status)) => {
                ended.push((*process, status));
                false
            }
            _ => true,
        });
        ended
    }

    /// Ends all processes: the joint loop first, so that the watchdog cuts the supply; the logger last.
    fn end(&mut self) {
        let order = |p: Process| match p {
            Process::Lowlevel => 0,
            Process::Logger => 2,
            _ => 1,
        };
        for turn in 0..3 {
            let now: Vec<usize> =
                (0..self.children.len()).filter(|&i| order(self.children[i].0) == turn).collect();
            for &i in &now {
                terminate(&self.children[i].1);
            }
            let begun = clock::now();
            for &i in &now {
                let child = &mut self.children[i].1;
                while child.try_wait().is_ok_and(|s| s.is_none()) {
                    if clock::now() - begun > END_PATIENCE {
                        let _ = child.kill();
                    }
                    std::thread::park_timeout(LOOK / 5);
                }
            }
            if turn == 0 {
                // The watchdog sees the silence and the robot its power line: a few cycles for the log.
                std::thread::park_timeout(Duration::from_millis(50));
            }
        }
        self.children.clear();
    }
}

impl Drop for Supervisor {
    fn drop(&mut self) {
        self.end();
    }
}

fn terminate(child: &Child) {
    realtime::terminate(child.id());
}

/// What the operator sees.
struct View {
    state: Reader<ControllerState>,
    sim: Reader<SimState>,
    sensors: Reader<Sensors>,
    events: Vec<(Process, Reader<Event>)>,
    joints: Vec<String>,
    start_up: StartUp,
    bar: ProgressBar,
    gait: GaitState,
}

impl View {
    fn new(s: &Supervisor, setup: &Setup) -> Result<Self, Box<dyn Error>> {
        let bar = if s.order.progress {
            ProgressBar::new((setup.scene.duration * 10.0) as u64)
        } else {
            ProgressBar::hidden()
        };
        let style = "{elapsed:>4} {wide_bar} {msg}";
        bar.set_style(ProgressStyle::with_template(style)?);
        let events =
            Process::ALL.into_iter().map(|p| Ok((p, s.events(p)?))).collect::<Result<_, Box<dyn Error>>>()?;
        let state = s.space.reader(&CONTROLLER_STATE)?;
        let joints = setup.robot.joints.iter().map(|joint| joint.name.clone()).collect();
        let (sim, sensors) = (s.space.reader(&SIM_STATE)?, s.space.reader(&SENSORS)?);
        let (start_up, gait) = (StartUp::Off, GaitState::Idle);
        Ok(Self { state, sim, sensors, events, joints, start_up, bar, gait })
    }

    fn say(&self, text: &str) {
        if self.bar.is_hidden() {
            eprintln!("{text}");
        } else {
            self.bar.println(text);
        }
    }

    fn standing(&mut self) -> bool {
        self.state
            .latest()
            .is_none_or(|s| matches!(GaitState::from(s.gait), GaitState::Standing | GaitState::Idle))
    }

    fn update(&mut self) {
        self.tell_events();
        self.tell_start_up();
        let Some(sim) = self.sim.latest() else { return };
        let (t, [x, y, _]) = (sim.time, sim.position);
        self.bar.set_position((t * 10.0) as u64);
        if let Some(state) = self.state.latest() {
            let gait = GaitState::from(state.gait);
            let [ex, ey] = state.inclination_error;
            self.bar.set_message(format!(
                "{t:5.1} s  {gait:?}  x {x:5.2} m  y {y:5.2} m  tilt {:4.1} mrad",
                1e3 * ex.hypot(ey)
            ));
            if gait != self.gait {
                self.gait = gait;
                self.say(&format!("{t:7.3} s  {gait:?}"));
            }
        }
    }

    /// Where the start-up is, and what the operator does next.
    fn tell_start_up(&mut self) {
        let Some(sensors) = self.sensors.latest() else { return };
        let (now, tick) = (StartUp::from_number(sensors.start_up), sensors.header.tick);
        if self.start_up != now {
            self.start_up = now;
            self.say(&format!("tick {tick:6}  {}", now.advice()));
        }
    }

    /// Everything that is no routine.
    fn tell_events(&mut self) {
        let mut lines = Vec::new();
        for (process, events) in &mut self.events {
            while let Some(e) = events.follow() {
                let code = EventCode::from_number(e.code).unwrap_or(EventCode::None);
                if !matches!(code, EventCode::Started | EventCode::Ended | EventCode::PlanActive) {
                    let detail = match code {
                        EventCode::PowerOff | EventCode::SafeStop => {
                            format!("{:?}", EventCode::from_number(e.detail).unwrap_or(EventCode::None))
                        }
                        EventCode::DriveTripped | EventCode::DriveHeld => {
                            let (joint, error) =
                                (self.joints.get((e.detail & 0xFFFF) as usize), e.detail >> 16);
                            let text = Fault::from_code(error as u16).map_or("", Fault::text);
                            format!("{}: error {error:#06x} {text}", joint.map_or("?", String::as_str))
                        }
                        EventCode::NotHomed | EventCode::DriveNotEnabled => {
                            self.joints.get(e.detail as usize).cloned().unwrap_or_default()
                        }
                        _ => e.detail.to_string(),
                    };
                    lines.push(format!("tick {:6}  {}: {code:?} ({detail})", e.header.tick, process.name()));
                }
            }
        }
        lines.iter().for_each(|line| self.say(line));
    }
}

/// The figures of a log.
///
/// # Errors
/// The log cannot be read.
pub fn figures_of(log: &Path, setup: &Setup) -> Result<Figures, Box<dyn Error>> {
    let file = recording::Log::open(log)?;
    let states = file.records::<ControllerState>(&CONTROLLER_STATE)?;
    let sims = file.records::<SimState>(&SIM_STATE)?;
    let mut gatherer = Gatherer::default();
    let mut sims = sims.iter().peekable();
    for state in &states {
        while sims.next_if(|s| s.header.tick < state.header.tick).is_some() {}
        if let Some(sim) = sims.next_if(|s| s.header.tick == state.header.tick) {
            gatherer.add(sim, state);
        }
    }
    Ok(gatherer.figures(setup, 0.0, Some(log.display().to_string())))
}

/// A signal's name for the summary.
pub fn how_it_died(status: &ExitStatus) -> String {
    status.signal().map_or_else(|| status.to_string(), |n| format!("signal {n}"))
}
