//! A ring of nine slaves between two network namespaces at 1 kHz, as a joint loop would drive it: how punctual, how fast
//! round, how much is lost, beside cyclictest in the same run.
//!
//! `cargo run --release -p sercos --example ring -- --seconds 60 [--break] [--capture FILE]`. Needs root.
//! `--break` pulls and plugs a cable on the way; `--capture` records port 1 with dumpcap. Prints one figure per line.

#[path = "../tests/veth/mod.rs"]
mod veth;

use realtime::{Histogram, Period, ThreadSchedule, clock, prepare_thread};
use sercos::{RingEvent, Stage};
use std::error::Error;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use veth::{ADDRESSES, CYCLE, DATA, FAR, NEAR, Veth};

/// Priority of the loop, of the slaves, and of cyclictest beside them.
const PRIORITY: [u8; 3] = [80, 79, 80];

struct Options {
    seconds: u64,
    pull: bool,
    capture: Option<String>,
}

fn options() -> Result<Options, String> {
    let mut options = Options { seconds: 10, pull: false, capture: None };
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{argument} needs a value"));
        match argument.as_str() {
            "--seconds" => options.seconds = value()?.parse().map_err(|e| format!("--seconds: {e}"))?,
            "--capture" => options.capture = Some(value()?),
            "--break" => options.pull = true,
            _ => return Err(format!("unknown argument {argument}; --seconds N, --break, --capture FILE")),
        }
    }
    Ok(options)
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = options()?;
    if let Some(reason) = veth::lacks() {
        return Err(reason.into());
    }
    let veth = Veth::new("tool")?;
    let capture = options.capture.as_ref().map(|file| record(&veth, file)).transpose()?;
    let stop = Arc::new(AtomicBool::new(false));
    let slaves = veth.slaves(&stop, || {
        prepare_thread(&ThreadSchedule { priority: PRIORITY[1], core: None });
    });
    let beside = cyclictest(options.seconds);
    let result = run(&veth, &options);
    stop.store(true, Ordering::Relaxed);
    slaves.thread.join().map_err(|_| "the slaves have died")?;
    if let Some(mut capture) = capture {
        Command::new("kill").args(["-INT", &capture.id().to_string()]).status()?;
        capture.wait()?;
    }
    match beside {
        Ok(child) => report_cyclictest(child)?,
        Err(error) => println!("cyclictest: {error}"),
    }
    for (name, count) in [("malformed", &slaves.malformed), ("foreign", &slaves.foreign)] {
        println!("slaves_{name} {}", count.load(Ordering::Relaxed));
    }
    result
}

/// Records port 1 into a file.
fn record(veth: &Veth, file: &str) -> Result<Child, Box<dyn Error>> {
    let mut child = Command::new("ip")
        .args(["netns", "exec", veth.near(), "dumpcap", "-q", "-P", "-i", NEAR[0], "-w", file])
        .stderr(Stdio::piped())
        .spawn()?;
    let said = BufReader::new(child.stderr.take().ok_or("dumpcap says nothing")?);
    let mut lines = said.lines().map_while(Result::ok);
    let began = lines.any(|line| line.starts_with("File:"));
    std::thread::spawn(move || lines.for_each(drop));
    if began { Ok(child) } else { Err("dumpcap does not record (is tshark installed?)".into()) }
}

fn cyclictest(seconds: u64) -> std::io::Result<Child> {
    Command::new("cyclictest")
        .args(["-q", "-m", "-t", "1", "-i", "1000", "-h", "20000", "-p"])
        .args([&PRIORITY[2].to_string(), "-D", &seconds.to_string()])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
}

/// Half, and 99 of 100, of cyclictest's wake-ups were at most so late.
fn report_cyclictest(child: Child) -> Result<(), Box<dyn Error>> {
    let output = child.wait_with_output()?;
    let text = String::from_utf8_lossy(&output.stdout);
    let row = |line: &str| {
        let mut columns = line.split_whitespace();
        let pair = (columns.next()?.parse::<u64>().ok()?, columns.next()?.parse::<u64>().ok()?);
        columns.next().is_none().then_some(pair)
    };
    let rows: Vec<_> = text.lines().filter(|l| !l.starts_with('#')).filter_map(row).collect();
    let all: u64 = rows.iter().map(|r| r.1).sum();
    let at = |share: f64| {
        let mut sum = 0;
        let reached = |r: &&(u64, u64)| {
            sum += r.1;
            sum as f64 >= share * all as f64
        };
        rows.iter().find(reached).map_or(0, |r| r.0)
    };
    println!("cyclictest_p50_us {}\ncyclictest_p99_us {}", at(0.5), at(0.99));
    Ok(())
}

fn run(veth: &Veth, options: &Options) -> Result<(), Box<dyn Error>> {
    let mut near = veth.master(true);
    prepare_thread(&ThreadSchedule { priority: PRIORITY[0], core: None });
    let mut period = Period::new(clock::now() + CYCLE, CYCLE, 1000);
    let mut lateness = Histogram::new();
    let mut round = Histogram::new();
    let (mut number, mut running, mut started) = (0u8, 0, 0);
    let last = options.seconds * 1_000_000_000 / CYCLE;
    while running < last {
        clock::sleep_until(period.planned());
        let late = clock::now().saturating_sub(period.planned());
        number = number.wrapping_add(1);
        for i in 0..ADDRESSES.len() {
            near.master_mut().set_command(i, &[number; DATA]);
        }
        let begun = clock::now();
        near.send();
        while clock::now() < begun + CYCLE * 7 / 10 && !near.drain() {
            near.wait(CYCLE / 10);
        }
        if running > 0 {
            lateness.record(late);
            round.record(clock::now() - begun);
        }
        match near.receive() {
            Stage::Running => running += 1,
            Stage::Starting(_) => started += 1,
            Stage::Failed(trouble) => return Err(trouble.into()),
        }
        if options.pull && running == last / 4 {
            veth.set(FAR[1], "down");
        } else if options.pull && running == last / 4 + last / 8 {
            veth.set(FAR[1], "up");
        }
        while let Some(event) = near.master_mut().take_event() {
            if matches!(event, RingEvent::RingBroken(..) | RingEvent::RingClosed) {
                println!("event {event:?} in cycle {running}");
            }
        }
        period.finish(clock::now());
    }
    let counts = near.master().counts();
    let us = |histogram: &Histogram| histogram.percentiles().map(|ns| ns as f64 / 1e3);
    let (late, round) = (us(&lateness), us(&round));
    println!("cycles {running}\nstart_cycles {started}\nperiods_skipped {}", period.skipped());
    println!("lateness_p50_us {}\nlateness_p99_us {}\nlateness_max_us {}", late[0], late[1], late[3]);
    println!("round_p50_us {}\nround_p99_us {}", round[0], round[1]);
    println!("data_missed {}\nlongest_run_missed {}", counts.missed, counts.longest);
    println!("telegrams_late {}\nmalformed {}", counts.late, counts.malformed);
    println!("cycles_open {}\nrefused {}", counts.open, near.refused());
    Ok(())
}
