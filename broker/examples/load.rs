//! The broker under load: `cargo run --release -p broker --example load -- commands | flood | connect ADDRESS SECONDS`.
//!
//! - `commands`: 20 clients on the socket with 500 stops each per second: how many were answered, how many were lost.
//! - `flood`: a process of its own connects 5,000 times a second and sends garbage; the answers to one honest client.
//! - `connect`: that process.

use std::io::Write;
use std::net::{SocketAddr, TcpStream};
use std::path::Path;
use std::thread;
use std::time::Duration;

use broker::daemon::{Tcp, serve};
use broker::{Client, StreamClient};
use ipc::{Run, Space};
use messages::command::Domain;
use messages::{Command, CommandSource};
use realtime::Stop;
use realtime::clock::{SECOND, now, sleep_until};

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["connect", address, seconds] => {
            connect(address.parse().expect("an address"), seconds.parse().expect("seconds"));
        }
        ["commands"] => with_broker(commands),
        ["flood"] => with_broker(flood),
        _ => eprintln!("commands | flood"),
    }
}

/// A broker in this process, in a run directory of its own.
fn with_broker(what: fn(&Space, &Path)) {
    let dir = std::env::temp_dir().join(format!("gangwerk-load-{}", std::process::id()));
    let space = Space::create(&dir).expect("space");
    let run = Run::bare(&dir);
    run.save().expect("run");
    let stop = Stop::default();
    let tcp = Tcp { address: Some(([127, 0, 0, 1], 0).into()), keys: None };
    let broker = thread::spawn({
        let stop = stop.clone();
        move || serve(&run, &tcp, &stop).expect("broker")
    });
    while StreamClient::connect(&dir, "start").is_err() {
        sleep_until(now() + SECOND / 100);
    }
    what(&space, &dir);
    stop.ask();
    broker.join().expect("broker");
    drop(space);
    let _ = std::fs::remove_dir_all(dir);
}

fn percentiles(name: &str, mut times: Vec<u64>) {
    times.sort_unstable();
    let at = |share: f64| times[((times.len() - 1) as f64 * share) as usize] as f64 * 1e-3;
    println!(
        "{name}: {} times, p50 {:.1} us, p99 {:.1} us, max {:.1} us",
        times.len(),
        at(0.5),
        at(0.99),
        at(1.0)
    );
}

fn planner(space: &Space) -> Client {
    Client::start("planner", &[Domain::Walk], space).expect("client")
}

/// A planner with cycles of 1 ms that takes 16 commands in each.
fn plan(mut planner: Client, stop: &Stop) -> u64 {
    let (mut due, mut taken) = (now(), 0);
    while !stop.asked() {
        due += SECOND / 1000;
        sleep_until(due);
        for _ in 0..16 {
            let Some(live) = planner.next() else { break };
            planner.answer(&live, Ok(()));
            taken += 1;
        }
    }
    assert_eq!(planner.statistics().lost_in, 0, "the planner lost commands");
    taken
}

fn commands(space: &Space, dir: &Path) {
    const CLIENTS: u64 = 20;
    const SECONDS: u64 = 10;
    let (stop, client) = (Stop::default(), planner(space));
    thread::scope(|s| {
        let consumer = s.spawn(|| plan(client, &stop));
        sleep_until(now() + SECOND / 2);
        let before = resident();
        let senders: Vec<_> = (0..CLIENTS).map(|_| s.spawn(|| send(dir, SECONDS))).collect();
        let mut sums = [0u64; 3];
        for sender in senders {
            let counts = sender.join().expect("sender");
            sums.iter_mut().zip(counts).for_each(|(sum, n)| *sum += n);
        }
        let [sent, accepted, refused] = sums;
        stop.ask();
        let taken = consumer.join().expect("planner");
        println!(
            "{CLIENTS} clients, {:.0} commands/s: sent {sent}, accepted {accepted}, refused {refused}, unanswered {}, \
             taken by the planner {taken}; memory {before} kB before, {} kB after",
            sent as f64 / SECONDS as f64,
            sent - accepted - refused,
            resident()
        );
    });
}

/// 500 stops per second: sent, accepted, refused.
fn send(dir: &Path, seconds: u64) -> [u64; 3] {
    let mut client = StreamClient::connect(dir, "load").expect("connection");
    let (begun, mut counts, mut waiting) = (now(), [0u64; 3], Vec::new());
    for n in 0..100 * seconds {
        sleep_until(begun + n * SECOND / 100);
        for _ in 0..5 {
            waiting.push(client.send(&Command::Stop).expect("link"));
            counts[0] += 1;
        }
        for sequence in waiting.drain(..) {
            let code = client.answer(sequence).expect("answer").code;
            counts[if code == 0 { 1 } else { 2 }] += 1;
        }
    }
    counts
}

/// Resident memory of this process \[kB\].
fn resident() -> u64 {
    let text = std::fs::read_to_string("/proc/self/status").expect("proc");
    let line = text.lines().find_map(|l| l.strip_prefix("VmRSS:")).expect("VmRSS");
    line.trim().trim_end_matches(" kB").parse().expect("a number")
}

fn flood(space: &Space, dir: &Path) {
    let (stop, client) = (Stop::default(), planner(space));
    let address = std::fs::read_to_string(dir.join(broker::doors::TCP_FILE)).expect("address");
    thread::scope(|s| {
        s.spawn(|| plan(client, &stop));
        sleep_until(now() + SECOND / 2);
        let honest = || {
            let mut times = Vec::new();
            for _ in 0..400 {
                let sent = now();
                let mut client = StreamClient::connect(dir, "honest").expect("connection");
                client.publish(&Command::Stop).expect("answer");
                times.push(now() - sent);
                sleep_until(now() + SECOND / 100);
            }
            times
        };
        percentiles("connect, stop, answer; quiet", honest());
        let this = std::env::current_exe().expect("own path");
        let mut other =
            std::process::Command::new(this).args(["connect", address.trim(), "6"]).spawn().expect("process");
        sleep_until(now() + SECOND / 2);
        percentiles("connect, stop, answer; under the flood", honest());
        let _ = other.wait();
        stop.ask();
    });
}

/// 5,000 connections a second with garbage, as far as the machine goes.
fn connect(address: SocketAddr, seconds: u64) {
    let (begun, mut made, mut n) = (now(), 0u64, 0u64);
    while now() - begun < seconds * SECOND {
        n += 1;
        sleep_until(begun + n * SECOND / 5000);
        if let Ok(mut stream) = TcpStream::connect_timeout(&address, Duration::from_millis(100)) {
            let _ = stream.write_all(b"GET / HTTP/1.1\r\nHost: robot\r\n\r\n");
            made += 1;
        }
    }
    println!("flood: {:.0} connections/s", made as f64 * 1e9 / (now() - begun) as f64);
}
