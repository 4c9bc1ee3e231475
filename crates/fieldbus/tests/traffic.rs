//! Recorded traffic by node, cycle and identifier.

use codec::layout::{BusMessage, BusSignal, Carries, FrameLayout};
use fieldbus::cycles::{Cycles, Unwrapped};
use fieldbus::owners::Owners;
use fieldbus::statistics::{BitRates, Statistics};
use fieldbus::{Capture, candump};

const COUNTER: u32 = 8;

fn message(
    name: &str,
    id: u32,
    node: usize,
    to_drives: bool,
    len: u32,
    number: Option<Carries>,
) -> BusMessage {
    let signal = |start, bits, carries| BusSignal {
        name: "x".into(),
        start,
        bits,
        signed: false,
        scale: 1.0,
        offset: 0.0,
        carries,
    };
    let mut signals = vec![signal(0, COUNTER, Carries::Counter)];
    signals.extend(number.map(|carries| signal(8, 16, carries)));
    BusMessage { name: name.into(), id, len, node, to_drives, cyclic: true, signals }
}

/// Two nodes with targets and angles of their own and one SYNC, 0x80, for both.
fn layout() -> FrameLayout {
    let mut messages = Vec::new();
    for node in 0..2 {
        let id = node as u32;
        messages.push(message("to", 0x100 + id, node, true, 3, Some(Carries::Target(node))));
        messages.push(message("sync", 0x80, node, true, 1, None));
        messages.push(message("from", 0x180 + id, node, false, 3, Some(Carries::Angle(node))));
    }
    FrameLayout::new(vec!["a".into(), "b".into()], messages)
}

fn capture(text: &str) -> Capture {
    let (capture, broken) = candump::parse(text.as_bytes()).unwrap();
    assert_eq!(broken.count, 0, "{broken}");
    capture
}

/// Three cycles; the line of node b has the first name; an answer before the first SYNC, one unknown frame.
const TWO_LINES: &str = "\
(0000000000.000000) can1 181#000100
(0000000000.000000) can0 180#000200
(0000000000.001000) can1 101#011111
(0000000000.001100) can1 080#01
(0000000000.001200) can0 100#012222
(0000000000.001300) can0 080#01
(0000000000.001400) can1 181#010300
(0000000000.001500) can0 180#010400
(0000000000.001600) can0 7FF#00
(0000000000.002000) can0 100#022222
(0000000000.002100) can0 080#02
(0000000000.002200) can1 101#021111
(0000000000.002300) can1 080#02
(0000000000.002400) can0 180#020500
(0000000000.003000) can0 100#032222
";

#[test]
fn frames_are_sorted_by_node_and_tick_whatever_the_interfaces_are_called() {
    let (layout, capture) = (layout(), capture(TWO_LINES));
    let owners = Owners::of(&layout, &capture);
    assert_eq!(owners.behind(0).collect::<Vec<_>>(), [1], "can1 came first and is node b");
    let cycles = Cycles::of(&layout, &owners, &capture);
    assert_eq!((cycles.first(), cycles.ticks(), cycles.unknown, cycles.unfinished), (0, 3, 1, 1));
    let ids = |frames: messages::BusFrames| {
        frames.as_slice().iter().map(|f| (f.line, f.id, f.data[1])).collect::<Vec<_>>()
    };
    assert_eq!(ids(cycles.answers(&capture, 0)), [(0, 0x180, 2), (1, 0x181, 1)]);
    assert_eq!(ids(cycles.answers(&capture, 1)), [(0, 0x180, 4), (0, 0x7ff, 0), (1, 0x181, 3)]);
    assert_eq!(ids(cycles.answers(&capture, 2)), [(0, 0x180, 5)]);
    let told = [(0, 0x100, 0x22), (0, 0x80, 0), (1, 0x101, 0x11), (1, 0x80, 0)];
    assert_eq!(ids(cycles.told(&capture, 1)), told);
    assert_eq!(ids(cycles.told(&capture, 2)), told);
    assert_eq!(cycles.told(&capture, 2).header.tick, 2);
}

/// One SYNC on a line that both nodes share belongs to both.
#[test]
fn nodes_may_share_an_interface() {
    let layout = layout();
    let capture = capture(&TWO_LINES.replace("can1", "can0").replacen("can0 080#01\n", "can0 7FE#\n", 1));
    let owners = Owners::of(&layout, &capture);
    assert_eq!(owners.behind(0).collect::<Vec<_>>(), [0, 1]);
    let cycles = Cycles::of(&layout, &owners, &capture);
    let told = cycles.told(&capture, 1);
    let ids = told.as_slice().iter().map(|f| (f.line, f.id)).collect::<Vec<_>>();
    assert_eq!(ids, [(0, 0x100), (0, 0x80), (1, 0x101), (1, 0x80)]);
}

/// Until both ends are there, the far end tells its state unasked, and the near end asks more than once.
#[test]
fn repeated_answers_to_the_first_cycle_count_once() {
    let text = "\
(0000000000.000000) can0 180#000200
(0000000000.001000) can0 080#00
(0000000000.002000) can0 180#000200
(0000000000.003000) can0 080#00
(0000000000.004000) can0 180#000200
(0000000000.005000) can0 080#01
(0000000000.006000) can0 180#010200
(0000000000.007000) can0 180#010200
";
    let (layout, capture) = (layout(), capture(text));
    let cycles = Cycles::of(&layout, &Owners::of(&layout, &capture), &capture);
    let count = |tick| cycles.answers(&capture, tick).count;
    assert_eq!((count(0), count(1)), (1, 2), "later repetitions are a fault, and stay");
}

#[test]
fn ticks_are_told_from_their_low_bits() {
    let mut tick = Unwrapped::default();
    let ticks: Vec<u64> = [250, 251, 0, 0, 3, 2].iter().map(|c| tick.next(*c, 8)).collect();
    assert_eq!(ticks, [250, 251, 256, 256, 259, 514]);
}

#[test]
fn gaps_periods_and_load_are_counted() {
    let rates = BitRates { nominal: 1e6, data: 5e6 };
    let mut statistics = Statistics::new(rates);
    let text = "\
(0000000000.000000) can0 123#00AA
(0000000000.001000) can0 123#01AA
(0000000000.003000) can0 123#04AA
(0000000000.004000) can0 123#04AA
(0000000000.010000) can0 20000040#0000000000000000
";
    for frame in &capture(text).frames {
        let counter = (!frame.is_error()).then_some((u64::from(frame.data[0]), 8));
        statistics.add(frame, counter);
    }
    let rows: Vec<_> = statistics.rows().collect();
    let (_, id, row) = rows[0];
    assert_eq!((id, row.count, row.bytes, row.missing, row.repeated), (0x123, 4, 8, 2, 1));
    assert!((row.mean() - 4e-3 / 3.0).abs() < 1e-12);
    assert_eq!((row.shortest, row.longest), (0.001, 0.002));
    let (_, total) = statistics.lines().next().unwrap();
    assert_eq!((total.count, total.errors), (4, 1));
    // Four frames of two bytes at 1 Mbit/s: 63 bits each and a few stuff bits, in 10 ms.
    let load = statistics.load(total);
    assert!((4.0 * 63e-6 / 10e-3..4.0 * 75e-6 / 10e-3).contains(&load), "{load}");
}
