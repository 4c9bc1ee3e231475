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
