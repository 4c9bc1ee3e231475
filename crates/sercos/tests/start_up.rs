//! From NRT to CP4, and what stops it: master and slaves joined in memory.

mod wire;

use sercos::ServiceRefusal;
use sercos::header::{TelegramHeader, TelegramKind};
use sercos::idn::{self, connection};
use sercos::layout::LayoutError;
use sercos::{CommunicationPhase, Master, PortSide, RingEvent, Slave, SlaveChain, Stage, StartTrouble};
use wire::{Wire, setup};

/// Cycles until the master is in CP4 or has given up.
fn ends(wire: &mut Wire) -> StartTrouble {
    for _ in 0..5000 {
        match wire.cycle() {
            Stage::Failed(trouble) => return trouble,
            Stage::Running => panic!("this should not have started"),
            Stage::Starting(_) => {}
        }
    }
    panic!("neither started nor given up");
}

fn phases(wire: &Wire) -> Vec<CommunicationPhase> {
    let phase = |e: &RingEvent| match e {
        RingEvent::Phase(phase) => Some(*phase),
        _ => None,
    };
    wire.events.iter().filter_map(phase).collect()
}

#[test]
fn a_ring_and_a_line_start_phase_by_phase_and_exchange_data() {
    for two_ports in [true, false] {
        let mut wire = Wire::new(&[3, 7, 12], two_ports);
        wire.start(2000);
        assert_eq!(phases(&wire), CommunicationPhase::ALL);
        for number in 1..100 {
            assert_eq!(wire.exchange(number), Stage::Running);
            for i in 0..3 {
                let expected = vec![number.wrapping_mul(3) ^ i as u8; 12 + 2 * i];
                assert_eq!(wire.master.feedback(i), Some(&*expected), "station {i}, exchange {number}");
                let expected = vec![number ^ i as u8; 8 + 4 * i];
                assert_eq!(wire.chain.slaves_mut()[i].take_command(), Some(&*expected));
                assert_eq!(wire.chain.slaves()[i].ring_closed(), two_ports);
            }
        }
        let counts = wire.master.counts();
        assert_eq!((counts.missed, counts.malformed, counts.late, counts.open), (0, 0, 0, 0));
    }
}

/// Nothing new to say is not the same as nothing said.
#[test]
fn old_data_are_not_taken_for_new_ones() {
    let mut wire = Wire::new(&[3, 7], true);
    wire.start(2000);
    wire.exchange(1);
    wire.chain.slaves_mut()[0].take_command();
    wire.cycle();
    assert_eq!((wire.master.feedback(0), wire.master.missed(0)), (None, 1));
    assert_eq!(wire.chain.slaves_mut()[0].take_command(), None);
}

#[test]
fn the_order_of_the_slaves_does_not_matter() {
    let mut wire = Wire::new(&[3, 7, 12], true);
    let mut other = setup(&[3, 7, 12], true);
    other.stations.reverse();
    wire.master = Master::new(other).unwrap();
    wire.start(2000);
    wire.master.set_command(2, &[9; 8]); // address 3, the first in the ring
    wire.cycle();
    assert_eq!(wire.chain.slaves_mut()[0].take_command(), Some(&[9; 8][..]));
}

#[test]
fn a_silent_ring_is_given_up_after_1000_cycles() {
    let mut wire = Wire::new(&[3, 7], true);
    wire.chain.set_cable(0, false);
    wire.chain.set_cable(2, false);
    assert_eq!(ends(&mut wire), StartTrouble::NoTelegrams);
    assert_eq!(wire.master.counts().cycles, 1000);
}

#[test]
fn an_open_ring_does_not_start() {
    for cable in 0..3 {
        let mut wire = Wire::new(&[3, 7], true);
        wire.chain.set_cable(cable, false);
        let trouble = ends(&mut wire);
        assert!(matches!(trouble, StartTrouble::Shape(_)), "cable {cable}: {trouble}");
        assert!(trouble.to_string().contains("the ring is open"), "{trouble}");
    }
}

/// Cables that are plugged while the master is looking for slaves: the ring closes by itself.
#[test]
fn a_ring_that_is_closed_in_cp0_starts() {
    for cable in 0..3 {
        let mut wire = Wire::new(&[3, 7], true);
        wire.chain.set_cable(cable, false);
        for _ in 0..50 {
            wire.cycle();
        }
        wire.chain.set_cable(cable, true);
        wire.start(2000);
        wire.exchange(1);
        assert!(
            !wire.events.iter().any(|e| !matches!(e, RingEvent::Phase(_))),
            "cable {cable}: {:?}",
            wire.events
        );
    }
}

#[test]
fn other_slaves_than_the_configured_ones_are_named() {
    for (expected, trouble) in [
        (&[3, 7, 8][..], StartTrouble::Missing(8)),
        (&[3], StartTrouble::Stranger(7)),
        (&[3, 8], StartTrouble::Stranger(7)),
    ] {
        let mut wire = Wire::new(&[3, 7], true);
        wire.master = Master::new(setup(expected, true)).unwrap();
        assert_eq!(ends(&mut wire), trouble);
    }
    let mut wire = Wire::new(&[3, 7], true);
    wire.chain = SlaveChain::new(vec![Slave::new(3, 8, 12), Slave::new(3, 12, 14)], false);
    assert_eq!(ends(&mut wire), StartTrouble::Stranger(3), "two slaves with one address");
}

/// A slave whose connections are not the configured ones refuses in CP2, by name.
#[test]
fn a_slave_of_another_kind_is_refused() {
    let mut wire = Wire::new(&[3, 7], true);
    wire.chain = SlaveChain::new(vec![Slave::new(3, 8, 12), Slave::new(7, 99, 14)], false);
    let trouble = ends(&mut wire);
    let StartTrouble::Refused { address: 7, idn, refusal: ServiceRefusal::Value(value) } = trouble else {
        panic!("{trouble}");
    };
    assert_eq!((idn, value.number()), (connection(idn::COMMAND, idn::LENGTH), 101));
    assert_eq!(wire.chain.slaves()[0].phase(), Some(CommunicationPhase::Cp2), "nobody went on");
}

/// A slave that dies in CP2 does not hold the master for ever.
#[test]
fn a_slave_that_falls_silent_in_cp2_is_named() {
    let mut wire = Wire::new(&[3, 7], false);
    while !matches!(wire.master.stage(), Stage::Starting(CommunicationPhase::Cp2)) {
        wire.cycle();
    }
    for _ in 0..30 {
        wire.cycle();
    }
    wire.chain.set_cable(1, false);
    let trouble = ends(&mut wire);
    assert!(
        matches!(trouble, StartTrouble::Refused { address: 7, refusal: ServiceRefusal::Timeout, .. }),
        "{trouble}"
    );
}

#[test]
fn what_cannot_be_is_refused_before_anything_is_sent() {
    let mut wrong = setup(&[3, 7], true);
    wrong.cycle = 300_000;
    let error = Master::new(wrong).err().unwrap();
    assert_eq!(error, StartTrouble::CycleTime(300_000));
    assert!(error.to_string().contains("300 µs does not exist"), "{error}");
    let error = Master::new(setup(&[3, 3], true)).err().unwrap();
    assert_eq!(error, StartTrouble::Layout(LayoutError::Twice(3)));
}

/// Many slaves: service channels and connections need more than one telegram of each kind.
#[test]
fn forty_slaves_start() {
    let addresses: Vec<u16> = (1..=40).collect();
    let mut wire = Wire::new(&addresses, true);
    wire.start(3000);
    wire.exchange(5);
    assert!((0..40).all(|i| wire.master.feedback(i).is_some()));
}

/// A master that starts again finds the slaves in CP4 and takes them along.
#[test]
fn a_master_starts_again() {
    let mut wire = Wire::new(&[3, 7], true);
    wire.start(2000);
    wire.master = Master::new(setup(&[3, 7], true)).unwrap();
    wire.events.clear();
    wire.start(2000);
    assert_eq!(phases(&wire), CommunicationPhase::ALL);
}

/// Without a master, slaves in CP4 go back to NRT when more beats are missing than S-0-1003 permits.
#[test]
fn slaves_without_a_master_end_in_nrt() {
    let mut wire = Wire::new(&[3, 7], true);
    wire.start(2000);
    wire.exchange(0);
    wire.chain.silence();
    wire.chain.silence();
    assert_eq!(wire.chain.slaves()[0].phase(), Some(CommunicationPhase::Cp4), "two losses are permitted");
    wire.chain.silence();
    assert!(wire.chain.slaves().iter().all(|s| s.phase().is_none()));
    for _ in 0..5 {
        wire.exchange(1);
    }
    assert!(wire.events.contains(&RingEvent::Lost(3)) && wire.events.contains(&RingEvent::Lost(7)));
}

/// Awaited telegrams: all acknowledge telegrams, at both ports of a ring, however many data telegrams there are.
#[test]
fn a_cycle_is_complete_when_everything_is_back() {
    let mut wire = Wire::new(&[3, 7], true);
    let mut setup = setup(&[3, 7], true);
    setup.stations[1].feedback = 1480; // two ATs, one MDT
    let slaves = setup.stations.iter().map(|s| Slave::new(s.address, s.command, s.feedback)).collect();
    wire.chain = SlaveChain::new(slaves, false);
    wire.master = Master::new(setup).unwrap();
    wire.start(2000);
    for _ in 0..3 {
        wire.master.begin();
        let mut back = Vec::new();
        for (port, end) in [(0, PortSide::Left), (1, PortSide::Right)] {
            for frame in wire.master.telegrams(port) {
                wire.chain.take(end, frame, &mut |side, frame| back.push((side, frame.to_vec())));
            }
        }
        let telegrams = back
            .iter()
            .filter(|(_, frame)| TelegramHeader::read(frame).unwrap().kind == TelegramKind::At)
            .count();
        assert_eq!((back.len(), telegrams), (6, 4));
        for (i, (side, frame)) in back.iter().enumerate() {
            assert!(!wire.master.is_complete(), "{i} of 6");
            wire.master.take(if *side == PortSide::Left { 0 } else { 1 }, frame);
        }
        assert!(wire.master.is_complete());
        wire.master.end();
    }
}
