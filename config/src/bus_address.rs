//! Bus of a run, as written on the command line.

use std::fmt;
use std::str::FromStr;

/// Most interfaces of one bus.
const MOST: usize = 64;

/// A field bus and where it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BusAddress {
    /// Shared memory: both ends on this machine, no interface.
    Shared,
    /// SocketCAN.
    Can {
        /// CAN FD instead of classic frames.
        fd: bool,
        /// One interface for all lines, or one for each.
        interfaces: Vec<String>,
    },
    /// Sercos III on these Ethernet interfaces, as `crates/sercos` reads them.
    Sercos(String),
}

impl BusAddress {
    /// True if frames have 8 bytes at most.
    pub fn is_classic(&self) -> bool {
        matches!(self, Self::Can { fd: false, .. })
    }
}

impl FromStr for BusAddress {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (kind, place) = text.split_once(':').unwrap_or((text, ""));
        match (kind, place) {
            ("shm", "") => Ok(Self::Shared),
            ("can" | "canfd", place) if !place.is_empty() => {
                Ok(Self::Can { fd: kind == "canfd", interfaces: interface_names(place)? })
            }
            ("sercos", place) if !place.is_empty() => Ok(Self::Sercos(place.into())),
            _ => Err(format!(
                "bus `{text}`: must be shm, can:INTERFACES, canfd:INTERFACES or sercos:INTERFACES, where INTERFACES is \
                 one for all lines (can:vcan0) or one for each (can:vcan0-8, can:can0,can1)"
            )),
        }
    }
}

impl fmt::Display for BusAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shared => f.write_str("shm"),
            Self::Can { fd, interfaces } => {
                write!(f, "{}:{}", if *fd { "canfd" } else { "can" }, interfaces.join(","))
            }
            Self::Sercos(place) => write!(f, "sercos:{place}"),
        }
    }
}

/// The interfaces of a list: `vcan0`, `vcan0-8`, `can0,can1,vcan0-3`.
///
/// # Errors
/// A name is empty, too long or named twice, or a range runs backwards.
pub fn interface_names(list: &str) -> Result<Vec<String>, String> {
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
    fn addresses_are_read_and_written() {
        for text in ["shm", "can:vcan0", "canfd:can0,can1", "sercos:eth1,eth2"] {
            assert_eq!(text.parse::<BusAddress>().unwrap().to_string(), text);
        }
        assert_eq!("can:v2-4,x".parse::<BusAddress>().unwrap().to_string(), "can:v2,v3,v4,x");
        assert!("can:vcan0-8".parse::<BusAddress>().unwrap().is_classic());
    }

    #[test]
    fn lists_and_ranges_of_names() {
        assert_eq!(interface_names("vcan0").unwrap(), ["vcan0"]);
        assert_eq!(interface_names("can0,vcan2-4").unwrap(), ["can0", "vcan2", "vcan3", "vcan4"]);
        assert_eq!(interface_names("can-left").unwrap(), ["can-left"]);
        for (list, why) in [
            ("", "not the name"),
            ("can0,,can1", "not the name"),
            ("vcan8-0", "from 8 to 0"),
            ("vcan0-99999", "not 1 to 64"),
            ("can0,can0", "twice"),
            ("averyveryverylongname", "1 to 15"),
            ("a/b", "not the name"),
        ] {
            let said = interface_names(list).unwrap_err();
            assert!(said.contains(why), "{list}: {said}");
        }
    }

    #[test]
    fn what_is_no_address_is_refused() {
        for text in ["", "can", "can:", "shm:0", "usb:0", "can:v4-2", "can:v0-99", "can:a//b", "can:,"] {
            assert!(text.parse::<BusAddress>().is_err(), "{text}");
        }
    }
}
