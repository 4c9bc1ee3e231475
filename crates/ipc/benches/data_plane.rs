//! Cost of the data plane: `cargo bench -p ipc`.
//!
//! Times are percentiles over single operations, clock reading (about 30 ns) included. On a virtual machine the maxima
//! are the host's.

use ipc::Space;
use messages::topics::{BUS_TX, PLAN, SENSORS, with_type};
use messages::{BusFrames, Plan, Process, Record, Sensors, TOPICS, Topic, topics::ForType};
use realtime::{Histogram, clock};
use std::path::Path;
use std::sync::Barrier;
use std::time::Duration;

fn main() {
    let dir = std::env::temp_dir().join(format!("gangwerk-bench-{}", std::process::id()));
    let start = clock::now();
    let system = Space::create(&dir).unwrap();
    println!("Space::create            {:8.1} ms", ms(start));
    println!("shared memory            {:8.1} MiB", used() as f64 / f64::from(1 << 20));
    opening(&dir);
    println!("\n{:24} {:>8} {:>8} {:>8} {:>9}", "ns", "p50", "p99", "p99.9", "max");
    record::<Sensors>(&dir, &system, &SENSORS, "sensors");
    record::<Plan>(&dir, &system, &PLAN, "plan");
    record::<BusFrames>(&dir, &system, &BUS_TX, "bus_tx");
    bells(&dir);
    for spins in [0, 50] {
        ping_pong(&dir, spins);
    }
    drop(system);
    std::fs::remove_dir_all(dir).unwrap();
}

fn ms(start: u64) -> f64 {
    (clock::now() - start) as f64 / 1e6
}

fn used() -> u64 {
    use std::os::unix::fs::MetadataExt;
    let files = std::fs::read_dir("/dev/shm").unwrap().flatten();
    let own = files.filter(|f| f.file_name().to_string_lossy().starts_with("gangwerk_"));
    own.map(|f| f.metadata().map_or(0, |m| m.blocks() * 512)).sum()
}

fn opening(dir: &Path) {
    struct Read<'a>(&'a Space);
    impl ForType<()> for Read<'_> {
        fn call<T: Record>(self, topic: &'static Topic) {
            std::mem::forget(self.0.reader::<T>(topic).unwrap());
        }
    }
    let start = clock::now();
    let lowlevel = Space::open(dir, Process::Lowlevel).unwrap();
    println!("Space::open              {:8.1} ms", ms(start));
    let start = clock::now();
    let writer = lowlevel.writer::<Sensors>(&SENSORS).unwrap();
    println!("writer of sensors        {:8.1} ms", ms(start));
    let start = clock::now();
    let reader = lowlevel.reader::<Sensors>(&SENSORS).unwrap();
    println!("reader of sensors        {:8.1} ms", ms(start));
    drop((writer, reader));
    let logger = Space::open(dir, Process::Logger).unwrap();
    let start = clock::now();
    for topic in TOPICS {
        with_type(topic.name, Read(&logger));
    }
    println!("readers of all topics    {:8.1} ms", ms(start));
}

fn line(what: &str, times: &Histogram) {
    let [p50, p99, p999, max] = times.percentiles();
    println!("{what:24} {p50:8} {p99:8} {p999:8} {max:9}");
}

fn timed<R>(times: &mut Histogram, f: impl FnOnce() -> R) -> R {
    let start = clock::now();
    let result = f();
    times.record(clock::now() - start);
    result
}

fn record<T: Record>(dir: &Path, system: &Space, topic: &Topic, name: &str) {
    let space = Space::open(dir, topic.writer).unwrap();
    let mut writer = space.writer::<T>(topic).unwrap();
    let mut reader = system.reader::<T>(topic).unwrap();
    let mut every = system.reader::<T>(topic).unwrap();
    let mut times: [Histogram; 4] = std::array::from_fn(|_| Histogram::new());
    let record = Box::new(T::empty());
    for _ in 0..100_000 {
        timed(&mut times[0], || writer.write(&record));
        timed(&mut times[1], || assert!(reader.refresh()));
        timed(&mut times[2], || assert!(!reader.refresh()));
        timed(&mut times[3], || assert!(every.follow().is_some()));
    }
    println!("{name}: {} bytes", size_of::<T>());
    for (what, times) in
        ["  write", "  refresh, new", "  refresh, nothing new", "  follow"].iter().zip(&times)
    {
        line(what, times);
    }
}

fn bells(dir: &Path) {
    let space = Space::open(dir, Process::Lowlevel).unwrap();
    let other = Space::open(dir, Process::Controller).unwrap();
    let waiter = other.waiter(Process::Controller).unwrap();
    let bell = space.bell(&messages::topics::PLANNER_TICK).unwrap();
    let mut times: [Histogram; 4] = std::array::from_fn(|_| Histogram::new());
    println!("bell");
    for _ in 0..20_000 {
        timed(&mut times[0], || bell.ring());
        timed(&mut times[1], || waiter.wait(Duration::from_millis(1)));
    }
    for _ in 0..1000 {
        timed(&mut times[2], || waiter.wait(Duration::from_micros(100)));
        timed(&mut times[3], || waiter.wait(Duration::from_micros(1500)));
    }
    for (what, times) in
        ["  ring", "  wait, rung", "  wait 100 us, not rung", "  wait 1500 us, not rung"].iter().zip(&times)
    {
        line(what, times);
    }
}

/// Two threads with ports of their own answer each other; half of the round is one way.
fn ping_pong(dir: &Path, spins: u32) {
    use messages::topics::{BUS_RX, BUS_TX};
    const ROUNDS: usize = 10_000;
    let ready = Barrier::new(2);
    let times = std::thread::scope(|scope| {
        scope.spawn(|| {
            let space = Space::open(dir, Process::SimBackend).unwrap();
            let waiter = space.waiter(Process::SimBackend).unwrap().with_spins(spins);
            let mut input = space.reader::<BusFrames>(&BUS_TX).unwrap();
            let mut output = space.writer::<BusFrames>(&BUS_RX).unwrap();
            let bell = space.bell(&BUS_RX).unwrap();
            input.refresh();
            ready.wait();
            let mut frames = BusFrames::default();
            for _ in 0..ROUNDS {
                waiter.wait_until(Duration::from_secs(1), || false, || input.refresh());
                frames.header.tick += 1;
                output.write(&frames);
                bell.ring();
            }
            ready.wait();
        });
        let space = Space::open(dir, Process::Lowlevel).unwrap();
        let waiter = space.waiter(Process::Lowlevel).unwrap().with_spins(spins);
        let mut input = space.reader::<BusFrames>(&BUS_RX).unwrap();
        let mut output = space.writer::<BusFrames>(&BUS_TX).unwrap();
        let bell = space.bell(&BUS_TX).unwrap();
        input.refresh();
        ready.wait();
        let mut times = Histogram::new();
        let mut frames = BusFrames::default();
        for _ in 0..ROUNDS {
            frames.header.tick += 1;
            timed(&mut times, || {
                output.write(&frames);
                bell.ring();
                waiter.wait_until(Duration::from_secs(1), || false, || input.refresh());
            });
        }
        ready.wait();
        times
    });
    line(&format!("round trip, spins {spins}"), &times);
}
