//! `gangwerk gateway` at a robot that runs: a vision system walks her over UDP, and she stands whatever becomes of it.

use super::joystick::{Dice, Robot, says};
use super::{Site, doze, shared_turn, until};
use broker::StreamClient;
use gateway::Cause;
use gateway::trigger::flag;
use gateway::wire::{Datagram, TRIGGER};
use harness::{Running, Signal};
use messages::command::{BoxCommand, VelocityCommand};
use messages::topics::{EVENTS_PLANNER, SENSORS};
use messages::{Command, Event, EventCode, GaitState, Process, Sensors};
use realtime::clock;
use std::net::{SocketAddr, UdpSocket};
use std::time::Duration;

/// Simulated time that passes as real time does: a vision system is not simulated.
const PACED: [&str; 3] = ["--lockstep", "--paced", "--no-log"];
const STOP: Command = velocity(0.0);

const fn velocity(forward: f64) -> Command {
    Command::Velocity(VelocityCommand { forward, left: 0.0, turn: 0.0 })
}

/// `gangwerk gateway` whose triggers go to that address.
fn gateway(site: &Site, to: SocketAddr) -> Running {
    let (dir, to) = (site.run_dir().display().to_string(), to.to_string());
    site.start(&["gateway", "--dir", &dir, "--listen", "127.0.0.1:0", "--to", &to])
}

/// The numbers of a trigger that the tests look at.
#[derive(Clone, Copy, Debug)]
struct Seen {
    stamp: u64,
    flags: u64,
    gait: u64,
    /// Planning frame in I_0, and poses in it as the page lists them.
    numbers: [f64; 35],
    accepted: u64,
    refused: [u64; Cause::ALL.len()],
}

impl Seen {
    /// \[m\] Torso in I_0, out of its pose in the planning frame.
    fn torso(&self) -> [f64; 3] {
        let [x, y, z, heading] = [0, 1, 2, 3].map(|i| self.numbers[i]);
        let [tx, ty, tz] = [14, 15, 16].map(|i| self.numbers[i]);
        let (sin, cos) = heading.sin_cos();
        [x + cos * tx - sin * ty, y + sin * tx + cos * ty, z + tz]
    }
}

/// A vision system.
struct Eyes {
    socket: UdpSocket,
    gateway: SocketAddr,
    seen: Seen,
    sequence: u64,
    /// Datagrams sent.
    sent: u64,
}

impl Eyes {
    /// It, and a gateway that has found the robot.
    fn and_gateway(site: &Site) -> (Self, Running) {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        let mut running = gateway(site, socket.local_addr().unwrap());
        says(&mut running, "connected", 1);
        let seen = Seen {
            stamp: 0,
            flags: 0,
            gait: 0,
            numbers: [0.0; 35],
            accepted: 0,
            refused: [0; Cause::ALL.len()],
        };
        let nowhere = SocketAddr::from(([127, 0, 0, 1], 1));
        let mut eyes = Self { socket, gateway: nowhere, seen, sequence: 0, sent: 0 };
        while eyes.trigger().flags & flag::ROBOT == 0 {}
        (eyes, running)
    }

    /// The next trigger.
    #[track_caller]
    fn trigger(&mut self) -> Seen {
        self.socket.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
        let mut bytes = [0; 2048];
        let (length, from) = self.socket.recv_from(&mut bytes).expect("a trigger within 10 s");
        self.gateway = from;
        self.read(&bytes[..length]);
        self.seen
    }

    /// Triggers that have come meanwhile.
    fn catch_up(&mut self) {
        self.socket.set_nonblocking(true).unwrap();
        let mut bytes = [0; 2048];
        while let Ok((length, _)) = self.socket.recv_from(&mut bytes) {
            self.read(&bytes[..length]);
        }
        self.socket.set_nonblocking(false).unwrap();
    }

    /// Bytes of a trigger, by the page.
    fn read(&mut self, bytes: &[u8]) {
        assert_eq!((bytes.len(), &bytes[..8]), (TRIGGER, &b"GWVI\x01\0\0\0"[..]));
        let word = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap());
        self.seen = Seen {
            stamp: word(24),
            flags: word(40),
            gait: word(48),
            numbers: std::array::from_fn(|i| f64::from_bits(word(56 + 8 * i))),
            accepted: word(336),
            refused: std::array::from_fn(|i| word(344 + 8 * i)),
        };
    }

    /// The bytes that answer the newest trigger.
    fn answer(&mut self, command: Command) -> Vec<u8> {
        self.sequence += 1;
        let datagram = Datagram { sender: 77, sequence: self.sequence, stamp: self.seen.stamp, command };
        datagram.encode().unwrap()
    }

    fn send(&mut self, bytes: &[u8]) {
        self.sent += 1;
        self.socket.send_to(bytes, self.gateway).unwrap();
    }

    fn say(&mut self, command: Command) {
        let bytes = self.answer(command);
        self.send(&bytes);
    }

    /// Answers triggers until one is as it shall be.
    #[track_caller]
    fn go(&mut self, command: Command, until: impl Fn(&Seen) -> bool) {
        let begun = clock::now();
        while !until(&self.trigger()) {
            assert!(clock::now() - begun < 30 * clock::SECOND, "{:?}", self.seen);
            self.say(command);
        }
    }
}

/// A walk of her own program: the page's client in Python.
#[test]
fn the_python_client_walks_her_and_she_stops_before_a_box() {
    let _turn = shared_turn();
    let site = Site::patient(super::EXE);
    let mut robot = Robot::standing_in(&site, &PACED);
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let to = socket.local_addr().unwrap();
    drop(socket);
    let mut running = gateway(&site, to);
    says(&mut running, "connected", 1);
    let before = until(&mut robot.run, &mut robot.sim, |_| true).position[0];
    let client = std::process::Command::new("python3")
        .arg(harness::root().join("python/examples/vision_client.py"))
        .args(["--port", &to.port().to_string(), "--forward", "0.278", "--seconds", "9"])
        .args(["--box", "1.3", "0", "0.1", "1.5", "0.6"])
        .output()
        .expect("python3 is there");
    let said = String::from_utf8_lossy(&client.stdout).into_owned();
    assert!(client.status.success(), "{said}{}", String::from_utf8_lossy(&client.stderr));
    assert!(said.contains("refused {}"), "{said}{}", running.out());
    until(&mut robot.run, &mut robot.state, |s| s.gait == GaitState::Standing as u64);
    let sim = until(&mut robot.run, &mut robot.sim, |_| true);
    let way = sim.position[0] - before;
    assert!((0.4..1.2).contains(&way), "{way} m towards a box 1.25 m ahead: {said}");
    assert_eq!((sim.fallen, sim.power), (0, 1));
}

/// Four walls of which the planner knows nothing: she walks, turns away from each, and stands when the program that sees is stopped, or
/// somebody else stops her.
#[test]
fn explore_keeps_her_off_walls_and_she_stands_without_it() {
    let _turn = shared_turn();
    let site = Site::patient(super::EXE);
    let walls = [
        ([0.1, 4.0], [1.8, 0.0]),
        ([0.1, 4.0], [-1.6, 0.0]),
        ([4.0, 0.1], [0.0, 1.7]),
        ([4.0, 0.1], [0.0, -1.7]),
    ];
    let object = |([length, width], [x, y]): ([f64; 2], [f64; 2])| {
        format!("\n[[object]]\nname = \"wall\"\nbox = [{length}, {width}, 1.0]\nposition = [{x}, {y}, 0.5]\n")
    };
    let mut robot = Robot::standing_with(&site, &walls.map(object).concat(), &PACED);
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let to = socket.local_addr().unwrap();
    drop(socket);
    let mut running = gateway(&site, to);
    says(&mut running, "connected", 1);
    let mut explore =
        site.start(&["explore", "--dir", &site.run_dir().display().to_string(), "--listen", &to.to_string()]);
    robot.walks();
    // Her middle stays as far from each wall as half of her is wide, wherever she goes.
    let (end, mut turned, mut went) = (clock::now() + 25 * clock::SECOND, 0.0_f64, 0.0_f64);
    while clock::now() < end {
        let sim = until(&mut robot.run, &mut robot.sim, |_| true);
        let [x, y, _] = sim.position;
        assert!((-1.2..1.4).contains(&x) && y.abs() < 1.3, "{x} {y}");
        let [_, _, z, w] = sim.orientation;
        (turned, went) = (turned.max(2.0 * z.abs().atan2(w.abs())), went.max(x.hypot(y)));
        doze(0.02);
    }
    assert!(turned > 0.5 && went > 0.3, "{turned} rad, {went} m: {}", running.out());
    explore.signal_supervisor(Signal::STOP);
    robot.stands();

    // It goes on when it may, but not after somebody else's stop.
    explore.signal_supervisor(Signal::CONT);
    robot.walks();
    site.topic(&["pub", "walk/stop"]).well();
    robot.stands();
    let begun = clock::now();
    while explore.is_alive() && clock::now() - begun < 10 * clock::SECOND {
        doze(0.01);
    }
    assert!(
        !explore.is_alive() && explore.out().contains("somebody else has stopped her"),
        "{}",
        explore.out()
    );
}

/// Nearly a third of the datagrams lost, others late, doubled, replayed, or full of what is no number.
#[test]
fn a_bad_network_neither_throws_her_nor_makes_her_jump() {
    let _turn = shared_turn();
    let (site, mut dice) = (Site::patient(super::EXE), Dice::new());
    let mut robot = Robot::standing_in(&site, &PACED);
    let (mut eyes, mut running) = Eyes::and_gateway(&site);
    let mut sensors = robot.space.reader::<Sensors>(&SENSORS).unwrap();
    let limited = until(&mut robot.run, &mut sensors, |_| true).targets_limited;
    let begun = until(&mut robot.run, &mut robot.sim, |_| true);
    let (counted, end) = (eyes.seen, clock::now() + 20 * clock::SECOND);
    let mut late: Vec<(u64, Vec<u8>)> = Vec::new();
    let mut old = Vec::new();
    while clock::now() < end {
        eyes.trigger();
        let bytes = eyes.answer(velocity(dice.between(0.1, 0.4)));
        match dice.between(0.0, 100.0) as u64 {
            0..30 => {}
            30..45 => late.push((clock::now() + dice.between(0.0, 1e9) as u64, bytes.clone())),
            45..55 => (0..2).for_each(|_| eyes.send(&bytes)),
            55..60 => {
                let mut none = bytes.clone();
                none[32..40].copy_from_slice(&f64::NAN.to_le_bytes());
                eyes.send(&none);
            }
            60..63 => eyes.say(velocity(1.9e9)),
            63..66 => eyes.send(&bytes[..dice.between(0.0, 56.0) as usize]),
            _ => eyes.send(&bytes),
        }
        if dice.between(0.0, 1.0) < 0.2 && !old.is_empty() {
            let replayed: &Vec<u8> = &old[dice.between(0.0, old.len() as f64) as usize];
            eyes.send(&replayed.clone());
        }
        old.push(bytes);
        let due = late.extract_if(.., |(at, _)| clock::now() >= *at).collect::<Vec<_>>();
        due.iter().for_each(|(_, bytes)| eyes.send(bytes));
    }
    // Silence.
    let way = until(&mut robot.run, &mut robot.sim, |_| true).position[0] - begun.position[0];
    let late = clock::now() + 5 * clock::SECOND;
    let standing = |seen: &Seen| seen.gait == GaitState::Standing as u64 && seen.flags & flag::LEASE == 0;
    while !standing(&eyes.trigger()) {
        assert!(clock::now() < late, "she does not stand: {:?}\n{}", eyes.seen, running.out());
    }
    let sim = until(&mut robot.run, &mut robot.sim, |_| true);
    assert_eq!((sim.fallen, sim.power), (0, 1));
    assert!(way > 1.0, "{way} m");
    let jumps = until(&mut robot.run, &mut sensors, |_| true).targets_limited - limited;
    assert_eq!(jumps, 0, "targets that the joint loop had to limit");
    // Every datagram is counted once, accepted or under its cause.
    let seen = eyes.seen;
    let refused: [u64; Cause::ALL.len()] = std::array::from_fn(|i| seen.refused[i] - counted.refused[i]);
    let all = seen.accepted - counted.accepted + refused.iter().sum::<u64>();
    assert_eq!(all, eyes.sent, "{refused:?}");
    for cause in [Cause::Malformed, Cause::NotFinite, Cause::Range, Cause::Age, Cause::Order] {
        assert!(refused[cause as usize] > 0, "none was refused for {}: {refused:?}", cause.name());
    }
    let lines = running.out().matches("refused:").count();
    assert!((3..=28).contains(&lines), "{lines} lines in 25 s: {}", running.out());
    assert!(running.is_alive());
}

#[test]
fn she_stands_when_the_gateway_is_stopped_or_killed() {
    let _turn = shared_turn();
    let site = Site::patient(super::EXE);
    let mut robot = Robot::standing_in(&site, &PACED);
    let mut events = robot.space.reader::<Event>(&EVENTS_PLANNER).unwrap();
    let (mut eyes, running) = Eyes::and_gateway(&site);
    let walking = |seen: &Seen| seen.gait == GaitState::Walking as u64;

    // Stopped for a second, while the vision system goes on answering what it saw last.
    eyes.go(velocity(0.25), walking);
    let age = eyes.seen.refused[Cause::Age as usize];
    running.signal_supervisor(Signal::STOP);
    for _ in 0..10 {
        eyes.say(velocity(0.25));
        doze(0.1);
    }
    until(&mut robot.run, &mut events, |e| e.code == EventCode::LeaseLost as u64);
    running.signal_supervisor(Signal::CONT);
    robot.stands();
    eyes.catch_up();
    let late = eyes.trigger().refused[Cause::Age as usize] - age;
    assert!(late >= 3, "{late} answers of the time of the stop were refused for their age");

    // It goes on with what is new.
    eyes.go(velocity(0.25), walking);
    running.signal_supervisor(Signal::KILL);
    until(&mut robot.run, &mut events, |e| e.code == EventCode::LeaseLost as u64);
    robot.stands();
    robot.stays();
}

/// Whoever stops her is not overruled by a program that repeats itself, nor is who takes her over.
#[test]
fn somebody_elses_stop_holds_until_the_vision_system_has_seen_it() {
    let _turn = shared_turn();
    let site = Site::patient(super::EXE);
    let mut robot = Robot::standing_in(&site, &PACED);
    let (mut eyes, mut running) = Eyes::and_gateway(&site);
    let walking = |seen: &Seen| seen.gait == GaitState::Walking as u64;
    let held = |seen: &Seen| seen.flags & flag::HELD != 0 && seen.gait == GaitState::Standing as u64;
    eyes.go(velocity(0.25), walking);
    site.topic(&["pub", "walk/stop"]).well();
    eyes.go(velocity(0.25), held);
    for _ in 0..20 {
        eyes.go(velocity(0.25), |_| true);
    }
    assert!(held(&eyes.seen) && eyes.seen.refused[Cause::Held as usize] > 15, "{:?}", eyes.seen);
    says(&mut running, "stopped by somebody else (walk/stop)", 1);

    // Seen: it may walk again, until somebody takes the lease.
    eyes.say(STOP);
    eyes.go(velocity(0.25), walking);
    let dir = site.run_dir().display().to_string();
    let other = site.start(&["topic", "pub", "walk/velocity", "forward=0.278", "--take-over", "--dir", &dir]);
    eyes.go(velocity(0.25), |seen| seen.flags & flag::HELD != 0);
    drop(other);
    robot.stands();
    eyes.go(velocity(0.25), held);

    // Boxes need no lease; one that cannot be is named.
    let told = BoxCommand { id: 1, base: [9.0, 0.0, 0.0], yaw: 0.0, size: [0.1; 3], lifetime: 1.0 };
    let accepted = eyes.seen.accepted;
    eyes.go(Command::Box(told), |seen| seen.accepted > accepted + 2);
    assert_eq!(eyes.seen.refused[Cause::Robot as usize], 0, "{}", running.out());
    // Another sender is not heard, nor ends it the session.
    let stranger = UdpSocket::bind("127.0.0.1:0").unwrap();
    let bytes = eyes.answer(STOP);
    stranger.send_to(&bytes, eyes.gateway).unwrap();
    let before = eyes.seen.refused[Cause::Sender as usize];
    eyes.go(Command::Box(told), |seen| seen.refused[Cause::Sender as usize] == before + 1);
    assert!(held(&eyes.seen));
}

/// A velocity that came before the gateway had heard of a person's stop undid that, and boxes kept the lease: she walked on without end.
#[test]
fn a_velocity_right_behind_somebody_elses_stop_does_not_undo_it() {
    let _turn = shared_turn();
    let (site, mut dice) = (Site::patient(super::EXE), Dice::new());
    let mut robot = Robot::standing_in(&site, &PACED);
    let (mut eyes, running) = Eyes::and_gateway(&site);
    let mut person = StreamClient::connect(&site.run_dir(), "a person").unwrap();
    let held = |seen: &Seen| seen.flags & flag::HELD != 0 && seen.gait == GaitState::Standing as u64;
    let told = BoxCommand { id: 1, base: [50.0, 0.0, 0.0], yaw: 0.0, size: [0.1; 3], lifetime: 5.0 };
    for hung in [true, false, true, false, false, false] {
        eyes.catch_up();
        eyes.say(STOP);
        eyes.go(velocity(0.25), |seen| seen.gait == GaitState::Walking as u64);
        // The velocity comes a little later, or both wait for a gateway that stands still.
        running.signal_supervisor(if hung { Signal::STOP } else { Signal::CONT });
        person.send(&Command::Stop).unwrap();
        doze(dice.between(0.0, 0.01));
        eyes.say(velocity(0.25));
        doze(if hung { 0.15 } else { 0.0 });
        running.signal_supervisor(Signal::CONT);
        let late = clock::now() + 15 * clock::SECOND;
        while !held(&eyes.trigger()) {
            assert!(clock::now() < late, "she walks on, hung: {hung}: {:?}\n{}", eyes.seen, running.out());
            eyes.say(velocity(0.25));
            eyes.say(Command::Box(told));
        }
    }
    let sim = until(&mut robot.run, &mut robot.sim, |_| true);
    assert_eq!((sim.fallen, sim.power), (0, 1));
}

/// The broker died after a person's stop and was started again: she walked off by the velocity that was repeated all the time.
#[test]
fn somebody_elses_stop_holds_when_the_broker_is_started_again() {
    let _turn = shared_turn();
    let site = Site::patient(super::EXE);
    let mut robot = Robot::standing_in(&site, &PACED);
    let (mut eyes, mut running) = Eyes::and_gateway(&site);
    let walking = |seen: &Seen| seen.gait == GaitState::Walking as u64;
    let held = |seen: &Seen| seen.flags & flag::HELD != 0 && seen.gait == GaitState::Standing as u64;
    eyes.go(velocity(0.25), walking);
    site.topic(&["pub", "walk/stop"]).well();
    eyes.go(velocity(0.25), held);
    robot.run.kill(Process::Broker);
    says(&mut running, "connected", 2);
    let before = eyes.trigger().refused[Cause::Held as usize];
    eyes.go(velocity(0.25), |seen| seen.refused[Cause::Held as usize] > before + 10);
    assert!(held(&eyes.seen), "{:?}", eyes.seen);
    robot.stays();
    // Seen.
    eyes.catch_up();
    eyes.trigger();
    eyes.say(STOP);
    eyes.go(velocity(0.25), walking);
}

/// Where the frames of a trigger are, beside those of the simulation.
#[test]
fn a_trigger_says_where_she_is() {
    let _turn = shared_turn();
    let site = Site::patient(super::EXE);
    let mut robot = Robot::standing_in(&site, &PACED);
    let (mut eyes, _running) = Eyes::and_gateway(&site);
    let begun = until(&mut robot.run, &mut robot.sim, |_| true).position;
    let first = eyes.trigger().torso();
    eyes.go(velocity(0.25), |seen| seen.numbers[0] > 1.0);
    eyes.go(STOP, |seen| seen.gait == GaitState::Standing as u64);
    doze(0.5);
    eyes.catch_up();
    let (seen, sim) = (eyes.trigger(), until(&mut robot.run, &mut robot.sim, |_| true).position);
    let (walked, told): ([f64; 3], [f64; 3]) =
        (std::array::from_fn(|d| sim[d] - begun[d]), std::array::from_fn(|d| seen.torso()[d] - first[d]));
    let (error, bound) = ((told[0] - walked[0]).hypot(told[1] - walked[1]), seen.numbers[4]);
    assert!(
        (0.8..1.8).contains(&walked[0]) && (seen.numbers[6] - walked[0]).abs() < 0.3,
        "{seen:?}, {walked:?} m"
    );
    assert!(error < bound, "{error} m beside, at most {bound}");
    assert!((told[2] - walked[2]).abs() < 0.01, "{told:?}, {walked:?} m");
    assert!(seen.numbers.iter().all(|x| x.is_finite()), "{seen:?}");
}

/// From 127.0.0.1, where it listens by default, there is no way to another computer: it said "10 per second" and sent nothing.
#[test]
fn a_gateway_whose_triggers_cannot_be_sent_says_so() {
    let site = Site::patient(super::EXE);
    let mut running = gateway(&site, "198.51.100.1:47201".parse().unwrap());
    says(&mut running, "triggers cannot be sent from 127.0.0.1:", 1);
    says(&mut running, "--listen must be", 1);
}

/// Another user of this machine, who knows all that there is to know.
#[test]
fn another_user_of_the_machine_moves_nothing() {
    use std::io::Write;
    use std::os::unix::process::CommandExt;
    const SEND: &str = r"
import socket, sys
port = int(sys.argv[1])
try:  # also the gateway's port of the other family, which anybody may take
    other = socket.socket(socket.AF_INET6, socket.SOCK_DGRAM); other.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_V6ONLY, 1); other.bind(('::', port))
except OSError: pass  # no IPv6 here
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM); s.bind(('127.0.0.1', 0))
for line in sys.stdin: s.sendto(bytes.fromhex(line), ('127.0.0.1', port))";
    let root = std::fs::metadata("/proc/self").is_ok_and(|m| std::os::unix::fs::MetadataExt::uid(&m) == 0);
    if !root {
        return harness::left_out("another user: only root can be somebody else");
    }
    let _turn = shared_turn();
    let site = Site::patient(super::EXE);
    let mut robot = Robot::standing_in(&site, &PACED);
    let (mut eyes, mut running) = Eyes::and_gateway(&site);
    for (user, moves) in [(65534, false), (0, true)] {
        let mut other = std::process::Command::new("python3")
            .args(["-c", SEND, &eyes.gateway.port().to_string()])
            .stdin(std::process::Stdio::piped())
            .uid(user)
            .gid(user)
            .current_dir("/")
            .spawn()
            .expect("python3 is there");
        let count = |seen: &Seen| [seen.accepted, seen.refused[Cause::Sender as usize]];
        let before = count(&eyes.seen);
        // Sent until it counts: on a busy machine some come too late.
        while count(&eyes.trigger()) == before {
            let hex: String = eyes.answer(velocity(0.25)).iter().map(|b| format!("{b:02x}")).collect();
            writeln!(other.stdin.as_ref().unwrap(), "{hex}").unwrap();
            assert!(other.try_wait().unwrap().is_none() && running.is_alive(), "{}", running.out());
        }
        let [accepted, refused] = count(&eyes.seen);
        assert_eq!([accepted > before[0], refused > before[1]], [moves, !moves], "user {user}");
        drop(other.stdin.take());
        other.wait().unwrap();
    }
    robot.stands();
}
