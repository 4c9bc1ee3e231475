//! The watchdog as a process of its own; this test plays the joint loop.

use ipc::{Mode, Reader, Run, Space, Woken, Writer};
use messages::topics::{EVENTS_WATCHDOG, POWER, STATS_WATCHDOG, WATCHDOG_RESET};
use messages::{CycleStats, Event, EventCode, Power, Process, WatchdogReset};
use realtime::clock;
use rustix::process::{Pid, Signal, kill_process};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

/// Own cycles without a heartbeat in these tests: far more than a busy machine lets this process sleep.
const LIMIT: u64 = 500;
const PATIENCE: Duration = Duration::from_secs(20);

const SCENE: &str = r#"
about = "The motor supply is switched on."
robot = "lola"
gait = "lola"
depth = 1
integrator = "euler"
substeps = 1
cycle = 0.001
start_pose = "stand"
duration = 1.0
seed = 1
[[command]]
time = 0.010
topic = "system/reset"
[[command]]
time = 0.020
topic = "system/enable"
"#;

/// A run with everything but the joint loop.
struct Rig {
    dir: PathBuf,
    space: Option<Space>,
    lowlevel: Option<LowLevel>,
}

struct LowLevel {
    space: Space,
    reset: Writer<WatchdogReset>,
    bell: ipc::Bell,
    record: WatchdogReset,
}

impl LowLevel {
    fn live(&mut self, tick: u64) {
        self.record.header.tick = tick;
        self.record.header.stamp_ns = tick * 1_000_000;
        self.reset.write(&self.record);
        self.bell.ring();
    }
}

impl Rig {
    fn new(name: &str, mode: Mode) -> Self {
        let dir = std::env::temp_dir().join(format!("gangwerk-watchdog-{}-{name}", std::process::id()));
        let space = Space::create(&dir).unwrap();
        let run = Run {
            dir: dir.clone(),
            mode,
            paced: false,
            scene: "watchdog".into(),
            method: None,
            method_error: None,
            config: config(&dir),
            bus: "shm".into(),
            robot: true,
            stays: false,
            log: None,
            commit: String::new(),
            started: None,
        };
        run.save().unwrap();
        let own = Space::open(&dir, Process::Lowlevel).unwrap();
        let lowlevel = LowLevel {
            reset: own.writer(&WATCHDOG_RESET).unwrap(),
            bell: own.bell(&WATCHDOG_RESET).unwrap(),
            record: WatchdogReset::default(),
            space: own,
        };
        Self { dir, space: Some(space), lowlevel: Some(lowlevel) }
    }

    fn start(&self) -> Child {
        Command::new(env!("CARGO_BIN_EXE_watchdog"))
            .arg("--run")
            .arg(&self.dir)
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap()
    }

    fn reader<T: messages::Record>(&self, topic: &messages::Topic) -> Reader<T> {
        self.space.as_ref().unwrap().reader(topic).unwrap()
    }
}

impl Drop for Rig {
    fn drop(&mut self) {
        self.lowlevel = None;
        self.space = None;
        let _ = std::fs::remove_dir_all(&self.dir);
    }
}

/// The shipped configuration with a scene, a patience and a limit for these tests.
fn config(dir: &Path) -> PathBuf {
    let shipped = config::root(None);
    let own = dir.join("config");
    std::fs::create_dir_all(own.join("scenes")).unwrap();
    std::fs::write(own.join("scenes/watchdog.toml"), SCENE).unwrap();
    for part in ["robots", "gaits"] {
        std::os::unix::fs::symlink(shipped.join(part), own.join(part)).unwrap();
    }
    let system = std::fs::read_to_string(shipped.join("system.toml")).unwrap();
    let lines = system.lines().map(|line| match line.split_once(" = ") {
        Some(("watchdog_missed", _)) => format!("watchdog_missed = {LIMIT}\n"),
        Some(("peer_timeout", _)) => "peer_timeout = 0.5\n".into(),
        _ => format!("{line}\n"),
    });
    std::fs::write(own.join("system.toml"), lines.collect::<String>()).unwrap();
    own
}

fn end(child: Child) -> Output {
    kill_process(Pid::from_child(&child), Signal::TERM).unwrap();
    child.wait_with_output().unwrap()
}

#[test]
fn lockstep_answers_every_tick() {
    let mut rig = Rig::new("lockstep", Mode::Lockstep);
    let child = rig.start();
    let mut power: Reader<Power> = rig.reader(&POWER);
    let mut events: Reader<Event> = rig.reader(&EVENTS_WATCHDOG);
    let lowlevel = rig.lowlevel.as_mut().unwrap();
    let waiter = lowlevel.space.waiter(Process::Lowlevel).unwrap();
    for tick in 1..1000 {
        lowlevel.live(tick);
        assert_eq!(waiter.wait_until(PATIENCE, || false, || power.refresh()), Woken::Ready, "tick {tick}");
        let answer = power.held().unwrap();
        lowlevel.record.supply = answer.on;
        assert_eq!((answer.header.tick, answer.header.stamp_ns), (tick, tick * 1_000_000));
        // Switched on by the scene, at the very tick of its command.
        assert_eq!(answer.on == 1, tick >= 20, "tick {tick}");
        assert_eq!(answer.toggle, (tick + 1).saturating_sub(20));
    }
    let output = end(child);
    assert!(output.status.success(), "{output:?}");
    let mut codes = Vec::new();
    while let Some(event) = events.follow() {
        codes.push((event.code, event.header.tick));
    }
    let code = |c: EventCode| c as u64;
    assert_eq!(
        codes,
        [(code(EventCode::Started), 0), (code(EventCode::PowerOn), 20), (code(EventCode::Ended), 999)]
    );
}

#[test]
fn lockstep_names_a_silent_joint_loop() {
    let mut rig = Rig::new("silent", Mode::Lockstep);
    let child = rig.start();
    let mut power: Reader<Power> = rig.reader(&POWER);
    rig.lowlevel.as_mut().unwrap().live(7);
    let output = child.wait_with_output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success());
    assert!(text.contains("lockstep: lowlevel did not answer within 0.5 s"), "{text}");
    assert_eq!(power.latest().unwrap().on, 0);
}

/// Plays the joint loop, a tick per millisecond or so, until `done` of the newest power record.
fn live_until(
    rig: &mut Rig,
    tick: &mut u64,
    power: &mut Reader<Power>,
    done: impl Fn(&Power) -> bool,
) -> Power {
    let give_up = clock::now() + PATIENCE.as_nanos() as u64;
    loop {
        assert!(clock::now() < give_up, "{:?}", power.latest());
        *tick += 1;
        rig.lowlevel.as_mut().unwrap().live(*tick);
        clock::sleep_until(clock::now() + 1_000_000);
        rig.lowlevel.as_mut().unwrap().record.supply = power.latest().map_or(0, |p| p.on);
        if let Some(newest) = power.latest().copied().filter(&done) {
            return newest;
        }
    }
}

#[test]
fn real_time_cuts_a_silent_joint_loop_and_stays_off_when_restarted() {
    let mut rig = Rig::new("real-time", Mode::RealTime);
    let mut child = rig.start();
    let (mut power, mut every): (Reader<Power>, Reader<Power>) = (rig.reader(&POWER), rig.reader(&POWER));
    let mut stats: Reader<CycleStats> = rig.reader(&STATS_WATCHDOG);
    let mut tick = 0;
    live_until(&mut rig, &mut tick, &mut power, |p| p.on == 1);
    live_until(&mut rig, &mut tick, &mut power, |p| p.toggle > 1000);
    let measured = *stats.latest().unwrap();
    assert!(measured.cycles > 500);
    assert_eq!(measured.allocations, [0, 0]);
    assert!(measured.degraded == 1 || measured.page_faults == [0, 0], "{measured:?}");

    // Silence: on for as long as the limit allows, then off, and nothing but silence is the reason.
    while every.follow().is_some() {}
    let last = loop {
        if let Some(p) = every.follow()
            && p.on == 0
        {
            break *p;
        }
    };
    assert_eq!(last.header.tick, tick);
    assert_eq!((last.missed, last.reason), (LIMIT, EventCode::ResetMissed as u64));
    // Life returns, power does not: the scene's commands are spent.
    let toggle = last.toggle;
    let from = tick;
    let newest = live_until(&mut rig, &mut tick, &mut power, |p| p.header.tick > from + 100);
    assert_eq!((newest.on, newest.toggle), (0, toggle));

    child.kill().unwrap();
    child.wait().unwrap();
    let child = rig.start();
    let newest = live_until(&mut rig, &mut tick, &mut power, |p| p.header.epoch == 2 && p.missed == 0);
    assert_eq!(newest.on, 0);
    let from = tick;
    let newest = live_until(&mut rig, &mut tick, &mut power, |p| p.header.tick > from + 200);
    assert_eq!((newest.on, newest.toggle), (0, 0), "a restarted watchdog leaves power off");
    assert!(end(child).status.success());
}
