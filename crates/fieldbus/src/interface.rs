//! CAN interfaces of this machine by name, and what to do when one cannot be used.

use socketcan::{CanFdSocket, Socket};
use std::fmt;
use std::io;
use std::path::Path;

/// Type of a CAN interface in /sys/class/net/NAME/type (ARPHRD_CAN).
const TYPE_CAN: &str = "280";
/// Bit of /sys/class/net/NAME/flags: the interface is up.
const UP: u32 = 1;
/// Most interfaces of one bus.
const MOST: usize = 64;

/// Errors of the operating system, by number.
const EPERM: i32 = 1;
const EACCES: i32 = 13;
const ENODEV: i32 = 19;
const EINVAL: i32 = 22;
const EAFNOSUPPORT: i32 = 97;
const ENETDOWN: i32 = 100;
/// The interface's queue is full: wait and send again.
pub(crate) const ENOBUFS: i32 = 105;

/// What is wrong with an interface, and what to do.
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

    /// What an error of the operating system means for `interface`.
    pub fn of(interface: &str, error: &io::Error) -> Self {
        let why = match error.raw_os_error() {
            Some(EAFNOSUPPORT) => {
                "this kernel has no CAN (AF_CAN): load it with `modprobe can_raw` and, for \
                                   virtual lines, `modprobe vcan`"
                    .into()
            }
            Some(ENODEV) => format!(
                "there is no such interface; a virtual one is made with `ip link add dev {interface} type vcan`"
            ),
            Some(ENETDOWN) => format!(
                "the interface is down; `ip link set {interface} up` (a real one first needs its bit rate: \
                 `ip link set {interface} type can bitrate 1000000`)"
            ),
            Some(EPERM | EACCES) => {
                "not permitted; SocketCAN asks for no right of its own: rules of a container or service forbid it \
                 (seccomp, SELinux, AppArmor)"
                    .into()
            }
            Some(EINVAL) => format!(
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
        return Err(InterfaceError::of(name, &io::Error::from_raw_os_error(ENETDOWN)));
    }
    CanFdSocket::open(name).map_err(|e| InterfaceError::of(name, &e))
}

/// The interfaces of a list: `vcan0`, `vcan0-8`, `can0,can1,vcan0-3`.
///
/// # Errors
/// A name is empty, too long or named twice, or a range runs backwards.
pub fn names(list: &str) -> Result<Vec<String>, String> {
    let mut names: Vec<String> = Vec::new();
    for part in list.split(',') {
        for name in range(part)? {
            if name.is_empty() || name.len() > 15 || name.contains(['/', ' ', ':']) {
                return Err(format!("`{list}`: `{name}` is not the name of an interface (1 to 15 letters)"));
            }
            if names.contains(&name) {
                return Err(format!("`{list}` names {name} twice"));
            }
            names.push(name);
        }
    }
    let fits = names.len() <= MOST;
    fits.then_some(names).ok_or_else(|| format!("`{list}` are more than {MOST} interfaces"))
}

/// `vcan0-8` as nine names; anything else as it is: a hyphen may be part of a name.
fn range(part: &str) -> Result<Vec<String>, String> {
    let whole = || Ok(vec![part.to_owned()]);
    let Some((first, last)) = part.rsplit_once('-') else { return whole() };
    let stem = first.trim_end_matches(|c: char| c.is_ascii_digit());
    let (Ok(from), Ok(to)) = (first[stem.len()..].parse::<usize>(), last.parse::<usize>()) else {
        return whole();
    };
    if to < from || to - from >= MOST {
        return Err(format!("`{part}`: from {from} to {to} are not 1 to {MOST} interfaces"));
    }
    Ok((from..=to).map(|n| format!("{stem}{n}")).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_and_ranges_of_names() {
        assert_eq!(names("vcan0").unwrap(), ["vcan0"]);
        assert_eq!(names("can0,vcan2-4").unwrap(), ["can0", "vcan2", "vcan3", "vcan4"]);
        assert_eq!(names("can-left").unwrap(), ["can-left"]);
        for (list, why) in [
            ("", "not the name"),
            ("can0,,can1", "not the name"),
            ("vcan8-0", "from 8 to 0"),
            ("vcan0-99999", "not 1 to 64"),
            ("can0,can0", "twice"),
            ("averyveryverylongname", "1 to 15"),
            ("a/b", "not the name"),
        ] {
            let said = names(list).unwrap_err();
            assert!(said.contains(why), "{list}: {said}");
        }
    }

    #[test]
    fn every_error_of_the_system_says_what_to_do() {
        for (number, advice) in [(97, "modprobe"), (19, "ip link add"), (100, "ip link set"), (1, "seccomp")]
        {
            let said = InterfaceError::of("vcan0", &io::Error::from_raw_os_error(number)).to_string();
            assert!(said.starts_with("vcan0: ") && said.contains(advice), "{said}");
        }
    }
}
