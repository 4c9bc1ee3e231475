//! `gangwerk latency`: what it takes to tell another process something.
//!
//! Two processes send messages of the size of a bus record to and fro over one way after the other, in rounds, with
//! `cyclictest` between them, so that whatever else the machine does meets all of them. A time is half of a round trip: from
//! before the writing until the other process has the bytes. Polled ways spin on two cores; woken ones sleep on one core, at
//! SCHED_FIFO, as the processes of the chain do; the broker's are threads of the ordinary scheduler.

mod brokered;
mod report;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitCode, Stdio};
use std::time::Duration;

use latency::{Link, LinkEnd, Opened, raw, system, topics};
use realtime::cyclictest;
use realtime::{ThreadSchedule, clock, prepare_thread};

pub use report::{LatencyReport, LatencyRow};

/// Scheduling of both ends.
const PRIORITY: u8 = 70;
/// Messages of a round on a way that is polled, back to back, and on one that is woken, each after a pause.
const POLLED: usize = 5000;
const WOKEN: usize = 1000;
const PAUSE_NS: u64 = 500_000;
/// The first message, from the other process, and the last one, to it.
const HELLO: u64 = 1;
const LAST: u64 = u64::MAX;

/// Wake-up of the other end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum WakeUp {
    /// It looks all the time.
    Polled,
    /// It sleeps until it is woken.
    Woken,
    /// Through the broker's process.
    Brokered,
}

/// All ways, in the order of the table.
const WAYS: [(&str, WakeUp); 9] = [
    ("topic", WakeUp::Polled),
    ("iceoryx2 blackboard", WakeUp::Polled),
    ("iceoryx2 samples", WakeUp::Polled),
    ("topic and bell", WakeUp::Woken),
    ("iceoryx2 with an event", WakeUp::Woken),
    ("POSIX queue, in 2 parts", WakeUp::Woken),
    ("Unix datagram", WakeUp::Woken),
    ("TCP on loopback", WakeUp::Woken),
    ("command to answer over the broker", WakeUp::Brokered),
];

fn open(way: &str, dir: &Path, end: LinkEnd) -> Opened {
    match way {
        "topic" => topics::open(dir, end, false),
        "iceoryx2 blackboard" => raw::blackboard(dir, end),
        "iceoryx2 samples" => raw::samples(dir, end, false),
        "topic and bell" => topics::open(dir, end, true),
        "iceoryx2 with an event" => raw::samples(dir, end, true),
        "POSIX queue, in 2 parts" => system::posix_queue(dir, end),
        "Unix datagram" => system::unix_socket(dir, end),
        "TCP on loopback" => system::tcp(dir, end),
        _ => brokered::commands(dir, end, |role| start(role, dir, "any")),
    }
}

/// Measures every way in `rounds` rounds; `progress` hears what is being measured.
///
/// # Errors
/// The program cannot start itself again, or has no place to put files.
pub fn measure(rounds: usize, progress: impl Fn(usize, &str)) -> Result<LatencyReport, String> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let mut report =
        LatencyReport::new(WAYS.iter().map(|&(name, kind)| LatencyRow::new(name, kind)).collect());
    for round in 0..rounds {
        report.hear(cyclictest(Some(cores - 1), PRIORITY, 1));
        for (row, &(way, kind)) in WAYS.iter().enumerate() {
            progress(round, way);
            let found = if kind == WakeUp::Polled && cores < 2 {
                Err("needs two cores".into())
            } else {
                std::thread::scope(|s| s.spawn(|| one_round(way, kind, cores)).join())
                    .unwrap_or_else(|_| Err("the measurement broke off".into()))
            };
            report.add(row, found);
        }
    }
    Ok(report)
}

/// The times \[ns\] of one way in one round, on a thread of its own.
fn one_round(way: &str, kind: WakeUp, cores: usize) -> Result<Vec<u64>, String> {
    let dir = Dir::make()?;
    let mut near = open(way, &dir.0, LinkEnd::Near)?;
    let (own, other) = match kind {
        WakeUp::Polled => (cores - 2, (cores - 1).to_string()),
        WakeUp::Woken => (cores - 1, (cores - 1).to_string()),
        WakeUp::Brokered => (0, "any".to_owned()),
    };
    let mut far = Helper(start(way, &dir.0, &other)?);
    if kind != WakeUp::Brokered {
        prepare_thread(&ThreadSchedule { priority: PRIORITY, core: Some(own) });
        near.receive()?;
    } else {
        clock::sleep_until(clock::now() + clock::SECOND / 5);
    }
    let times = round_trips(near.as_mut(), kind);
    let _ = near.send(LAST);
    far.wait(Duration::from_millis(300));
    times
}

fn round_trips(near: &mut dyn Link, kind: WakeUp) -> Result<Vec<u64>, String> {
    let count = if kind == WakeUp::Polled { POLLED } else { WOKEN };
    let mut times = Vec::with_capacity(count);
    for _ in 0..count {
        if kind != WakeUp::Polled {
            clock::sleep_until(clock::now() + PAUSE_NS);
        }
        let sent = clock::now();
        near.send(sent)?;
        let stamp = near.receive()?;
        let round = clock::now() - sent;
        if stamp != sent {
            return Err(format!("another message came back than was sent ({stamp}, {sent})"));
        }
        times.push(round / 2);
    }
    Ok(times)
}

/// The other process: `gangwerk latency-end WAY DIR CORE`.
///
/// # Errors
/// The way cannot be opened, or the first process fell silent.
pub fn answer(way: &str, dir: &Path, core: &str) -> Result<(), String> {
    if way == "broker" {
        return brokered::broker(dir);
    }
    let mut far = open(way, dir, LinkEnd::Far)?;
    if let Ok(core) = core.parse() {
        prepare_thread(&ThreadSchedule { priority: PRIORITY, core: Some(core) });
    }
    far.send(HELLO)?;
    loop {
        let stamp = far.receive()?;
        if stamp == LAST {
            return Ok(());
        }
        far.send(stamp)?;
    }
}

fn start(way: &str, dir: &Path, core: &str) -> Result<Child, String> {
    let exe = std::env::current_exe().map_err(|e| e.to_string())?;
    let mut command = Command::new(exe);
    command.args(["latency-end", way]).arg(dir).arg(core).stdin(Stdio::null()).stdout(Stdio::null());
    command.stderr(Stdio::null()).spawn().map_err(|e| e.to_string())
}

/// A process that does not outlive its owner.
struct Helper(Child);

impl Helper {
    /// Waits for its end.
    fn wait(&mut self, limit: Duration) {
        let until = clock::now() + limit.as_nanos() as u64;
        while clock::now() < until && matches!(self.0.try_wait(), Ok(None)) {
            clock::sleep_until(clock::now() + clock::SECOND / 500);
        }
    }
}

impl Drop for Helper {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A directory of its own for one round.
struct Dir(PathBuf);

impl Dir {
    fn make() -> Result<Self, String> {
        use std::os::unix::fs::DirBuilderExt;
        static COUNT: std::sync::atomic::AtomicU32 = std::sync::atomic::AtomicU32::new(0);
        let n = COUNT.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        let dir = std::env::temp_dir().join(format!("gangwerk-latency-{}-{n}", std::process::id()));
        std::fs::DirBuilder::new().mode(0o700).create(&dir).map_err(|e| format!("{}: {e}", dir.display()))?;
        Ok(Self(dir))
    }
}

impl Drop for Dir {
    fn drop(&mut self) {
        raw::clear(&self.0);
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// `gangwerk latency`: table or JSON, and perhaps the picture.
///
/// # Errors
/// See [`measure`]; or the picture cannot be written.
pub fn main(rounds: usize, png: Option<&Path>, json: bool) -> Result<ExitCode, Box<dyn Error>> {
    let report = measure(rounds, |round, way| eprintln!("round {}: {way}", round + 1))?;
    if let Some(png) = png {
        report.draw(png)?;
    }
    println!("{}", if json { serde_json::to_string(&report)? } else { report.table() });
    Ok(ExitCode::SUCCESS)
}
