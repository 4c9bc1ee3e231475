//! Strangers at the broker's doors, in every way that a connection allows, until they are told to end.

use std::io::{Read, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpStream};
use std::os::unix::fs::PermissionsExt;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::time::Duration;

use broker::message::{MAX_BYTES, VERSION, service, service_message, write_command};
use broker::{StreamClient, keys};
use harness::{Site, doze};
use messages::command_text::COMMANDS;
use messages::{Command, Stamp};
use realtime::clock::now;

use crate::EXE;

/// A door for the network, with a key that nobody here knows.
pub(crate) fn with_door(site: Site) -> Site {
    write_key(&site.path("keys"), "7a");
    let keys = format!("tcp_keys = \"{}\"", site.path("keys").display());
    site.edit("system.toml", "tcp_keys = \"\"", &keys);
    site
}

fn write_key(path: &Path, digits: &str) {
    std::fs::write(path, format!("op all {}\n", digits.repeat(32))).unwrap();
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(0o600)).unwrap();
}

/// Where an attack goes on until it is told to end.
#[derive(Clone)]
pub(crate) struct Place {
    tcp: SocketAddr,
    dir: PathBuf,
    over: Arc<AtomicBool>,
    /// Times that it was done.
    pub(crate) done: Arc<AtomicU64>,
}

impl Place {
    /// At the doors of this robot.
    pub(crate) fn of(site: &Site) -> Self {
        Self {
            tcp: (Ipv4Addr::LOCALHOST, site.port()).into(),
            dir: site.run_dir(),
            over: Arc::default(),
            done: Arc::default(),
        }
    }

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

pub(crate) type Attack = (&'static str, fn(&Place));

pub(crate) const ATTACKS: [Attack; 8] = [
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

/// Does something while these attacks go on, each by two at a time; returns how often they were done.
pub(crate) fn under(place: &Place, attacks: &[Attack], meanwhile: impl FnOnce()) -> u64 {
    std::thread::scope(|scope| {
        let twice = attacks.iter().chain(attacks);
        let attackers: Vec<_> = twice.map(|(_, attack)| scope.spawn(|| attack(place))).collect();
        // Also if something is found.
        let over = Over(&place.over);
        meanwhile();
        drop(over);
        for attacker in attackers {
            attacker.join().unwrap_or_else(|e| std::panic::resume_unwind(e));
        }
    });
    place.done.load(Relaxed)
}
