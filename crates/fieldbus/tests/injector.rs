//! Faults between the two ends of the bus: each does what its name says, to the frames and lines it is for, and nothing else.

use codec::layout::{BusMessage, BusSignal, Carries, FrameLayout};
use config::bus_fault::{BusFault, FaultKind, FrameDirection};
use fieldbus::{ErrorFrame, ErrorState, Injector};
use messages::{BusFrames, Frame};

#[global_allocator]
static ALLOCATOR: realtime::CountingAllocator = realtime::CountingAllocator;

/// \[s\] Bus cycle.
const CYCLE: f64 = 1e-3;
/// Frames of a line and cycle, each way.
const FRAMES: u32 = 3;
const LINES: u32 = 4;

fn layout() -> FrameLayout {
    let counter = BusSignal {
        name: "counter".into(),
        start: 0,
        bits: 8,
        signed: false,
        scale: 1.0,
        offset: 0.0,
        carries: Carries::Counter,
    };
    let message = |node: u32, k: u32, to_drives: bool| BusMessage {
        name: format!("m{node}_{k}"),
        id: if to_drives { 0x100 } else { 0x200 } + k,
        len: 8,
        node: node as usize,
        to_drives,
        cyclic: true,
        signals: vec![counter.clone()],
    };
    let each = |to_drives| (0..LINES).flat_map(move |n| (0..FRAMES).map(move |k| (n, k, to_drives)));
    let messages = each(true).chain(each(false)).map(|(n, k, to)| message(n, k, to)).collect();
    FrameLayout::new((0..LINES).map(|n| format!("node{n}")).collect(), messages)
}

/// Frame that an end sends in cycle `tick`; its payload is a hash of its identity.
fn sent(way: FrameDirection, tick: u64) -> BusFrames {
    let mut frames = BusFrames::default();
    frames.header.tick = tick;
    for line in 0..LINES {
        for k in 0..FRAMES {
            let id = if way == FrameDirection::ToDrives { 0x100 } else { 0x200 } + k;
            let mut frame = Frame { line, id, len: 8, ..Frame::default() };
            let content =
                (tick * 31 + u64::from(line) * 7 + u64::from(k)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            frame.data[..8].copy_from_slice(&content.to_le_bytes());
            frames.push(&frame);
        }
    }
    frames
}

fn injector(faults: &[BusFault]) -> Injector {
    Injector::new(faults, &layout(), CYCLE, 7).unwrap().unwrap()
}

/// Both ways of one cycle: what the drives got, what lowlevel got.
fn cycle(injector: &mut Injector, tick: u64) -> [Vec<Frame>; 2] {
    [FrameDirection::ToDrives, FrameDirection::FromDrives]
        .map(|way| injector.pass(way, &sent(way, tick)).as_slice().to_vec())
}

fn is_error(frame: &Frame) -> bool {
    ErrorFrame::read(frame).is_some()
}

/// A fault of all lines for all the time.
fn always(kind: FaultKind) -> BusFault {
    BusFault::new(kind, 0.0, f64::INFINITY)
}

fn same(a: &[Frame], b: &[Frame]) -> bool {
    a.len() == b.len()
        && a.iter().zip(b).all(|(a, b)| (a.line, a.id, a.len, a.data) == (b.line, b.id, b.len, b.data))
}

#[test]
fn without_faults_there_is_no_injector_and_an_unknown_node_is_named() {
    assert!(Injector::new(&[], &layout(), CYCLE, 1).unwrap().is_none());
    let fault = BusFault { node: Some("node9".into()), ..always(FaultKind::Lost) };
    let error = Injector::new(&[fault], &layout(), CYCLE, 1).unwrap_err();
    assert_eq!(error, "no node `node9` on the bus; there is node0, node1, node2, node3");
}

#[test]
fn before_and_after_a_fault_frames_pass_untouched() {
    for kind in FaultKind::ALL.into_iter().filter(|kind| *kind != FaultKind::Shorted) {
        let mut x = injector(&[BusFault::new(kind, 0.010, 0.005)]);
        for tick in (1..10).chain(30..40) {
            if tick == 30 {
                (10..30).for_each(|tick| drop(cycle(&mut x, tick)));
            }
            let got = cycle(&mut x, tick);
            assert!(same(&got[0], sent(FrameDirection::ToDrives, tick).as_slice()), "{kind:?} at {tick}");
            let data: Vec<Frame> = got[1].iter().copied().filter(|f| !is_error(f)).collect();
            assert!(same(&data, sent(FrameDirection::FromDrives, tick).as_slice()), "{kind:?} at {tick}");
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_bits_and_another_one_others() {
    let faults: Vec<BusFault> = [FaultKind::Lost, FaultKind::Flipped, FaultKind::Late, FaultKind::Reordered]
        .map(|kind| BusFault { share: 0.2, ..always(kind) })
        .into();
    let run = |seed| {
        let mut x = Injector::new(&faults, &layout(), CYCLE, seed).unwrap().unwrap();
        (1..200).map(|tick| cycle(&mut x, tick)).collect::<Vec<_>>()
    };
    let equal = |a: &[[Vec<Frame>; 2]], b: &[[Vec<Frame>; 2]]| {
        a.iter().zip(b).all(|(a, b)| same(&a[0], &b[0]) && same(&a[1], &b[1]))
    };
    assert!(equal(&run(1), &run(1)));
    assert!(!equal(&run(1), &run(2)));
}

/// Binomial: within four standard deviations.
#[test]
fn losses_are_as_frequent_as_they_are_to_be() {
    for share in [0.001, 0.01, 0.1] {
        let mut x =
            injector(&[BusFault { share, way: Some(FrameDirection::FromDrives), ..always(FaultKind::Lost) }]);
        let cycles = 20_000;
        for tick in 1..=cycles {
            x.pass(FrameDirection::FromDrives, &sent(FrameDirection::FromDrives, tick));
        }
        let n = (cycles * u64::from(LINES * FRAMES)) as f64;
        let spread = (n * share * (1.0 - share)).sqrt();
        assert!((x.injected().lost as f64 - n * share).abs() < 4.0 * spread, "{share}: {:?}", x.injected());
        let got = x.pass(FrameDirection::ToDrives, &sent(FrameDirection::ToDrives, 1)).count;
        assert_eq!(got, u64::from(LINES * FRAMES), "the other way is whole");
    }
}

#[test]
fn a_burst_takes_all_frames_of_its_line_for_its_cycles() {
    for length in [1, 5, 50] {
        let fault = BusFault {
            cycles: length,
            node: Some("node2".into()),
            ..BusFault::new(FaultKind::Lost, 0.1, CYCLE)
        };
        let mut x = injector(&[fault]);
        for tick in 1..300 {
            let gone = (100..100 + u64::from(length)).contains(&tick);
            for frames in cycle(&mut x, tick) {
                let of_line = frames.iter().filter(|f| f.line == 2).count();
                assert_eq!((of_line == 0, frames.len() - of_line), (gone, 9), "length {length}, tick {tick}");
            }
        }
    }
}

#[test]
fn late_frames_come_so_many_cycles_later_before_the_new_ones() {
    let fault =
        BusFault { cycles: 3, node: Some("node1".into()), ..BusFault::new(FaultKind::Late, 0.010, CYCLE) };
    let mut x = injector(&[fault]);
    for tick in 1..10 {
        cycle(&mut x, tick);
    }
    let original = sent(FrameDirection::FromDrives, 10);
    assert_eq!(cycle(&mut x, 10)[1].len(), 9);
    assert_eq!(cycle(&mut x, 12)[1].len(), 12);
    let got = cycle(&mut x, 13);
    assert!(same(&got[1][..3], &original.as_slice()[3..6]), "unchanged, and first");
    assert!(same(&got[1][3..], sent(FrameDirection::FromDrives, 13).as_slice()));
}

#[test]
fn duplicates_come_at_once_or_later() {
    let mut at_once = injector(&[always(FaultKind::Duplicated)]);
    let got = cycle(&mut at_once, 1);
    assert!(got[1].chunks(2).all(|pair| same(&pair[..1], &pair[1..])) && got[1].len() == 24);
    let mut later = injector(&[BusFault { cycles: 2, ..always(FaultKind::Duplicated) }]);
    let first = cycle(&mut later, 1);
    assert_eq!(first[1].len(), 12);
    cycle(&mut later, 2);
    let got = cycle(&mut later, 3);
    assert!(same(&got[1][..12], &first[1]) && got[1].len() == 24);
}

#[test]
fn reordering_loses_and_changes_nothing() {
    let mut x = injector(&[always(FaultKind::Reordered)]);
    let mut moved = 0;
    for tick in 1..100 {
        let (was, mut got) = (sent(FrameDirection::FromDrives, tick), cycle(&mut x, tick)[1].clone());
        moved += usize::from(!same(&got, was.as_slice()));
        got.sort_by_key(|f| (f.line, f.id));
        assert!(same(&got, was.as_slice()));
    }
    assert!(moved > 50, "{moved}");
}

#[test]
fn a_flip_is_one_bit_of_identifier_length_or_payload() {
    let mut x = injector(&[always(FaultKind::Flipped)]);
    let mut where_ = [0; 3];
    for tick in 1..200 {
        let (was, got) = (sent(FrameDirection::FromDrives, tick), cycle(&mut x, tick)[1].clone());
        for (a, b) in was.as_slice().iter().zip(&got) {
            let data: u32 = a.data.iter().zip(&b.data).map(|(a, b)| (a ^ b).count_ones()).sum();
            let flips = [(a.id ^ b.id).count_ones(), u32::from(a.len != b.len), data];
            assert_eq!(flips.iter().sum::<u32>(), 1);
            (0..3).for_each(|i| where_[i] += flips[i]);
        }
    }
    // 11 of 79 bits, 4, and 64, of 2388 frames.
    assert!(where_[0] > 260 && where_[1] > 80 && where_[2] > 1800, "{where_:?}");
}

/// States that the error frames of a line tell, with the cycle.
fn told(x: &mut Injector, ticks: std::ops::Range<u64>, line: u32) -> Vec<(u64, ErrorState)> {
    let mut all = Vec::new();
    for tick in ticks {
        let got = cycle(x, tick);
        let of_line = got[1].iter().filter(|f| f.line == line).filter_map(ErrorFrame::read);
        all.extend(of_line.filter_map(|e| e.state).map(|state| (tick, state)));
    }
    all
}

/// Three frames per cycle each way, every one destroyed: + 24 and + 3 per cycle. Warning at 96, passive at 128, off at 256.
#[test]
fn corrupted_frames_lead_the_controllers_off_the_bus_and_only_a_reset_back() {
    let fault = BusFault { node: Some("node3".into()), ..BusFault::new(FaultKind::Corrupted, 0.001, 0.011) };
    let mut x = injector(&[fault]);
    let states = told(&mut x, 1..60, 3);
    assert_eq!(states, [(4, ErrorState::Warning), (6, ErrorState::Passive), (11, ErrorState::Off)]);
    for frames in cycle(&mut x, 60) {
        assert!(frames.iter().all(|f| f.line != 3), "nothing passes, though the fault is long over");
        assert_eq!(frames.len(), 9, "and the other lines go on");
    }
    x.reset(60);
    // 1408 bits at 1 Mbit/s are 1.4 cycles: two.
    assert_eq!(told(&mut x, 61..80, 3), [(62, ErrorState::Active)]);
    assert_eq!(cycle(&mut x, 80)[1].len(), 12);
}

#[test]
fn a_pulled_cable_is_passive_and_heals_when_plugged() {
    let fault = BusFault { node: Some("node0".into()), ..BusFault::new(FaultKind::Pulled, 0.010, 0.1) };
    let mut x = injector(&[fault]);
    let states = told(&mut x, 1..110, 0);
    assert_eq!(states, [(13, ErrorState::Warning), (15, ErrorState::Passive)]);
    assert!(cycle(&mut x, 109).iter().all(|frames| frames.iter().all(|f| f.line != 0 || is_error(f))));
    let states = told(&mut x, 110..300, 0);
    assert_eq!(states.last().map(|s| s.1), Some(ErrorState::Active), "{states:?}");
    assert_eq!(cycle(&mut x, 300)[1].len(), 12);
}

#[test]
fn a_short_is_bus_off_in_its_first_cycle() {
    let fault = BusFault { node: Some("node1".into()), ..BusFault::new(FaultKind::Shorted, 0.005, 0.05) };
    let mut x = injector(&[fault]);
    assert_eq!(told(&mut x, 1..20, 1), [(5, ErrorState::Off)]);
    x.reset(20);
    // Told to come back into the short: off again.
    let states = told(&mut x, 21..40, 1);
    assert!(states.iter().all(|s| s.1 == ErrorState::Off), "{states:?}");
}

#[test]
fn a_silent_node_is_silent_without_an_error() {
    let fault = BusFault { node: Some("node2".into()), ..BusFault::new(FaultKind::Silent, 0.005, 0.05) };
    let mut x = injector(&[fault]);
    for tick in 1..80 {
        let quiet = (5..55).contains(&tick);
        for frames in cycle(&mut x, tick) {
            assert_eq!(frames.len(), if quiet { 9 } else { 12 });
            assert!(!frames.iter().any(is_error));
        }
    }
}

#[test]
fn nothing_is_allocated_in_a_cycle() {
    let faults: Vec<BusFault> = FaultKind::ALL
        .into_iter()
        .map(|kind| BusFault {
            // More corrupted ones, and all lines would be off soon.
            share: if kind == FaultKind::Corrupted { 0.05 } else { 0.3 },
            cycles: 5,
            node: (kind == FaultKind::Shorted).then(|| "node0".into()),
            ..always(kind)
        })
        .filter(|fault| !matches!(fault.kind, FaultKind::Silent | FaultKind::Pulled))
        .collect();
    let mut x = injector(&faults);
    let frames: Vec<[BusFrames; 2]> = (1..100)
        .map(|tick| [sent(FrameDirection::ToDrives, tick), sent(FrameDirection::FromDrives, tick)])
        .collect();
    realtime::allocations::arm();
    for (i, [to, from]) in frames.iter().enumerate() {
        x.pass(FrameDirection::ToDrives, to);
        x.pass(FrameDirection::FromDrives, from);
        if i % 10 == 9 {
            x.reset(i as u64);
        }
    }
    realtime::allocations::disarm();
    assert_eq!(realtime::allocations::counted(), [0, 0]);
    assert!(x.injected().late > 100 && x.injected().duplicated > 100 && x.injected().flipped > 100);
}
