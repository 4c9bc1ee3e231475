//! Cables pulled and plugged while data are exchanged: what is lost, what is told, and the ring closed again.

mod wire;

use sercos::header::{TelegramHeader, TelegramKind};
use sercos::{RingEvent, Stage};
use wire::{LOSSES, Wire};

const ADDRESSES: [u16; 4] = [3, 7, 12, 20];

fn running() -> Wire {
    let mut wire = Wire::new(&ADDRESSES, true);
    wire.start(2000);
    for number in 0..20 {
        wire.exchange(number);
    }
    wire.events.clear();
    wire
}

/// Exchanges for so many cycles; the longest run without data, on either way.
fn longest_loss(wire: &mut Wire, cycles: u32) -> u32 {
    let (mut runs, mut longest) = ([[0; 2]; ADDRESSES.len()], 0);
    for number in 0..cycles {
        assert_eq!(wire.exchange(number as u8), Stage::Running);
        for (i, run) in runs.iter_mut().enumerate() {
            let got =
                [wire.master.feedback(i).is_some(), wire.chain.slaves_mut()[i].take_command().is_some()];
            for (count, got) in run.iter_mut().zip(got) {
                *count = if got { 0 } else { *count + 1 };
                longest = longest.max(*count);
            }
        }
    }
    longest
}

#[test]
fn every_cable_can_be_pulled_and_plugged() {
    for cable in 0..=ADDRESSES.len() {
        let mut wire = running();
        wire.chain.set_cable(cable, false);
        let lost = longest_loss(&mut wire, 300);
        assert_eq!(lost, 0, "cable {cable}: both of its ends turn telegrams round at once");
        let left = cable.checked_sub(1).map(|i| ADDRESSES[i]);
        let right = ADDRESSES.get(cable).copied();
        assert_eq!(wire.events, [RingEvent::RingBroken(left, right)], "cable {cable}");
        assert!(wire.master.is_broken() && !wire.chain.slaves()[0].ring_closed());

        wire.events.clear();
        wire.chain.set_cable(cable, true);
        let lost = longest_loss(&mut wire, 90);
        assert!(wire.master.is_broken(), "cable {cable}: not before 100 stable cycles");
        let lost = lost.max(longest_loss(&mut wire, 100));
        assert_eq!(wire.events, [RingEvent::RingClosed], "cable {cable}");
        assert!(wire.chain.slaves()[0].ring_closed());
        assert!(lost <= LOSSES.into(), "cable {cable}: {lost} cycles lost while closing");
    }
}

/// What is behind two breaks is lost and told; what is not goes on.
#[test]
fn two_cables_cut_off_what_is_between_them() {
    let mut wire = running();
    wire.chain.set_cable(1, false);
    wire.chain.set_cable(3, false);
    for number in 0..10 {
        wire.exchange(number);
    }
    assert!(wire.events.contains(&RingEvent::Lost(7)) && wire.events.contains(&RingEvent::Lost(12)));
    assert!(wire.master.feedback(0).is_some() && wire.master.feedback(3).is_some());
    assert!(wire.master.feedback(1).is_none() && wire.master.feedback(2).is_none());
    assert!(!wire.events.contains(&RingEvent::Lost(3)));
}

/// A cable that comes and goes within the 100 cycles closes nothing.
#[test]
fn a_loose_plug_does_not_close_the_ring() {
    let mut wire = running();
    for _ in 0..5 {
        wire.chain.set_cable(2, false);
        assert_eq!(longest_loss(&mut wire, 40), 0);
        wire.chain.set_cable(2, true);
        assert_eq!(longest_loss(&mut wire, 80), 0);
    }
    assert_eq!(wire.events, [RingEvent::RingBroken(Some(7), Some(12))]);
    longest_loss(&mut wire, 110);
    assert_eq!(wire.events.last(), Some(&RingEvent::RingClosed));
}

/// One channel's telegrams lost: the other one's are enough, and the ring is told to be open.
#[test]
fn one_channel_is_enough() {
    let mut wire = running();
    for number in 0..10 {
        for i in 0..ADDRESSES.len() {
            wire.chain.slaves_mut()[i].set_feedback(&vec![number; 12 + 2 * i]);
        }
        wire.cycle_with(|port, _| port == 0);
        assert!((0..ADDRESSES.len()).all(|i| wire.master.feedback(i).is_some()));
    }
    assert_eq!(wire.events, [RingEvent::RingBroken(None, None)]);
}

/// Losses up to the permitted number are counted and nothing more; one more is told.
#[test]
fn lost_acknowledge_telegrams_are_counted() {
    for losses in 1..5 {
        let mut wire = running();
        for number in 0..losses {
            for i in 0..ADDRESSES.len() {
                wire.chain.slaves_mut()[i].set_feedback(&vec![number; 12 + 2 * i]);
            }
            wire.cycle_with(|_, frame| TelegramHeader::read(frame).unwrap().kind == TelegramKind::Mdt);
        }
        wire.exchange(99);
        let counts = wire.master.counts();
        assert_eq!((counts.longest, counts.missed), (losses.into(), 4 * u64::from(losses)));
        let told = wire.events.contains(&RingEvent::Lost(3));
        assert_eq!(told, u16::from(losses) > LOSSES);
        assert_eq!(told, wire.events.contains(&RingEvent::Back(3)));
    }
}
