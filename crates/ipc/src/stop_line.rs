//! The emergency stop's own line: an abstract Unix datagram socket of the watchdog's.
//!
//! It has no file, no inode and no shared memory, so neither a full disk, nor a full /dev/shm, nor permissions are in its way:
//! every user of this machine reaches every robot. Whatever datagram arrives asks for the stop; there is nothing in it that
//! could be parsed wrongly. Who sent it is told by the kernel (SO_PASSCRED), not by the sender.
//!
//! The name says whose robot it is: `gangwerk/estop/UID/HASH DIR`. Somebody else who takes a name first makes the *start* of
//! that robot fail, with an error that names him; he cannot come between a running robot and its stop.

use crate::IpcError;
use crate::place;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use std::io::{self, Write};
use std::os::fd::AsRawFd;
use std::os::linux::net::SocketAddrExt;
use std::os::unix::net::{SocketAddr, UnixDatagram};
use std::path::Path;
use std::time::Duration;

/// Prefix of every name.
const PREFIX: &str = "gangwerk/estop/";
/// Longest name of an abstract socket \[B\].
const LONGEST: usize = 107;

/// Whose line it is, and where its robot runs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StopName {
    /// The user who runs the robot.
    pub uid: u32,
    text: String,
}

impl StopName {
    /// The line of the robot that `uid` runs in `dir`.
    pub fn of(uid: u32, dir: &Path) -> Self {
        let dir = place::resolved(dir);
        let shown = dir.to_string_lossy().replace(|c: char| !c.is_ascii_graphic(), "?");
        let mut text = format!("{PREFIX}{uid}/{:012x} {shown}", place::key(&dir));
        text.truncate(LONGEST); // all of it is ASCII
        Self { uid, text }
    }

    /// The line of the robot that this user runs in `dir`.
    pub fn own(dir: &Path) -> Self {
        Self::of(rustix::process::geteuid().as_raw(), dir)
    }

    /// Every robot on this machine (in this network namespace), whoever runs it.
    ///
    /// # Errors
    /// /proc/net/unix cannot be read.
    pub fn all() -> io::Result<Vec<Self>> {
        Ok(sockets()?.lines().filter_map(|line| Self::parse(line.split_once(" @")?.1)).collect())
    }

    /// Whether this is a line of a robot in `dir`, whoever runs it.
    pub fn is_in(&self, dir: &Path) -> bool {
        Self::of(self.uid, dir) == *self
    }

    /// The run directory, as far as it fits into the name.
    pub fn dir(&self) -> &str {
        self.text.split_once(' ').map_or("", |(_, dir)| dir)
    }

    fn parse(text: &str) -> Option<Self> {
        let (uid, _) = text.strip_prefix(PREFIX)?.split_once('/')?;
        Some(Self { uid: uid.parse().ok()?, text: text.into() })
    }

    fn address(&self) -> io::Result<SocketAddr> {
        SocketAddr::from_abstract_name(&self.text)
    }

    /// Holders of this name, in words: those that may be looked at.
    fn holder(&self) -> String {
        let table = sockets().unwrap_or_default();
        let line = table.lines().find(|line| line.ends_with(&format!(" @{}", self.text)));
        let inode = line.and_then(|line| line.split_whitespace().nth(6));
        let socket = format!("socket:[{}]", inode.unwrap_or("?"));
        let holds = |pid: u32| {
            let descriptors = std::fs::read_dir(format!("/proc/{pid}/fd")).into_iter().flatten().flatten();
            descriptors.filter_map(|d| d.path().read_link().ok()).any(|link| link.as_os_str() == &*socket)
        };
        let processes = std::fs::read_dir("/proc").into_iter().flatten().flatten();
        let mut pids = processes.filter_map(|p| p.file_name().to_str()?.parse().ok());
        match pids.find(|&pid| holds(pid)) {
            Some(pid) => {
                use std::os::unix::fs::MetadataExt;
                let name = std::fs::read_to_string(format!("/proc/{pid}/comm")).unwrap_or_default();
                let uid =
                    std::fs::metadata(format!("/proc/{pid}")).map_or("?".into(), |m| m.uid().to_string());
                format!("pid {pid} ({}) of user {uid}", name.trim())
            }
            None => format!("a process of another user ({socket})"),
        }
    }
}

/// The kernel's table of Unix sockets. Anybody may put a name of any bytes into it, and hides no robot with one that is not UTF-8.
fn sockets() -> io::Result<String> {
    Ok(String::from_utf8_lossy(&std::fs::read("/proc/net/unix")?).into_owned())
}

/// Sender of a datagram, as the kernel saw it; zeros if unknown (another namespace).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Asker {
    /// Process id.
    pub pid: u32,
    /// User id.
    pub uid: u32,
}

/// Answer of the watchdog.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopAnswer {
    /// The motor supply is off, since this tick.
    Off {
        /// \[1\] Tick of the first power record that said so.
        tick: u64,
        /// \[ns\] Time of writing, on the monotonic clock of this machine.
        stamp_ns: u64,
    },
    /// Taken and latched; no cycle of the watchdog has acted on it yet.
    Pending,
}

impl StopAnswer {
    /// One line of text, for every program that can read one. On the stack: who answers does not allocate.
    fn line(self, buffer: &mut [u8; 128]) -> &[u8] {
        let mut left = &mut buffer[..];
        let _fits = match self {
            Self::Off { tick, stamp_ns } => writeln!(left, "off tick {tick} at {stamp_ns} ns"),
            Self::Pending => writeln!(left, "pending"),
        };
        let left = left.len();
        &buffer[..128 - left]
    }

    fn parse(text: &str) -> Option<Self> {
        let words: Vec<&str> = text.split_whitespace().collect();
        match words[..] {
            ["off", "tick", tick, "at", stamp, "ns"] => {
                Some(Self::Off { tick: tick.parse().ok()?, stamp_ns: stamp.parse().ok()? })
            }
            ["pending"] => Some(Self::Pending),
            _ => None,
        }
    }
}

/// A datagram: who sent it, and where an answer goes; none: the sender has no name.
#[derive(Clone, Debug)]
pub struct Datagram {
    /// Sender.
    pub from: Asker,
    /// Destination of an answer.
    pub answer_to: Option<SocketAddr>,
}

/// The watchdog's end.
#[derive(Debug)]
pub struct StopLine {
    socket: UnixDatagram,
}

impl StopLine {
    /// Takes the line of the robot in `dir`.
    ///
    /// # Errors
    /// Somebody else has its name: the robot does not start, because nobody could stop it this way.
    pub fn bind(dir: &Path) -> Result<Self, IpcError> {
        let name = StopName::own(dir);
        let bound = name.address().and_then(|address| UnixDatagram::bind_addr(&address));
        let socket = bound.map_err(|e| {
            let reason = match e.kind() {
                io::ErrorKind::AddrInUse => {
                    format!("{} has taken its name; end it, then start again", name.holder())
                }
                _ => e.to_string(),
            };
            IpcError::Other(format!("the emergency stop has no socket (@{}): {reason}", name.text))
        })?;
        let ready = socket.set_nonblocking(true).and_then(|()| pass_credentials(&socket));
        ready.map_err(|e| IpcError::Other(format!("the emergency stop's socket (@{}): {e}", name.text)))?;
        Ok(Self { socket })
    }

    /// Sleeps until a datagram is there, at most `limit`.
    pub fn wait(&self, limit: Duration) -> bool {
        readable(&self.socket, limit)
    }

    /// The next datagram that waits. Allocates nothing and never waits.
    pub fn receive(&self) -> Option<Datagram> {
        receive(&self.socket, &mut [0; 16]).map(|(_, datagram)| datagram)
    }

    /// Answers; who does not fetch its answers gets none. Never waits.
    pub fn answer(&self, to: &SocketAddr, answer: StopAnswer) {
        let _ = self.socket.send_to_addr(answer.line(&mut [0; 128]), to);
    }
}

/// The end of somebody who wants to stop a robot.
#[derive(Debug)]
pub struct StopButton {
    socket: UnixDatagram,
    robot: SocketAddr,
    name: StopName,
}

impl StopButton {
    /// For the robot of this name.
    ///
    /// # Errors
    /// No socket can be made.
    pub fn new(name: &StopName) -> io::Result<Self> {
        let socket = UnixDatagram::unbound()?;
        // With this the kernel gives it a name at the first datagram, to which the answer can go.
        pass_credentials(&socket)?;
        // A full queue: wait a little for room, among the others that wait.
        socket.set_write_timeout(Some(Duration::from_millis(20)))?;
        Ok(Self { socket, robot: name.address()?, name: name.clone() })
    }

    /// Asks for the stop. False: the queue stayed full; what fills it has asked for the stop already.
    ///
    /// # Errors
    /// Nobody listens: the watchdog of this robot is gone.
    pub fn press(&self) -> io::Result<bool> {
        match self.socket.send_to_addr(b"stop", &self.robot) {
            Ok(_) => Ok(true),
            Err(e) if matches!(e.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut) => Ok(false),
            Err(e) => Err(e),
        }
    }

    /// The next answer within `limit`. Only the user who runs the robot, or root, answers for it.
    pub fn answer(&self, limit: Duration) -> Option<StopAnswer> {
        if !readable(&self.socket, limit) {
            return None;
        }
        let mut bytes = [0; 128];
        let (length, datagram) = receive(&self.socket, &mut bytes)?;
        let genuine = [0, self.name.uid].contains(&datagram.from.uid) && datagram.from.pid != 0;
        std::str::from_utf8(&bytes[..length]).ok().filter(|_| genuine).and_then(StopAnswer::parse)
    }

    /// The robot.
    pub fn name(&self) -> &StopName {
        &self.name
    }
}

fn readable(socket: &UnixDatagram, limit: Duration) -> bool {
    let limit = Timespec { tv_sec: limit.as_secs() as i64, tv_nsec: i64::from(limit.subsec_nanos()) };
    let mut watched = [PollFd::new(socket, PollFlags::IN)];
    poll(&mut watched, Some(&limit)).is_ok_and(|n| n > 0)
}

fn pass_credentials(socket: &UnixDatagram) -> io::Result<()> {
    rustix::net::sockopt::set_socket_passcred(socket, true)?;
    Ok(())
}

/// Room for one set of credentials with its header, aligned as the kernel writes it.
#[repr(C, align(8))]
struct CredentialsBuffer([u8; 64]);

/// One datagram: its length and where it came from.
///
/// By hand, because the safe wrappers hold a process id to be never 0, and the kernel gives 0 for a sender that this
/// process's namespace does not see.
fn receive(socket: &UnixDatagram, bytes: &mut [u8]) -> Option<(usize, Datagram)> {
    let mut control = CredentialsBuffer([0; 64]);
    // SAFETY: an address and a message header are plain numbers and null pointers, for which zero is a value.
    let (mut address, mut header): (libc::sockaddr_un, libc::msghdr) = unsafe { std::mem::zeroed() };
    let mut part = libc::iovec { iov_base: bytes.as_mut_ptr().cast(), iov_len: bytes.len() };
    header.msg_name = (&raw mut address).cast();
    header.msg_namelen = size_of::<libc::sockaddr_un>() as u32;
    (header.msg_iov, header.msg_iovlen) = (&raw mut part, 1);
    (header.msg_control, header.msg_controllen) = (control.0.as_mut_ptr().cast(), control.0.len());
    // SAFETY: every pointer of `header` is to a writable local of the length that stands beside it.
    let length = unsafe {
        libc::recvmsg(socket.as_raw_fd(), &mut header, libc::MSG_DONTWAIT | libc::MSG_CMSG_CLOEXEC)
    };
    let length = usize::try_from(length).ok()?;
    let mut from = Asker::default();
    // SAFETY: `header` was filled by `recvmsg`, which keeps its control messages inside `control`; credentials are read
    // from behind a header that says that they follow, unaligned.
    unsafe {
        let message = libc::CMSG_FIRSTHDR(&header);
        if !message.is_null()
            && ((*message).cmsg_level, (*message).cmsg_type) == (libc::SOL_SOCKET, libc::SCM_CREDENTIALS)
            && (*message).cmsg_len >= libc::CMSG_LEN(size_of::<libc::ucred>() as u32) as usize
        {
            let who: libc::ucred = libc::CMSG_DATA(message).cast::<libc::ucred>().read_unaligned();
            from = Asker { pid: who.pid as u32, uid: who.uid };
        }
    }
    let named = (header.msg_namelen as usize).saturating_sub(size_of::<libc::sa_family_t>());
    let name = address.sun_path.map(|c| c as u8);
    // Answers go to abstract names only: looking a path up could wait for a disk.
    let answer_to = match name.get(1..named) {
        Some(abstracted) if name[0] == 0 => SocketAddr::from_abstract_name(abstracted).ok(),
        _ => None,
    };
    Some((length, Datagram { from, answer_to }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dir(name: &str) -> std::path::PathBuf {
        std::env::temp_dir().join(format!("gangwerk-stop-line-{}-{name}", std::process::id()))
    }

    const SOON: Duration = Duration::from_secs(10);

    #[test]
    fn a_request_names_its_sender_and_gets_its_answer() {
        let dir = dir("answer");
        let line = StopLine::bind(&dir).unwrap();
        let name = StopName::own(&dir);
        assert!(StopName::all().unwrap().contains(&name) && name.is_in(&dir));
        let button = StopButton::new(&name).unwrap();
        assert!(button.press().unwrap());
        assert!(line.wait(SOON));
        let request = line.receive().unwrap();
        assert_eq!(request.from.pid, std::process::id());
        assert_eq!(request.from.uid, rustix::process::geteuid().as_raw());
        let off = StopAnswer::Off { tick: 4481, stamp_ns: 17 };
        line.answer(&request.answer_to.unwrap(), off);
        assert_eq!(button.answer(SOON), Some(off));
        assert!(line.receive().is_none());
    }

    #[test]
    fn a_robot_that_is_gone_is_an_error_and_a_full_queue_is_none() {
        let dir = dir("full");
        let button = StopButton::new(&StopName::own(&dir)).unwrap();
        assert_eq!(button.press().unwrap_err().kind(), io::ErrorKind::ConnectionRefused);
        let line = StopLine::bind(&dir).unwrap();
        let other = StopButton::new(&StopName::own(&dir)).unwrap();
        while other.press().unwrap() {}
        assert!(!button.press().unwrap());
        while line.receive().is_some() {}
        assert!(button.press().unwrap());
    }

    #[test]
    fn a_squatted_name_refuses_the_start_and_names_the_squatter() {
        let dir = dir("squatted");
        let _squatter = UnixDatagram::bind_addr(&StopName::own(&dir).address().unwrap()).unwrap();
        let text = StopLine::bind(&dir).unwrap_err().to_string();
        assert!(text.contains(&format!("pid {} ", std::process::id())), "{text}");
    }

    /// One socket of any user, with such a name, hid every robot from everybody's emergency stop.
    #[test]
    fn a_name_that_is_not_utf8_hides_no_robot() {
        let dir = dir("hidden");
        let name = [&b"\xFF\xFE"[..], dir.as_os_str().as_encoded_bytes()].concat();
        let strange = SocketAddr::from_abstract_name(name).unwrap();
        let _strange = UnixDatagram::bind_addr(&strange).unwrap();
        let _line = StopLine::bind(&dir).unwrap();
        assert!(StopName::all().unwrap().contains(&StopName::own(&dir)));
        assert!(StopLine::bind(&dir).unwrap_err().to_string().contains("pid"));
    }

    #[test]
    fn anything_is_a_request_and_senders_without_a_name_count_too() {
        let dir = dir("anything");
        let line = StopLine::bind(&dir).unwrap();
        let nameless = UnixDatagram::unbound().unwrap();
        for bytes in [&[][..], &[0xFF; 1], &[0; 100_000]] {
            nameless.send_to_addr(bytes, &StopName::own(&dir).address().unwrap()).unwrap();
            assert!(line.receive().unwrap().answer_to.is_none());
        }
    }

    #[test]
    fn answers_survive_their_line_of_text() {
        let mut buffer = [0; 128];
        for answer in [StopAnswer::Pending, StopAnswer::Off { tick: u64::MAX, stamp_ns: 0 }] {
            let text = std::str::from_utf8(answer.line(&mut buffer)).unwrap();
            assert_eq!(StopAnswer::parse(text), Some(answer));
        }
        assert_eq!(StopAnswer::parse("off tick x at 3 ns"), None);
    }
}
