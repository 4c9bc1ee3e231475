//! Which bus a run uses, as it is written on the command line.

use crate::interface;
use std::fmt;
use std::str::FromStr;

/// A field bus and where it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Address {
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

impl Address {
    /// Whether frames have 8 bytes at most.
    pub fn is_classic(&self) -> bool {
        matches!(self, Self::Can { fd: false, .. })
    }
}

impl FromStr for Address {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (kind, place) = text.split_once(':').unwrap_or((text, ""));
        match (kind, place) {
            ("shm", "") => Ok(Self::Shared),
            ("can" | "canfd", place) if !place.is_empty() => {
                Ok(Self::Can { fd: kind == "canfd", interfaces: interface::names(place)? })
            }
            ("sercos", place) if !place.is_empty() => Ok(Self::Sercos(place.into())),
            _ => Err(format!(
                "bus `{text}`: must be shm, can:INTERFACES, canfd:INTERFACES or sercos:INTERFACES, where INTERFACES is \
                 one for all lines (can:vcan0) or one for each (can:vcan0-8, can:can0,can1)"
            )),
        }
    }
}

impl fmt::Display for Address {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_read_and_written() {
        for text in ["shm", "can:vcan0", "canfd:can0,can1", "sercos:eth1,eth2"] {
            assert_eq!(text.parse::<Address>().unwrap().to_string(), text);
        }
        assert_eq!("can:v2-4,x".parse::<Address>().unwrap().to_string(), "can:v2,v3,v4,x");
        assert!("can:vcan0-8".parse::<Address>().unwrap().is_classic());
    }

    #[test]
    fn what_is_no_address_is_refused() {
        for text in ["", "can", "can:", "shm:0", "usb:0", "can:v4-2", "can:v0-99", "can:a//b", "can:,"] {
            assert!(text.parse::<Address>().is_err(), "{text}");
        }
    }
}
