//! One number per channel: two runs are equal if all of them are.

use crate::error::RecordingError;
use crate::log::Log;
use std::collections::BTreeMap;
use std::path::Path;

/// Hash (FNV-1a, 64 bit) of all payload bytes of each channel, in the order they were written; channels without a
/// message are left out. `keep` chooses channels by name: clocks differ from run to run, so comparisons leave out
/// `/gangwerk/cycle_stats/*`.
pub fn payload_hashes(
    path: &Path,
    keep: impl Fn(&str) -> bool,
) -> Result<BTreeMap<String, u64>, RecordingError> {
    let mut hashes = BTreeMap::new();
    Log::open(path)?.each(|message| {
        if keep(message.channel) {
            // Time and length go in too: messages must not flow into each other.
            let hash = hashes.entry(message.channel.to_string()).or_insert(0xcbf2_9ce4_8422_2325u64);
            let length = message.payload.len() as u64;
            let prefix = message.log_time_ns.to_le_bytes().into_iter().chain(length.to_le_bytes());
            for byte in prefix.chain(message.payload.iter().copied()) {
                *hash = (*hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
            }
        }
    })?;
    Ok(hashes)
}
