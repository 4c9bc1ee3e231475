//! What a process did in real time is done again from its log, bit for bit; a difference of one bit is named.
//!
//! `GANGWERK_REPLAY_SECONDS=60` makes the run longer.

use harness::{Running, Site, doze, turn};
use messages::topics::{JOINT_TARGETS, SENSORS, SIM_STATE};
use messages::{JointTargets, Process, Record, Sensors, SimState, Topic};
use recording::{cdr, channel_name, rewrite};
use std::path::{Path, PathBuf};

const EXE: &str = harness::executable!();

/// Lola stands up, waits for commands, and is pushed while she walks.
const SCENE: &str = "
[[command]]
time = 0.2
topic = \"walk/stand\"
[[push]]
time = 6.5
duration = 0.1
force = [0.0, 20.0, 0.0]
";

fn seconds() -> f64 {
    std::env::var("GANGWERK_REPLAY_SECONDS").ok().and_then(|s| s.parse().ok()).unwrap_or(10.0)
}

/// A run in real time with a walking command, a parameter of planner and stabilizer, and a push from outside, all of them live.
fn recorded(site: &Site) -> PathBuf {
    let duration = seconds();
    site.scene("walk", duration, SCENE);
    let dir = site.run_dir().display().to_string();
    let mut run: Running = site.run("walk", &[]);
    let space = run.space();
    let mut sim = space.reader::<SimState>(&SIM_STATE).unwrap();
    let mut until = |run: &mut Running, time: f64| {
        while !sim.latest().is_some_and(|s| s.time > time) {
            assert!(run.is_alive(), "{}", run.err());
            doze(0.01);
        }
    };
    until(&mut run, 3.0);
    let walking = (duration - 6.0).to_string();
    let walk =
        site.start(&["topic", "pub", "walk/velocity", "forward=0.278", "--for", &walking, "--dir", &dir]);
    until(&mut run, 4.5);
    site.topic(&["pub", "sim/push", "force.y=15", "duration=0.1"]).well();
    // The lease is the walker's: this is refused, and that is in the log.
    assert_eq!(site.topic(&["pub", "walk/velocity", "forward=0.1", "--for", "0.1"]).code, Some(1));
    until(&mut run, 5.5);
    for (name, value) in [("force_gain.x", "21.5"), ("planner.swing_height", "0.06")] {
        site.gangwerk(&["param", "set", name, value, "--take-over", "--dir", &dir]).well();
    }
    drop(space);
    let _ = walk.end();
    let said = run.end().well();
    println!("{}", said.err);
    site.path("walk.mcap")
}

/// The log of a run from which nothing was lost: on a machine that has no time for the logger, some are.
fn complete(site: &Site) -> PathBuf {
    for _ in 0..3 {
        let log = recorded(site);
        let lost = recording::Log::open(&log).unwrap();
        let lost = lost.records::<messages::Event>(&messages::topics::EVENTS_LOGGER).unwrap();
        if lost.iter().all(|e| e.code != messages::EventCode::LogDropped as u64) {
            return log;
        }
    }
    panic!("records were lost in each of three runs");
}

/// What the replay of a log says that has another record at this tick; none: it is left out.
fn after<T: Record>(
    log: &Path,
    process: Process,
    topic: &Topic,
    tick: u64,
    change: Option<fn(&mut T)>,
) -> String {
    let edited = log.with_extension("edited.mcap");
    let mut found = 0;
    rewrite(log, &edited, |channel, payload| {
        let mut record: T = match channel == channel_name(topic.name) {
            true => cdr::decode(payload).unwrap(),
            false => return true,
        };
        if record.header().tick != tick {
            return true;
        }
        found += 1;
        if let Some(change) = change {
            change(&mut record);
            *payload = cdr::CdrEncoder::new().encode(&record).to_vec();
        }
        change.is_some()
    })
    .unwrap();
    assert_eq!(found, 1, "{} at tick {tick}", topic.name);
    cli::replay::replay(&edited, process).unwrap_err().to_string()
}

fn flip(x: &mut f64, bit: u32) {
    *x = f64::from_bits(x.to_bits() ^ 1 << bit);
}

#[test]
fn a_run_in_real_time_is_replayed_bit_for_bit_and_one_bit_is_named() {
    let _turn = turn();
    let site = Site::patient(EXE);
    let log = complete(&site);
    let denied = recording::Log::open(&log).unwrap();
    let denied = denied.records::<messages::CommandTaken>(&messages::topics::COMMANDS_BROKER).unwrap();
    assert!(
        denied.iter().any(|taken| taken.refused == 9 && taken.command().is_some()),
        "the lease was the walker's"
    );
    for process in cli::replay::PROCESSES {
        let done = cli::replay::replay(&log, process).unwrap_or_else(|e| panic!("{}: {e}", process.name()));
        println!("{}: {done}", process.name());
        assert!(!done.cut);
        assert!(done.cycles as f64 > 0.8e3 * seconds(), "{}: {done}", process.name());
        let commands = match process {
            Process::Planner => 3,                      // stand, the velocity, the parameter
            Process::Controller => 1,                   // the parameter
            Process::Lowlevel | Process::Watchdog => 2, // reset, enable
            _ => 0,
        };
        assert!(done.commands >= commands, "{}: {done}", process.name());
    }
    // An output.
    let said = after::<JointTargets>(
        &log,
        Process::Controller,
        &JOINT_TARGETS,
        4000,
        Some(|t| flip(&mut t.angle[3], 0)),
    );
    assert!(
        said.starts_with("controller differs: topic joint_targets, tick 4000, field angle[3]:"),
        "{said}"
    );
    // An input: the first record that comes out otherwise.
    let said = after::<Sensors>(
        &log,
        Process::Controller,
        &SENSORS,
        4000,
        Some(|s| flip(&mut s.imu.angular_velocity[0], 40)),
    );
    println!("{said}");
    assert!(said.starts_with("controller differs: topic controller_state, tick 4000, field "), "{said}");
    // Records that are not there.
    let said = after::<JointTargets>(&log, Process::Controller, &JOINT_TARGETS, 4000, None);
    assert!(
        said.starts_with("the log is not complete: topic joint_targets, needed at tick 4001: 1 record"),
        "{said}"
    );
    let said = after::<Sensors>(&log, Process::Controller, &SENSORS, 4000, None);
    assert!(said.starts_with("the log is not complete: topic sensors, needed at tick 4000:"), "{said}");
    let said =
        after::<messages::CycleInputs>(&log, Process::Planner, &messages::topics::INPUTS_PLANNER, 4000, None);
    assert!(
        said.starts_with("the log is not complete: topic cycle_inputs/planner, needed at tick"),
        "{said}"
    );
}

#[test]
fn a_run_in_lockstep_is_replayed_and_a_log_of_one_process_is_refused() {
    let site = Site::new(EXE);
    site.scene("walk", 3.0, "[[command]]\ntime = 0.2\ntopic = \"walk/stand\"\n");
    site.run("walk", &["--lockstep"]).end().well();
    let log = site.path("walk.mcap").display().to_string();
    let said = site.gangwerk(&["replay", &log]).well();
    assert_eq!(said.out.matches("no byte differs").count(), 4, "{said:#?}");
    let alone = site.path("sim.mcap").display().to_string();
    site.gangwerk(&["sim", "walk", "--log", &alone]).well();
    let said = site.gangwerk(&["replay", &alone, "--process", "planner"]);
    assert_eq!(said.code, Some(1));
    assert!(said.err.contains("only logs of `gangwerk run` can be replayed"), "{}", said.err);
    let said = site.gangwerk(&["replay", &log, "--process", "broker"]);
    assert!(
        said.code == Some(1) && said.err.contains("planner, controller, lowlevel, watchdog"),
        "{said:#?}"
    );
}
