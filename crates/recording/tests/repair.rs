//! A log whose writer died in the middle gets its index, and loses nothing that was whole.

use messages::topics::SENSORS;
use messages::{Header, Sensors};
use recording::{Log, LogEnd, Recorder, RecordingError, RobotInfo, RunInfo, is_being_written, repair};
use std::path::{Path, PathBuf};

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("repair_{name}.mcap"))
}

/// A log of 2000 sensor records; the last of it is cut off.
fn cut(name: &str, bytes: u64) -> (PathBuf, u64) {
    let path = file(name);
    let mut log = Recorder::create(&path, &RobotInfo::default(), &RunInfo::default()).unwrap();
    log.attach("note", b"kept").unwrap();
    for tick in 1..=2000 {
        let header = Header { tick, stamp_ns: tick * 1_000_000, epoch: 1 };
        log.write(&SENSORS, &Sensors { header, ..Sensors::default() }).unwrap();
    }
    log.finish().unwrap();
    let whole = std::fs::metadata(&path).unwrap().len();
    let file = std::fs::File::options().write(true).open(&path).unwrap();
    file.set_len(whole - bytes.min(whole)).unwrap();
    let mut before = 0;
    if let Ok(log) = Log::open(&path) {
        let end = log.each(|_| before += 1);
        assert!(bytes == 0 || !matches!(end, Ok(LogEnd::Complete)));
    }
    (path, before)
}

#[test]
fn a_cut_log_keeps_every_whole_message_and_gets_its_index() {
    for bytes in [1, 100, 5000, 20_000] {
        let (path, before) = cut(&format!("cut_{bytes}"), bytes);
        let done = repair(&path).unwrap();
        assert!(done.found.is_some() && done.messages == before && before > 1000, "{done:?}, {before}");
        let log = Log::open(&path).unwrap();
        let mut after = 0;
        assert_eq!(log.each(|_| after += 1).unwrap(), LogEnd::Complete);
        assert_eq!(after, before);
        let summary = mcap::Summary::read(&std::fs::read(&path).unwrap()).unwrap().unwrap();
        assert_eq!(summary.stats.unwrap().message_count, before);
        let mut note = Vec::new();
        log.each_attachment(|_, bytes| note.extend_from_slice(bytes)).unwrap();
        assert_eq!(note, b"kept");
        assert_eq!(repair(&path).unwrap().found, None, "once is enough");
    }
}

#[test]
fn a_whole_log_is_left_as_it_is_and_another_file_is_refused() {
    let (path, _) = cut("whole", 0);
    let before = std::fs::read(&path).unwrap();
    assert_eq!(repair(&path).unwrap().found, None);
    assert_eq!(std::fs::read(&path).unwrap(), before);
    let other = file("other");
    std::fs::write(&other, b"no log at all, by any means").unwrap();
    assert!(matches!(repair(&other), Err(RecordingError::NotALog(..))));
    assert!(!beside(&other).exists());
}

/// Heads of the records of a file: opcode, place, length \[byte\].
fn records(bytes: &[u8]) -> Vec<(u8, usize, usize)> {
    let (mut all, mut at) = (Vec::new(), mcap::MAGIC.len());
    while at + 9 <= bytes.len() {
        let length = 9 + u64::from_le_bytes(bytes[at + 1..at + 9].try_into().unwrap()) as usize;
        all.push((bytes[at], at, length));
        at += length;
    }
    all
}

/// Regression: one flipped bit cost all that was behind it, and the log as it was.
#[test]
fn a_damaged_log_loses_the_damaged_chunk_only() {
    let (path, before) = cut("damaged", 0);
    let whole = std::fs::read(&path).unwrap();
    let chunks: Vec<_> = records(&whole).into_iter().filter(|(opcode, ..)| *opcode == 6).collect();
    assert!(chunks.len() > 4, "{}", chunks.len());
    // The first one describes the channels; so does the summary.
    for (_, begin, length) in [chunks[0], chunks[2], chunks[chunks.len() - 1]] {
        let mut bytes = whole.clone();
        bytes[begin + length / 2] ^= 4;
        std::fs::write(&path, &bytes).unwrap();
        let original = PathBuf::from(format!("{}.damaged", path.display()));
        let _ = std::fs::remove_file(&original);
        let done = repair(&path).unwrap();
        let found = done.found.unwrap();
        let (place, lost) = (format!("damaged at byte {begin}: "), format!("other records, {length} bytes"));
        assert!(
            found.starts_with(&place) && found.contains("left out: 1 ") && found.ends_with(&lost),
            "{found}"
        );
        assert!(done.original.as_ref() == Some(&original) && std::fs::read(&original).unwrap() == bytes);
        let (log, mut after) = (Log::open(&path).unwrap(), 0);
        assert_eq!(log.each(|_| after += 1).unwrap(), LogEnd::Complete);
        // About as many messages in each chunk; before the attachment there is none.
        let (lost, most) = (before - after, 2 * before / chunks.len() as u64);
        assert!(
            after == done.messages && lost <= most && (lost > 0 || begin == chunks[0].1),
            "{lost} of {before}"
        );
        assert!(!beside(&path).exists() && repair(&path).unwrap().found.is_none());
        // Another damage does not cost the first original.
        std::fs::write(&path, &bytes).unwrap();
        assert!(matches!(repair(&path), Err(RecordingError::OriginalKept(_))));
        assert!(std::fs::read(&path).unwrap() == bytes && !beside(&path).exists());
    }
}

/// A length that cannot be ends what can be read; what is before it is kept. At the end of a file nothing is lost.
#[test]
fn what_is_damaged_beside_the_chunks_costs_no_chunk_before_it() {
    let (path, before) = cut("lengths", 0);
    let whole = std::fs::read(&path).unwrap();
    let original = PathBuf::from(format!("{}.damaged", path.display()));
    let repaired = |at: usize, to: u8| {
        let mut bytes = whole.clone();
        bytes[at] = to;
        std::fs::write(&path, &bytes).unwrap();
        let _ = std::fs::remove_file(&original);
        repair(&path).unwrap()
    };
    let last = records(&whole).into_iter().rfind(|(opcode, ..)| *opcode == 6).unwrap().1;
    let done = repaired(last + 8, 1);
    assert!(done.found.unwrap().contains("left out: 1 chunks or other records"));
    assert!(done.messages < before && done.messages > before / 2, "{} of {before}", done.messages);
    let done = repaired(whole.len() - 1, 0);
    assert_eq!(done.found.unwrap(), "its end is damaged; nothing is left out");
    assert_eq!(done.messages, before);
}

/// Where the new log is made.
fn beside(path: &Path) -> PathBuf {
    PathBuf::from(format!("{}.repair", path.display()))
}

/// Regression: what the writer wrote after a repair went into a file without a name.
#[test]
fn a_log_that_is_being_written_is_neither_repaired_nor_begun_anew() {
    let path = file("written");
    let mut log = Recorder::create(&path, &RobotInfo::default(), &RunInfo::default()).unwrap();
    assert!(is_being_written(&path));
    assert!(matches!(repair(&path), Err(RecordingError::BeingWritten(..))));
    let again = Recorder::create(&path, &RobotInfo::default(), &RunInfo::default()).map(|_| ());
    assert!(matches!(again, Err(RecordingError::BeingWritten(..))));
    for tick in 1..=2000 {
        let header = Header { tick, stamp_ns: tick * 1_000_000, epoch: 1 };
        log.write(&SENSORS, &Sensors { header, ..Sensors::default() }).unwrap();
    }
    log.finish().unwrap();
    assert!(!is_being_written(&path) && !beside(&path).exists());
    let mut messages = 0;
    assert_eq!(Log::open(&path).unwrap().each(|_| messages += 1).unwrap(), LogEnd::Complete);
    assert!(messages >= 2000);
}

/// Regression: a log with the ending of the new file was emptied and removed.
#[test]
fn a_log_may_have_any_name() {
    let (path, before) = cut("named", 100);
    let named = file("named").with_extension("repair");
    std::fs::rename(path, &named).unwrap();
    let done = repair(&named).unwrap();
    assert!(done.found.is_some() && done.messages == before, "{done:?}, {before}");
    assert_eq!(repair(&named).unwrap().found, None);
}
