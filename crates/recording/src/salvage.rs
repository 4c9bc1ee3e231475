//! A damaged log, record by record: what is damaged is left out, and what follows is read on, as long as lengths allow.

use std::fmt;
use std::fs::File;
use std::ops::ControlFlow;
use std::os::unix::fs::FileExt;
use std::path::Path;

use mcap::records::op;

use crate::chunk::{self, HEAD};
use crate::error::RecordingError;
use crate::lengths;
use crate::log::{Described, LONGEST_RECORD, LogContent};

/// Records of a damaged log that were left out: chunks, messages of channels that nothing describes, and the rest of a
/// file in which a length is wrong.
#[derive(Debug, Default)]
pub(crate) struct LeftOut {
    records: u64,
    bytes: u64,
    /// Where the first one begins \[byte\], and what is wrong with it.
    first: Option<(u64, String)>,
}

impl LeftOut {
    fn add(&mut self, begin: u64, bytes: u64, why: impl Into<String>) {
        self.records += 1;
        self.bytes += bytes;
        self.first.get_or_insert_with(|| (begin, why.into()));
    }
}

impl fmt::Display for LeftOut {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { records, bytes, first } = self;
        match first {
            None => write!(f, "its end is damaged; nothing is left out"),
            Some((begin, why)) => write!(
                f,
                "damaged at byte {begin}: {why}; left out: {records} chunks or other records, {bytes} bytes"
            ),
        }
    }
}

/// A record of the file: where it begins and how long it is \[byte\], with its head.
#[derive(Clone, Copy)]
struct Place {
    opcode: u8,
    begin: u64,
    length: u64,
}

impl Place {
    fn read(self, file: &File) -> std::io::Result<Vec<u8>> {
        let mut bytes = vec![0; self.length as usize];
        file.read_exact_at(&mut bytes, self.begin).map(|()| bytes)
    }
}

/// Shows all of a log that is whole: chunks are those whose check sum is right.
///
/// # Errors
/// The file cannot be read.
pub(crate) fn salvage(
    path: &Path,
    see: &mut dyn FnMut(LogContent<'_>) -> ControlFlow<()>,
) -> Result<LeftOut, RecordingError> {
    let read = |e| RecordingError::Read(path.into(), e);
    let file = File::open(path).map_err(read)?;
    let (mut described, mut left_out) = (Described::default(), LeftOut::default());
    let places = places(&file, &mut left_out).map_err(read)?;

    // The summary at the end repeats all channels: the chunk that introduced some may be the damaged one.
    for place in places.iter().filter(|place| matches!(place.opcode, op::SCHEMA | op::CHANNEL)) {
        let bytes = place.read(&file).map_err(read)?;
        match described.show((place.opcode, &bytes[HEAD..]), see) {
            Ok(ControlFlow::Continue(())) => {}
            Ok(ControlFlow::Break(())) => return Ok(left_out),
            Err(why) => left_out.add(place.begin, place.length, why),
        }
    }

    for place in places.iter().filter(|place| !matches!(place.opcode, op::SCHEMA | op::CHANNEL)) {
        let bytes = place.read(&file).map_err(read)?;
        let mut stopped = false;
        let mut show = |opcode: u8, data: &[u8]| {
            match described.show((opcode, data), see) {
                Ok(flow) => stopped |= flow.is_break(),
                Err(why) => left_out.add(place.begin, (HEAD + data.len()) as u64, why),
            }
            if stopped { Err(String::new()) } else { Ok(()) }
        };
        let shown = if place.opcode == op::CHUNK {
            // Once to its check sum before anything of it is shown.
            let whole = chunk::each_record(&bytes, |_, _| Ok(()));
            whole.and_then(|()| chunk::each_record(&bytes, &mut show))
        } else {
            show(place.opcode, &bytes[HEAD..])
        };
        match shown {
            Ok(()) => {}
            Err(_) if stopped => return Ok(left_out),
            Err(why) => left_out.add(place.begin, place.length, why),
        }
    }
    Ok(left_out)
}

/// Chunks and other records of the file that a log is read for, up to its end, or to a length that cannot be.
fn places(file: &File, left_out: &mut LeftOut) -> std::io::Result<Vec<Place>> {
    let (mut places, mut begin) = (Vec::new(), mcap::MAGIC.len() as u64);
    let end = file.metadata()?.len();
    let mut head = [0; HEAD];
    // What is shorter than a head is the magic number at the end.
    while begin + HEAD as u64 <= end {
        file.read_exact_at(&mut head, begin)?;
        let [opcode, size @ ..] = head;
        let size = u64::from_le_bytes(size);
        let length = size.saturating_add(HEAD as u64);
        if size > LONGEST_RECORD as u64 || length > end - begin {
            left_out.add(begin, end - begin, format!("a record claims to be {size} bytes long"));
            break;
        }
        if opcode == op::CHUNK || lengths::is_read(opcode) {
            places.push(Place { opcode, begin, length });
        } else if !(op::HEADER..=op::DATA_END).contains(&opcode) {
            left_out.add(begin, length, format!("there is no record of type {opcode}"));
        }
        begin += length;
    }
    Ok(places)
}
