//! CAN interfaces of this machine by name, and what to do when one cannot be used.

use rustix::io::Errno;
use socketcan::{CanFdSocket, Socket};
use std::fmt;
use std::io;
use std::path::Path;

/// Type of a CAN interface in /sys/class/net/NAME/type (ARPHRD_CAN).
const TYPE_CAN: &str = "280";
/// Bit of /sys/class/net/NAME/flags: the interface is up.
const UP: u32 = 1;

/// Problem of an interface, and what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InterfaceError {
    /// Its name.
    pub interface: String,
    /// Reason and advice.
    pub why: String,
}

impl InterfaceError {
    pub(crate) fn new(interface: &str, why: impl Into<String>) -> Self {
        Self { interface: interface.into(), why: why.into() }
    }

    /// Meaning of an error of the operating system for `interface`.
    pub fn of(interface: &str, error: &io::Error) -> Self {
        let why = match Errno::from_io_error(error) {
            Some(Errno::AFNOSUPPORT) => {
                "this kernel has no CAN (AF_CAN): load it with `modprobe can_raw` and, for \
                                   virtual lines, `modprobe vcan`"
                    .into()
            }
            Some(Errno::NODEV) => format!(
                "there is no such interface; a virtual one is made with `ip link add dev {interface} type vcan`"
            ),
            Some(Errno::NETDOWN) => format!(
                "the interface is down; `ip link set {interface} up` (a real one first needs its bit rate: \
                 `ip link set {interface} type can bitrate 1000000`)"
            ),
            Some(Errno::PERM | Errno::ACCESS) => {
                "not permitted; SocketCAN asks for no right of its own: rules of a container or service forbid it \
                 (seccomp, SELinux, AppArmor)"
                    .into()
            }
            Some(Errno::INVAL) => format!(
                "it does not take this frame; CAN FD needs `ip link set {interface} mtu 72` while it is down"
            ),
            _ => error.to_string(),
        };
        Self::new(interface, why)
    }
}

impl fmt::Display for InterfaceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.interface, self.why)
    }
}

impl std::error::Error for InterfaceError {}

/// Opens a socket on an interface that exists, is a CAN interface and is up.
///
/// # Errors
/// One of these does not hold, or the kernel has no CAN.
pub(crate) fn open(name: &str) -> Result<CanFdSocket, InterfaceError> {
    // First on all interfaces: tells a kernel without CAN from a name that is wrong.
    CanFdSocket::open_iface(0).map_err(|e| InterfaceError::of(name, &e))?;
    let about = |what: &str| {
        std::fs::read_to_string(Path::new("/sys/class/net").join(name).join(what)).unwrap_or_default()
    };
    let kind = about("type");
    if !kind.is_empty() && kind.trim() != TYPE_CAN {
        let why = "is not a CAN interface; `ip -brief link show type can` and `... type vcan` list them";
        return Err(InterfaceError::new(name, why));
    }
    let flags = about("flags");
    let flags = u32::from_str_radix(flags.trim().trim_start_matches("0x"), 16);
    if flags.is_ok_and(|flags| flags & UP == 0) {
        return Err(InterfaceError::of(name, &Errno::NETDOWN.into()));
    }
    CanFdSocket::open(name).map_err(|e| InterfaceError::of(name, &e))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_error_of_the_system_says_what_to_do() {
        for (number, advice) in [(97, "modprobe"), (19, "ip link add"), (100, "ip link set"), (1, "seccomp")]
        {
            let said = InterfaceError::of("vcan0", &io::Error::from_raw_os_error(number)).to_string();
            assert!(said.starts_with("vcan0: ") && said.contains(advice), "{said}");
        }
    }
}
