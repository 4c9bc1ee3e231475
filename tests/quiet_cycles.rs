//! System calls of a control cycle while the robot walks and observers come and die: a short list,
//! each so often per cycle and no oftener, no allocation, no page fault.
//!
//! The calls are counted by the kernel (tracefs, root only), not by us. `GANGWERK_SECONDS` says how long.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use harness::{Running, Site, WALK, doze, turn};
use messages::topics::{STATS_CONTROLLER, STATS_LOWLEVEL, STATS_PLANNER, STATS_SIM_BACKEND, STATS_WATCHDOG};
use messages::{CycleStats, Process, Topic};
use realtime::clock;

const EXE: &str = harness::executable!();

/// Time until she walks \[s\].
const WALKS: f64 = 4.0;
const CYCLE: f64 = 1e-3;
/// Observers at a time.
const OBSERVERS: usize = 8;

const SENDTO: u32 = 44;
const RECVFROM: u32 = 45;
const GETRUSAGE: u32 = 98;
const CLOCK_NANOSLEEP: u32 = 230;
const PPOLL: u32 = 271;

/// Numbers of system calls, and how often per cycle at most.
type Calls = &'static [(u32, f64)];

/// Calls of each process. A bell is rung by a datagram (sendto) to whoever is woken and heard by ppoll and recvfrom; the
/// two clocks sleep; page faults are asked for (getrusage) once in a hundred cycles.
const LIST: [(Process, &Topic, Calls); 5] = [
    (Process::Watchdog, &STATS_WATCHDOG, &[(CLOCK_NANOSLEEP, 1.0), (SENDTO, 0.02), (GETRUSAGE, 0.01)]),
    (
        Process::SimBackend,
        &STATS_SIM_BACKEND,
        &[(PPOLL, 1.0), (RECVFROM, 1.0), (SENDTO, 1.0), (GETRUSAGE, 0.01)],
    ),
    (Process::Planner, &STATS_PLANNER, &[(PPOLL, 1.0), (RECVFROM, 1.0), (SENDTO, 0.02), (GETRUSAGE, 0.01)]),
    (
        Process::Controller,
        &STATS_CONTROLLER,
        &[(PPOLL, 1.0), (RECVFROM, 1.0), (SENDTO, 1.0), (GETRUSAGE, 0.01)],
    ),
    // It rings simulation, planner and controller, and hears the simulation and the controller.
    (
        Process::Lowlevel,
        &STATS_LOWLEVEL,
        &[(CLOCK_NANOSLEEP, 1.0), (PPOLL, 2.0), (RECVFROM, 3.0), (SENDTO, 3.0), (GETRUSAGE, 0.01)],
    ),
];
/// Share by which a count may be above: a wait that is woken too early is gone into again.
const PLAY: f64 = 0.02;

/// Counts the system calls of some threads, by thread and number.
struct Trace(PathBuf);

impl Trace {
    /// None without tracefs or the right to use it.
    fn of(threads: &[u32]) -> Option<Self> {
        let home = ["/sys/kernel/tracing", "/sys/kernel/debug/tracing"].map(Path::new);
        let home = home.into_iter().find(|dir| dir.join("events/raw_syscalls").exists())?;
        let dir = home.join(format!("instances/gangwerk-{}", std::process::id()));
        fs::create_dir(&dir).ok()?;
        let trace = Self(dir);
        trace.set("buffer_size_kb", "65536").ok()?;
        let threads: Vec<String> = threads.iter().map(u32::to_string).collect();
        trace.set("set_event_pid", &threads.join(" ")).ok()?;
        trace.set("events/raw_syscalls/sys_enter/enable", "1").ok()?;
        Some(trace)
    }

    fn set(&self, file: &str, to: &str) -> std::io::Result<()> {
        fs::write(self.0.join(file), to)
    }

    fn counts(&self) -> BTreeMap<(u32, u32), f64> {
        self.set("tracing_on", "0").unwrap();
        let mut counts = BTreeMap::new();
        let text = fs::read_to_string(self.0.join("trace")).unwrap();
        for line in text.lines().filter(|line| !line.starts_with('#')) {
            // `   gangwerk-27562 [001] ..... 99.1: sys_enter: NR 45 (...)`
            let words: Vec<&str> = line.split_whitespace().collect();
            let number = words.iter().position(|w| *w == "NR").map(|i| words[i + 1]);
            let thread = words[0].rsplit('-').next();
            if let (Some(Ok(thread)), Some(Ok(number))) = (thread.map(str::parse), number.map(str::parse)) {
                *counts.entry((thread, number)).or_default() += 1.0;
            }
        }
        counts
    }
}

impl Drop for Trace {
    fn drop(&mut self) {
        let _ = self.set("events/raw_syscalls/sys_enter/enable", "0");
        let _ = fs::remove_dir(&self.0);
    }
}

/// Observers come, read one record at least, and die.
fn observe(site: &Site, run: &mut Running, seconds: f64) -> usize {
    let begun = clock::now();
    let (dir, mut many) = (site.run_dir(), 0);
    while (clock::now() - begun) as f64 * 1e-9 < seconds {
        let mut all: Vec<_> = (0..OBSERVERS)
            .map(|_| {
                let mut command = Command::new(EXE);
                command.args(["topic", "echo", "sensors", "--dir"]).arg(&dir);
                command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
            })
            .collect();
        doze(0.5);
        for child in &mut all {
            child.kill().unwrap();
            child.wait().unwrap();
        }
        many += all.len();
        assert!(run.is_alive(), "{}", run.err());
    }
    many
}

#[test]
fn a_cycle_makes_the_calls_of_its_list_and_neither_allocates_nor_faults() {
    let _turn = turn();
    let seconds: f64 = std::env::var("GANGWERK_SECONDS").ok().and_then(|n| n.parse().ok()).unwrap_or(8.0);
    let site = Site::patient(EXE);
    site.scene("quiet", 10_000.0, WALK);
    let mut run = site.run("quiet", &["--no-log"]);
    let space = run.space();
    let mut readers = LIST.map(|(_, topic, _)| space.reader::<CycleStats>(topic).unwrap());
    doze(WALKS);

    let threads = LIST.map(|(process, ..)| run.pid(process));
    let before = readers.each_mut().map(|r| *r.latest().unwrap());
    // A trace of a minute is large enough; the rest of a long run is judged by what the processes count.
    let trace = Trace::of(&threads);
    let mut observers = observe(&site, &mut run, seconds.min(60.0));
    let after = readers.each_mut().map(|r| *r.latest().unwrap());
    let counts = trace.as_ref().map(Trace::counts);
    drop(trace);
    observers += observe(&site, &mut run, seconds - 60.0);
    let last = readers.each_mut().map(|r| *r.latest().unwrap());
    run.interrupt();
    let said = run.end();
    assert!(!said.err.contains("watchdog: motor supply off"), "{said:#?}");

    let mut wrong = Vec::new();
    for (i, (process, _, list)) in LIST.iter().enumerate() {
        let cycles = (after[i].cycles - before[i].cycles) as f64;
        assert!(cycles > 0.9 * seconds.min(60.0) / CYCLE, "{process:?}: {cycles} cycles");
        let mine = counts.iter().flatten().filter(|((thread, _), _)| *thread == threads[i]);
        for ((_, call), count) in mine {
            let most = list.iter().find(|(c, _)| c == call).map_or(0.0, |(_, most)| *most);
            println!("{process:?}: call {call}: {:.4} per cycle, at most {most}", count / cycles);
            // The statistics come ten times a second: so many cycles more may be in the count.
            if *count > (1.0 + PLAY) * most * (cycles + 200.0) {
                wrong.push(format!(
                    "{process:?} makes call {call} {count} times in {cycles} cycles, not {most} per cycle"
                ));
            }
        }
        let more = |of: fn(&CycleStats) -> [u64; 2]| {
            let (a, b) = (of(&before[i]), of(&last[i]));
            [b[0] - a[0], b[1] - a[1]]
        };
        for (what, count) in
            [("page faults", more(|s| s.page_faults)), ("allocations", more(|s| s.allocations))]
        {
            if count != [0, 0] {
                wrong.push(format!(
                    "{process:?}: {what} {count:?} in {} cycles",
                    last[i].cycles - before[i].cycles
                ));
            }
        }
    }
    println!("{observers} observers came and died");
    assert_eq!(wrong, [""; 0]);
    match counts {
        None => println!("system calls were not counted: that needs root and tracefs"),
        Some(counts) => assert!(counts.len() >= 15, "{counts:?}"),
    }
}
