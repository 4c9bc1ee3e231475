//! Frames of CAN lines survive a log.

use recording::traffic::{CanFrame, TrafficWriter, read_traffic};
use recording::{LogEnd, RecordingError};
use std::path::PathBuf;

fn place(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("gangwerk-traffic-{}-{name}.mcap", std::process::id()))
}

/// Time stamp, line, identifier; form, flags, way and length; data.
type Written = (u64, &'static str, u32, [u8; 4], Vec<u8>);

fn frames() -> Vec<Written> {
    let long: Vec<u8> = (0..64).collect();
    vec![
        (1_436_509_052_249_713_001, "vcan0", 0x123, [0, 0, 0, 2], vec![1, 2]),
        (1_436_509_052_249_713_002, "can-left.1", 0x8000_0001, [1, 5, 2, 64], long),
        (1_436_509_052_249_713_002, "vcan0", 0x4000_0007, [0, 0, 1, 8], vec![]),
        (1_436_509_052_249_714_000, "vcan0", 0x2000_0004, [0, 0, 0, 8], vec![0; 8]),
    ]
}

fn write(path: &std::path::Path) {
    let mut writer = TrafficWriter::create(path).unwrap();
    for (stamp_ns, line, id, [form, flags, way, len], data) in &frames() {
        let (form, flags, way, len) = (*form, *flags, *way, *len);
        writer.write(&CanFrame { stamp_ns: *stamp_ns, line, id: *id, form, flags, way, len, data }).unwrap();
    }
    writer.finish().unwrap();
}

#[test]
fn frames_of_several_lines_are_read_back_as_written() {
    let path = place("whole");
    write(&path);
    let mut read = Vec::new();
    let end = read_traffic(&path, |f| {
        read.push((f.stamp_ns, f.line.to_owned(), f.id, [f.form, f.flags, f.way, f.len], f.data.to_vec()));
    });
    assert_eq!(end.unwrap(), LogEnd::Complete);
    let written: Vec<_> = frames()
        .into_iter()
        .map(|(t, line, id, bytes, data)| (t, line.to_owned(), id, bytes, data))
        .collect();
    assert_eq!(read, written);
    std::fs::remove_file(path).unwrap();
}

#[test]
fn a_file_without_frames_and_a_cut_one_are_told() {
    let path = place("cut");
    TrafficWriter::create(&path).unwrap().finish().unwrap();
    assert!(matches!(read_traffic(&path, |_| {}), Err(RecordingError::NoTraffic(_))));
    write(&path);
    let bytes = std::fs::read(&path).unwrap();
    std::fs::write(&path, &bytes[..bytes.len() - 8]).unwrap();
    let mut count = 0;
    assert_eq!(read_traffic(&path, |_| count += 1).unwrap(), LogEnd::Truncated(4));
    assert_eq!(count, 4, "what was whole is there");
    std::fs::write(&path, b"(1.0) vcan0 123#00").unwrap();
    assert!(matches!(read_traffic(&path, |_| {}), Err(RecordingError::NotALog(..))));
    std::fs::remove_file(path).unwrap();
}
