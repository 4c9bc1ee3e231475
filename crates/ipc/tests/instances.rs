//! One supervisor and one of each process per run directory; any number of run directories.

mod place;

use ipc::{IpcError, Space};
use messages::topics::SENSORS;
use messages::{Header, Process, Sensors};
use place::RunDir;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// Another process that holds something in `dir` until it is killed: this binary again.
#[test]
fn holder_process() {
    let Ok(dir) = std::env::var("GANGWERK_HOLDER_DIR") else { return };
    let space = match std::env::var("GANGWERK_HOLDER").as_deref() {
        Ok("supervisor") => Space::create(Path::new(&dir)).unwrap(),
        _ => Space::open(Path::new(&dir), Process::Lowlevel).unwrap(),
    };
    let waiter = space.waiter(Process::Observer).unwrap();
    std::fs::write(Path::new(&dir).join("holding"), "").unwrap();
    while !waiter.wait(Duration::from_secs(1)) {}
}

struct Holder(Child);
impl Holder {
    fn start(dir: &Path, who: &str) -> Self {
        let child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "holder_process"])
            .env("GANGWERK_HOLDER_DIR", dir)
            .env("GANGWERK_HOLDER", who)
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        while !dir.join("holding").exists() {
            realtime::clock::sleep_until(realtime::clock::now() + 1_000_000);
        }
        std::fs::remove_file(dir.join("holding")).unwrap();
        Self(child)
    }

    fn kill(&mut self) -> u32 {
        self.0.kill().unwrap();
        self.0.wait().unwrap();
        self.0.id()
    }
}

fn refused(result: Result<Space, IpcError>, name: &str, by: u32) {
    match result.err().unwrap() {
        IpcError::AlreadyRunning { who, pid, .. } => assert_eq!((who.as_str(), pid), (name, by)),
        other => panic!("{other}"),
    }
}

#[test]
fn a_second_supervisor_is_refused_and_disturbs_nothing() {
    let dir = RunDir::new("second");
    dir.make();
    let mut first = Holder::start(dir.path(), "supervisor");
    refused(Space::create(dir.path()), "supervisor", first.0.id());
    // The first one's topics are there and work.
    let lowlevel = Space::open(dir.path(), Process::Lowlevel).unwrap();
    let mut writer = lowlevel.writer::<Sensors>(&SENSORS).unwrap();
    writer.write(&Sensors::default());
    // A process is one of its kind, too.
    refused(Space::open(dir.path(), Process::Lowlevel), "lowlevel", std::process::id());
    // Observers come as they like.
    let _one = Space::open(dir.path(), Process::Observer).unwrap();
    let two = Space::open(dir.path(), Process::Observer).unwrap();
    assert!(two.reader::<Sensors>(&SENSORS).unwrap().latest().is_some());
    first.kill();
    // While a process of the killed run is alive, nobody wipes its memory.
    refused(Space::create(dir.path()), "lowlevel", std::process::id());
    drop((writer, lowlevel));
    let again = Space::create(dir.path()).unwrap();
    assert!(again.reader::<Sensors>(&SENSORS).unwrap().latest().is_none(), "old records in a new run");
}

#[test]
fn only_one_of_many_supervisors_wins() {
    let dir = RunDir::new("race");
    dir.make();
    let winners: Vec<_> = std::thread::scope(|scope| {
        let starts: Vec<_> = (0..16).map(|_| scope.spawn(|| Won(Space::create(dir.path())))).collect();
        starts.into_iter().map(|s| s.join().unwrap()).filter(|w| w.0.is_ok()).collect()
    });
    assert_eq!(winners.len(), 1);
    drop(winners);
    drop(Space::create(dir.path()).unwrap());
}

/// A space made in one thread and only dropped in another.
struct Won(Result<Space, IpcError>);
// SAFETY: the making thread has ended when the value is dropped; nothing is shared between the two.
unsafe impl Send for Won {}

#[test]
fn what_killed_ones_left_is_cleared_away() {
    let dir = RunDir::new("stale");
    dir.make();
    // Somebody else's run stays as it is.
    let other = RunDir::new("stale-other");
    let _other_system = Space::create(other.path()).unwrap();
    for _ in 0..5 {
        let mut system = Holder::start(dir.path(), "supervisor");
        let mut lowlevel = Holder::start(dir.path(), "lowlevel");
        system.kill();
        lowlevel.kill();
    }
    let mine = Space::create(dir.path()).unwrap();
    assert!(mine.reader::<Sensors>(&SENSORS).unwrap().latest().is_none());
    let reader = Space::open(other.path(), Process::Observer).unwrap();
    assert!(reader.reader::<Sensors>(&SENSORS).is_ok());
}

/// A page that is open when a run ends holds its memory for a while, and removes files by their names when it lets go.
#[test]
fn an_observer_that_lets_go_late_takes_nothing_from_the_next_run() {
    let dir = RunDir::new("late");
    let first = Space::create(dir.path()).unwrap();
    let late = Space::open(dir.path(), Process::Observer).unwrap();
    let reader = late.reader::<Sensors>(&SENSORS).unwrap();
    let (waiter, queue) = (late.waiter(Process::Observer).unwrap(), late.queue_receiver("commands").unwrap());
    drop(first);
    let second = Space::create(dir.path()).unwrap();
    drop((reader, waiter, queue, late));
    // Everything of the second run is there and works.
    let lowlevel = Space::open(dir.path(), Process::Lowlevel).unwrap();
    let mut writer = lowlevel.writer::<Sensors>(&SENSORS).unwrap();
    let bell = lowlevel.bell(&SENSORS).unwrap();
    writer.write(&Sensors { header: Header { tick: 3, ..Header::default() }, ..Sensors::default() });
    bell.ring();
    let observer = Space::open(dir.path(), Process::Observer).unwrap();
    let mut reader = observer.reader::<Sensors>(&SENSORS).unwrap();
    let found = reader.latest();
    assert_eq!(found.map(|sensors| sensors.header.tick), Some(3));
    drop(second);
}

#[test]
fn two_robots_do_not_meet() {
    let dirs = [RunDir::new("robot-a"), RunDir::new("robot-b")];
    let systems = [0, 1].map(|k| Space::create(dirs[k].path()).unwrap());
    let processes = [0, 1].map(|k| Space::open(dirs[k].path(), Process::Lowlevel).unwrap());
    let mut writers = [0, 1].map(|k| processes[k].writer::<Sensors>(&SENSORS).unwrap());
    let mut readers = [0, 1].map(|k| systems[k].reader::<Sensors>(&SENSORS).unwrap());
    let mut sensors = Sensors::default();
    sensors.header.tick = 7;
    writers[0].write(&sensors);
    assert_eq!(readers[0].latest().unwrap().header.tick, 7);
    assert!(readers[1].latest().is_none());
    sensors.header.tick = 9;
    writers[1].write(&sensors);
    assert_eq!(readers[0].latest().unwrap().header.tick, 7);
    assert_eq!(readers[1].latest().unwrap().header.tick, 9);
}

#[test]
fn missing_or_wrong_directories_are_named() {
    let dir = RunDir::new("missing");
    let error = Space::open(dir.path(), Process::Planner).err().unwrap().to_string();
    assert!(error.contains("gangwerk-ipc") && error.contains("does not exist: start a run"), "{error}");
    dir.make();
    let error = Space::open(dir.path(), Process::Planner).err().unwrap().to_string();
    assert!(error.contains("no run in") && error.contains("gangwerk run"), "{error}");
}
