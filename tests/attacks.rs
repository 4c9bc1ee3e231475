//! Strangers against a standing robot, in every way that a connection allows: nothing moves, the operator's commands go
//! through, and each `gangwerk estop` is answered. Floods of commands, and the memory of all processes under them.
//!
//! `GANGWERK_SOAK_SECONDS=3600` makes the soak longer.

use broker::connection::UNANSWERED;
use broker::message::{MAX_BYTES, VERSION, service, service_message, write_command};
use broker::{StreamClient, keys};
use harness::{Running, Site, doze, turn};
use ipc::{Reader, Space};
use messages::command_text::COMMANDS;
use messages::topics::{CONTROLLER_STATE, JOINT_TARGETS, POWER, SIM_STATE};
use messages::{Command, ControllerState, GaitState, JointTargets, Power, Process, SimState, Stamp};
use realtime::clock::{SECOND, now};
use std::io::{Read, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpStream};
use std::os::unix::fs::PermissionsExt;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::time::Duration;

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
    fn standing() -> Self {
        let site = Site::patient(EXE);
        write_key(&site.path("keys"), "7a");
        let keys = format!("tcp_keys = \"{}\"", site.path("keys").display());
        site.edit("system.toml", "tcp_keys = \"\"", &keys);
        site.scene("wait", 100_000.0, "[[command]]\ntime = 0.2\ntopic = \"walk/stand\"\n");
        let mut run = site.run("wait", &["--no-log"]);
        let space = run.space();
        let mut state: Reader<ControllerState> = space.reader(&CONTROLLER_STATE).unwrap();
        let begun = now();
        while !state.latest().is_some_and(|s| s.header.tick > 3000 && s.gait == GaitState::Standing as u64) {
            assert!(run.is_alive() && now() - begun < 60 * SECOND, "{}", run.err());
            doze(0.01);
        }
        let targets = space.reader(&JOINT_TARGETS).unwrap();
        Self { run, space, targets, site }
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

fn write_key(path: &Path, digits: &str) {
    std::fs::write(path, format!("op all {}\n", digits.repeat(32))).unwrap();
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(0o600)).unwrap();
}

/// Where an attack goes on until it is told to end.
#[derive(Clone)]
struct Place {
    tcp: SocketAddr,
    dir: PathBuf,
    over: Arc<AtomicBool>,
    /// Times that it was done.
    done: Arc<AtomicU64>,
}

impl Place {
    fn again(&self) -> bool {
        self.done.fetch_add(1, Relaxed);
        !self.over.load(Relaxed)
    }

    fn stream(&self) -> Option<TcpStream> {
        let stream = TcpStream::connect(self.tcp).ok()?;
        stream.set_read_timeout(Some(Duration::from_secs(3))).ok()?;
        stream.set_write_timeout(Some(Duration::from_secs(3))).ok()?;
        Some(stream)
    }
}

/// Every command that a stranger may not give; stops are everybody's.
fn forbidden() -> impl Iterator<Item = Command> {
    let all = COMMANDS.iter().map(|info| info.example());
    all.filter(|c| !matches!(c, Command::Stop | Command::EmergencyStop))
}

fn frame(message: &[u8]) -> Vec<u8> {
    [&(message.len() as u32).to_le_bytes(), message].concat()
}

fn bytes_of(command: &Command, sequence: u64) -> Vec<u8> {
    let mut buffer = [0; MAX_BYTES];
    let stamp = Stamp { sequence, sent_ns: now(), ..Stamp::default() };
    frame(write_command(command, command.priority(), &stamp, &mut buffer).unwrap())
}

fn hello() -> Vec<u8> {
    let payload = [&VERSION.to_le_bytes()[..], &[0; 8], &[0; 16], b"stranger"].concat();
    frame(&service_message(service::HELLO, 1, now(), &payload))
}

/// Every command without a key, also under numbers that were used before.
fn every_command(place: &Place) {
    while place.again() {
        let Ok(mut client) = StreamClient::connect_tcp(place.tcp, "stranger", None) else { continue };
        for command in forbidden() {
            if let Ok(who) = client.publish(&command) {
                panic!("{command:?} was taken by {who}");
            }
        }
    }
}

/// The key's name with another secret.
fn wrong_key(place: &Place) {
    let own = std::thread::current().id();
    let path = std::env::temp_dir().join(format!("gangwerk-wrong-key-{}-{own:?}", std::process::id()));
    write_key(&path, "7b");
    let key = keys::load(&path).unwrap().remove(0);
    std::fs::remove_file(path).unwrap();
    while place.again() {
        let client = StreamClient::connect_tcp(place.tcp, "stranger", Some(&key));
        assert!(client.is_err(), "a wrong key opened a connection");
    }
}

/// Every command cut at every byte, and the connection closed, or kept, there.
fn truncated(place: &Place) {
    let mut kept = Vec::new();
    while place.again() {
        for command in forbidden() {
            let whole = [hello(), bytes_of(&command, 2)].concat();
            for n in 1..whole.len() {
                let Some(mut stream) = place.stream() else { continue };
                let _ = stream.write_all(&whole[..n]);
                if n % 16 == 0 {
                    kept.push(stream);
                }
                if place.over.load(Relaxed) {
                    return;
                }
            }
            kept.truncate(32);
        }
    }
}

/// Lengths that no frame has, with as much as fits behind them.
fn oversized(place: &Place) {
    while place.again() {
        for length in [u32::MAX, 1 << 31, 1 << 20, 600, 0] {
            if let Some(mut stream) = place.stream() {
                let _ =
                    stream.write_all(&length.to_le_bytes()).and_then(|()| stream.write_all(&[7; 100_000]));
                let _ = stream.read(&mut [0; 512]);
            }
        }
    }
}

/// Many connections, each with one byte every tenth of a second.
fn slow_writers(place: &Place) {
    let bytes = hello();
    let mut streams: Vec<Option<TcpStream>> = (0..100).map(|_| place.stream()).collect();
    for n in 0.. {
        for stream in &mut streams {
            let sent = stream.as_mut().is_some_and(|s| s.write_all(&[bytes[n % bytes.len()]]).is_ok());
            if !sent {
                *stream = place.stream();
            }
        }
        if !place.again() {
            return;
        }
        doze(0.1);
    }
}

/// Subscribes to everything, asks for the longest answer again and again, and reads nothing.
fn slow_readers(place: &Place) {
    while place.again() {
        let mut streams: Vec<TcpStream> = (0..8).filter_map(|_| place.stream()).collect();
        for stream in &mut streams {
            let _ = stream.write_all(&hello());
            let subscribe = service_message(service::SUBSCRIBE, 2, now(), &[0xff, 0, 0, 0]);
            let _ = stream.write_all(&frame(&subscribe));
            for n in 3..40 {
                let _ = stream.write_all(&frame(&service_message(service::DESCRIBE, n, now(), &[])));
            }
        }
        doze(0.5);
    }
}

/// As many connections as there is time for; some stay open, with a frame of nobody's.
fn connections(place: &Place) {
    let mut open = Vec::new();
    while place.again() {
        if let Some(mut stream) = place.stream() {
            let _ = stream.write_all(&frame(&service_message(77, 1, 0, &[])));
            open.push(stream);
        }
        if open.len() == 200 {
            open.clear();
        }
    }
}

/// Another user's programs at the run directory, which he cannot enter.
fn another_user(place: &Place) {
    while place.again() {
        for info in COMMANDS.iter().filter(|info| !info.name.ends_with("stop")).step_by(5) {
            let mut program = std::process::Command::new(EXE);
            program.args(["topic", "pub", info.name, "--dir"]).arg(&place.dir).uid(65534).gid(65534);
            let Ok(said) = program.output() else { return };
            assert!(!said.status.success(), "{said:?}");
        }
    }
}

type Attack = (&'static str, fn(&Place));

const ATTACKS: [Attack; 8] = [
    ("every command without a key", every_command),
    ("wrong key", wrong_key),
    ("frames cut at every byte", truncated),
    ("lengths that no frame has", oversized),
    ("slow writers", slow_writers),
    ("slow readers", slow_readers),
    ("connections", connections),
    ("another user", another_user),
];

/// Ends the attack.
struct Over<'a>(&'a AtomicBool);

impl Drop for Over<'_> {
    fn drop(&mut self) {
        self.0.store(true, Relaxed);
    }
}

/// Does something while the attack goes on; returns how often it was done.
fn under(robot: &mut Robot, attack: fn(&Place), mut meanwhile: impl FnMut(&mut Robot, &Place)) -> u64 {
    let place = Place {
        tcp: (Ipv4Addr::LOCALHOST, robot.site.port()).into(),
        dir: robot.site.run_dir(),
        over: Arc::default(),
        done: Arc::default(),
    };
    std::thread::scope(|scope| {
        let attackers: Vec<_> = (0..2).map(|_| scope.spawn(|| attack(&place))).collect();
        // Also if something is found.
        let over = Over(&place.over);
        meanwhile(robot, &place);
        drop(over);
        for attacker in attackers {
            attacker.join().unwrap_or_else(|e| std::panic::resume_unwind(e));
        }
    });
    place.done.load(Relaxed)
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
    for (name, attack) in ATTACKS {
        let enough = if name == "connections" { CONNECTIONS as u64 } else { 1 };
        let mut moved = 0.0f64;
        let done = under(&mut robot, attack, |robot, place| {
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
    for (name, attack) in ATTACKS {
        under(&mut robot, attack, |robot, _| {
            let answered = (0..STOPS).filter(|_| robot.stop()).count();
            assert_eq!(answered, STOPS, "{name}");
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
    let seconds = std::env::var("GANGWERK_SOAK_SECONDS").ok().and_then(|s| s.parse().ok()).unwrap_or(30);
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
