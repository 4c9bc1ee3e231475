//! Crash record of a process that dies or hangs in the middle of a run: its last two seconds, the reason, the stack.

use harness::{Running, Said, Signal, Site, doze, turn};
use messages::topics::{CONTROLLER_STATE, INPUTS_CONTROLLER, INPUTS_PLANNER, JOINT_TARGETS, SIM_STATE};
use messages::{ControllerState, CycleInputs, JointTargets, Process, Record, SimState, Topic};
use recording::{Log, LogEnd};
use std::path::PathBuf;

const EXE: &str = harness::executable!();

const WAIT: &str = "
[[command]]
time = 0.2
topic = \"walk/stand\"
";

/// A run to which something happens after four seconds; what the supervisor said, and the crash record.
fn after(site: &Site, process: Process, happen: impl FnOnce(&mut Running)) -> (Said, PathBuf, String) {
    site.scene("wait", 1000.0, WAIT);
    let mut run = site.run("wait", &[]);
    let space = run.space();
    let mut sim = space.reader::<SimState>(&SIM_STATE).unwrap();
    while !sim.latest().is_some_and(|s| s.time > 4.0) {
        assert!(run.is_alive(), "{}", run.err());
        doze(0.01);
    }
    drop((sim, space));
    happen(&mut run);
    let said = run.end();
    assert_eq!(said.code, Some(1), "{said:#?}");
    let begins = format!("crash-{}-", process.name());
    let files = std::fs::read_dir(site.path(".")).unwrap().map(|e| e.unwrap().path());
    let found = files.filter(|p| p.file_name().unwrap().to_string_lossy().starts_with(&begins));
    let records: Vec<PathBuf> = found.collect();
    assert_eq!(records.len(), 1, "{}", said.err);
    assert!(said.err.contains(&format!("{}: its last seconds are in", process.name())), "{}", said.err);
    let shown = site.gangwerk(&["log", "show", &records[0].display().to_string()]).well().out;
    println!("{shown}");
    (said, records[0].clone(), shown)
}

/// Ticks of a topic in a crash record: without a gap, at least two seconds.
fn two_seconds<T: Record>(log: &Log, topic: &Topic) {
    let ticks: Vec<u64> = log.records::<T>(topic).unwrap().iter().map(|r| r.header().tick).collect();
    let span = ticks.last().unwrap_or(&0) - ticks.first().unwrap_or(&0);
    assert!(span >= 2000, "{}: {} records over {span} cycles", topic.name, ticks.len());
}

#[test]
fn a_killed_planner_leaves_its_last_two_seconds() {
    let _turn = turn();
    let site = Site::patient(EXE);
    let (_, record, shown) = after(&site, Process::Planner, |run| run.kill(Process::Planner));
    for part in ["planner died during the run: signal 9", "none: a process that is killed", "cycle    "] {
        assert!(shown.contains(part), "{part}: {shown}");
    }
    let log = Log::open(&record).unwrap();
    two_seconds::<CycleInputs>(&log, &INPUTS_PLANNER);
    two_seconds::<ControllerState>(&log, &CONTROLLER_STATE);
}

#[test]
fn a_controller_that_faults_says_where() {
    let _turn = turn();
    for (signal, name) in [(Signal::SEGV, "signal 11"), (Signal::ABORT, "signal 6")] {
        let site = Site::patient(EXE);
        let (_, record, shown) =
            after(&site, Process::Controller, |run| run.signal(Process::Controller, signal));
        assert!(shown.contains(&format!("controller died during the run: {name}")), "{shown}");
        assert!(shown.contains("controller/src/daemon.rs:"), "the function it was in: {shown}");
        let log = Log::open(&record).unwrap();
        two_seconds::<CycleInputs>(&log, &INPUTS_CONTROLLER);
        two_seconds::<JointTargets>(&log, &JOINT_TARGETS);
    }
}

#[test]
fn a_stopped_process_is_seen_as_it_was() {
    let _turn = turn();
    let site = Site::patient(EXE);
    let (_, _, shown) = after(&site, Process::Lowlevel, |run| run.signal(Process::Lowlevel, Signal::STOP));
    for part in ["lowlevel hung during the run", "state T (stopped)", "waits in do_signal_stop"] {
        assert!(shown.contains(part), "{part}: {shown}");
    }
}

/// The logger was killed: its part of the log gets an index at the end of the run, and its successor's is whole.
#[test]
fn the_log_of_a_killed_logger_is_repaired() {
    let _turn = turn();
    let site = Site::patient(EXE);
    let (said, _, shown) = after(&site, Process::Logger, |run| {
        run.kill(Process::Logger);
        while !site.path("wait.2.mcap").exists() {
            doze(0.05);
        }
        doze(1.0);
        run.interrupt();
    });
    assert!(shown.contains("logger died during the run: signal 9"), "{shown}");
    assert!(said.err.contains("it ended in the middle; repaired, with "), "{}", said.err);
    for part in ["wait.mcap", "wait.2.mcap"] {
        let log = Log::open(&site.path(part)).unwrap();
        assert_eq!(log.each(|_| ()).unwrap(), LogEnd::Complete, "{part}");
    }
}
