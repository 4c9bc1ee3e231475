//! Memory that a short file can ask for: a process of its own, so that nothing else counts.

use recording::Log;
use std::path::Path;

/// Most memory so far \[kB\].
fn peak() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|line| line.starts_with("VmHWM:")).unwrap();
    line.split_whitespace().nth(1).unwrap().parse().unwrap()
}

/// Found by fuzzing: 64 MB were filled with zeros for a record that claimed to be so long, each time the log was read.
#[test]
fn a_record_that_claims_to_be_long_costs_what_is_there() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("recording_long.mcap");
    let length = 60u64 << 20;
    let bytes = [b"\x89MCAP0\r\n\x03".to_vec(), length.to_le_bytes().to_vec(), vec![0; 100]].concat();
    std::fs::write(&path, bytes).unwrap();
    let before = peak();
    let error = Log::open(&path).unwrap_err();
    let grown = peak() - before;
    assert!(grown < 8 << 10, "{grown} kB for 117 bytes: {error}");
}
