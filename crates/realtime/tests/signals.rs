//! Signals that ask a process to end, seen from processes of their own.
//!
//! A parent's threads end one after the other, and the kernel tells the child of each that had it in turn. Asked is asked once;
//! only who asks again by hand is in a hurry. And a terminal that is closed asks who was not started by nohup; its Ctrl-Z and
//! Ctrl-\ ask as its Ctrl-C does, where a robot would walk on without the supervisor that they stop.

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::time::Duration;

use realtime::Stop;

/// Between two ends of threads, and two requests: much longer than the child takes to see one.
const PAUSE: Duration = Duration::from_millis(200);

fn main() {
    match std::env::args().nth(1).as_deref() {
        Some("parent") => parent(),
        Some("child") => child(),
        Some("orphan of a terminal") => signalled("HUP"),
        Some("signalled") => signalled(&std::env::args().nth(2).unwrap()),
        _ => {
            let this = std::env::current_exe().unwrap();
            let asked = Command::new(&this).arg("parent").output().unwrap();
            // Its parent's two threads, SIGTERM, and again.
            assert_eq!(String::from_utf8_lossy(&asked.stderr), "asked 1\nasked 2\nasked 3\n");
            println!("test a_parent_that_ends_in_pieces_asks_once ... ok");
            for (command, asked) in [("env --default-signal=HUP", "true"), ("nohup", "false")] {
                let mut words = command.split(' ');
                let said = Command::new(words.next().unwrap())
                    .args(words)
                    .arg(&this)
                    .arg("orphan of a terminal")
                    .output()
                    .unwrap();
                assert_eq!(String::from_utf8_lossy(&said.stdout), asked, "{command}");
            }
            println!("test who_was_started_by_nohup_goes_on_without_its_terminal ... ok");
            for signal in ["INT", "QUIT", "TSTP"] {
                // A child that is stopped is killed.
                let mut child = Command::new("timeout");
                child.args(["-s", "KILL", "20"]).arg(&this).args(["signalled", signal]);
                let said = child.output().unwrap();
                assert_eq!(String::from_utf8_lossy(&said.stdout), "true", "{signal}");
            }
            println!("test keys_of_the_terminal_ask_and_stop_nobody ... ok");
            println!("\ntest result: ok. 3 passed; 0 failed");
        }
    }
}

/// One thread starts the child and ends, then the other does.
#[expect(clippy::zombie_processes, reason = "the parent ends first, as is tested here")]
fn parent() {
    let started = std::thread::spawn(|| {
        let mut child = Command::new(std::env::current_exe().unwrap())
            .arg("child")
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut String::new()).unwrap();
    });
    started.join().unwrap();
    std::thread::park_timeout(PAUSE);
}

/// Says how often it was asked to end. Once its parent is gone it asks itself, as somebody in a hurry does.
fn child() {
    let stop = Stop::on_signals().unwrap();
    let parent = std::os::unix::process::parent_id();
    Stop::with_parent().unwrap();
    println!("ready");
    let mut asked = 0;
    let mut look = || {
        std::thread::park_timeout(PAUSE / 20);
        if stop.taken() {
            asked += 1;
            eprintln!("asked {asked}");
        }
    };
    while std::os::unix::process::parent_id() == parent {
        look();
    }
    for hurry in [false, true, true] {
        if hurry {
            realtime::terminate(std::process::id());
        }
        (0..20).for_each(|_| look());
    }
}

/// Says whether this signal asked it to end.
fn signalled(signal: &str) {
    let stop = Stop::on_signals().unwrap();
    let own = std::process::id().to_string();
    assert!(Command::new("kill").args(["-s", signal, &own]).status().unwrap().success());
    std::thread::park_timeout(PAUSE);
    print!("{}", stop.asked());
}
