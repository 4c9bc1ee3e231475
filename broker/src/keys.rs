//! Keys of clients on the network: a file with one line each, and the frames that they make authentic (HMAC-SHA-256).
//!
//! | symbol | name |
//! |---|---|
//! | K | key of the file, 32 bytes, known to both sides |
//! | c, s | nonces of client and broker, 16 bytes each, fresh for each connection |
//! | K_b, K_c | keys of one connection, to the broker and to the client: HMAC(K, direction \| c \| s) |
//! | n | number of the frame in its direction, from 0 |
//!
//! A frame carries the first 16 bytes of HMAC(K_b or K_c, n \| message). So a frame that was replayed, left out, put in
//! another order, or belongs to another connection is not authentic, and the connection ends. What is sent is not secret.

use std::fmt;
use std::io::Read;
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::path::Path;

use hmac::{Hmac, Mac};
use messages::command::Domain;
use sha2::Sha256;

use crate::message::domain_mask;

/// Bytes of a tag on the wire.
pub const TAG: usize = 16;
/// Bytes of a nonce.
pub const NONCE: usize = 16;

type Secret = [u8; 32];

/// One line of the file.
#[derive(Clone)]
pub struct Key {
    /// Name of the key.
    pub name: String,
    /// Domains that its owner may command: bit n for domain n.
    pub may: u32,
    secret: Secret,
}

impl fmt::Debug for Key {
    /// Without the secret.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Key({})", self.name)
    }
}

/// Reads a file of keys, `NAME DOMAIN,DOMAIN HEX` per line; `all` for all domains.
///
/// # Errors
/// The file is not there, is not its owner's alone, or a line is none.
pub fn load(path: &Path) -> Result<Vec<Key>, String> {
    let here = path.display();
    let unreadable = |e: std::io::Error| format!("key file {here}: {e}");
    // Rights and contents of one and the same file, whatever happens to its name meanwhile.
    let mut file = std::fs::File::open(path).map_err(unreadable)?;
    let facts = file.metadata().map_err(unreadable)?;
    let (mode, owner) = (facts.permissions().mode() & 0o777, facts.uid());
    if mode & 0o077 != 0 || !facts.is_file() {
        return Err(format!(
            "key file {here}: mode {mode:04o}, must be 0600: `chmod 600 {here}`, and make new keys if others could read it"
        ));
    }
    let user = std::fs::metadata("/proc/self").map_err(unreadable)?.uid();
    if owner != user && owner != 0 {
        return Err(format!("key file {here}: belongs to user {owner}, must be {user}'s or root's"));
    }
    let mut text = String::new();
    file.read_to_string(&mut text).map_err(unreadable)?;
    let lines = text.lines().enumerate().map(|(i, line)| (i + 1, line.trim()));
    lines
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
        .map(|(n, line)| {
            parse(line).ok_or_else(|| {
                format!(
                    "key file {here}, line {n}: must be `NAME DOMAIN,DOMAIN HEX` with 64 hexadecimal digits"
                )
            })
        })
        .collect()
}

fn parse(line: &str) -> Option<Key> {
    let mut words = line.split_whitespace();
    let (name, domains, hex) = (words.next()?, words.next()?, words.next()?);
    let domain = |name: &str| Domain::ALL.into_iter().find(|d| d.name() == name).map(|d| domain_mask(&[d]));
    let may = match domains {
        "all" => domain_mask(&Domain::ALL),
        list => list.split(',').try_fold(0, |mask, name| Some(mask | domain(name)?))?,
    };
    let mut secret = Secret::default();
    if hex.len() != 2 * secret.len() || !hex.is_ascii() || words.next().is_some() {
        return None;
    }
    for (byte, digits) in secret.iter_mut().zip(hex.as_bytes().chunks(2)) {
        *byte = u8::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok()?;
    }
    Some(Key { name: name.into(), may, secret })
}

/// Sixteen bytes that nobody has seen before.
///
/// # Errors
/// The kernel gives none.
pub fn nonce() -> Result<[u8; NONCE], String> {
    let mut bytes = [0; NONCE];
    let read = std::fs::File::open("/dev/urandom").and_then(|mut f| f.read_exact(&mut bytes));
    read.map(|()| bytes).map_err(|e| format!("/dev/urandom: {e}"))
}

/// One direction of one authentic connection.
#[derive(Clone)]
pub struct Half {
    key: Secret,
    frame: u64,
}

/// Both directions of a connection: to the broker, to the client.
pub fn session(key: &Key, client: &[u8; NONCE], broker: &[u8; NONCE]) -> [Half; 2] {
    let derive = |direction: &[u8]| mac(&key.secret, &[direction, client, broker]).finalize().into_bytes();
    [&b"gangwerk to broker"[..], b"gangwerk to client"]
        .map(|direction| Half { key: derive(direction).into(), frame: 0 })
}

impl Half {
    /// Tag of the next frame.
    pub fn seal(&mut self, message: &[u8]) -> [u8; TAG] {
        let whole = mac(&self.key, &[&self.frame.to_le_bytes(), message]).finalize().into_bytes();
        self.frame += 1;
        whole[..TAG].try_into().unwrap_or_default()
    }

    /// Whether `tag` belongs to the next frame; compared in constant time.
    pub fn open(&mut self, message: &[u8], tag: &[u8]) -> bool {
        let whole = mac(&self.key, &[&self.frame.to_le_bytes(), message]);
        self.frame += 1;
        tag.len() == TAG && whole.verify_truncated_left(tag).is_ok()
    }

    /// Proof that the client has the key, before the first tagged frame.
    pub fn proof(&self) -> [u8; 32] {
        mac(&self.key, &[b"proof"]).finalize().into_bytes().into()
    }

    /// Whether that is the proof; compared in constant time.
    pub(crate) fn proves(&self, proof: &[u8]) -> bool {
        mac(&self.key, &[b"proof"]).verify_slice(proof).is_ok()
    }
}

fn mac(key: &Secret, parts: &[&[u8]]) -> Hmac<Sha256> {
    let mut mac = Hmac::<Sha256>::new_from_slice(key).expect("HMAC takes keys of any length");
    parts.iter().for_each(|part| mac.update(part));
    mac
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub(crate) fn key() -> Key {
        parse(&format!("k all {}", "a".repeat(64))).expect("a key")
    }

    fn halves(digit: char) -> [Half; 2] {
        let key = parse(&format!("k all {}", digit.to_string().repeat(64))).expect("a key");
        session(&key, &[1; NONCE], &[2; NONCE])
    }

    #[test]
    fn replayed_reordered_changed_and_foreign_frames_are_not_authentic() {
        let [mut sender, _] = halves('a');
        let tags: Vec<_> = [&b"one"[..], b"two"].iter().map(|m| sender.seal(m)).collect();
        let fresh = || halves('a').into_iter().next().expect("two halves");
        let mut receiver = fresh();
        assert!(receiver.open(b"one", &tags[0]) && receiver.open(b"two", &tags[1]));
        let mut replayed = fresh();
        assert!(replayed.open(b"one", &tags[0]) && !replayed.open(b"one", &tags[0]));
        assert!(!fresh().open(b"two", &tags[1]), "reordered");
        assert!(!fresh().open(b"onE", &tags[0]), "changed");
        assert!(!fresh().open(b"one", &tags[0][..8]), "a shorter tag");
        assert!(!halves('b')[0].open(b"one", &tags[0]), "another key");
        assert!(!halves('a')[1].open(b"one", &tags[0]), "the other direction");
        assert!(!halves('b')[0].proves(&fresh().proof()) && fresh().proves(&fresh().proof()));
    }

    #[test]
    fn lines_that_are_no_key_are_refused() {
        let hex = "0f".repeat(32);
        assert_eq!(
            parse(&format!("console walk,head {hex}")).map(|k| k.may),
            Some(domain_mask(&[Domain::Walk, Domain::Head]))
        );
        for bad in [
            "console".into(),
            format!("console walk {}", &hex[2..]),
            format!("console run {hex}"),
            format!("console walk {hex} more"),
            format!("console walk {}", "zz".repeat(32)),
        ] {
            assert!(parse(&bad).is_none(), "{bad}");
        }
    }
}
