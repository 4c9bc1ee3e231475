//! Encoding of commands: bincode 2, legacy configuration (fixed width, little endian), with a size limit.
//!
//! The bytes equal those of bincode 1 and of wincode; `tests/wire.rs` holds golden vectors against both.

use crate::command::Command;

/// Longest encoded command \[B\].
pub const MAX_BYTES: usize = 256;

type Config = bincode::config::Configuration<
    bincode::config::LittleEndian,
    bincode::config::Fixint,
    bincode::config::Limit<MAX_BYTES>,
>;

fn config() -> Config {
    bincode::config::legacy().with_limit::<MAX_BYTES>()
}

/// Error of decoding a command.
#[derive(Debug)]
pub struct WireError(String);

impl std::fmt::Display for WireError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "not a command: {}", self.0)
    }
}
impl std::error::Error for WireError {}

/// Encodes into `buffer` without an allocation; returns the bytes used.
pub fn encode<'a>(command: &Command, buffer: &'a mut [u8]) -> Result<&'a [u8], WireError> {
    let n =
        bincode::serde::encode_into_slice(command, buffer, config()).map_err(|e| WireError(e.to_string()))?;
    Ok(&buffer[..n])
}

/// Decodes exactly one command; bytes left over are an error.
pub fn decode(bytes: &[u8]) -> Result<Command, WireError> {
    let (command, used) = bincode::serde::decode_from_slice::<Command, _>(bytes, config())
        .map_err(|e| WireError(e.to_string()))?;
    if used != bytes.len() {
        return Err(WireError(format!("{} bytes too many", bytes.len() - used)));
    }
    Ok(command)
}
