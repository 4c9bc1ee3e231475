//! Writers killed with SIGKILL at random moments, their start included.
//!
//! Readers must never see a torn record, what was read must not change or go back, and the next writer must take over.
//! Print of the seed first: `GANGWERK_SEED=n` repeats a run, `GANGWERK_KILLS=n` makes it longer.

mod place;

use ipc::{IpcError, Reader, Space, Writer};
use messages::topics::{EVENTS_BROKER, PLAN, SENSORS};
use messages::{Event, Plan, Process, Record, Sensors, Topic, Visit};
use place::RunDir;
use realtime::clock;
use std::path::Path;
use std::process::{Child, Command, Stdio};

/// Sum over all fields, in order: any two records mixed give another one.
#[derive(Default)]
struct Sum(u64);
impl Sum {
    fn eat(&mut self, x: u64) {
        self.0 = (self.0.rotate_left(7) ^ x).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }
}
impl Visit for Sum {
    fn f64(&mut self, value: f64) {
        self.eat(value.to_bits());
    }
    fn u64(&mut self, value: u64) {
        self.eat(value);
    }
    fn u32(&mut self, value: u32) {
        self.eat(u64::from(value));
    }
    fn u8(&mut self, value: u8) {
        self.eat(u64::from(value));
    }
}

/// A record whose every part follows from a number, and which carries its own check sum.
trait Sealed: Record {
    const TOPIC: &'static Topic;
    const WRITER: Process;
    fn fill(&mut self, n: u64);

    fn seal(&mut self, n: u64) {
        self.fill(n);
        self.header_mut().tick = n;
        self.header_mut().stamp_ns = self.sum();
    }

    /// Over everything but the stamp that carries it and the epoch, which the writer fills in.
    fn sum(&self) -> u64 {
        let mut copy = *self;
        (copy.header_mut().stamp_ns, copy.header_mut().epoch) = (0, 0);
        let mut sum = Sum::default();
        copy.visit(&mut sum);
        sum.0
    }
}

impl Sealed for Sensors {
    const TOPIC: &'static Topic = &SENSORS;
    const WRITER: Process = Process::Lowlevel;
    fn fill(&mut self, n: u64) {
        for (k, x) in self.joint_angle.iter_mut().chain(&mut self.joint_speed).enumerate() {
            *x = (n + k as u64) as f64;
        }
        self.frames_missed = n;
    }
}

impl Sealed for Plan {
    const TOPIC: &'static Topic = &PLAN;
    const WRITER: Process = Process::Planner;
    fn fill(&mut self, n: u64) {
        self.id = n;
        for (k, x) in self.body.coefficients.iter_mut().flatten().flatten().enumerate() {
            *x = (n + k as u64) as f64;
        }
        self.steps[7].end = n as f64;
        self.origin = [n as f64; 3];
    }
}

impl Sealed for Event {
    const TOPIC: &'static Topic = &EVENTS_BROKER;
    const WRITER: Process = Process::Broker;
    fn fill(&mut self, n: u64) {
        (self.code, self.detail) = (n, n);
    }
}

/// The writing process: this binary again, in the role that the environment names.
#[test]
fn writer_process() {
    let Ok(dir) = std::env::var("GANGWERK_WRITER_DIR") else { return };
    let topic = std::env::var("GANGWERK_WRITER_TOPIC").unwrap_or_default();
    match Topic::find(&topic).map(|topic| topic.writer) {
        Some(Process::Lowlevel) => write_for_ever::<Sensors>(Path::new(&dir)),
        Some(Process::Broker) => write_for_ever::<Event>(Path::new(&dir)),
        _ => write_for_ever::<Plan>(Path::new(&dir)),
    }
}

fn write_for_ever<T: Sealed>(dir: &Path) {
    let space = Space::open(dir, T::WRITER).unwrap();
    let mut writer: Writer<T> = space.writer(T::TOPIC).unwrap();
    let mut record = Box::new(T::empty());
    for n in 1.. {
        record.seal(n);
        writer.write(&record);
    }
}

fn start_writer<T: Sealed>(dir: &Path) -> Child {
    Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "writer_process", "--nocapture"])
        .env("GANGWERK_WRITER_DIR", dir)
        .env("GANGWERK_WRITER_TOPIC", T::TOPIC.name)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

/// Reads until `until` \[ns\] or until `enough`; checks every record. Returns how many were read.
fn check<T: Sealed>(
    latest: &mut Reader<T>,
    every: &mut Reader<T>,
    last: &mut [(u64, u64); 2],
    until: u64,
    enough: impl Fn((u64, u64)) -> bool,
) -> u64 {
    let mut read = 0;
    while clock::now() < until && !enough(last[0]) {
        for (record, last) in [latest.newer(), every.follow()].into_iter().zip(last.iter_mut()) {
            let Some(record) = record else { continue };
            assert_eq!(record.header().stamp_ns, record.sum(), "torn record after {last:?}");
            let now = (record.header().epoch, record.header().tick);
            assert!(now > *last, "{now:?} after {last:?}");
            *last = now;
            read += 1;
        }
    }
    read
}

/// Kills four writers of one space: three at random moments, and one that must have taken over from them.
fn kill_four<T: Sealed>(name: &str, random: &mut impl FnMut() -> u64) -> (u64, u64) {
    let dir = RunDir::new(name);
    let system = Space::create(dir.path()).unwrap();
    let mut latest: Reader<T> = system.reader(T::TOPIC).unwrap();
    let mut every: Reader<T> = system.reader(T::TOPIC).unwrap();
    let mut last = [(0, 0); 2];
    let mut read = 0;
    for k in 0..4 {
        let before = last[0];
        let mut writer = start_writer::<T>(dir.path());
        let now = clock::now();
        if k < 3 {
            // Up to 20 ms: half of it is the writer's start.
            read += check(&mut latest, &mut every, &mut last, now + random() % 20_000_000, |_| false);
        } else {
            read += check(&mut latest, &mut every, &mut last, now + 10 * clock::SECOND, |l| {
                l.0 > before.0 && l.1 > 3
            });
            assert!(last[0].0 > before.0, "no writer took over from {before:?}");
        }
        writer.kill().unwrap();
        writer.wait().unwrap();
        // The dead do not change.
        read += check(&mut latest, &mut every, &mut last, clock::now() + 200_000, |_| false);
        let held = latest.latest().map(|r| (r.header().epoch, r.header().tick));
        assert_eq!(held.unwrap_or((0, 0)), last[0]);
    }
    (read, every.lost())
}

#[test]
fn two_hundred_killed_writers() {
    let number = |name: &str| std::env::var(name).ok().and_then(|s| s.parse::<u64>().ok());
    let seed = number("GANGWERK_SEED").unwrap_or_else(clock::now);
    let kills = number("GANGWERK_KILLS").unwrap_or(208);
    println!("GANGWERK_SEED={seed}");
    let mut state = seed | 1;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state
    };
    let (mut read, mut lost) = (0, 0);
    for _ in 0..kills.div_ceil(8) {
        for (r, l) in [kill_four::<Sensors>("kill", &mut random), kill_four::<Plan>("kill", &mut random)] {
            (read, lost) = (read + r, lost + l);
        }
    }
    println!("{kills} kills, {read} records read and checked, {lost} overwritten unread");
    assert!(read > kills, "the writers hardly wrote");
}

/// Kills as many writers of a topic as it can have; the next one is refused.
fn use_up<T: Sealed>(system: &Space, dir: &Path) {
    let mut reader: Reader<T> = system.reader(T::TOPIC).unwrap();
    let slots = ipc::writers(T::WRITER);
    for life in 1..=slots as u64 {
        let mut writer = start_writer::<T>(dir);
        while reader.latest().is_none_or(|r| r.header().epoch < life) {
            assert_eq!(writer.try_wait().unwrap(), None, "writer {life} of {slots} found no slot");
        }
        writer.kill().unwrap();
        writer.wait().unwrap();
        assert_eq!(system.clear_dead(), 1);
    }
    let next = Space::open(dir, T::WRITER).unwrap();
    let error = next.writer::<T>(T::TOPIC).err().unwrap();
    assert!(matches!(error, IpcError::SlotsUsedUp { slots: s, .. } if s == slots), "{error}");
}

#[test]
fn used_up_slots_are_named_and_a_new_space_is_clean() {
    let dir = RunDir::new("slots");
    let system = Space::create(dir.path()).unwrap();
    use_up::<Sensors>(&system, dir.path());
    use_up::<Event>(&system, dir.path());
    drop(system);
    let _system = Space::create(dir.path()).unwrap();
    let lowlevel = Space::open(dir.path(), Process::Lowlevel).unwrap();
    assert_eq!(lowlevel.writer::<Sensors>(&SENSORS).unwrap().epoch(), 1);
}
