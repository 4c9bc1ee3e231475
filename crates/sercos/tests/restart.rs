//! Slaves that fell to NRT while data were exchanged: noticed, taken back by a start from CP0, and told from cables and
//! lost telegrams.

mod wire;

use sercos::{CommunicationPhase, RingEvent, Stage};
use wire::{LOSSES, Wire};

const ADDRESSES: [u16; 4] = [3, 7, 12, 20];

fn running(two_ports: bool) -> Wire {
    let mut wire = Wire::new(&ADDRESSES, two_ports);
    wire.start(2000);
    exchange(&mut wire, 20);
    wire.events.clear();
    wire
}

fn exchange(wire: &mut Wire, cycles: u8) {
    for number in 0..cycles {
        wire.exchange(number);
    }
}

/// The master pauses for so long that every slave misses too many beats.
fn pause(wire: &mut Wire) {
    (0..=LOSSES).for_each(|_| wire.chain.silence());
    assert!(wire.chain.slaves().iter().all(|slave| slave.phase().is_none()));
}

/// Cycles with data until the master is in CP4.
fn comes_back(wire: &mut Wire, most: u32) -> u32 {
    (1..=most).find(|cycle| wire.exchange(*cycle as u8) == Stage::Running).expect("in CP4 again")
}

#[test]
fn slaves_that_fell_to_nrt_are_started_again_and_have_their_data() {
    for two_ports in [true, false] {
        let mut wire = running(two_ports);
        pause(&mut wire);
        for cycle in 0..=u32::from(LOSSES) {
            assert_eq!(wire.master.fallen(), 0, "cycle {cycle}: losses are permitted");
            assert_eq!(wire.exchange(1), Stage::Running);
        }
        assert_eq!(wire.master.fallen(), ADDRESSES.len());
        assert!((0..4).all(|i| wire.master.feedback(i).is_none()), "what is old is not taken for new");
        wire.events.clear();
        wire.master.restart();
        let cycles = comes_back(&mut wire, 2000);
        let phases =
            wire.events.iter().filter_map(|e| if let RingEvent::Phase(p) = e { Some(*p) } else { None });
        assert_eq!(
            (wire.events[0], phases.collect::<Vec<_>>()),
            (RingEvent::Restart, CommunicationPhase::ALL.to_vec())
        );
        assert!(cycles < 600, "{cycles} cycles");
        for number in 100..120 {
            assert_eq!(wire.exchange(number), Stage::Running);
            for i in 0..4 {
                assert_eq!(wire.master.feedback(i).map(|d| d[0]), Some(number.wrapping_mul(3) ^ i as u8));
                let command = wire.chain.slaves_mut()[i].take_command().map(|d| d[0]);
                assert_eq!(command, Some(number ^ i as u8));
            }
        }
        assert_eq!(wire.master.fallen(), 0);
        let back = wire.events.iter().filter(|e| matches!(e, RingEvent::Back(_))).count();
        assert_eq!(back, ADDRESSES.len());
    }
}

/// Before CP0 it is silent for so long that slaves in CP4 fall to NRT, too.
#[test]
fn one_slave_alone_is_counted_and_a_restart_takes_all_along() {
    let mut wire = running(true);
    (0..=LOSSES).for_each(|_| wire.chain.slaves_mut()[2].silence());
    for number in 0..10 {
        assert_eq!(wire.exchange(number), Stage::Running);
    }
    assert_eq!(wire.master.fallen(), 1);
    assert_eq!([0, 1, 2, 3].map(|i| wire.master.feedback(i).is_some()), [true, true, false, true]);
    assert!(!wire.master.is_broken(), "it passes telegrams on");
    wire.master.restart();
    let mut all_fell = false;
    for _ in 0..2000 {
        all_fell |= wire.chain.slaves().iter().all(|slave| slave.phase().is_none());
        if wire.exchange(1) == Stage::Running {
            break;
        }
    }
    assert!(all_fell);
    wire.exchange(2);
    assert!((0..4).all(|i| wire.master.feedback(i).is_some()));
}

/// What lies behind two pulled cables, and what lost telegrams would have told, has not fallen.
#[test]
fn cables_and_lost_telegrams_are_no_reason_to_start_again() {
    let mut wire = running(true);
    wire.chain.set_cable(1, false);
    wire.chain.set_cable(3, false);
    for number in 0..50 {
        wire.exchange(number);
        assert_eq!(wire.master.fallen(), 0);
    }
    assert!(wire.events.contains(&RingEvent::Lost(7)));
    let mut wire = running(true);
    for _ in 0..50 {
        wire.cycle_with(|_, _| false);
        assert_eq!(wire.master.fallen(), 0);
    }
}

/// They fell while the ring was open: it starts as soon as the cable is plugged, and not before.
#[test]
fn a_restart_that_fails_can_be_tried_again() {
    let mut wire = running(true);
    wire.chain.set_cable(2, false);
    exchange(&mut wire, 20);
    pause(&mut wire);
    exchange(&mut wire, 20);
    assert_eq!(wire.master.fallen(), ADDRESSES.len());
    wire.master.restart();
    let failed = (0..2000).any(|_| matches!(wire.exchange(1), Stage::Failed(_)));
    assert!(failed, "a ring that is open does not start");
    wire.chain.set_cable(2, true);
    wire.master.restart();
    comes_back(&mut wire, 2000);
}
