//! The doors of the broker: a Unix socket in the run directory, and TCP if `system.toml` wants it.
//!
//! Each door has a thread and places of its own: what floods one of them leaves the other alone. A place is for one
//! connection; nobody gets more than a share of them, counted by user or address, and beyond the places a few more
//! connections are heard for a stop and nothing else. Where there are keys, who has proved none gives way to who comes.
//!
//! | who | may |
//! |---|---|
//! | the user of the run, or root, on the socket (SO_PEERCRED) | everything |
//! | other users on the socket; TCP on the loopback interface without a key | stop, emergency stop, read |
//! | TCP from elsewhere without a key | stop, emergency stop |
//! | TCP with a key | what the key's line says |

use std::fs;
use std::net::{IpAddr, SocketAddr, TcpListener};
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::os::unix::net::UnixListener;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::Duration;

use messages::command::Domain;
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::sync::mpsc;
use tokio::task::AbortHandle;

use crate::connection::{self, RATE, Rights};
use crate::exchange::FIRST_STREAM;
use crate::identity;
use crate::inlet::Gate;
use crate::keys::Key;
use crate::log_gate::LogGate;
use crate::message::domain_mask;
use crate::refusal::Refusal;

/// Name of the socket in the run directory.
pub const SOCKET: &str = "broker.sock";
/// Name of the file in the run directory that holds the address that TCP is served on.
pub const TCP_FILE: &str = "broker.tcp";
/// Connections beyond the places that are heard for a stop; one more closes the oldest of them.
pub const RESERVE: usize = 8;

/// Places of one door.
#[derive(Clone, Copy, Debug)]
pub struct DoorPlaces {
    /// Connections at once.
    pub total: usize,
    /// Of them, for one user or address.
    pub each: usize,
    /// First number of its connections.
    first: u32,
}

/// Places at the socket; other users share a few of them.
pub const SOCKET_PLACES: DoorPlaces = DoorPlaces { total: 72, each: 64, first: FIRST_STREAM };
/// Of the places at the socket, those of each other user.
const OTHER_USERS: usize = 4;
/// Places at the TCP port.
pub const TCP_PLACES: DoorPlaces = DoorPlaces { total: 32, each: 16, first: 0xc000_0000 };
/// Messages per second, and at once, of a connection that may not command, or not yet.
const STRANGER_RATE: u64 = 100;

/// Peer of a new connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Peer {
    User { uid: u32, own: bool },
    Address(IpAddr),
}

/// Binds the socket of the run directory `dir`, for its user alone.
///
/// # Errors
/// The path is too long for a socket, or cannot be made.
pub(crate) fn bind_socket(dir: &Path) -> Result<(UnixListener, u32), String> {
    let path = dir.join(SOCKET);
    let wrong = |e: std::io::Error| {
        format!("cannot listen on {}: {e}; a path of at most 107 bytes is needed (--dir)", path.display())
    };
    // The lock of the run says that no other broker serves it: what is there was left behind.
    match fs::remove_file(&path) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => return Err(wrong(e)),
        _ => {}
    }
    let listener = UnixListener::bind(&path).map_err(wrong)?;
    fs::set_permissions(&path, fs::Permissions::from_mode(0o600)).map_err(wrong)?;
    let owner = fs::symlink_metadata(&path).map_err(wrong)?.uid();
    listener.set_nonblocking(true).map_err(wrong)?;
    Ok((listener, owner))
}

/// Listens for TCP; port 0 lets the system choose one. Off the loopback interface only with keys.
///
/// # Errors
/// The address is taken, or would be open to everybody.
pub fn bind_tcp(address: SocketAddr, keys: &[Key]) -> Result<TcpListener, String> {
    if !address.ip().is_loopback() && keys.is_empty() {
        return Err(format!(
            "system.toml: tcp_listen = \"{address}\" is not on the loopback interface, and there are no keys: name a file \
             in tcp_keys (docs/protocol.md)"
        ));
    }
    let listener = TcpListener::bind(address).map_err(|e| {
        format!(
            "cannot listen on {address}: {e}; is another run active? Choose another tcp_listen in system.toml"
        )
    })?;
    listener.set_nonblocking(true).map_err(|e| e.to_string())?;
    Ok(listener)
}

/// Writes into the run directory where TCP is served.
///
/// # Errors
/// The file cannot be written.
pub(crate) fn publish_address(dir: &Path, listener: &TcpListener) -> Result<(), String> {
    let path: PathBuf = dir.join(TCP_FILE);
    let address = listener.local_addr().map_err(|e| e.to_string())?;
    fs::write(&path, format!("{address}\n")).map_err(|e| format!("{}: {e}", path.display()))
}

/// Serves the socket until the process ends, in a thread of its own. `owner`: user of the run.
///
/// # Errors
/// The thread or its run-time cannot be made.
pub(crate) fn serve_socket(listener: UnixListener, owner: u32, gate: Gate) -> Result<(), String> {
    in_thread("socket", async move {
        let listener = match tokio::net::UnixListener::from_std(listener) {
            Ok(listener) => listener,
            Err(e) => return tracing::error!("no connections on the socket: {e}"),
        };
        let mut door = Door::new(SOCKET_PLACES, gate, Vec::new());
        loop {
            match listener.accept().await {
                Ok((stream, _)) => {
                    let Ok(credentials) = stream.peer_cred() else { continue };
                    let uid = credentials.uid();
                    let own = uid == owner || uid == 0;
                    let name = identity::of_process(uid, credentials.pid());
                    let (read, write) = stream.into_split();
                    door.admit(Peer::User { uid, own }, name, read, write);
                }
                Err(e) => door.wait_for_resources(&e).await,
            }
        }
    })
}

/// Serves TCP until the process ends, in a thread of its own.
///
/// # Errors
/// The thread or its run-time cannot be made.
pub(crate) fn serve_tcp(listener: TcpListener, keys: Vec<Key>, gate: Gate) -> Result<(), String> {
    in_thread("tcp", async move {
        let listener = match tokio::net::TcpListener::from_std(listener) {
            Ok(listener) => listener,
            Err(e) => return tracing::error!("no TCP connections: {e}"),
        };
        let mut door = Door::new(TCP_PLACES, gate, keys);
        loop {
            match listener.accept().await {
                Ok((stream, from)) => {
                    let _ = stream.set_nodelay(true);
                    let (read, write) = stream.into_split();
                    door.admit(Peer::Address(from.ip()), from.to_string(), read, write);
                }
                Err(e) => door.wait_for_resources(&e).await,
            }
        }
    })
}

fn in_thread(name: &str, serve: impl Future<Output = ()> + Send + 'static) -> Result<(), String> {
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .map_err(|e| format!("cannot make the run-time of the {name} server: {e}"))?;
    let thread = std::thread::Builder::new().name(name.into()).spawn(move || runtime.block_on(serve));
    thread.map(drop).map_err(|e| format!("no thread for the {name} server: {e}"))
}

/// One open connection.
struct Open {
    peer: Peer,
    only_stops: bool,
    /// True once it has proved a key.
    proven: Arc<AtomicBool>,
    task: AbortHandle,
}

/// Connections of one door.
struct Door {
    places: DoorPlaces,
    gate: Gate,
    keys: Arc<Vec<Key>>,
    open: Vec<Open>,
    token: u32,
    log: LogGate,
    ends: mpsc::UnboundedSender<End>,
}

/// Closed connection: number, peer, reason.
type End = (u32, String, Refusal);

impl Door {
    fn new(places: DoorPlaces, gate: Gate, keys: Vec<Key>) -> Self {
        let (ends, mut ended) = mpsc::unbounded_channel::<End>();
        tokio::spawn(async move {
            let mut log = LogGate::default();
            while let Some((token, peer, refusal)) = ended.recv().await {
                connection::log_end(&mut log, token, &peer, &refusal);
            }
        });
        let (keys, log) = (Arc::new(keys), LogGate::default());
        Self { places, gate, keys, open: Vec::new(), token: places.first, log, ends }
    }

    /// Serves a new connection, with a place or without one.
    fn admit(
        &mut self,
        peer: Peer,
        name: String,
        read: impl AsyncRead + Unpin + Send + 'static,
        write: impl AsyncWrite + Unpin + Send + 'static,
    ) {
        self.open.retain(|open| !open.task.is_finished());
        let only_stops = !self.has_place(peer);
        if only_stops {
            self.make_room_for_a_stop();
        }
        let rights = rights(peer, name.clone(), only_stops, self.keys.clone());
        let (gate, token, ends) = (self.gate.clone(), self.token, self.ends.clone());
        let proven = Arc::new(AtomicBool::new(false));
        let serve = connection::serve_at_door(read, write, gate, token, rights, proven.clone());
        let task = tokio::spawn(async move {
            if let Err(refusal) = serve.await {
                let _ = ends.send((token, name, refusal));
            }
        });
        self.open.push(Open { peer, only_stops, proven, task: task.abort_handle() });
        // Numbers of the two doors never meet.
        let last = self.places.first + 0x3fff_ffff;
        self.token = if self.token >= last { self.places.first } else { self.token + 1 };
    }

    /// Place for one more connection of this peer. If there is none, and keys are shown here, the oldest one
    /// that has not proved any is closed for it: whoever has a key would be locked out by a crowd of those who have none.
    fn has_place(&mut self, peer: Peer) -> bool {
        let each = match peer {
            Peer::User { own: false, .. } => OTHER_USERS,
            _ => self.places.each,
        };
        let placed = self.open.iter().filter(|open| !open.only_stops);
        let (all, own) = (placed.clone().count(), placed.filter(|open| open.peer == peer).count());
        if all < self.places.total && own < each {
            return true;
        }
        // A peer with a full share gives way to itself only.
        let gives_way =
            |open: &Open| !open.only_stops && !open.proven.load(Relaxed) && (own < each || open.peer == peer);
        let oldest = self.open.iter().position(gives_way).filter(|_| !self.keys.is_empty());
        oldest.map(|at| self.open.remove(at).task.abort()).is_some()
    }

    /// One more connection beyond the places closes the oldest of them.
    fn make_room_for_a_stop(&mut self) {
        let beyond = self.open.iter().filter(|open| open.only_stops).count();
        if beyond < RESERVE {
            return;
        }
        if let Some(oldest) = self.open.iter().position(|open| open.only_stops) {
            self.open.remove(oldest).task.abort();
        }
    }

    /// The system has no descriptor left, or the like: a moment, and then again.
    async fn wait_for_resources(&mut self, error: &std::io::Error) {
        if self.log.admit(realtime::clock::now()).is_some() {
            tracing::warn!("cannot accept a connection: {error}");
        }
        tokio::time::sleep(Duration::from_millis(100)).await;
    }
}

/// Rights of a peer before it shows a key.
fn rights(peer: Peer, name: String, only_stops: bool, keys: Arc<Vec<Key>>) -> Rights {
    let (may, reads) = match peer {
        Peer::User { own: true, .. } => (domain_mask(&Domain::ALL), true),
        Peer::User { own: false, .. } => (0, true),
        Peer::Address(ip) => (0, ip.is_loopback()),
    };
    let rate = if may != 0 { RATE } else { STRANGER_RATE };
    Rights { peer: name, may, reads, only_stops, rate, keys }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inlet;
    use proptest::prelude::*;
    use proptest::strategy::ValueTree;
    use proptest::test_runner::TestRunner;

    #[test]
    fn only_the_user_of_the_run_may_command_without_a_key() {
        let may = |peer| rights(peer, String::new(), false, Arc::default()).may;
        assert_eq!(may(Peer::User { uid: 7, own: true }), domain_mask(&Domain::ALL));
        assert_eq!(may(Peer::User { uid: 8, own: false }), 0);
        for address in ["127.0.0.1", "::1", "10.0.0.7"] {
            let peer = Peer::Address(address.parse().expect("an address"));
            let rights = rights(peer, String::new(), false, Arc::default());
            assert_eq!((rights.may, rights.reads), (0, address != "10.0.0.7"), "{address}");
        }
    }

    /// 16 connections without a key locked out whoever had one for their address, and two addresses everybody. At random, with
    /// more addresses than there are places: who comes has a place unless all of them are held by keys, those stay, and no
    /// limit is passed. Without keys whoever was there first stays.
    #[tokio::test]
    async fn a_crowd_without_keys_gives_way_and_who_has_proved_one_stays() {
        let places = DoorPlaces { total: 6, each: 3, first: FIRST_STREAM };
        for keys in [vec![crate::keys::tests::key()], Vec::new()] {
            let mut runner = TestRunner::deterministic();
            for _ in 0..200 {
                let steps = prop::collection::vec((0u8..4, 0..9usize, any::<bool>()), 0..60);
                let steps = steps.new_tree(&mut runner).expect("steps").current();
                let mut door = Door::new(places, inlet::gate().0, keys.clone());
                for (address, chosen, comes) in steps {
                    if comes {
                        one_comes(&mut door, Peer::Address([10, 0, 0, address].into()));
                    } else if let Some(open) = door.open.get(chosen).filter(|_| !keys.is_empty()) {
                        open.proven.store(true, Relaxed);
                    }
                }
            }
        }
    }

    /// One more connection of `peer`, held against the rule.
    fn one_comes(door: &mut Door, peer: Peer) {
        // Places held, or held by keys: all, and those of the peer.
        let held = |door: &Door, keys_only: bool| {
            let of = door.open.iter().filter(|open| !keys_only || open.proven.load(Relaxed));
            [of.clone().count(), of.filter(|open| open.peer == peer).count()]
        };
        let [all, own] = held(door, !door.keys.is_empty());
        let expected = all < door.places.total && own < door.places.each;
        let keys = held(door, true);
        let has_place = door.has_place(peer);
        assert_eq!(has_place, expected, "{all} places that do not give way, {own} of this address");
        assert_eq!(held(door, true), keys, "a key lost its place");
        if has_place {
            let task = tokio::spawn(std::future::pending::<()>()).abort_handle();
            door.open.push(Open { peer, only_stops: false, proven: Arc::default(), task });
        }
        let [all, own] = held(door, false);
        assert!(all <= door.places.total && own <= door.places.each);
    }

    #[test]
    fn off_the_loopback_interface_nobody_listens_without_keys() {
        let error = bind_tcp("0.0.0.0:0".parse().expect("an address"), &[]).unwrap_err();
        assert!(error.contains("tcp_listen = \"0.0.0.0:0\"") && error.contains("tcp_keys"), "{error}");
    }
}
