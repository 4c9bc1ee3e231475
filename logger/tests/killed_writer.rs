//! What a process wrote last before it was killed is in the log: the rings outlive it, and the logger saves them.

use ipc::{Mode, Space};
use logger::{LogOutput, Parts};
use messages::topics::{EVENTS_LOGGER, LOG_TICK, SENSORS};
use messages::{Event, EventCode, Header, Process, Sensors};
use realtime::Stop;
use recording::{Log, Recorder, RobotInfo, RunInfo};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

const DIR: &str = "GANGWERK_TEST_DIR";
const FIRST: &str = "GANGWERK_TEST_FIRST";
const RECORDS: u64 = 200;

/// Not a test of its own: the process that is killed. It writes its records and then hangs.
#[test]
fn writer() {
    let Ok(dir) = std::env::var(DIR) else { return };
    let first: u64 = std::env::var(FIRST).unwrap().parse().unwrap();
    let space = Space::open(dir.as_ref(), Process::Lowlevel).unwrap();
    let mut writer = space.writer::<Sensors>(&SENSORS).unwrap();
    for tick in first..first + RECORDS {
        let header = Header { tick, stamp_ns: tick * 1_000_000, epoch: 0 };
        writer.write(&Sensors { header, ..Sensors::default() });
    }
    loop {
        std::thread::park();
    }
}

fn start_writer(dir: &std::path::Path, first: u64) -> Child {
    Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "writer"])
        .env(DIR, dir)
        .env(FIRST, first.to_string())
        .stdout(Stdio::null())
        .spawn()
        .unwrap()
}

/// 20 s at most: a bound for a hanging test, not a measurement.
fn wait_for(what: &str, mut come: impl FnMut() -> bool) {
    for _ in 0..10_000 {
        if come() {
            return;
        }
        std::thread::park_timeout(Duration::from_millis(2));
    }
    panic!("{what} did not come");
}

#[test]
fn the_last_words_of_killed_writers_are_in_the_log() {
    let dir = PathBuf::from(format!("/dev/shm/gangwerk-logger-test-{}", std::process::id()));
    let space = Space::create(&dir).unwrap();
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("logger_killed.mcap");
    let mut newest = space.reader::<Sensors>(&SENSORS).unwrap();

    // The first writer is dead before the logger even starts.
    let mut first = start_writer(&dir, 0);
    wait_for("the first writer", || newest.latest().is_some_and(|s| s.header.tick == RECORDS - 1));
    first.kill().unwrap();
    first.wait().unwrap();
    space.clear_dead();

    let stop = Stop::default();
    let (asked, log_dir, parts) = (stop.clone(), dir.clone(), Parts::new(&path));
    let daemon = std::thread::spawn(move || {
        let space = Space::open(&log_dir, Process::Logger).unwrap();
        let open =
            move |part| Recorder::create(&parts.path(part), &RobotInfo::default(), &RunInfo::default());
        logger::daemon::serve(&space, LogOutput::new(Box::new(open)), Mode::Lockstep, &asked)
    });
    let mut tick = space.reader::<Event>(&LOG_TICK).unwrap();
    wait_for("the log's tick", || tick.latest().is_some_and(|t| t.header.tick == RECORDS - 1));

    // The second one is killed while the logger runs.
    let mut second = start_writer(&dir, RECORDS);
    wait_for("the second writer", || tick.latest().is_some_and(|t| t.header.tick == 2 * RECORDS - 1));
    second.kill().unwrap();
    second.wait().unwrap();

    let mut events = space.reader::<Event>(&EVENTS_LOGGER).unwrap();
    assert_eq!(events.latest().unwrap().code, EventCode::Started as u64);
    stop.ask();
    daemon.join().unwrap().unwrap();
    let log = Log::open(&path).unwrap();
    let seen: Vec<(u64, u64)> =
        log.records::<Sensors>(&SENSORS).unwrap().iter().map(|s| (s.header.epoch, s.header.tick)).collect();
    let expected: Vec<(u64, u64)> = (0..2 * RECORDS).map(|tick| (1 + tick / RECORDS, tick)).collect();
    assert_eq!(seen, expected);
    drop(space);
    assert!(!dir.exists(), "a run directory is gone with its run");
}
