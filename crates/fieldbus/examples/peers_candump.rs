//! Writes `ours.log`, one frame of every form, and `ours.txt`, what stands in it, into a directory; with a second
//! argument reads that candump log instead and prints what stands in it. Used by `tests/peers/candump.sh`.

use fieldbus::candump;
use fieldbus::capture::{Capture, Captured, ERROR, EXTENDED, FD_LENGTHS, FrameType, REMOTE};
use fieldbus::text_log::{self, Strictness};
use std::error::Error;
use std::fmt::Write;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.as_slice() {
        [directory] => {
            let capture = ours();
            let directory = Path::new(directory);
            candump::write(std::fs::File::create(directory.join("ours.log"))?, &capture)?;
            std::fs::write(directory.join("ours.txt"), listed(&capture))?;
        }
        [_, log] => print!("{}", listed(&text_log::read(Path::new(log), Strictness::Strict)?.0)),
        _ => return Err("usage: peers_candump DIRECTORY [LOG]".into()),
    }
    Ok(())
}

/// Every length of classic, remote and CAN FD frames with short and long identifiers, and error frames.
fn ours() -> Capture {
    let mut capture = Capture::default();
    let mut add = |line: &str, id: u32, len: usize, form: FrameType| {
        let line = capture.line(line);
        let mut data = [0; 64];
        if id & (REMOTE | ERROR) != REMOTE {
            data[..len].iter_mut().enumerate().for_each(|(k, byte)| *byte = (37 * k + id as usize) as u8);
        }
        let time_ns = 1_700_000_000_123_456_000 + 1_000_000 * capture.frames.len() as u64;
        capture.frames.push(Captured { time_ns, line, id, len: len as u8, data, form, way: None });
    };
    // Classic frames, and remote ones, which have a length but no data.
    for len in 0..=8 {
        for id in [0x123, 0x7ff, EXTENDED | 0x123, EXTENDED | 0x1fff_ffff] {
            add("vcan0", id, len, FrameType::CLASSIC);
            add("vcan1", id | REMOTE, len, FrameType::CLASSIC);
        }
    }
    // CAN FD, with and without bit rate switch and error state.
    for len in FD_LENGTHS {
        for flags in [0, 1, 2, 3] {
            add("vcan0", 0x222, len, FrameType::Fd { flags });
            add("vcan1", EXTENDED | 0x222, len, FrameType::Fd { flags });
        }
    }
    add("vcan0", ERROR | 0x40, 8, FrameType::CLASSIC);
    add("vcan1", ERROR | 0x204, 8, FrameType::CLASSIC);
    capture
}

/// Microseconds, interface, identifier, extended, remote, error, FD, bit rate switch, error state, length, data.
fn listed(capture: &Capture) -> String {
    let mut text = String::new();
    for f in &capture.frames {
        let is = |flag: u32| u8::from(f.id & flag != 0);
        // A classic frame has no flags of CAN FD; the peer prints zeros there, too.
        let (fd, flags) = match f.form {
            FrameType::Classic { .. } => (0, 0),
            FrameType::Fd { flags } => (1, flags),
        };
        let data: String = f.payload().iter().map(|byte| format!("{byte:02x}")).collect();
        let _ = writeln!(
            text,
            "{} {} {:x} {} {} {} {fd} {} {} {} {data}",
            f.time_ns / 1000,
            capture.lines[f.line as usize],
            f.id & 0x1fff_ffff,
            is(EXTENDED),
            is(REMOTE),
            is(ERROR),
            flags & 1,
            flags >> 1 & 1,
            f.len,
        );
    }
    text
}
