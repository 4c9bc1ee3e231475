//! Strangers against a robot that stands, in every way that a connection allows: nothing moves, the operator's commands go
//! through, and each `gangwerk estop` is answered. The same while it walks: `attacks/walking.rs`. Floods of commands, and the
//! memory of all processes under them.
//!
//! `GANGWERK_SOAK_SECONDS=3600` makes the soak longer.

#[path = "attacks/strangers.rs"]
mod strangers;
#[path = "attacks/walking.rs"]
mod walking;

use broker::StreamClient;
use broker::connection::UNANSWERED;
use harness::{Running, Site, doze, turn};
use ipc::{Reader, Space};
use messages::topics::{CONTROLLER_STATE, JOINT_TARGETS, POWER, SIM_STATE};
use messages::{Command, ControllerState, GaitState, JointTargets, Power, Process, SimState};
use realtime::clock::{SECOND, now};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use strangers::{ATTACKS, Place, under, with_door};

const EXE: &str = harness::executable!();
/// Emergency stops asked for under each attack.
const STOPS: usize = 20;
/// Connections of one flood.
const CONNECTIONS: usize = 5000;

/// A robot in real time that stands, with a door for the network and a key that nobody here knows.
struct Robot {
    run: Running,
    space: Space,
    targets: Reader<JointTargets>,
    site: Site,
}

impl Robot {
    /// A machine that stands still for some milliseconds may stop the robot before any stranger comes: then another one starts.
    fn standing() -> Self {
        (0..5).find_map(|_| Self::stood_up()).expect("the machine lets a robot stand up")
    }

    /// None: it was stopped before it stood.
    fn stood_up() -> Option<Self> {
        let site = with_door(Site::patient(EXE));
        site.scene("wait", 100_000.0, "[[command]]\ntime = 0.2\ntopic = \"walk/stand\"\n");
        let mut run = site.run("wait", &["--no-log"]);
        let space = run.space();
        let mut state: Reader<ControllerState> = space.reader(&CONTROLLER_STATE).unwrap();
        let begun = now();
        while !state.latest().is_some_and(|s| s.header.tick > 3000 && s.gait == GaitState::Standing as u64) {
            if state.held().is_some_and(|s| s.gait == GaitState::Halted as u64) {
                println!("stopped before it stood: {}", run.err());
                return None;
            }
            assert!(run.is_alive() && now() - begun < 60 * SECOND, "{}", run.err());
            doze(0.01);
        }
        let targets = space.reader(&JOINT_TARGETS).unwrap();
        Some(Self { run, space, targets, site })
    }

    /// Largest difference of any joint target since the last look \[rad\].
    fn moved(&mut self, since: &mut Option<JointTargets>) -> f64 {
        let mut most = 0.0f64;
        while let Some(record) = self.targets.follow() {
            let first = since.get_or_insert(*record);
            let pairs = record.angle.iter().zip(&first.angle);
            most = pairs.fold(most, |most, (a, b)| most.max((a - b).abs()));
        }
        most
    }

    fn stop(&self) -> bool {
        let dir = self.site.run_dir();
        let child = std::process::Command::new(EXE).args(["estop", "--dir"]).arg(dir).output().unwrap();
        child.status.success()
    }
}

#[test]
fn strangers_move_nothing_and_hold_up_neither_operator_nor_emergency_stop() {
    let _turn = turn();
    let mut robot = Robot::standing();
    let mut power: Reader<Power> = robot.space.reader(&POWER).unwrap();
    let mut since = None;
    let quiet = {
        doze(1.0);
        robot.moved(&mut since)
    };
    for attack in ATTACKS {
        let (name, _) = attack;
        let enough = if name == "connections" { CONNECTIONS as u64 } else { 1 };
        let mut moved = 0.0f64;
        let place = Place::of(&robot.site);
        let done = under(&place, &[attack], || {
            let begun = now();
            // The operator comes anew each time: what is shown is that his place is free.
            while now() - begun < 2 * SECOND || place.done.load(Relaxed) < enough {
                let mut operator = StreamClient::connect(&robot.site.run_dir(), "operator").unwrap();
                // The lease of the one before ends with his connection, and after half a second in any case.
                let came = now();
                while let Err(error) = operator.take_lease(false) {
                    assert!(now() - came < SECOND, "{name}: {error}");
                    doze(0.05);
                }
                assert_eq!(operator.publish(&Command::Stop), Ok("planner".into()), "{name}");
                moved = moved.max(robot.moved(&mut since));
                assert!(now() - begun < 60 * SECOND, "{name}: it takes too long");
                doze(0.05);
            }
        });
        println!("{name}: {done} times, joint targets within {moved:.1e} rad ({quiet:.1e} rad before)");
        assert!(moved < 1e-3, "{name}: a joint target moved by {moved} rad");
        assert_eq!(power.latest().map(|p| p.on), Some(1), "{name}: {}", robot.run.err());
        assert!(robot.run.is_alive(), "{name}: {}", robot.run.err());
    }
    for attack in ATTACKS {
        under(&Place::of(&robot.site), &[attack], || {
            let answered = (0..STOPS).filter(|_| robot.stop()).count();
            assert_eq!(answered, STOPS, "{}", attack.0);
        });
    }
    assert_eq!(power.latest().map(|p| p.on), Some(0));
    assert!(robot.run.is_alive(), "{}", robot.run.err());
}

/// 20 clients of the robot's user send 500 commands per second each; one more works as an operator does.
#[test]
fn ten_thousand_commands_per_second_lose_no_command_of_the_operator() {
    const CLIENTS: u64 = 20;
    const EACH: u64 = 500;
    const SECONDS: u64 = 3;
    let _turn = turn();
    let robot = Robot::standing();
    let dir = robot.site.run_dir();
    let (accepted, busy, refused) = (AtomicU64::new(0), AtomicU64::new(0), AtomicU64::new(0));
    let flood = || {
        let mut client = StreamClient::connect(&dir, "flood").unwrap();
        let mut waiting = std::collections::VecDeque::new();
        let answered = |client: &mut StreamClient, number| match client.answer(number).unwrap().code {
            0 => accepted.fetch_add(1, Relaxed),
            6 => busy.fetch_add(1, Relaxed),
            _ => refused.fetch_add(1, Relaxed),
        };
        let begun = now();
        for n in 0..EACH * SECONDS {
            let due = begun + n * SECOND / EACH;
            if due > now() {
                realtime::clock::sleep_until(due);
            }
            waiting.push_back(client.send(&Command::Stop).unwrap());
            if waiting.len() >= UNANSWERED {
                answered(&mut client, waiting.pop_front().unwrap());
            }
        }
        let sent = now() - begun;
        waiting.into_iter().for_each(|number| _ = answered(&mut client, number));
        sent
    };
    let (sent, operator) = std::thread::scope(|scope| {
        let clients: Vec<_> = (0..CLIENTS).map(|_| scope.spawn(flood)).collect();
        let mut operator = StreamClient::connect(&dir, "operator").unwrap();
        let mut slowest = 0;
        for n in 0..20 * SECONDS {
            let begun = now();
            assert_eq!(operator.publish(&Command::Stop), Ok("planner".into()), "command {n}");
            slowest = slowest.max(now() - begun);
            doze(0.05);
        }
        (clients.into_iter().map(|c| c.join().unwrap()).max().unwrap(), slowest)
    });
    let [accepted, busy, refused] = [accepted, busy, refused].map(AtomicU64::into_inner);
    let all = CLIENTS * EACH * SECONDS;
    println!(
        "{all} commands in {:.1} s: {accepted} accepted, {busy} refused as too many, {refused} otherwise; the operator's \
         slowest answer took {:.1} ms",
        sent as f64 * 1e-9,
        operator as f64 * 1e-6
    );
    assert_eq!(accepted + busy + refused, all, "each is answered");
    assert_eq!(refused, 0);
}

/// Resident memory of a process \[kB\].
fn resident(pid: u32) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{pid}/status")).unwrap();
    let line = status.lines().find(|line| line.starts_with("VmRSS:")).unwrap();
    line.split_whitespace().nth(1).unwrap().parse().unwrap()
}

/// Clients come and go, command, read and are refused; all the while no process grows.
#[test]
fn no_process_grows_while_clients_come_and_go() {
    /// \[kB\] What a process may gain after warming up, whatever the time: a few pages of allocators.
    const GROWTH: u64 = 1024;
    let seconds = std::env::var("GANGWERK_SOAK_SECONDS").ok().and_then(|s| s.parse().ok()).unwrap_or(15);
    let _turn = turn();
    let mut robot = Robot::standing();
    let processes = Process::ALL.iter().filter(|p| **p != Process::Observer && **p != Process::Logger);
    let processes: Vec<(Process, u32)> = processes.map(|p| (*p, robot.run.pid(*p))).collect();
    let dir = robot.site.run_dir();
    let round = |n: u64| {
        let mut operator = StreamClient::connect(&dir, "operator").unwrap();
        operator.subscribe(&messages::command::Domain::ALL).unwrap();
        operator.statistics().unwrap();
        let _ = operator.publish(&Command::Stop);
        if n.is_multiple_of(10) {
            let space = Space::open(&dir, Process::Observer).unwrap();
            let mut sim: Reader<SimState> = space.reader(&SIM_STATE).unwrap();
            assert!(sim.latest().is_some());
        }
        doze(0.01);
    };
    let work = |seconds: u64| {
        let begun = now();
        let rounds = (0..).take_while(|_| now() - begun < seconds * SECOND);
        rounds.map(round).count()
    };
    work(seconds.min(60) / 3);
    let before: Vec<u64> = processes.iter().map(|(_, pid)| resident(*pid)).collect();
    let rounds = work(seconds);
    for ((process, pid), before) in processes.iter().zip(before) {
        let after = resident(*pid);
        println!("{}: {before} kB, {after} kB after {seconds} s and {rounds} clients", process.name());
        assert!(after < before + GROWTH, "{}: {before} kB, then {after} kB", process.name());
    }
    assert!(robot.run.is_alive(), "{}", robot.run.err());
}
