//! Files of can-utils: what is written is read back the same, and what is broken is named.

use fieldbus::candump;
use fieldbus::capture::{ERROR, EXTENDED, FD_LENGTHS, REMOTE};
use fieldbus::statistics::{BitRates, Statistics};
use fieldbus::text_log::{self, Strictness, TextLogError};
use fieldbus::{Capture, CaptureDirection, Captured, FrameType, candump_line};
use proptest::prelude::*;
use std::path::PathBuf;

/// Lines as programs of can-utils wrote them (candump 2020.11 and 2023.03, canplayer's documentation).
const THEIRS: &str = "\
(1436509052.249713) vcan0 044#2A366C2BBA
(1436509052.449847) vcan0 0F6#7ADFE07BD2
(1436509052.650004) vcan0 00000123#
(1436509052.850001) vcan0 123#R
(1436509052.850002) vcan0 123#R8
(1436509053.000000) vcan0 7FF#1122334455667788_E
(1436509053.100000) vcan0 213##311
(1436509053.200000) vcan0 1FFFFFFF##5000102030405060708090A0B
(1436509053.300000) vcan0 20000004#000C000000000000
(1436509053.400000) vcan0 100#DEADBEEF R
(1436509053.500000) vcan0 101#DEADBEEF T
";

fn written(capture: &Capture) -> String {
    let mut text = Vec::new();
    candump::write(&mut text, capture).unwrap();
    String::from_utf8(text).unwrap()
}

fn read_back(text: &str) -> Capture {
    let (capture, broken) = candump::parse(text.as_bytes()).unwrap();
    assert_eq!(broken.count, 0, "{broken}");
    capture
}

#[test]
fn lines_of_can_utils_come_back_byte_for_byte() {
    let capture = read_back(THEIRS);
    assert_eq!(capture.frames.len(), 11);
    assert_eq!(written(&capture), THEIRS);
    let ids: Vec<u32> = capture.frames.iter().map(|f| f.id).collect();
    assert_eq!(ids[2], 0x123 | EXTENDED);
    assert_eq!((ids[4], capture.frames[4].len), (0x123 | REMOTE, 8));
    assert_eq!(ids[7], 0x1fff_ffff | EXTENDED);
    assert_eq!(ids[8], 4 | ERROR);
    assert_eq!(capture.frames[5].form, FrameType::Classic { code: 14 });
    assert_eq!(capture.frames[6].form, FrameType::Fd { flags: 3 });
    assert_eq!(capture.frames[7].payload(), (0..12).collect::<Vec<u8>>());
    assert_eq!(capture.frames[9].way, Some(CaptureDirection::Received));
    assert_eq!(capture.frames[0].time_ns, 1_436_509_052_249_713_000);
}

/// candump fills names up to the longest one, and reads its interfaces one after the other.
#[test]
fn several_interfaces_are_sorted_by_time_and_their_names_filled_up() {
    let theirs = "(0000000001.000002)   vcan0 001#\n(0000000001.000001) slcan12 002#\n(0000000001.000003)   vcan0 003#\n";
    let mut capture = read_back(theirs);
    assert_eq!(capture.lines, ["vcan0", "slcan12"]);
    assert_eq!(written(&capture), theirs);
    capture.sort();
    assert_eq!(capture.frames.iter().map(|f| f.id).collect::<Vec<_>>(), [2, 1, 3]);
}

#[test]
fn nanoseconds_are_read_and_blank_lines_and_line_ends_of_windows_do_no_harm() {
    let capture = read_back("\n(1.000000007) can0 7ff#aB\r\n\n");
    assert_eq!(capture.frames[0].time_ns, 1_000_000_007);
    assert_eq!(written(&capture), "(0000000001.000000) can0 7FF#AB\n");
}

/// One line of each kind of damage, and what has to be said about it.
const BROKEN: [(&str, &str); 26] = [
    ("garbage", "is not a time"),
    ("(12.34) can0 123#00", "six digits"),
    ("(x.000000) can0 123#00", "is not a time"),
    ("(+1.000000) can0 123#00", "is not a time"),
    ("(99999999999999999999.000000) can0 123#00", "is not a time"),
    ("(18446744073709551615.000000) can0 123#00", "later than any clock"),
    ("(1.000000)", "interface and frame are missing"),
    ("(1.000000) can0", "the frame is missing"),
    ("(1.000000) averyveryverylongname 123#00", "not the name of an interface"),
    ("(1.000000) can0 12300", "it has no #"),
    ("(1.000000) can0 #00", "not an identifier"),
    ("(1.000000) can0 +12#00", "not an identifier"),
    ("(1.000000) can0 12#00", "2 hex digits"),
    ("(1.000000) can0 800#00", "more than 11 bits"),
    ("(1.000000) can0 40000000#00", "more than 29 bits"),
    ("(1.000000) can0 123#0", "middle of a byte"),
    ("(1.000000) can0 123#0G", "`G` in the data"),
    ("(1.000000) can0 123#112233445566778899", "at most 8"),
    ("(1.000000) can0 123#R9", "0 to 8 bytes"),
    ("(1.000000) can0 123#1122_9", "only behind 8 bytes"),
    ("(1.000000) can0 123##", "flags is missing"),
    ("(1.000000) can0 123##0112233445566778899", "no CAN FD frame has 9 bytes"),
    ("(1.000000) can0 20000004##0", "cannot be a CAN FD frame"),
    ("(1.000000) can0 20000004#00", "an error frame has 8 bytes"),
    ("(1.000000) can0 123#00 X", "only R (received) or T (sent)"),
    ("(1.000000) can0 123#00 R more", "behind the end"),
];

#[test]
fn every_broken_line_is_named_with_what_is_wrong() {
    for (line, why) in BROKEN {
        let said = candump_line::parse(line).unwrap_err();
        assert!(said.contains(why), "{line}: {said}");
    }
}

fn file(text: &[u8]) -> PathBuf {
    let name = format!("gangwerk-candump-{}-{:p}", std::process::id(), text);
    let path = std::env::temp_dir().join(name);
    std::fs::write(&path, text).unwrap();
    path
}

#[test]
fn a_file_with_broken_lines_is_refused_and_all_of_them_counted() {
    let mut text = String::from("(0000000001.000000) can0 123#00\n");
    BROKEN.iter().for_each(|(line, _)| text += &format!("{line}\n"));
    text += "(0000000000.500000) can0 123#00\n(0000000000.500000) can1 123#00\n";
    let mut bytes = text.into_bytes();
    bytes.extend(b"(2.000000) can0 123#\xff\xfe\n");
    bytes.extend([b'x'; 100_000]);
    bytes.extend(b"\n(0000000003.000000) can0 123#00"); // no line end: whole all the same
    let path = file(&bytes);
    let refused = text_log::read(&path, Strictness::Strict).unwrap_err();
    let said = refused.to_string();
    let TextLogError::Broken(broken) = refused else { panic!("{said}") };
    let lines = BROKEN.len() + 5;
    // All of BROKEN, what is not text, what never ends; not the time that goes back on can0.
    assert_eq!((broken.count, broken.of, broken.first.len()), (BROKEN.len() + 2, lines + 1, 10));
    assert!(said.contains("line 2: `garbage` is not a time"), "{said}");
    assert!(said.contains(&format!("and {} more", broken.count - 10)), "{said}");
    let (capture, left_out) = text_log::read(&path, Strictness::Lenient).unwrap();
    assert_eq!((capture.frames.len(), left_out.count), (4, broken.count));
    assert_eq!(capture.frames[2].line, 1, "the clock was put back, on can1, too");
    std::fs::remove_file(path).unwrap();
}

/// Every frame behind a step was thrown away until the clock had caught up: 5538 of 222,867.
#[test]
fn a_clock_that_was_put_back_costs_no_frame_and_is_told() {
    // Frame k at k ms; after frames 40 and 60 the clock is put back by half a second.
    let time = |k: u64| 10_000 + k - [40, 60].iter().filter(|step| k >= **step).count() as u64 * 500;
    let line = |k: u64| format!("({:010}.{:03}000) can{} {k:03}#\n", time(k) / 1000, time(k) % 1000, k % 2);
    let path = file((0..100).map(line).collect::<String>().as_bytes());
    let (capture, broken) = text_log::read(&path, Strictness::Strict).unwrap();
    std::fs::remove_file(path).unwrap();
    assert_eq!((capture.frames.len(), broken.count), (100, 0));
    let order: Vec<u32> = capture.frames.iter().map(|f| f.id).collect();
    let written: Vec<u32> = (0..100).map(|k| k / 10 * 16 + k % 10).collect();
    assert_eq!(order, written, "the order is that of the file");
    assert_eq!(
        capture.steps.iter().map(|s| (s.at, s.back_ns)).collect::<Vec<_>>(),
        [(40, 499_000_000), (60, 499_000_000)]
    );
    assert_eq!(capture.elapsed().last(), Some(97_000_000), "of two times nothing is known");
    let mut statistics = Statistics::new(BitRates { nominal: 1e6, data: 5e6 });
    for (i, frame) in capture.frames.iter().enumerate() {
        if capture.steps.iter().any(|step| step.at == i) {
            statistics.clock_was_put_back();
        }
        statistics.add(&Captured { id: 7, ..*frame }, None);
    }
    let rows: Vec<_> = statistics.rows().map(|(_, _, row)| (row.count, row.periods, row.longest)).collect();
    // Each interface: 50 frames, 2 ms from one to the next but where the clock was put back.
    assert!(rows.iter().all(|r| (r.0, r.1) == (50, 47) && (r.2 - 2e-3).abs() < 1e-12), "{rows:?}");
    assert!((statistics.seconds() - 0.097).abs() < 1e-12);
}

/// Each line is a step: none is lost, and it takes no longer.
#[test]
fn a_clock_that_drifts_back_costs_no_frame() {
    let lines =
        |k: u64| format!("({:010}.000000) can0 123#\n({:010}.500000) can1 123#\n", 30_000 - k, 30_000 - k);
    let text: String = (0..20_000).map(lines).collect();
    let (mut capture, broken) = candump::parse(text.as_bytes()).unwrap();
    capture.sort();
    assert_eq!((capture.frames.len(), broken.count, capture.steps.len()), (40_000, 0, 19_999));
}

/// The formats are told apart by what stands in the file; a binary one is named with the command that makes text of it.
#[test]
fn logs_of_other_tools_are_read_and_a_binary_one_is_named() {
    for text in [
        "date Sat Sep 30 15:06:13.191 2017\nbase hex  timestamps absolute\n 0.5 1  123  Rx   d 1 AB\n",
        ";$FILEVERSION=1.1\n 1) 500.0 Rx 0123 1 AB\n",
        "(0000000000.500000) can0 123#AB R\n",
    ] {
        let path = file(text.as_bytes());
        let (capture, _) = text_log::read(&path, Strictness::Strict).unwrap();
        std::fs::remove_file(path).unwrap();
        assert_eq!(written(&capture), "(0000000000.500000) can0 123#AB R\n", "{text}");
    }
    let path = file(b"LOGG\x90\0\0\0");
    let said = text_log::read(&path, Strictness::Lenient).unwrap_err().to_string();
    std::fs::remove_file(path).unwrap();
    assert!(said.contains("BLF") && said.contains("python3 -m can.logconvert"), "{said}");
}

#[test]
fn an_empty_file_and_a_missing_one_are_told_apart() {
    let path = file(b"");
    assert!(matches!(text_log::read(&path, Strictness::Strict), Err(TextLogError::Empty(_))));
    std::fs::remove_file(&path).unwrap();
    assert!(matches!(text_log::read(&path, Strictness::Strict), Err(TextLogError::Read(..))));
}

fn captured() -> impl Strategy<Value = Captured> {
    let id = prop_oneof![0..0x800u32, (0..0x2000_0000u32).prop_map(|id| id | EXTENDED)];
    let classic = (id.clone(), 0..=8usize, prop_oneof![4 => Just(0u8), 1 => 9..=15u8])
        .prop_map(|(id, n, code)| (id, n, FrameType::Classic { code: if n == 8 { code } else { 0 } }));
    let remote = (id.clone(), 0..=8usize).prop_map(|(id, n)| (id | REMOTE, n, FrameType::CLASSIC));
    let error = (0..0x2000_0000u32).prop_map(|id| (id | ERROR, 8, FrameType::CLASSIC));
    let fd =
        (id, 0..16usize, 0..16u8).prop_map(|(id, n, flags)| (id, FD_LENGTHS[n], FrameType::Fd { flags }));
    let way =
        prop_oneof![Just(None), Just(Some(CaptureDirection::Received)), Just(Some(CaptureDirection::Sent))];
    let kind = prop_oneof![3 => classic, 1 => remote, 1 => error, 3 => fd];
    let bytes = proptest::collection::vec(any::<u8>(), 64);
    (kind, bytes, 0..4_000_000_000_000_000u64, 0..3u32, way).prop_map(
        |((id, n, form), bytes, micros, line, way)| {
            let mut data = [0; 64];
            if id & (REMOTE | ERROR) != REMOTE {
                data[..n].copy_from_slice(&bytes[..n]);
            }
            Captured { time_ns: micros * 1000, line, id, len: n as u8, data, form, way }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn every_recording_is_read_back_as_it_was_and_its_text_again_byte_for_byte(
        mut frames in proptest::collection::vec(captured(), 1..20)
    ) {
        frames.sort_by_key(|frame| frame.time_ns);
        let lines = ["can0", "vcan1", "slcan10"].map(String::from);
        let mut capture = Capture::default();
        for mut frame in frames {
            frame.line = capture.line(&lines[frame.line as usize]);
            capture.frames.push(frame);
        }
        let text = written(&capture);
        let back = read_back(&text);
        prop_assert_eq!(&back, &capture);
        prop_assert_eq!(written(&back), text);
    }

    /// Whatever stands in a line: it is read or refused, and the reader goes on.
    #[test]
    fn no_line_stops_the_reader(line in "[ -~]{0,40}", cut in 0..40usize) {
        let _ = candump_line::parse(&line);
        let whole = "(1436509053.200000) vcan0 1FFFFFFF##50001020304050607";
        let _ = candump_line::parse(&whole[..cut.min(whole.len())]);
        let _ = candump_line::parse(&format!("(1.000000) can0 {line}"));
    }
}
