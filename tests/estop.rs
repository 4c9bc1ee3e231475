//! `gangwerk estop` against a robot in real time, under everything that may be in its way: how soon the supply is off.
//!
//! Every request must be answered, and the supply must be off; times are printed, and left as a table in the build
//! directory. `GANGWERK_TRIALS=500` takes 500 of each instead of a few, and then holds the limits: 5 bus cycles without load,
//! 20 ms for 99 of 100 otherwise.

use harness::{Running, Site, doze, shared_turn, turn};
use ipc::{Reader, Space, StopButton, StopName};
use messages::topics::{EVENTS_WATCHDOG, POWER, SIM_STATE};
use messages::{Event, EventCode, Power, Process, SimState};
use realtime::{ThreadSchedule, clock, prepare_side_thread};
use rustix::process::Signal;
use std::fmt::Write as _;
use std::io::Write as _;
use std::net::{Ipv4Addr, TcpStream};
use std::path::PathBuf;
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::thread::JoinHandle;

const EXE: &str = harness::executable!();

/// Lola stands up and waits. Her supply is what is looked at.
const WAIT: &str = "
[[command]]
time = 0.2
topic = \"walk/stand\"
";

/// Trials of each condition, unless more are asked for.
const TRIALS: usize = 8;
/// From this many on, percentiles mean something, and are held.
const MANY: usize = 100;
/// Starts of one run whose processes are killed: each is a run of its own.
const DEATHS: usize = 3;
const SECOND: u64 = clock::SECOND;

fn trials() -> usize {
    std::env::var("GANGWERK_TRIALS").ok().and_then(|n| n.parse().ok()).unwrap_or(TRIALS)
}

/// The same, armed by the scene long after a person can have pressed.
const LATE: &str = "
[[command]]
time = 2.0
topic = \"system/reset\"

[[command]]
time = 2.1
topic = \"system/enable\"

[[command]]
time = 2.2
topic = \"walk/stand\"
";

/// A robot that stands, and what is seen of its supply.
struct Rig {
    run: Running,
    /// Records of the readers.
    _space: Space,
    power: Reader<Power>,
    sim: Reader<SimState>,
    events: Reader<Event>,
    site: Site,
}

/// One trial.
#[derive(Clone, Copy, Debug)]
struct Trial {
    /// \[us\] From the request to the record that says off, as the command says.
    record_us: u64,
    /// Bus cycles from the newest one before the command was started until the robot's power line was off.
    cycles: u64,
    /// \[ms\] From the start of the command to its end, with the time that a program takes to start.
    command_ms: f64,
}

impl Rig {
    fn new(site: Site, more: &[&str]) -> Self {
        site.scene("wait", 100_000.0, WAIT);
        let run = site.run("wait", more);
        Self::of(site, run)
    }

    fn of(site: Site, run: Running) -> Self {
        let mut rig = Self::beginning(site, run);
        rig.wait_for("power", |rig| rig.power.latest().is_some_and(|p| p.on == 1));
        rig
    }

    /// Whatever its supply.
    fn beginning(site: Site, mut run: Running) -> Self {
        let space = run.space();
        let (power, sim) = (space.reader(&POWER).unwrap(), space.reader(&SIM_STATE).unwrap());
        let events = space.reader(&EVENTS_WATCHDOG).unwrap();
        Self { power, sim, events, run, _space: space, site }
    }

    #[track_caller]
    fn wait_for(&mut self, what: &str, done: impl Fn(&mut Self) -> bool) {
        let begun = clock::now();
        while !done(self) {
            assert!(clock::now() < begun + 30 * SECOND, "{what}: {}", self.run.err());
            doze(0.001);
        }
    }

    /// Reset and enable, until the supply is on.
    fn arm(&mut self) {
        doze(0.3); // an edge is a command after a pause without it
        for command in ["system/reset", "system/enable"] {
            let said = self.site.topic(&["pub", command]);
            assert_eq!(said.code, Some(0), "{said:?} {}", self.run.err());
            doze(0.02);
        }
        self.wait_for("power again", |rig| {
            rig.power.latest().is_some_and(|p| p.on == 1) && rig.sim.latest().is_some_and(|s| s.power == 1)
        });
    }

    /// `gangwerk estop`, and what became of it.
    #[track_caller]
    fn stop(&mut self) -> Trial {
        while self.events.follow().is_some() {}
        let before = self.power.latest().unwrap().header.tick;
        let begun = clock::now();
        let dir = self.site.run_dir();
        let child = Command::new(EXE).args(["estop", "--dir"]).arg(&dir).output().unwrap();
        let command_ms = (clock::now() - begun) as f64 * 1e-6;
        let said = String::from_utf8_lossy(&child.stdout).into_owned();
        assert!(
            child.status.success(),
            "{said} {} {}",
            String::from_utf8_lossy(&child.stderr),
            self.run.err()
        );
        assert_eq!(self.power.latest().unwrap().on, 0, "answered before it was off");
        self.wait_for("power line off", |rig| rig.sim.latest().unwrap().power == 0);
        let event = std::iter::from_fn(|| self.events.follow().copied())
            .find(|e| e.code == EventCode::EmergencyStop as u64)
            .expect("an event that says who asked");
        assert_eq!(event.detail >> 32, u64::from(rustix::process::geteuid().as_raw()));
        let words: Vec<&str> = said.split_whitespace().collect();
        let number = |after: &str| -> u64 {
            let at =
                words.iter().position(|word| *word == after).unwrap_or_else(|| panic!("{after} in {said}"));
            words[at + 1].trim_end_matches(',').parse().unwrap()
        };
        let micros = words[words.iter().position(|word| *word == "us").expect("a time") - 1].parse().unwrap();
        Trial { record_us: micros, cycles: (number("tick") + 1).saturating_sub(before), command_ms }
    }
}

/// Percentile of values in any order.
fn at(mut values: Vec<f64>, share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[((values.len() as f64 * share).ceil() as usize).clamp(1, values.len()) - 1]
}

/// Figures of one condition; with many trials its limits are held.
fn row(name: &str, trials: &[Trial]) -> String {
    let of = |value: fn(&Trial) -> f64, share| at(trials.iter().map(value).collect(), share);
    let record = |share| of(|t| t.record_us as f64 * 1e-3, share);
    let (cycles, command) = (of(|t| t.cycles as f64, 1.0), of(|t| t.command_ms, 0.99));
    let mut row = String::new();
    let (p50, p99, max) = (record(0.5), record(0.99), record(1.0));
    let n = trials.len();
    let _ =
        writeln!(row, "| {name} | {n} of {n} | {p50:.2} | {p99:.2} | {max:.2} | {cycles} | {command:.1} |");
    print!("{row}");
    if n >= MANY {
        assert!(p99 <= 20.0, "{name}: p99 {p99} ms");
        assert!(name != "nothing" || p99 <= 5.0, "5 bus cycles of 1 ms without load, not {p99} ms");
    }
    row
}

/// Does something again and again until it is dropped.
struct Load(Arc<AtomicBool>, Vec<JoinHandle<()>>);

impl Load {
    fn start(threads: usize, work: impl Fn() + Clone + Send + 'static) -> Self {
        let on = Arc::new(AtomicBool::new(true));
        let start = |_| {
            let (on, work) = (on.clone(), work.clone());
            std::thread::spawn(move || {
                while on.load(Relaxed) {
                    work();
                }
            })
        };
        let threads = (0..threads).map(start).collect();
        Self(on, threads)
    }
}

impl Drop for Load {
    fn drop(&mut self) {
        self.0.store(false, Relaxed);
        self.1.drain(..).for_each(|thread| drop(thread.join()));
    }
}

/// Stop and arm again, as often as asked; `around` is in force while the stop is asked for.
fn repeated<T>(rig: &mut Rig, mut around: impl FnMut(&mut Rig) -> T) -> Vec<Trial> {
    let again = |n| {
        if n > 0 {
            rig.arm();
        }
        let load = around(rig);
        let trial = rig.stop();
        drop(load);
        trial
    };
    (0..trials()).map(again).collect()
}

/// Stopped by SIGSTOP, together with the supervisor, while the stop is asked for.
fn stopped(processes: &'static [Process]) -> Vec<Trial> {
    let mut rig = Rig::new(Site::patient(EXE), &[]);
    let trial = |n: usize| {
        if n > 0 {
            rig.arm();
        }
        rig.run.signal_supervisor(Signal::STOP);
        processes.iter().for_each(|p| rig.run.signal(*p, Signal::STOP));
        doze(0.02);
        let trial = rig.stop();
        processes.iter().for_each(|p| rig.run.signal(*p, Signal::CONT));
        rig.run.signal_supervisor(Signal::CONT);
        trial
    };
    (0..trials()).map(trial).collect()
}

/// Broker and logger killed, the supervisor stopped so that it does not start them again.
fn dead() -> Vec<Trial> {
    let death = |_| {
        let mut rig = Rig::new(Site::patient(EXE), &[]);
        rig.run.signal_supervisor(Signal::STOP);
        rig.run.kill(Process::Broker);
        rig.run.kill(Process::Logger);
        doze(0.02);
        rig.stop()
    };
    (0..DEATHS.max(trials() / 10)).map(death).collect()
}

/// Standard error of the run is a pipe that is full and that nobody reads.
fn terminal_blocked() -> Vec<Trial> {
    let site = Site::patient(EXE);
    site.scene("wait", 100_000.0, WAIT);
    let (_reader, writer) = std::io::pipe().unwrap();
    rustix::io::ioctl_fionbio(&writer, true).unwrap();
    while (&writer).write(&[b'x'; 512]).is_ok() {}
    rustix::io::ioctl_fionbio(&writer, false).unwrap();
    let run = site.run_into("wait", &["--no-log"], writer);
    let port = site.port();
    let mut rig = Rig::of(site, run);
    // Every one of them makes the broker say something.
    let _garbage = Load::start(1, move || {
        if let Ok(mut stream) = TcpStream::connect((Ipv4Addr::LOCALHOST, port)) {
            let _ = stream.write_all(&[0xFF; 64]);
        }
        doze(0.002);
    });
    doze(1.5);
    repeated(&mut rig, |_| ())
}

/// What a run in a mount namespace of its own does: a small /dev/shm, full with the log's disk in it. This test again, as a
/// process of its own; without the name of its table it has nothing to do.
#[test]
fn inside_a_full_disk() {
    let Some(table) = std::env::var_os("GANGWERK_ESTOP_INSIDE") else { return };
    let mut rig = Rig::new(Site::patient(EXE), &[]);
    let fill = |_: &mut Rig| {
        let mut file = std::fs::File::options().append(true).create(true).open("/dev/shm/fill").unwrap();
        while file.write(&[0; 4096]).is_ok_and(|n| n > 0) {}
    };
    let again = |n| {
        if n > 0 {
            let _ = std::fs::remove_file("/dev/shm/fill");
            rig.arm();
        }
        fill(&mut rig);
        rig.stop()
    };
    let all: Vec<Trial> = (0..trials()).map(again).collect();
    let _ = std::fs::remove_file("/dev/shm/fill");
    std::fs::write(table, row("/dev/shm and the log's disk full", &all)).unwrap();
}

fn full_disk() -> Option<String> {
    let table = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("estop_full.md");
    let _ = std::fs::remove_file(&table);
    // Between the trials there has to be room again: for the log that grows meanwhile, and for what commands say.
    let size = 96 + 4 * trials();
    let script = format!(
        "mount -t tmpfs -o size={size}m tmpfs /dev/shm && exec \"$0\" --exact inside_a_full_disk --nocapture"
    );
    let done = Command::new("unshare")
        .args(["--mount", "--propagation", "private", "sh", "-c", &script])
        .arg(std::env::current_exe().unwrap())
        .env("GANGWERK_ESTOP_INSIDE", &table)
        .output();
    let refused = |err: &[u8]| err.starts_with(b"unshare:") || err.starts_with(b"mount:");
    let done = done.ok().filter(|o| !refused(&o.stderr))?;
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stdout));
    Some(std::fs::read_to_string(table).unwrap())
}

/// Regression: reset and enable of the scene undid what a person had pressed before them, and she stood up.
#[test]
fn no_scene_undoes_what_a_person_pressed() {
    let (_turn, site) = (turn(), Site::patient(EXE));
    site.scene("late", 100_000.0, LATE);
    let run = site.run("late", &[]);
    let mut rig = Rig::beginning(site, run);
    rig.wait_for("a cycle", |rig| {
        rig.sim.latest().is_some_and(|s| s.header.tick > 10) && rig.power.latest().is_some()
    });
    let dir = rig.site.run_dir();
    let said = Command::new(EXE).args(["estop", "--dir"]).arg(&dir).output().unwrap();
    assert!(said.status.success(), "{said:?}");
    rig.wait_for("the scene's commands", |rig| {
        assert_eq!(rig.power.latest().unwrap().on, 0);
        rig.sim.latest().unwrap().time > 3.0
    });
    rig.arm();
}

#[test]
fn every_request_is_answered_and_the_supply_is_off() {
    let _turn = turn();
    let mut table = String::from(
        "| in its way | answered | p50 ms | p99 ms | max ms | cycles, most | whole command p99 ms |\n|---|---|---|---|---|---|---|\n",
    );
    table += &quiet("nothing", |_| None);
    table += &row("broker, logger and supervisor stopped", &stopped(&[Process::Broker, Process::Logger]));
    table += &row("broker and logger dead", &dead());
    table += &row("terminal blocked, broker complaining", &terminal_blocked());
    let connect = |rig: &mut Rig| {
        let port = rig.site.port();
        let load = Load::start(2, move || {
            drop(TcpStream::connect((Ipv4Addr::LOCALHOST, port)));
            doze(0.0004);
        });
        doze(0.1);
        Some(load)
    };
    table += &quiet("flood of connections to the broker", connect);
    let press = |rig: &mut Rig| {
        let name = StopName::own(&rig.site.run_dir());
        Some(Load::start(2, move || drop(StopButton::new(&name).and_then(|b| b.press()))))
    };
    // Its first datagram stops the robot: what counts is that the others are answered, too.
    table += &flooded(press);
    let spin = |_: &mut Rig| {
        let until = clock::now() + SECOND / 20;
        Some(Load::start(1, move || {
            prepare_side_thread(&ThreadSchedule { priority: 55, core: Some(1) });
            while clock::now() < until {
                std::hint::spin_loop();
            }
            doze(0.001);
        }))
    };
    table += &quiet("spinner at priority 55 on the chain's core", spin);
    match full_disk() {
        Some(row) => table += &row,
        None => harness::left_out("a full /dev/shm needs a mount namespace, which this user may not make"),
    }
    println!("\n{table}");
    std::fs::write(concat!(env!("CARGO_TARGET_TMPDIR"), "/../estop_table.md"), &table).unwrap();
}

/// A run without a log, under this load while the stop is asked for.
fn quiet(name: &str, load: impl FnMut(&mut Rig) -> Option<Load>) -> String {
    let mut rig = Rig::new(Site::patient(EXE), &["--no-log"]);
    row(name, &repeated(&mut rig, load))
}

/// Requests of others fill the line: each `gangwerk estop` is answered, and says that the supply is off.
fn flooded(flood: impl Fn(&mut Rig) -> Option<Load>) -> String {
    let mut rig = Rig::new(Site::patient(EXE), &["--no-log"]);
    let _load = flood(&mut rig);
    let dir = rig.site.run_dir();
    let took = (0..trials()).map(|_| {
        let begun = clock::now();
        let child = Command::new(EXE).args(["estop", "--dir"]).arg(&dir).output().unwrap();
        assert!(child.status.success(), "{child:?}");
        (clock::now() - begun) as f64 * 1e-6
    });
    let took: Vec<f64> = took.collect();
    assert_eq!(rig.power.latest().unwrap().on, 0);
    assert!(rig.run.is_alive());
    let (n, p99) = (took.len(), at(took.clone(), 0.99));
    format!("| flood of requests on its own line | {n} of {n} | - | - | - | - | {p99:.1} |\n")
}

#[test]
fn it_works_in_simulated_time_and_names_a_robot_that_is_not_there() {
    let _turn = shared_turn();
    let mut rig = Rig::new(Site::patient(EXE), &["--lockstep", "--no-log"]);
    rig.stop();
    // Other spellings stopped another robot, or none.
    let dir = format!("--dir={}", rig.site.run_dir().display());
    for words in [&["estop", &dir][..], &["--config", "/nowhere", "estop", &dir]] {
        let said = Command::new(EXE).args(words).output().unwrap();
        let out = String::from_utf8_lossy(&said.stdout).into_owned();
        assert!(said.status.success() && out.contains("power was off already"), "{said:?}");
    }
    drop(rig);
    let nowhere = Command::new(EXE).args(["estop", "--dir", "/nowhere/at/all"]).output().unwrap();
    assert_eq!(nowhere.status.code(), Some(1));
    let said = String::from_utf8_lossy(&nowhere.stdout).into_owned();
    assert!(said.contains("NOT KNOWN TO BE OFF: nobody listens"), "{said}");
}
