//! The pure part of the logger, against sources in memory and disks that fail.

use logger::{Follower, LogOutput, Logging, Parts, Source};
use messages::topics::{EVENTS_LOGGER, POWER, SENSORS};
use messages::{Event, EventCode, Header, Power, Record, Sensors};
use recording::{Log, Recorder, RecordingError, RobotInfo, RunInfo};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A ring that holds `depth` records and forgets the oldest.
struct Ring<T> {
    records: VecDeque<T>,
    depth: usize,
    lost: u64,
    held: T,
}

/// Writer and reader of a [`Ring`] in one thread.
struct Shared<T>(Rc<RefCell<Ring<T>>>, T);

impl<T: Record> Shared<T> {
    fn new(depth: usize) -> (Self, Rc<RefCell<Ring<T>>>) {
        let ring = Ring { records: VecDeque::new(), depth, lost: 0, held: T::empty() };
        let ring = Rc::new(RefCell::new(ring));
        (Self(ring.clone(), T::empty()), ring)
    }
}

impl<T: Copy> Ring<T> {
    fn write(&mut self, record: T) {
        if self.records.len() == self.depth {
            self.records.pop_front();
            self.lost += 1;
        }
        self.records.push_back(record);
        self.held = record;
    }
}

impl<T: Record> Source<T> for Shared<T> {
    fn follow(&mut self) -> Option<(u64, &T)> {
        self.1 = self.0.borrow_mut().records.pop_front()?;
        Some((self.1.header().tick, &self.1))
    }
    fn lost(&self) -> u64 {
        self.0.borrow().lost
    }
}

fn file(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("logger_{name}.mcap"));
    for part in 1..5 {
        let _ = std::fs::remove_file(Parts::new(&path).path(part));
    }
    path
}

fn to_file(path: &Path) -> LogOutput {
    let parts = Parts::new(path);
    LogOutput::new(Box::new(move |part| {
        Recorder::create(&parts.path(part), &RobotInfo::default(), &RunInfo::default())
    }))
}

fn header(tick: u64) -> Header {
    Header { tick, stamp_ns: tick * 1_000_000, epoch: 1 }
}

fn sensors(tick: u64) -> Sensors {
    Sensors { header: header(tick), ..Sensors::default() }
}

#[test]
fn everything_written_is_in_the_log_in_order() {
    let path = file("order");
    let mut logging = Logging::new(to_file(&path));
    let (source, ring) = Shared::<Sensors>::new(256);
    let (power_source, power) = Shared::<Power>::new(256);
    logging.follow(Follower::new(&SENSORS, source));
    logging.follow(Follower::new(&POWER, power_source));
    for tick in 0..1000 {
        ring.borrow_mut().write(sensors(tick));
        power.borrow_mut().write(Power { header: header(tick), ..Power::default() });
        if tick % 100 == 99 {
            let pass = logging.pass();
            assert_eq!((pass.records, pass.lost), (200, None));
            assert_eq!(pass.caught_up, Some(header(tick)));
        }
    }
    logging.output().finish();
    let log = Log::open(&path).unwrap();
    let ticks: Vec<u64> = log.records::<Sensors>(&SENSORS).unwrap().iter().map(|s| s.header.tick).collect();
    assert_eq!(ticks, (0..1000).collect::<Vec<_>>());
    assert_eq!(log.records::<Power>(&POWER).unwrap().len(), 1000);
}

#[test]
fn what_was_overwritten_is_counted_and_noted_in_the_log() {
    let path = file("lost");
    let mut logging = Logging::new(to_file(&path));
    let (source, ring) = Shared::<Sensors>::new(256);
    logging.follow(Follower::new(&SENSORS, source));
    for tick in 0..300 {
        ring.borrow_mut().write(sensors(tick));
    }
    let noted = logging.pass().lost.expect("a loss");
    assert_eq!((noted.code, noted.detail), (EventCode::LogDropped as u64, 44));
    assert_eq!(logging.pass().lost, None);
    logging.output().finish();
    let log = Log::open(&path).unwrap();
    assert_eq!(log.records::<Event>(&EVENTS_LOGGER).unwrap(), [noted]);
    assert_eq!(log.records::<Sensors>(&SENSORS).unwrap()[0].header.tick, 44);
}

/// A writer that is always faster than the log.
struct Endless(Sensors);

impl Source<Sensors> for Endless {
    fn follow(&mut self) -> Option<(u64, &Sensors)> {
        self.0.header.tick += 1;
        Some((self.0.header.tick, &self.0))
    }
    fn lost(&self) -> u64 {
        0
    }
}

/// A pass took up to 2048 records of a topic, two seconds of a run, and nobody heard of the logger meanwhile.
#[test]
fn a_pass_that_never_catches_up_ends_soon_and_says_how_far_it_came() {
    let mut logging = Logging::new(to_file(&file("endless")));
    logging.follow(Follower::new(&SENSORS, Endless(sensors(0))));
    let pass = logging.pass();
    assert_eq!((pass.caught_up, pass.newest.map(|h| h.tick)), (None, Some(pass.records)));
    assert!(pass.records < 200, "a fifth of a second in real time: {}", pass.records);
}

#[test]
fn an_unwritable_log_is_said_once_and_the_run_goes_on() {
    let mut logging = Logging::new(to_file(Path::new("/proc/gangwerk/walk.mcap")));
    let complaint = logging.output().complaint().expect("a complaint");
    assert!(complaint.contains("/proc/gangwerk/walk.mcap"), "{complaint}");
    let (source, ring) = Shared::<Sensors>::new(256);
    logging.follow(Follower::new(&SENSORS, source));
    for tick in 0..10 {
        ring.borrow_mut().write(sensors(tick));
        assert_eq!(logging.pass().records, 1);
        logging.output().retry();
        logging.output().flush();
        assert_eq!(logging.output().complaint(), None);
    }
    assert_eq!(logging.output().dropped(), 10);
}

/// A disk that is full while the flag is set.
struct Disk(std::fs::File, Arc<AtomicBool>);

impl Disk {
    fn check(&self) -> std::io::Result<()> {
        if self.1.load(Ordering::Relaxed) { Err(std::io::ErrorKind::StorageFull.into()) } else { Ok(()) }
    }
}
impl Write for Disk {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.check()?;
        self.0.write(bytes)
    }
    fn flush(&mut self) -> std::io::Result<()> {
        self.check()?;
        self.0.flush()
    }
}
impl Seek for Disk {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.0.seek(to)
    }
}

#[test]
fn after_a_full_disk_a_new_part_begins_and_says_what_is_missing() {
    let path = file("full");
    let full = Arc::new(AtomicBool::new(false));
    let (parts, disk_full) = (Parts::new(&path), full.clone());
    let mut logging = Logging::new(LogOutput::new(Box::new(move |part| {
        let file = std::fs::File::create(parts.path(part))
            .map_err(|e| RecordingError::Create(parts.path(part), e))?;
        Recorder::to(Box::new(Disk(file, disk_full.clone())), &RobotInfo::default(), &RunInfo::default())
    })));
    let (source, ring) = Shared::<Sensors>::new(256);
    logging.follow(Follower::new(&SENSORS, source));
    let go = |ticks: std::ops::Range<u64>, logging: &mut Logging| {
        for tick in ticks {
            ring.borrow_mut().write(sensors(tick));
        }
        let pass = logging.pass();
        logging.output().retry();
        logging.output().flush();
        pass
    };
    go(0..100, &mut logging);
    assert_eq!(logging.output().complaint(), None);
    full.store(true, Ordering::Relaxed);
    go(100..200, &mut logging); // noticed when these are flushed
    let complaint = logging.output().complaint().expect("a complaint");
    assert!(complaint.contains("disk full"), "{complaint}");
    go(200..300, &mut logging);
    assert_eq!(logging.output().complaint(), None);
    full.store(false, Ordering::Relaxed);
    logging.output().retry();
    let noted = go(300..400, &mut logging).lost.expect("a loss");
    assert_eq!(noted.detail, 200); // those of the failed flush, and those while there was no file
    logging.output().finish();

    let first = Log::open(&path).unwrap().records::<Sensors>(&SENSORS).unwrap();
    let second = Log::open(&Parts::new(&path).path(2)).unwrap();
    assert_eq!(first.len(), 100);
    assert_eq!(second.records::<Sensors>(&SENSORS).unwrap()[0].header.tick, 300);
    assert_eq!(second.records::<Event>(&EVENTS_LOGGER).unwrap(), [noted]);
}
