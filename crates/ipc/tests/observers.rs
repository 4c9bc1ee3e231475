//! Observers that open everything and are killed: nothing of them stays, and readers and writers have room as before.
//!
//! `GANGWERK_OBSERVERS=10000` kills as many as that.

mod place;

use ipc::{Reader, Space, Writer};
use messages::topics::{ForType, PLAN, SENSORS, with_type};
use messages::{Header, Plan, Process, Record, Sensors, TOPICS, Topic};
use place::RunDir;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};

/// Observers that live and die together.
const AT_ONCE: u64 = 8;

/// The observing process: this program again. It dies with everything open.
#[test]
fn observer() {
    let Ok(dir) = std::env::var("GANGWERK_OBSERVED") else { return };
    let space = Space::open(Path::new(&dir), Process::Observer).unwrap();
    let mut sensors: Reader<Sensors> = space.reader(&SENSORS).unwrap();
    let _plan: Reader<Plan> = space.reader(&PLAN).unwrap();
    let _bell = space.waiter(Process::Observer).unwrap();
    assert!(sensors.latest().is_some());
    // SAFETY: takes no memory; nothing of this process runs afterwards.
    unsafe { libc::kill(libc::getpid(), libc::SIGKILL) };
}

/// Reads a topic for as long as the process lives.
struct Read<'a>(&'a Space);

impl ForType<()> for Read<'_> {
    fn call<T: Record>(self, topic: &'static Topic) {
        std::mem::forget(self.0.reader::<T>(topic).unwrap());
    }
}

/// The process that reads everything: this program again.
#[test]
fn reader_of_everything() {
    let Ok(dir) = std::env::var("GANGWERK_READ") else { return };
    let space = Space::open(Path::new(&dir), Process::Observer).unwrap();
    TOPICS.iter().for_each(|topic| with_type(topic.name, Read(&space)).unwrap());
}

/// With room for more writers a dashboard with its second door took 1199 files, and many systems allow 1024.
#[test]
fn a_reader_of_everything_has_more_files_than_a_process_is_allowed_unasked() {
    let dir = RunDir::new("files");
    let _space = Space::create(dir.path()).unwrap();
    let read = Command::new("sh")
        .args(["-c", "ulimit -Sn 256 && exec \"$0\" --exact reader_of_everything"])
        .arg(std::env::current_exe().unwrap())
        .env("GANGWERK_READ", dir.path())
        .output()
        .unwrap();
    assert!(read.status.success(), "{}", String::from_utf8_lossy(&read.stdout));
}

/// Objects in shared memory and files in the run directory, of this run.
fn files(dir: &Path) -> usize {
    let mut hash = 0xcbf2_9ce4_8422_2325u64;
    for byte in dir.as_os_str().as_encoded_bytes() {
        hash = (hash ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3);
    }
    let prefix = format!("gangwerk_{:012x}", hash >> 16);
    let shared = std::fs::read_dir("/dev/shm").unwrap().flatten();
    let shared = shared.filter(|e| e.file_name().to_string_lossy().starts_with(&prefix)).count();
    assert!(shared > 0, "no object in shared memory begins with {prefix}");
    shared + std::fs::read_dir(dir).unwrap().count()
}

#[test]
fn observers_that_are_killed_leave_nothing() {
    let many = std::env::var("GANGWERK_OBSERVERS").ok().and_then(|n| n.parse().ok()).unwrap_or(96);
    let dir = RunDir::new("observers");
    let space = Space::create(dir.path()).unwrap();
    let lowlevel = Space::open(dir.path(), Process::Lowlevel).unwrap();
    let mut writer: Writer<Sensors> = lowlevel.writer(&SENSORS).unwrap();
    let mut write =
        |tick| writer.write(&Sensors { header: Header { tick, ..Header::default() }, ..Sensors::default() });
    write(1);
    let mut first = None;
    for n in 0..many / AT_ONCE {
        let start = || {
            Command::new(std::env::current_exe().unwrap())
                .args(["--exact", "observer"])
                .env("GANGWERK_OBSERVED", dir.path())
                .stdout(Stdio::null())
                .spawn()
                .unwrap()
        };
        let observers: Vec<Child> = (0..AT_ONCE).map(|_| start()).collect();
        for mut observer in observers {
            let died = observer.wait().unwrap();
            assert_eq!(died.signal(), Some(9), "lot {n}: {died}");
        }
        space.clear_dead();
        let now = files(dir.path());
        assert_eq!(*first.get_or_insert(now), now, "files after lot {n}");
        write(n + 2);
    }
    let mut reader: Reader<Sensors> = space.reader(&SENSORS).unwrap();
    assert_eq!(reader.latest().map(|s| s.header.tick), Some(many / AT_ONCE + 1));
    println!("{many} observers, {} files before and after", first.unwrap_or(0));
}
