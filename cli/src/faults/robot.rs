//! One run of a robot that is to be hurt, and everything that is seen of it: records, not what it prints.

use config::Setup;
use harness::{Running, Said, Site, doze};
use ipc::{Reader, Space};
use messages::topics::{
    CONTROLLER_STATE, JOINT_TARGETS, POWER, SIM_STATE, STATS_LOWLEVEL, STATS_SIM_BACKEND, STATS_WATCHDOG,
};
use messages::{
    ControllerState, CycleStats, Event, EventCode, GaitState, JointTargets, MAX_JOINTS, Power, Process,
    SimState, Topic,
};
use realtime::clock;

/// \[rad/s\] Joints slower than this are at rest.
const REST: f64 = 1e-3;
/// \[cycle\] For so long they must be, to be at rest.
const RESTED: usize = 100;
/// \[s\] In which every run that is to end has ended: a last plan and what comes after it.
const LONGEST_END: f64 = 25.0;
/// \[s\] Between two looks: far less than what the rings hold.
const LOOK: f64 = 0.002;

/// A robot at work, and what was seen.
pub(super) struct RobotUnderTest {
    pub(super) run: Running,
    pub(super) site: Site,
    pub(super) setup: Setup,
    space: Space,
    readers: Readers,
    pub(super) sims: Vec<SimState>,
    pub(super) powers: Vec<Power>,
    pub(super) events: Vec<(Process, Event)>,
    /// Tick and gait.
    gaits: Vec<(u64, GaitState)>,
    /// Tick of the newest targets.
    pub(super) targets: u64,
    /// Place in `sims`, and wall time \[ns\], of the fault.
    at: usize,
    since: u64,
}

struct Readers {
    sim: Reader<SimState>,
    power: Reader<Power>,
    state: Reader<ControllerState>,
    targets: Reader<JointTargets>,
    events: Vec<(Process, Reader<Event>)>,
    stats: [Reader<CycleStats>; 3],
}

impl Readers {
    fn new(space: &Space) -> Result<Self, ipc::IpcError> {
        let events = |p: Process| {
            let topic = Topic::find(&format!("events/{}", p.name()))?;
            Some(space.reader(topic).map(|reader| (p, reader)))
        };
        Ok(Self {
            sim: space.reader(&SIM_STATE)?,
            power: space.reader(&POWER)?,
            state: space.reader(&CONTROLLER_STATE)?,
            targets: space.reader(&JOINT_TARGETS)?,
            events: Process::ALL.into_iter().filter_map(events).collect::<Result<_, _>>()?,
            stats: [
                space.reader(&STATS_WATCHDOG)?,
                space.reader(&STATS_SIM_BACKEND)?,
                space.reader(&STATS_LOWLEVEL)?,
            ],
        })
    }
}

impl RobotUnderTest {
    /// Starts a scene at a site.
    pub(super) fn start(site: Site, tables: &str, more: &[&str]) -> Result<Self, String> {
        site.scene("fault", 600.0, tables);
        let run = site.run("fault", more);
        Self::of(site, run)
    }

    /// Processes started at a site.
    pub(super) fn of(site: Site, mut run: Running) -> Result<Self, String> {
        let setup = Setup::load(&site.config(""), "fault").map_err(|e| e.to_string())?;
        let space = run.try_space()?;
        let readers = Readers::new(&space).map_err(|e| e.to_string())?;
        Ok(Self {
            run,
            site,
            setup,
            space,
            readers,
            sims: Vec::with_capacity(20_000),
            powers: Vec::with_capacity(20_000),
            events: Vec::new(),
            gaits: Vec::with_capacity(20_000),
            targets: 0,
            at: 0,
            since: clock::now(),
        })
    }

    /// Takes what was written since the last look.
    pub(super) fn look(&mut self) {
        let Readers { sim, power, state, targets, events, .. } = &mut self.readers;
        while let Some(s) = sim.follow() {
            self.sims.push(*s);
        }
        while let Some(p) = power.follow() {
            self.powers.push(*p);
        }
        while let Some(s) = state.follow() {
            self.gaits.push((s.header.tick, GaitState::from(s.gait)));
        }
        while let Some(t) = targets.follow() {
            self.targets = t.header.tick;
        }
        for (process, reader) in events {
            while let Some(event) = reader.follow() {
                self.events.push((*process, *event));
            }
        }
    }

    /// Looks until `done`, for this long \[s\] at most, or until the run ends; whether it was.
    pub(super) fn wait(&mut self, seconds: f64, done: impl Fn(&Self) -> bool) -> bool {
        let late = clock::now() + (seconds * 1e9) as u64;
        loop {
            self.look();
            if done(self) {
                return true;
            }
            if clock::now() > late || !self.run.is_alive() {
                return false;
            }
            doze(LOOK);
        }
    }

    /// Looks for so long \[s\].
    pub(super) fn watch(&mut self, seconds: f64) {
        self.wait(seconds, |_| false);
    }

    /// Simulated time \[s\].
    pub(super) fn time(&self) -> f64 {
        self.sims.last().map_or(0.0, |s| s.time)
    }

    /// Waits for this simulated time; the robot must walk then if it is told to.
    pub(super) fn until(&mut self, time: f64) -> Result<(), String> {
        let reached = self.wait(60.0, |robot| robot.time() >= time);
        if reached { Ok(()) } else { Err(format!("did not come to {time} s: {}", self.run.err())) }
    }

    /// The fault is done now.
    pub(super) fn mark(&mut self) {
        self.look();
        (self.at, self.since) = (self.sims.len(), clock::now());
    }

    /// The fault was done at this simulated time \[s\].
    pub(super) fn mark_at(&mut self, time: f64) {
        self.mark();
        self.at = self.sims.iter().position(|s| s.time >= time).unwrap_or(self.sims.len());
    }

    /// \[ms\] Of wall time since the fault.
    pub(super) fn wall_ms(&self) -> f64 {
        (clock::now() - self.since) as f64 * 1e-6
    }

    /// Tick of the last cycle before the fault.
    pub(super) fn tick(&self) -> u64 {
        self.at.checked_sub(1).map_or(0, |i| self.sims[i].header.tick)
    }

    /// Cycles of the robot since the fault.
    pub(super) fn after(&self) -> &[SimState] {
        &self.sims[self.at.min(self.sims.len())..]
    }

    /// Cycles from the fault to this record, by the robot's time: records may have been missed.
    fn cycles(&self, state: &SimState) -> u64 {
        let before = self.sims[..self.at.min(self.sims.len())].last().map_or(state.time, |s| s.time);
        ((state.time - before) / self.setup.scene.cycle).round() as u64
    }

    /// First cycle without supply after the fault.
    pub(super) fn power_off(&self) -> Option<u64> {
        self.after().iter().find(|s| s.power == 0).map(|s| self.cycles(s))
    }

    /// Whether it has fallen since the fault.
    pub(super) fn fell(&self) -> bool {
        self.after().iter().any(|s| s.fallen == 1)
    }

    /// Fastest joint between two cycles \[rad/s\].
    fn speed(w: &[SimState]) -> f64 {
        let dt = (w[1].time - w[0].time).max(1e-3);
        (0..MAX_JOINTS).map(|j| (w[1].joint_angle[j] - w[0].joint_angle[j]).abs() / dt).fold(0.0, f64::max)
    }

    /// Cycle after the fault from which all joints stay at rest.
    pub(super) fn at_rest(&self) -> Option<u64> {
        let after = self.after();
        let first = after.windows(2).rposition(|w| Self::speed(w) > REST).map_or(0, |i| i + 1);
        (first + RESTED < after.len()).then(|| self.cycles(&after[first]))
    }

    /// The first event of this kind since the fault, in cycles.
    pub(super) fn told(&self, process: Process, code: EventCode) -> Option<u64> {
        let is = |e: &&(Process, Event)| {
            e.0 == process && e.1.code == code as u64 && e.1.header.tick >= self.tick()
        };
        self.events.iter().find(is).map(|(_, e)| e.header.tick - self.tick())
    }

    /// The newest gait.
    pub(super) fn gait(&self) -> GaitState {
        self.gaits.last().map_or(GaitState::from(0), |(_, gait)| *gait)
    }

    /// The gait when the supply went off, or now if it is on.
    pub(super) fn last_gait(&self) -> GaitState {
        let off = self.after().iter().find(|s| s.power == 0).map_or(u64::MAX, |s| s.header.tick);
        self.gaits.iter().rev().find(|(tick, _)| *tick < off).map_or(GaitState::from(0), |(_, gait)| *gait)
    }

    /// Reason why a robot that should walk on does not.
    pub(super) fn walks_on(&self) -> Option<&'static str> {
        let after = self.after();
        let way = after.last().map_or(0.0, |s| s.position[0]) - after.first().map_or(0.0, |s| s.position[0]);
        if self.fell() {
            Some("fell")
        } else if self.power_off().is_some() {
            Some("lost its supply")
        } else if self.gait() != GaitState::Walking || way <= 0.0 {
            Some("does not walk any more")
        } else {
            None
        }
    }

    /// Cycles and skips that were late, of watchdog, simulated robot and joint loop.
    pub(super) fn late_cycles(&mut self) -> [u64; 3] {
        self.readers.stats.each_mut().map(|r| r.latest().map_or(0, |s| s.overruns + s.skipped))
    }

    /// Disturbance from outside that spoilt the run; none: the observation is the robot's own.
    pub(super) fn disturbance(&mut self) -> Option<String> {
        if self.sims[..self.at].last().is_some_and(|s| s.fallen == 1 || s.power == 0) {
            return Some("did not walk any more before the fault".into());
        }
        let before =
            |e: &&(Process, Event)| e.1.code == EventCode::Overrun as u64 && e.1.header.tick <= self.tick();
        if let Some((process, e)) = self.events.iter().find(before) {
            return Some(format!("{} missed {} cycles before", process.name(), e.detail));
        }
        let lost = self.readers.sim.lost() + self.readers.power.lost();
        if lost > 0 {
            return Some(format!("the observer was {lost} records too slow"));
        }
        let [watchdog, sim, _] = self.late_cycles();
        (watchdog + sim > 0).then(|| format!("watchdog {watchdog}, simulated robot {sim} cycles too late"))
    }

    /// Looks until the run has ended; what it said.
    pub(super) fn end(mut self, look: impl FnOnce(&mut Self)) -> Result<Said, String> {
        self.wait(LONGEST_END, |_| false);
        if self.run.is_alive() {
            return Err(format!("did not end within {LONGEST_END} s: {}", self.run.err()));
        }
        look(&mut self);
        let Self { run, space, readers, .. } = self;
        drop((readers, space));
        run.try_end()
    }

    /// Whether the joint loop says that it lacks rights.
    pub(super) fn degraded(&mut self) -> bool {
        self.readers.stats[2].latest().is_some_and(|s| s.degraded == 1)
    }

    /// Lets go of everything but the place.
    pub(super) fn into_site(self) -> Site {
        self.site
    }

    /// A command from an operator.
    pub(super) fn publish(&self, arguments: &[&str]) -> Result<Said, String> {
        let dir = self.site.run_dir().display().to_string();
        self.site.start(&[&["topic", "pub"], arguments, &["--dir", &dir]].concat()).try_end()
    }

    /// Process id in a lock file of the run.
    pub(super) fn pid(&self, process: Process) -> Option<u32> {
        let path = self.site.run_dir().join(format!("{}.lock", process.name()));
        std::fs::read_to_string(path).ok()?.trim().parse().ok()
    }
}
