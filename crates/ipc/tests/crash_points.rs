//! Every point at which a writer can die inside of a write: a child is stopped before each of its machine instructions
//! (`ptrace`), and what lies in shared memory then is what its death there would leave. At each of them readers must see the
//! record before or the new one, whole, and go on at once. At some it is killed, and the next writer takes over.
//!
//! `GANGWERK_CRASH_POINTS=all` kills at every one, and steps through the longest record, too.

use ipc::{Reader, Space, Writer};
use messages::topics::{PLAN, SENSORS};
use messages::{Plan, Process, Record, Sensors, Topic};
use place::RunDir;
use realtime::black_box::{BlackBox, Left};
use std::path::Path;
use std::process::{Child, Command, Stdio};

mod place;

/// Kills of each kind of write, at points that lie evenly in it.
const KILLS: usize = 40;
/// Records that are written before the one in which the writer dies.
const BEFORE: u64 = 2;

/// A record whose every number follows from one.
trait Pattern: Record {
    const TOPIC: &'static Topic;
    const WRITER: Process;
    fn numbers(&mut self) -> impl Iterator<Item = &mut f64>;

    fn of(n: u64) -> Box<Self> {
        let mut record = Box::new(Self::empty());
        record.header_mut().tick = n;
        record.numbers().for_each(|x| *x = n as f64);
        record
    }

    /// Its number, if all of it is of one write.
    fn number(&self) -> u64 {
        let (mut copy, n) = (*self, self.header().tick);
        assert!(copy.numbers().all(|x| *x == n as f64), "record {n} is mixed with another one");
        n
    }
}

impl Pattern for Sensors {
    const TOPIC: &'static Topic = &SENSORS;
    const WRITER: Process = Process::Lowlevel;
    fn numbers(&mut self) -> impl Iterator<Item = &mut f64> {
        self.joint_angle.iter_mut().chain(&mut self.joint_speed)
    }
}

impl Pattern for Plan {
    const TOPIC: &'static Topic = &PLAN;
    const WRITER: Process = Process::Planner;
    fn numbers(&mut self) -> impl Iterator<Item = &mut f64> {
        self.body.coefficients.iter_mut().flatten().flatten().chain(&mut self.origin)
    }
}

/// A child of this program whose writing thread is stopped before and behind each of its writes.
struct Stepped {
    child: Child,
    thread: i32,
}

impl Stepped {
    /// Starts the role; it stands before its first write.
    fn start(role: &str, dir: &Path) -> Self {
        let child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "role", "--nocapture"])
            .env("GANGWERK_STEPPED", role)
            .env("GANGWERK_STEPPED_DIR", dir)
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        let (thread, status) = wait(-1);
        let stepped = Self { child, thread };
        assert!(thread > 0 && libc::WIFSTOPPED(status), "the child ended: {status:#x}");
        stepped
    }

    fn go(&self, how: libc::c_uint) -> i32 {
        // SAFETY: a stopped child that asked to be traced; both requests take no memory.
        let done = unsafe { libc::ptrace(how, self.thread, 0, 0) };
        assert_eq!(done, 0, "{}", std::io::Error::last_os_error());
        let (thread, status) = wait(self.thread);
        assert!(thread == self.thread && libc::WIFSTOPPED(status), "the child ended: {status:#x}");
        libc::WSTOPSIG(status)
    }

    /// Before the next write, or behind this one.
    fn to_mark(&self) {
        assert_eq!(self.go(libc::PTRACE_CONT), libc::SIGSTOP);
    }

    /// One instruction; `false`: the write is over.
    fn step(&self) -> bool {
        let signal = self.go(libc::PTRACE_SINGLESTEP);
        assert!(signal == libc::SIGTRAP || signal == libc::SIGSTOP, "signal {signal}");
        signal == libc::SIGTRAP
    }

    /// Dies `points` instructions into the write behind [`BEFORE`] others.
    fn die(role: &str, dir: &Path, points: usize) {
        let child = Self::start(role, dir);
        (0..2 * BEFORE).for_each(|_| child.to_mark());
        let _ = (0..points).all(|_| child.step());
    }
}

impl Drop for Stepped {
    fn drop(&mut self) {
        let _ = self.child.kill();
        wait(self.thread);
        let _ = self.child.wait();
    }
}

/// Waits for a traced thread; -1: any of those that this thread traces. Who it was, and its status.
fn wait(thread: i32) -> (i32, i32) {
    let mut status = 0;
    // SAFETY: the status is ours, and nobody else waits for this thread's children.
    let who = unsafe { libc::waitpid(thread, &raw mut status, libc::__WALL | libc::__WNOTHREAD) };
    (who, status)
}

fn mark() {
    // SAFETY: stops this thread; whoever traces it lets it go on.
    unsafe { libc::raise(libc::SIGSTOP) };
}

/// The writing process: this program again, in the role that the environment names.
#[test]
fn role() {
    let Ok(role) = std::env::var("GANGWERK_STEPPED") else { return };
    let dir = std::env::var("GANGWERK_STEPPED_DIR").unwrap();
    // SAFETY: asks the parent to trace this thread, which is the only one that writes.
    unsafe { libc::ptrace(libc::PTRACE_TRACEME, 0, 0, 0) };
    match role.as_str() {
        "sensors" => write_records::<Sensors>(Path::new(&dir)),
        "plan" => write_records::<Plan>(Path::new(&dir)),
        "queue" => {
            let space = Space::open(Path::new(&dir), Process::Planner).unwrap();
            let mut queue = space.queue_sender("stepped", "stepped").unwrap();
            write_for_ever(|n| assert!(queue.send(&[n as u8; 200])));
        }
        "box" => {
            let mut kept = BlackBox::create(&Path::new(&dir).join("box"), RING).unwrap();
            write_for_ever(|n| kept.keep(1, n, &[n; 40]));
        }
        other => panic!("no role {other}"),
    }
}

fn write_records<T: Pattern>(dir: &Path) {
    let space = Space::open(dir, T::WRITER).unwrap();
    let mut writer: Writer<T> = space.writer(T::TOPIC).unwrap();
    let mut record = T::of(0);
    write_for_ever(|n| {
        // What is built here is not in shared memory; the write is.
        *record = *T::of(n);
        writer.write(&record);
    });
}

fn write_for_ever(mut write: impl FnMut(u64)) {
    for n in 1.. {
        mark();
        write(n);
        mark();
    }
}

fn all() -> bool {
    std::env::var("GANGWERK_CRASH_POINTS").is_ok_and(|v| v == "all")
}

/// Points of `points` at which to kill: all of them, unless to reach them takes hours.
fn kills(points: usize) -> impl Iterator<Item = usize> {
    (0..points).step_by(if all() && points < 10_000 { 1 } else { points.div_ceil(KILLS) })
}

/// Two readers: of the newest record, and of every one.
struct Readers<T: Record>(Reader<T>, Reader<T>, u64);

impl<T: Pattern> Readers<T> {
    fn of(space: &Space) -> Self {
        Self(space.reader(T::TOPIC).unwrap(), space.reader(T::TOPIC).unwrap(), 0)
    }

    /// Number of the newest record. Those that are followed come whole, one after the other.
    fn look(&mut self) -> Option<u64> {
        if let Some(record) = self.1.follow() {
            let n = record.number();
            assert_eq!(n, self.2 + 1, "in order");
            self.2 = n;
        }
        self.0.latest().map(T::number)
    }
}

/// All points of one write, and of those behind it until the ring has come round; then kills.
fn records<T: Pattern>(role: &str) {
    let dir = RunDir::new(role);
    let (mut points, mut in_one) = (0, 0);
    {
        let space = Space::create(dir.path()).unwrap();
        let mut readers = Readers::<T>::of(&space);
        let child = Stepped::start(role, dir.path());
        let last = T::TOPIC.depth.min(4) as u64 + 1;
        for n in 1..=last {
            let mut newest = readers.look().unwrap_or(0);
            assert_eq!(newest, n - 1);
            // The first one, and one that is written over another one.
            if n > 1 && n < last {
                child.to_mark();
                child.to_mark();
                continue;
            }
            in_one = 0;
            while child.step() {
                let seen = readers.look().unwrap_or(0);
                assert!(seen == newest || seen == n, "{seen} after {newest}, while {n} is written");
                (newest, in_one) = (seen, in_one + 1);
            }
            assert_eq!(newest, n, "what is written is there");
            points += in_one;
            child.to_mark();
        }
    }
    let mut space = None;
    let mut killed = 0;
    for (k, point) in kills(in_one).enumerate() {
        // A space has room for four writers.
        if k % 3 == 0 {
            drop(space.take());
            space = Some(Space::create(dir.path()).unwrap());
        }
        let space = space.as_ref().unwrap();
        let mut latest: Reader<T> = space.reader(T::TOPIC).unwrap();
        Stepped::die(role, dir.path(), point);
        let mut fresh: Reader<T> = space.reader(T::TOPIC).unwrap();
        for reader in [&mut latest, &mut fresh] {
            let seen = reader.latest().map(T::number);
            assert!(seen == Some(BEFORE) || seen == Some(BEFORE + 1), "{seen:?} after a death at {point}");
        }
        space.clear_dead();
        let heir = Space::open(dir.path(), T::WRITER).unwrap();
        let mut writer: Writer<T> = heir.writer(T::TOPIC).unwrap();
        writer.write(&T::of(77));
        assert_eq!([latest, fresh].map(|mut reader| reader.latest().map(T::number)), [Some(77); 2]);
        killed += 1;
    }
    println!(
        "{role}: {points} points looked at, {in_one} in the last write; {killed} deaths, each followed by a writer"
    );
    assert!(in_one > 100, "{in_one} instructions write a record?");
}

#[test]
fn a_writer_of_sensors_dies_at_every_instruction_of_a_write() {
    records::<Sensors>("sensors");
}

/// The longest record: its copies take hundreds of thousands of steps, and the test minutes.
#[test]
fn a_writer_of_plans_dies_at_every_instruction_of_a_write() {
    if !all() {
        return println!("left out: GANGWERK_CRASH_POINTS is not all");
    }
    records::<Plan>("plan");
}

#[test]
fn a_sender_dies_at_every_instruction_of_a_message() {
    let dir = RunDir::new("queue");
    let space = Space::create(dir.path()).unwrap();
    let mut queue = space.queue_receiver("stepped").unwrap();
    let mut whole = move || {
        let message = queue.receive()?;
        let n = message[0];
        assert!(message.len() == 200 && message.iter().all(|b| *b == n), "{message:?}");
        Some(n)
    };
    let child = Stepped::start("queue", dir.path());
    let mut points = 0;
    for n in 1..=3 {
        let mut heard = None;
        points = 0;
        while child.step() {
            let now = whole();
            assert!(now.is_none() || heard.is_none() && now == Some(n), "{now:?} after {heard:?}");
            (heard, points) = (heard.or(now), points + 1);
        }
        assert_eq!(heard, Some(n));
        child.to_mark();
    }
    drop(child);
    for point in kills(points) {
        Stepped::die("queue", dir.path(), point);
        let heard: Vec<u8> = std::iter::from_fn(&mut whole).collect();
        assert!(heard == [1, 2] || heard == [1, 2, 3], "{heard:?} after a death at {point}");
        space.clear_dead();
        let heir = Space::open(dir.path(), Process::Planner).unwrap();
        let mut sender = heir.queue_sender("stepped", "stepped").unwrap();
        assert!(sender.send(&[9; 200]));
        assert_eq!(whole(), Some(9), "a death at {point}");
    }
    println!("queue: {points} points in a message");
}

/// Size of the black box's ring \[B\]: a few entries, so that it comes round.
const RING: usize = 1600;

/// What a dying process keeps is read by those who survive, at any point.
#[test]
fn a_process_dies_at_every_instruction_of_an_entry_of_its_black_box() {
    let dir = RunDir::new("box");
    dir.make();
    let child = Stepped::start("box", dir.path());
    let mut points = 0;
    for n in 1..=12 {
        while child.step() {
            let left = Left::read(&dir.path().join("box")).unwrap();
            let ticks: Vec<u64> = left.entries.iter().map(|e| e.tick).collect();
            let last = ticks.last().copied().unwrap_or(0);
            assert!(last + 1 == n || last == n, "{ticks:?} while {n} is written");
            assert!(ticks.windows(2).all(|pair| pair[1] == pair[0] + 1), "{ticks:?}");
            // The ring holds four; the oldest one goes before a new one comes.
            assert!(ticks.len() as u64 >= 3.min(n - 1), "{ticks:?} while {n} is written");
            for entry in &left.entries {
                let expected: Vec<u8> = [entry.tick; 40].iter().flat_map(|n| n.to_le_bytes()).collect();
                assert!(entry.bytes.starts_with(&expected[..313]) && entry.bytes.len() == 320, "{entry:?}");
            }
            points += 1;
        }
        child.to_mark();
    }
    println!("black box: {points} points in 12 entries");
}
