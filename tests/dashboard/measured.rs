//! Measurements: time of an emergency stop from a page, and load of the server.
//!
//! `GANGWERK_TRIALS=500` takes so many emergency stops; `GANGWERK_SOAK_SECONDS=60` looks at the load for so long.

use crate::page::{Page, Received, Server};
use crate::{EXE, WAIT, standing};
use harness::{Signal, Site, doze, turn};
use messages::topics::POWER;
use messages::{Power, Process};
use realtime::clock;
use serde_json::{Value, json};

/// Emergency stops, unless more are asked for.
const TRIALS: usize = 5;

pub(crate) fn number_of(variable: &str) -> Option<usize> {
    std::env::var(variable).ok()?.parse().ok()
}

#[test]
fn an_emergency_stop_cuts_the_supply_without_lease_or_broker() {
    let _turn = turn();
    let site = Site::patient(EXE);
    site.scene("wait", 100_000.0, WAIT);
    let mut run = site.run("wait", &["--no-log"]);
    let space = run.space();
    // One that follows and one that looks: a reader does one or the other.
    let [mut power, mut newest] = [0, 1].map(|_| space.reader::<Power>(&POWER).unwrap());
    let server = Server::start(&site);
    let mut page = server.page();
    page.text("hello");
    let (mut answered, mut cut) = (Vec::new(), Vec::new());
    for trial in 0..number_of("GANGWERK_TRIALS").unwrap_or(TRIALS) {
        page.until_entry("supply", |supply| supply[0] == 1.0);
        if trial == 1 {
            // A broker that hangs holds up commands, and not this.
            run.signal(Process::Broker, Signal::STOP);
        }
        let begun = clock::now();
        let (accepted, text) = page.order(json!({"type": "emergency_stop"}));
        answered.push(clock::now() - begun);
        assert!(accepted && text.starts_with("power off at tick "), "{text}");
        assert_eq!(newest.latest().unwrap().on, 0, "it is off when the answer comes");
        cut.push(off_since(&mut power, begun));
        page.until_entry("supply", |supply| supply[0] == 0.0);
        if trial == 1 {
            run.signal(Process::Broker, Signal::CONT);
        }
        for edge in ["system/reset", "system/enable"] {
            again(&mut page, edge);
        }
    }
    let show = |name: &str, times: &mut Vec<u64>| {
        times.sort_unstable();
        let at = |share: f64| times[((times.len() - 1) as f64 * share).round() as usize] as f64 * 1e-6;
        println!(
            "{name}: p50 {:.2} ms, p99 {:.2} ms, max {:.2} ms of {}",
            at(0.5),
            at(0.99),
            at(1.0),
            times.len()
        );
    };
    show("request to first record without supply", &mut cut);
    show("request to answer", &mut answered);
}

/// Time from `begun` to the stamp of the first record that says off \[ns\].
fn off_since(power: &mut ipc::Reader<Power>, begun: u64) -> u64 {
    while let Some(record) = power.follow() {
        if record.on == 0 && record.header.stamp_ns >= begun {
            return record.header.stamp_ns - begun;
        }
    }
    0
}

/// An edge of the start, until the watchdog takes it.
fn again(page: &mut Page, edge: &str) {
    let mut why = String::new();
    for _ in 0..50 {
        doze(0.3); // an edge is a command after a pause without it
        match page.order(json!({"type": "command", "name": edge, "values": {}})) {
            (true, _) => return,
            (false, text) => why = text,
        }
    }
    panic!("{edge} is refused: {why}");
}

#[test]
fn load_of_a_server_with_one_page_and_sixty_fields() {
    let _turn = turn();
    let site = Site::patient(EXE);
    let (_run, server, mut page) = standing(&site);
    let all: Vec<Value> =
        page.hello["fields"].as_array().unwrap().iter().map(|f| f["name"].clone()).collect();
    let of = |topic: &str| {
        all.iter().filter(|n| n.as_str().unwrap().starts_with(topic)).take(20).cloned().collect::<Vec<_>>()
    };
    let fields = [of("sensors."), of("controller_state."), of("sim_state.")].concat();
    assert_eq!(fields.len(), 60);
    page.send(&json!({"type": "plot", "fields": fields, "rate": 500}));
    page.text("plotting");
    let pid = server.running.id();
    let ticks = || -> u64 {
        let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).unwrap();
        let fields: Vec<&str> = stat.rsplit_once(") ").unwrap().1.split(' ').collect();
        fields[11].parse::<u64>().unwrap() + fields[12].parse::<u64>().unwrap()
    };
    let seconds = number_of("GANGWERK_SOAK_SECONDS").unwrap_or(5) as u64;
    let (begun, before, mut rows) = (clock::now(), ticks(), 0);
    while clock::now() - begun < seconds * clock::SECOND {
        if let Some(Received::Frame(frame)) = page.receive()
            && frame.kind == 2
        {
            rows += frame.rows().len() as u64;
        }
    }
    let share = (ticks() - before) as f64 / 100.0 / seconds as f64;
    let status = std::fs::read_to_string(format!("/proc/{pid}/status")).unwrap();
    let kb = |key: &str| -> f64 {
        let line = status.lines().find(|line| line.starts_with(key)).unwrap();
        line.split_whitespace().nth(1).unwrap().parse().unwrap()
    };
    let smaps = std::fs::read_to_string(format!("/proc/{pid}/smaps_rollup")).unwrap();
    let pss = smaps.lines().find(|line| line.starts_with("Pss:")).unwrap().split_whitespace().nth(1).unwrap();
    println!(
        "{:.2} % of a core, {rows} rows in {seconds} s; resident {:.1} MB: own {:.1}, files {:.1}, shared memory {:.1}; Pss {:.1} MB",
        100.0 * share,
        kb("VmRSS:") / 1e3,
        kb("RssAnon:") / 1e3,
        kb("RssFile:") / 1e3,
        kb("RssShmem:") / 1e3,
        pss.parse::<f64>().unwrap() / 1e3
    );
    // Simulated time goes no faster than real time: every row came, and none twice.
    assert!(rows > seconds * 100, "{rows} rows");
    assert!(kb("RssAnon:") < 30e3, "the server grows: {status}");
}
