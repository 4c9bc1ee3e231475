//! Owner of a socket of this machine, by the kernel's tables of UDP sockets: from its own addresses every user can send.

use std::fs;
use std::io::ErrorKind;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, UdpSocket};

/// Tables of IPv4 and IPv6 sockets.
const TABLES: [&str; 2] = ["/proc/net/udp", "/proc/net/udp6"];
/// Places of a socket's own address and of its user's number in a line.
const ADDRESS: usize = 1;
const USER: usize = 7;

/// True if what came from there is root's or of this process's own user. Of another machine's address nothing is known: true.
///
/// An address is somebody's while his socket is open; of several sockets with one address each has to be trusted.
pub fn is_trusted(from: SocketAddr) -> bool {
    let tables = || TABLES.map(|table| fs::read_to_string(table).unwrap_or_default());
    !is_here(from) || are_of(&tables(), from, rustix::process::geteuid().as_raw())
}

/// True if the sockets of these tables that send from there are root's or this user's, and there are any.
///
/// Who we are is not asked of the tables: anybody's socket for all addresses of the other family may stand there as ours does.
fn are_of(tables: &[impl AsRef<str>], from: SocketAddr, user: u32) -> bool {
    let users: Vec<_> = tables.iter().flat_map(|table| users_of(table.as_ref(), from)).collect();
    !users.is_empty() && users.iter().all(|of| *of == Some(0) || *of == Some(user))
}

/// True of an address of this machine, on whatever interface: a socket can be bound to those, and to no other.
fn is_here(mut at: SocketAddr) -> bool {
    at.set_port(0);
    UdpSocket::bind(at).map_or_else(|e| e.kind() != ErrorKind::AddrNotAvailable, |_| true)
}

/// Users of the sockets of a table that send from `at`; none of a line that is not understood.
fn users_of(table: &str, at: SocketAddr) -> impl Iterator<Item = Option<u32>> {
    table.lines().skip(1).filter_map(move |line| {
        let mut fields = line.split_whitespace();
        let (ip, port) = fields.nth(ADDRESS)?.rsplit_once(':')?;
        let user = fields.nth(USER - ADDRESS - 1);
        let ip = address(ip)?;
        let sends = ip == at.ip().to_canonical() || ip.is_unspecified();
        let of_port = u16::from_str_radix(port, 16) == Ok(at.port());
        (sends && of_port).then(|| user.and_then(|user| user.parse().ok()))
    })
}

/// Address of one or four words in this machine's order of bytes, 8 digits each.
fn address(digits: &str) -> Option<IpAddr> {
    let word =
        |at: usize| u32::from_str_radix(digits.get(8 * at..8 * at + 8)?, 16).ok().map(u32::to_ne_bytes);
    match digits.len() {
        8 => Some(Ipv4Addr::from(word(0)?).into()),
        32 => {
            let mut bytes = [0; 16];
            for (at, four) in bytes.chunks_exact_mut(4).enumerate() {
                four.copy_from_slice(&word(at)?);
            }
            Some(IpAddr::from(Ipv6Addr::from(bytes)).to_canonical())
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(target_endian = "little")]
    #[test]
    fn users_are_read_by_the_address_of_the_socket_itself() {
        let table = "\
  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout inode ref pointer drops
 2150: 0100007F:B861 00000000:0000 07 00000000:00000000 00:00000000 00000000  1000        0 21487 2 0000000000000000 0
 2151: 00000000:B862 0100007F:B861 07 00000000:00000000 00:00000000 00000000     0        0 21488 2 0000000000000000 0
 2152: 0100007F:B862 00000000:0000 07 00000000:00000000 00:00000000 00000000   lots       0 21489 2 0000000000000000 0
 2153: 0200007F:B861 00000000:0000 07 00000000:00000000 00:00000000 00000000  1001        0 21490 2 0000000000000000 0
 2154: 00000000000000000000000001000000:B863 00000000:0000 07 00000000:00000000 00:00000000 00000000  1002 0 21491 2
 2155: 0000000000000000FFFF00000100007F:B863 00000000:0000 07 00000000:00000000 00:00000000 00000000  1003 0 21492 2
";
        let users = |at: &str| users_of(table, at.parse().unwrap()).collect::<Vec<_>>();
        assert_eq!(users("127.0.0.1:47201"), [Some(1000)], "somebody else has its port at another address");
        assert_eq!(users("127.0.0.1:47202"), [Some(0), None]);
        assert_eq!(users("[::1]:47203"), [Some(1002)]);
        assert_eq!(users("127.0.0.1:47203"), [Some(1003)]);
        assert_eq!(users("[::ffff:127.0.0.1]:47203"), [Some(1003)]);
        assert_eq!(users("127.0.0.1:0"), []);
    }

    /// Another user walked her, who had a socket for all IPv6 addresses at the gateway's port: he counted as the gateway's user.
    #[cfg(target_endian = "little")]
    #[test]
    fn a_socket_at_the_gateways_port_makes_nobody_its_user() {
        let head = "sl local_address rem_address st queues tm->when retrnsmt uid timeout inode";
        let line = |address: &str, user: u32| {
            format!("{head}\n 1: {address} 00000000:0000 07 0:0 00:0 0 {user} 0 21487 2 0 0\n")
        };
        let (all, gateway) = ("0".repeat(32), "0100007F:B860");
        let tables = |from: &str, user: u32| {
            [line(gateway, 1000), line(&format!("{all}:B860"), 1001), line(from, user)]
        };
        let sender = "127.0.0.1:47201".parse().unwrap();
        for (user, trusted) in [(1001, false), (1000, true), (0, true)] {
            assert_eq!(are_of(&tables("0100007F:B861", user), sender, 1000), trusted, "{user}");
        }
        // One more of his own at the sender's port: which of them sent, nobody knows.
        let tables = [line("0100007F:B861", 1000), line(&format!("{all}:B861"), 1001)];
        assert!(!are_of(&tables, sender, 1000));
        assert!(!are_of(&[""], sender, 1000), "nobody's");
    }

    /// Address of an interface that leads to other machines, if there is one. Nothing is sent.
    fn outward() -> Option<IpAddr> {
        let socket = UdpSocket::bind("0.0.0.0:0").ok()?;
        socket.connect("198.51.100.1:9").ok()?;
        socket.local_addr().ok().map(|at| at.ip())
    }

    /// `--to` may be any address of this machine: on those besides the loopback interface nobody was asked for his user.
    #[test]
    fn a_socket_is_trusted_while_it_is_open() {
        let loopback = ["127.0.0.1", "::1"].map(|host| host.parse().unwrap());
        for host in loopback.into_iter().chain(outward()) {
            let from = UdpSocket::bind((host, 0)).unwrap();
            let at = from.local_addr().unwrap();
            assert!(is_trusted(at), "{at}");
            drop(from);
            assert!(!is_trusted(at), "nobody's");
            for other in ["203.0.113.1:1", "[2001:db8::1]:1"] {
                assert!(is_trusted(other.parse().unwrap()), "another machine's");
            }
        }
    }
}
