//! Strings inside of a record, before the mcap crate asks for as much memory as they claim to need.

use mcap::records::op;

/// Fault of a record whose strings do not [fit].
pub(crate) const LONG_STRING: &str = "a string is longer than the record that it is in";

/// Whether this is a record that a log is read for.
pub(crate) fn is_read(opcode: u8) -> bool {
    matches!(opcode, op::SCHEMA | op::CHANNEL | op::MESSAGE | op::ATTACHMENT | op::METADATA)
}

/// Whether every string of a record that is read ends within it.
pub(crate) fn fit(opcode: u8, body: &[u8]) -> bool {
    // Bytes before the strings, strings, and whether a map of strings follows.
    let (front, strings, map) = match opcode {
        op::SCHEMA => (2, 2, false),
        op::CHANNEL => (4, 2, true),
        op::CHUNK => (28, 1, false),
        op::ATTACHMENT => (16, 2, false),
        op::METADATA => (0, 1, true),
        _ => return true,
    };
    let ends = || {
        let mut rest = body.get(front..)?;
        for _ in 0..strings {
            (_, rest) = prefixed(rest)?;
        }
        if map {
            (rest, _) = prefixed(rest)?;
            while !rest.is_empty() {
                (_, rest) = prefixed(rest)?;
            }
        }
        Some(())
    };
    ends().is_some()
}

/// As many bytes as the u32 in front says, and what follows.
fn prefixed(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let (length, rest) = bytes.split_first_chunk()?;
    rest.split_at_checked(u32::from_le_bytes(*length) as usize)
}
