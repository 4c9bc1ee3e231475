//! A chunk of a log by itself.

use mcap::records::op;
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};

use crate::lengths;
use crate::log::LONGEST_RECORD;

/// \[B\] Opcode and length in front of each record.
pub(crate) const HEAD: usize = 9;

/// Shows every record inside of a chunk, which is whole, with its head. That it is damaged may be found after some were shown.
///
/// # Errors
/// Refusal by `see`, or damage of the chunk.
pub(crate) fn each_record(
    chunk: &[u8],
    mut see: impl FnMut(u8, &[u8]) -> Result<(), String>,
) -> Result<(), String> {
    if !lengths::fit(op::CHUNK, chunk.get(HEAD..).unwrap_or_default()) {
        return Err(lengths::LONG_STRING.into());
    }
    let options = LinearReaderOptions::default()
        .with_skip_start_magic(true)
        .with_skip_end_magic(true)
        .with_validate_chunk_crcs(true)
        .with_record_length_limit(LONGEST_RECORD);
    let (mut reader, mut rest) = (LinearReader::new_with_options(options), chunk);
    while let Some(event) = reader.next_event() {
        match event.map_err(|e| e.to_string())? {
            // All at once: a reader may ask for nothing and go on with what it has.
            LinearReadEvent::ReadRequest(_) => {
                reader.insert(rest.len()).copy_from_slice(rest);
                reader.notify_read(rest.len());
                rest = &[];
            }
            LinearReadEvent::Record { opcode, data } => see(opcode, data)?,
        }
    }
    Ok(())
}
