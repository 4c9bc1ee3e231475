//! A raw Ethernet socket: frames of Sercos III on one interface, sent and received as they are.
//!
//! The only file of this crate with `unsafe`: packet sockets have no safe interface in the libraries used here. Each call
//! hands the kernel memory that this file owns, with its true length.
#![allow(unsafe_code, reason = "packet sockets: see the head of this file")]

use crate::header::{ETHERTYPE, Mac};
use std::ffi::c_int;
use std::io::{Error, ErrorKind};
use std::mem::{size_of, zeroed};
use std::os::fd::{AsRawFd, FromRawFd, OwnedFd};
use std::{fmt, ptr};

/// A socket on one interface. It neither blocks nor allocates, but for [`Socket::wait`], which blocks.
pub struct Socket {
    fd: OwnedFd,
    request: libc::ifreq,
    name: String,
    mac: Mac,
}

/// Error of opening a socket.
#[derive(Debug)]
pub enum SocketError {
    /// The name is empty or too long.
    Name(String),
    /// Packet sockets are not allowed to this process.
    Permission(String),
    /// There is no such interface.
    Missing(String),
    /// The interface is switched off.
    Down(String),
    /// It is no Ethernet interface.
    Kind(String),
    /// Anything else: interface, call, and what the kernel said.
    Other(String, &'static str, Error),
}

impl fmt::Display for SocketError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Name(name) => write!(f, "sercos: '{name}' is no name of an interface (1 to 15 bytes)"),
            Self::Permission(name) => write!(
                f,
                "sercos: {name}: no permission for raw Ethernet frames; run as root or give the program the \
                 capability: setcap cap_net_raw+ep PROGRAM"
            ),
            Self::Missing(name) => write!(
                f,
                "sercos: there is no interface {name}; see `ip link` (for a trial: ip link add {name} type veth peer \
                 name {name}far)"
            ),
            Self::Down(name) => {
                write!(f, "sercos: the interface {name} is switched off; ip link set {name} up")
            }
            Self::Kind(name) => {
                write!(f, "sercos: {name} is no Ethernet interface; see `ip link` for one that is")
            }
            Self::Other(name, call, error) => write!(f, "sercos: {name}: {call}: {error}"),
        }
    }
}

impl std::error::Error for SocketError {}

impl Socket {
    /// Opens a socket on this interface, which is there and switched on.
    ///
    /// # Errors
    /// No permission, no such interface, interface off or of another kind: each with what to do.
    pub fn open(interface: &str) -> Result<Self, SocketError> {
        let request = name_request(interface)?;
        let protocol = c_int::from(ETHERTYPE.to_be());
        let kind = libc::SOCK_RAW | libc::SOCK_NONBLOCK | libc::SOCK_CLOEXEC;
        // SAFETY: no memory is involved. Protocol 0 here: nothing is received before `bind` names the interface.
        let fd = unsafe { libc::socket(libc::AF_PACKET, kind, 0) };
        if fd < 0 {
            let error = Error::last_os_error();
            return Err(match error.kind() {
                ErrorKind::PermissionDenied => SocketError::Permission(interface.to_owned()),
                _ => SocketError::Other(interface.to_owned(), "socket", error),
            });
        }
        // SAFETY: `fd` was just made and belongs to nobody else.
        let fd = unsafe { OwnedFd::from_raw_fd(fd) };
        let mut socket = Self { fd, request, name: interface.to_owned(), mac: [0; 6] };
        let index = socket.ask(libc::SIOCGIFINDEX, "SIOCGIFINDEX")?;
        // SAFETY: after SIOCGIFINDEX this is the field that the kernel has written.
        let index = unsafe { index.ifr_ifru.ifru_ifindex };
        if !socket.has(libc::IFF_UP)? {
            return Err(SocketError::Down(socket.name));
        }
        socket.mac = socket.hardware_address()?;
        socket.ignore_own()?;
        socket.bind(index, protocol)?;
        Ok(socket)
    }

    /// Name of the interface.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Hardware address of the interface.
    pub fn mac(&self) -> Mac {
        self.mac
    }

    /// Whether the interface is on and somebody is at the far end of the cable.
    pub(crate) fn has_link(&self) -> bool {
        self.has(libc::IFF_UP | libc::IFF_RUNNING).unwrap_or(false)
    }

    /// Sends a frame. `false`: the kernel did not take it; it is lost, as on a pulled cable.
    pub fn send(&self, frame: &[u8]) -> bool {
        // SAFETY: pointer and length are those of a slice that outlives the call.
        let sent = unsafe { libc::send(self.fd.as_raw_fd(), frame.as_ptr().cast(), frame.len(), 0) };
        usize::try_from(sent) == Ok(frame.len())
    }

    /// The next frame, at the begin of `buffer`; none if there is none. A frame that is longer is cut.
    pub fn receive<'a>(&self, buffer: &'a mut [u8]) -> Option<&'a [u8]> {
        // The first call after the interface went down tells of that; the second one has what came before.
        for _ in 0..2 {
            // SAFETY: pointer and length are those of a slice that outlives the call, and that nobody else uses.
            let got = unsafe {
                libc::recv(self.fd.as_raw_fd(), buffer.as_mut_ptr().cast(), buffer.len(), libc::MSG_DONTWAIT)
            };
            if let Ok(len) = usize::try_from(got) {
                return Some(&buffer[..len]);
            }
            if Error::last_os_error().raw_os_error() != Some(libc::ENETDOWN) {
                return None;
            }
        }
        None
    }

    /// Waits until one of these sockets has a frame, for at most so long \[ns\]; whether one has.
    pub fn wait<const N: usize>(sockets: [Option<&Self>; N], nanoseconds: u64) -> bool {
        // A negative descriptor is left out by the kernel.
        let mut set = sockets.map(|socket| libc::pollfd {
            fd: socket.map_or(-1, |s| s.fd.as_raw_fd()),
            events: libc::POLLIN,
            revents: 0,
        });
        let timeout = libc::timespec {
            tv_sec: (nanoseconds / 1_000_000_000) as libc::time_t,
            tv_nsec: (nanoseconds % 1_000_000_000) as libc::c_long,
        };
        // SAFETY: the array has N entries; the time-out outlives the call; no signal mask is given.
        let ready = unsafe { libc::ppoll(set.as_mut_ptr(), N as libc::nfds_t, &timeout, ptr::null()) };
        ready > 0 && set.iter().any(|s| s.revents & libc::POLLIN != 0)
    }

    /// Asks the kernel about the interface.
    fn ask(&self, what: libc::c_ulong, name: &'static str) -> Result<libc::ifreq, SocketError> {
        let mut request = self.request;
        // SAFETY: `request` is a valid `ifreq` with the name of the interface; the kernel writes into it only.
        if unsafe { libc::ioctl(self.fd.as_raw_fd(), what as _, &mut request) } == 0 {
            return Ok(request);
        }
        let error = Error::last_os_error();
        Err(match error.raw_os_error() {
            Some(libc::ENODEV) => SocketError::Missing(self.name.clone()),
            _ => SocketError::Other(self.name.clone(), name, error),
        })
    }

    fn has(&self, flags: c_int) -> Result<bool, SocketError> {
        let found = self.ask(libc::SIOCGIFFLAGS, "SIOCGIFFLAGS")?;
        // SAFETY: after SIOCGIFFLAGS this is the field that the kernel has written.
        let found = c_int::from(unsafe { found.ifr_ifru.ifru_flags });
        Ok(found & flags == flags)
    }

    fn hardware_address(&self) -> Result<Mac, SocketError> {
        let found = self.ask(libc::SIOCGIFHWADDR, "SIOCGIFHWADDR")?;
        // SAFETY: after SIOCGIFHWADDR this is the field that the kernel has written.
        let address = unsafe { found.ifr_ifru.ifru_hwaddr };
        if address.sa_family != libc::ARPHRD_ETHER {
            return Err(SocketError::Kind(self.name.clone()));
        }
        Ok(std::array::from_fn(|i| address.sa_data[i] as u8))
    }

    /// Own frames are not received.
    fn ignore_own(&self) -> Result<(), SocketError> {
        let on: c_int = 1;
        // SAFETY: pointer and length are those of an integer that outlives the call.
        let result = unsafe {
            libc::setsockopt(
                self.fd.as_raw_fd(),
                libc::SOL_PACKET,
                libc::PACKET_IGNORE_OUTGOING,
                (&raw const on).cast(),
                size_of::<c_int>() as libc::socklen_t,
            )
        };
        self.check(result, "PACKET_IGNORE_OUTGOING (needs Linux 4.20)")
    }

    fn bind(&self, index: c_int, protocol: c_int) -> Result<(), SocketError> {
        // SAFETY: all zeros are a valid `sockaddr_ll`.
        let mut address: libc::sockaddr_ll = unsafe { zeroed() };
        address.sll_family = libc::AF_PACKET as u16;
        address.sll_protocol = protocol as u16;
        address.sll_ifindex = index;
        // SAFETY: pointer and length are those of the address, which outlives the call.
        let result = unsafe {
            libc::bind(
                self.fd.as_raw_fd(),
                (&raw const address).cast(),
                size_of::<libc::sockaddr_ll>() as libc::socklen_t,
            )
        };
        self.check(result, "bind")
    }

    fn check(&self, result: c_int, call: &'static str) -> Result<(), SocketError> {
        if result == 0 {
            return Ok(());
        }
        Err(SocketError::Other(self.name.clone(), call, Error::last_os_error()))
    }
}

/// A request to the kernel with the name of an interface.
fn name_request(interface: &str) -> Result<libc::ifreq, SocketError> {
    // SAFETY: all zeros are a valid `ifreq`.
    let mut request: libc::ifreq = unsafe { zeroed() };
    if interface.is_empty() || interface.len() >= request.ifr_name.len() || interface.contains('\0') {
        return Err(SocketError::Name(interface.to_owned()));
    }
    for (place, byte) in request.ifr_name.iter_mut().zip(interface.bytes()) {
        *place = byte as libc::c_char;
    }
    Ok(request)
}
