//! SIGKILL to one process after the other while Lola walks in real time: what the robot does, and how soon.
//!
//! Everything is judged by what the processes wrote, cycle by cycle; wall time is only shown. On a machine without
//! real-time guarantees a run can be disturbed from outside. Then, and only then, it is done again, and the table says so.

use config::Setup;
use harness::{Site, doze};
use ipc::{Reader, Space};
use messages::topics::{
    CONTROLLER_STATE, JOINT_TARGETS, POWER, SIM_STATE, STATS_SIM_BACKEND, STATS_WATCHDOG,
};
use messages::{
    ControllerState, CycleStats, Event, EventCode, GaitState, JointTargets, MAX_JOINTS, Power, Process,
    Record, SimState, Topic,
};
use realtime::clock;
use recording::{Log, LogEnd};
use std::fmt::Write;

const EXE: &str = harness::executable!();

const SCENE: &str = "
[[command]]
time = 0.2
topic = \"walk/stand\"
[[command]]
time = 2.4
topic = \"walk/velocity\"
forward = 0.278
[[command]]
time = 5.2
topic = \"walk/stop\"
";
/// \[s\] Length of the scene, and when the process dies: the robot swings a leg.
const SECONDS: f64 = 13.0;
const DEATH: f64 = 4.9;
/// Runs of one scenario that may be spoilt from outside.
const ATTEMPTS: u32 = 3;
/// \[rad/s\] Joints slower than this are at rest.
const REST: f64 = 1e-3;

/// All records of a topic, in order.
struct Track<T: Record> {
    reader: Reader<T>,
    all: Vec<T>,
}

impl<T: Record> Track<T> {
    fn new(space: &Space, topic: &Topic) -> Self {
        Self { reader: space.reader(topic).unwrap(), all: Vec::with_capacity(16_000) }
    }

    fn follow(&mut self) {
        while let Some(record) = self.reader.follow() {
            self.all.push(*record);
        }
    }
}

/// A run as an observer sees it.
struct Observer {
    sim: Track<SimState>,
    power: Track<Power>,
    targets: Track<JointTargets>,
    state: Track<ControllerState>,
    events: Vec<(Process, Track<Event>)>,
    /// Of the watchdog and the simulated robot: their cycles are what the limits are counted in.
    stats: [Track<CycleStats>; 2],
}

impl Observer {
    fn new(space: &Space) -> Self {
        let events =
            |p: Process| (p, Track::new(space, Topic::find(&format!("events/{}", p.name())).unwrap()));
        Self {
            sim: Track::new(space, &SIM_STATE),
            power: Track::new(space, &POWER),
            targets: Track::new(space, &JOINT_TARGETS),
            state: Track::new(space, &CONTROLLER_STATE),
            events: Process::ALL.map(events).into(),
            stats: [Track::new(space, &STATS_WATCHDOG), Track::new(space, &STATS_SIM_BACKEND)],
        }
    }

    fn look(&mut self) {
        self.sim.follow();
        self.power.follow();
        self.targets.follow();
        self.state.follow();
        self.events.iter_mut().for_each(|(_, track)| track.follow());
        self.stats.iter_mut().for_each(Track::follow);
    }

    fn time(&self) -> f64 {
        self.sim.all.last().map_or(0.0, |s| s.time)
    }

    /// Records that this observer was too slow for.
    fn lost(&self) -> u64 {
        let Self { sim, power, targets, state, .. } = self;
        sim.reader.lost() + power.reader.lost() + targets.reader.lost() + state.reader.lost()
    }

    fn has(&self, process: Process, code: EventCode) -> Option<Event> {
        let (_, track) = self.events.iter().find(|(p, _)| *p == process)?;
        track.all.iter().find(|e| e.code == code as u64).copied()
    }
}

/// One run in which `victim` was killed.
struct Evidence {
    victim: Process,
    seen: Observer,
    /// Simulated cycles when the signal was sent.
    at: usize,
    /// \[ms\] Wall time from the signal until the supply was seen off.
    wall_off: Option<f64>,
    /// Output and exit of the run.
    said: harness::Said,
    log: std::path::PathBuf,
    _site: Site,
}

fn kill(victim: Process) -> Evidence {
    let site = Site::new(EXE);
    site.scene("kill", SECONDS, SCENE);
    let mut run = site.run("kill", &[]);
    let mut seen = Observer::new(&run.space());
    while seen.time() < DEATH && run.is_alive() {
        seen.look();
        doze(0.002);
    }
    seen.look();
    let at = seen.sim.all.len();
    let (signalled, mut wall_off) = (clock::now(), None);
    run.kill(victim);
    while run.is_alive() {
        seen.look();
        if wall_off.is_none() && seen.sim.all[at..].iter().any(|s| s.power == 0) {
            wall_off = Some((clock::now() - signalled) as f64 * 1e-6);
        }
        doze(if wall_off.is_none() { 0.0005 } else { 0.005 });
    }
    let said = run.end();
    Evidence { victim, seen, at, wall_off, said, log: site.path("kill.mcap"), _site: site }
}

impl Evidence {
    /// Cycles from the death until shortly before the run ends, which cuts the supply too.
    fn after(&self) -> &[SimState] {
        let all = &self.seen.sim.all[self.at..];
        &all[..all.len().saturating_sub(500)]
    }

    /// First cycle after the death without motor supply \[cycles\].
    fn power_off(&self) -> Option<usize> {
        self.after().iter().position(|s| s.power == 0)
    }

    /// Fastest joint between two cycles \[rad/s\].
    fn speed(a: &SimState, b: &SimState) -> f64 {
        let dt = (b.time - a.time).max(1e-3);
        (0..MAX_JOINTS).map(|j| (b.joint_angle[j] - a.joint_angle[j]).abs() / dt).fold(0.0, f64::max)
    }

    /// Cycle from which all joints stay at rest.
    fn at_rest(&self) -> Option<usize> {
        let after = self.after();
        let moving = after.windows(2).rposition(|w| Self::speed(&w[0], &w[1]) > REST);
        let first = moving.map_or(0, |i| i + 1);
        (first + 100 < after.len()).then_some(first)
    }

    fn fell(&self) -> bool {
        self.after().iter().any(|s| s.fallen == 1)
    }

    /// What spoilt the run from outside; none: what the robot did is what it does.
    fn disturbance(&self) -> Option<String> {
        let before = &self.seen.sim.all[..self.at];
        if before.last().is_none_or(|s| s.fallen == 1 || s.power == 0 || s.time < DEATH) {
            return Some(format!("did not walk any more before the kill: {}", self.said.err));
        }
        if let Some(e) = self.seen.has(Process::Lowlevel, EventCode::Overrun) {
            return Some(format!("the joint loop missed {} cycles at tick {}", e.detail, e.header.tick));
        }
        if self.seen.lost() > 0 {
            return Some(format!("the observer was {} records too slow", self.seen.lost()));
        }
        let overruns = |t: &Track<CycleStats>| t.all.last().map_or(0, |s| s.overruns + s.skipped);
        let [watchdog, sim] = [0, 1].map(|i| overruns(&self.seen.stats[i]));
        (watchdog + sim > 0).then(|| format!("watchdog {watchdog} and simulated robot {sim} cycles too late"))
    }
}

/// Output of the processes between the death and the end of the run.
fn events(e: &Evidence) -> String {
    let until = e.after().last().map_or(0, |s| s.header.tick);
    let mut text: Vec<String> = Vec::new();
    for (process, track) in &e.seen.events {
        for event in track.all.iter().filter(|event| (e.tick()..=until).contains(&event.header.tick)) {
            let code = EventCode::from_number(event.code).unwrap_or(EventCode::None);
            let routine = [EventCode::Started, EventCode::Ended, EventCode::PlanActive, EventCode::Overrun];
            if !routine.contains(&code) {
                text.push(format!("{}: {code:?} ({})", process.name(), event.detail));
            }
        }
    }
    text.join(", ")
}

impl Evidence {
    /// Tick of the bus cycle in which the process died.
    fn tick(&self) -> u64 {
        self.seen.sim.all[self.at - 1].header.tick
    }
}

/// Demands. The limits are those of `system.toml` and of the robot's brakes.
fn judge(e: &Evidence, setup: &Setup) -> Result<(), String> {
    let check = |right: bool, what: &str| if right { Ok(()) } else { Err(what.to_owned()) };
    let said_twice = e.seen.events.iter().find_map(|(process, track)| {
        let fallen = track.all.iter().filter(|event| event.code == EventCode::Fallen as u64).count();
        (fallen > 1).then(|| format!("{} said {fallen} times that the robot has fallen", process.name()))
    });
    said_twice.map_or(Ok(()), Err)?;
    let braking = braking_cycles(e, setup);
    let missed = u64::from(setup.system.watchdog_missed);
    match e.victim {
        Process::Lowlevel => {
            let off = e.seen.power.all.iter().find(|p| p.header.tick >= e.tick() && p.on == 0);
            let off = off.ok_or("the watchdog did not cut the supply")?;
            check(off.reason == EventCode::ResetMissed as u64, "the watchdog does not say why")?;
            check(off.missed <= missed.min(3), &format!("cut after {} cycles", off.missed))?;
            let line =
                cycles_after(e, off.header.tick, |s| s.power == 0).ok_or("the power line did not fall")?;
            check(line <= 4, &format!("the power line fell in cycle {line} after the last frame"))?;
            let rest = e.at_rest().ok_or("the joints did not come to rest")?;
            check(rest <= line + 4 + braking, &format!("{rest} cycles to rest, brakes need {braking}"))
        }
        Process::Watchdog => {
            let last = e.seen.power.all.last().ok_or("no power record")?.header.tick;
            let quiet = setup.system.toggle_missed as usize;
            // The toggle of tick n reaches the robot in its cycle n to n + 2; the cycles without follow.
            let line = cycles_after(e, last, |s| s.power == 0).ok_or("the power line did not fall")?;
            check(
                (quiet..=quiet + 2).contains(&line),
                &format!("the power line fell in cycle {line} after the last toggle"),
            )?;
            let rest = e.at_rest().ok_or("the joints did not come to rest")?;
            check(rest <= line + 1 + braking, &format!("{rest} cycles to rest, brakes need {braking}"))
        }
        Process::Controller => {
            let last = e.seen.targets.all.last().ok_or("no targets")?.header.tick;
            let stop =
                e.seen.has(Process::Lowlevel, EventCode::TargetsStale).ok_or("no event TargetsStale")?;
            let patience = u64::from(setup.system.targets_missed) + 1;
            check(
                stop.header.tick <= last + patience,
                &format!("stopped {} cycles late", stop.header.tick - last),
            )?;
            let rest = e.at_rest().ok_or("the joints did not come to rest")?;
            let limit = patience as usize + 2 + braking;
            check(rest <= limit, &format!("{rest} cycles to rest instead of {limit}"))?;
            check(e.power_off().is_none(), "a controlled stop keeps the supply on")
        }
        Process::Planner => {
            let silent =
                e.seen.has(Process::Controller, EventCode::PlannerSilent).ok_or("no event PlannerSilent")?;
            let limit = u64::from(messages::topics::PLANNER_TICK.stale_after) + 2;
            check(silent.header.tick <= e.tick() + limit, "the planner's silence was seen late")?;
            walks_on(e)
        }
        _ => walks_on(e),
    }
}

/// On its feet with the supply on, and in the end it stands.
fn walks_on(e: &Evidence) -> Result<(), String> {
    let check = |right: bool, what: &str| if right { Ok(()) } else { Err(what.to_owned()) };
    check(!e.fell(), "fell")?;
    check(e.power_off().is_none(), "lost its supply")?;
    let after = e.after();
    let way = after.last().ok_or("no cycle after the kill")?.position[0] - after[0].position[0];
    check(way > 0.1, &format!("went on for {way} m only"))?;
    let gait = e.seen.state.all.iter().rev().nth(500).map(|s| GaitState::from(s.gait));
    check(gait == Some(GaitState::Standing), &format!("does not stand at the end: {gait:?}"))?;
    e.at_rest().map(|_| ()).ok_or_else(|| "the joints did not come to rest".to_owned())
}

/// Cycles of the robot after the one that carried `tick` until `what`.
fn cycles_after(e: &Evidence, tick: u64, what: impl Fn(&SimState) -> bool) -> Option<usize> {
    let all = &e.seen.sim.all;
    let first = all.iter().position(|s| s.header.tick >= tick)?;
    all[first..].iter().position(what)
}

/// What the slowest joint needs at its rate of braking from the speed it has at the kill \[cycles\]; joints that carry
/// on at that speed before they brake lose nothing by it.
fn braking_cycles(e: &Evidence, setup: &Setup) -> usize {
    let window = &e.seen.sim.all[e.at - 2..e.at + 30];
    let time = |j: usize| {
        let speed = |w: &[SimState]| (w[1].joint_angle[j] - w[0].joint_angle[j]).abs() / setup.scene.cycle;
        window.windows(2).map(speed).fold(0.0, f64::max) / setup.robot.joints[j].braking
    };
    let longest = (0..setup.robot.joints.len()).map(time).fold(0.0, f64::max);
    (longest / setup.scene.cycle).ceil() as usize + 2
}

/// The log on disk tells what the observer saw.
fn check_log(e: &Evidence) {
    let log = Log::open(&e.log).unwrap();
    let mut last = 0;
    let end = log.each_record(&SIM_STATE, |s: &SimState| last = s.header.tick).unwrap();
    // Also the log of a logger that was killed: the supervisor has given it its index.
    assert_eq!(end, LogEnd::Complete);
    if e.victim == Process::Logger {
        // Its last flush is half a second old, or a little more.
        assert!(last + 700 >= e.tick(), "the log of the killed logger ends at tick {last} of {}", e.tick());
        return;
    }
    for (process, track) in
        e.seen.events.iter().filter(|(p, _)| !matches!(p, Process::Logger | Process::Broker))
    {
        let topic = Topic::find(&format!("events/{}", process.name())).unwrap();
        let logged: Vec<Event> = log.records(topic).unwrap();
        for event in track.all.iter().filter(|event| event.header.tick >= e.tick()) {
            assert!(logged.contains(event), "{}: {event:?} is not in the log", process.name());
        }
    }
}

fn row(e: &Evidence, note: &str) -> String {
    let ms = |cycles: Option<usize>| cycles.map_or("-".into(), |n| format!("{n} ms"));
    let wall = e.wall_off.filter(|_| e.power_off().is_some()).map_or("-".into(), |t| format!("{t:.1} ms"));
    let fell = if e.fell() { "yes" } else { "no" };
    let (off, rest) = (ms(e.power_off()), ms(e.at_rest()));
    let code = e.said.code.map_or("-".into(), |c| c.to_string());
    format!("| {} | {off} | {wall} | {rest} | {fell} | {} | {code} | {note} |\n", e.victim.name(), events(e))
}

#[test]
fn a_killed_process_ends_in_the_reaction_that_is_designed_for_it() {
    let setup = {
        let site = Site::new(EXE);
        site.scene("kill", SECONDS, SCENE);
        Setup::load(&site.config(""), "kill").unwrap()
    };
    let mut table = String::from(
        "| killed | power off after | wall time | joints at rest after | fell | events | exit code | |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    let mut wrong = Vec::new();
    use Process::{Broker, Controller, Logger, Lowlevel, Planner, Watchdog};
    for victim in [Controller, Planner, Lowlevel, Watchdog, Broker, Logger] {
        let mut note = String::new();
        for attempt in 1..=ATTEMPTS {
            let evidence = kill(victim);
            let verdict = judge(&evidence, &setup);
            if let (Err(problem), Some(cause), true) = (&verdict, evidence.disturbance(), attempt < ATTEMPTS)
            {
                println!("{}: run {attempt} is done again: {problem}; {cause}", victim.name());
                let _ = write!(note, "run {attempt} disturbed: {cause}; ");
                continue;
            }
            table += &row(&evidence, &note);
            if let Err(problem) = verdict {
                wrong.push(format!("{}: {problem}\n{}", victim.name(), evidence.said.err));
            } else {
                assert_eq!(evidence.said.code, Some(1), "a death is no success: {:?}", evidence.said);
                let named = format!("{} died during the run: signal 9", victim.name());
                assert!(evidence.said.err.contains(&named), "{named}: {}", evidence.said.err);
                check_log(&evidence);
            }
            break;
        }
    }
    println!("\n{table}");
    std::fs::write(concat!(env!("CARGO_TARGET_TMPDIR"), "/../kill_table.md"), &table).unwrap();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
