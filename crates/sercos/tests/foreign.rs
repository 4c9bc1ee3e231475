//! Frames that are not what they should be, at both ends: counted, never a panic, and nothing is taken from them.

mod wire;

use proptest::prelude::*;
use sercos::header::{CommunicationPhase, HEADER, TelegramHeader, TelegramKind};
use sercos::{PortSide, Stage};
use std::cell::RefCell;
use wire::Wire;

thread_local! {
    /// Two rings that stay: one in CP4, and one that is held in CP2.
    static RINGS: RefCell<[Wire; 2]> = RefCell::new([CommunicationPhase::Cp4, CommunicationPhase::Cp2].map(ring));
}

fn ring(phase: CommunicationPhase) -> Wire {
    let mut wire = Wire::new(&[3, 7, 12], true);
    while wire.master.stage() != Stage::Starting(phase) && wire.master.stage() != Stage::Running {
        wire.cycle();
    }
    wire.cycle();
    wire
}

/// Whatever comes, from anywhere.
fn feed(wire: &mut Wire, frame: &[u8]) {
    for (port, end) in [(0, PortSide::Left), (1, PortSide::Right)] {
        wire.master.begin();
        wire.master.take(port, frame);
        wire.chain.take(end, frame, &mut |side, frame| {
            wire.master.take(if side == PortSide::Left { 0 } else { 1 }, frame);
        });
        wire.master.end();
    }
}

proptest! {
    #[test]
    fn random_bytes_are_counted(frame in proptest::collection::vec(any::<u8>(), 0..1600)) {
        RINGS.with_borrow_mut(|rings| {
            for wire in rings {
                let before = wire.master.counts();
                feed(wire, &frame);
                let after = wire.master.counts();
                prop_assert_eq!(after.malformed + after.foreign, before.malformed + before.foreign + 2);
            }
            Ok(())
        })?;
    }

    /// Right heads, any data: every word of a telegram may hold anything.
    #[test]
    fn any_data_behind_a_right_head_do_no_harm(
        data in proptest::collection::vec(any::<u8>(), 0..1494),
        kind in any::<bool>(), number in 0..4u8, phase in 0..5usize, cycle in 0..8u8, switching in any::<bool>(),
    ) {
        RINGS.with_borrow_mut(|rings| {
            for wire in rings {
                let mut frame = vec![0; HEADER];
                frame.extend(&data);
                let kind = if kind { TelegramKind::At } else { TelegramKind::Mdt };
                let channel = sercos::header::RingChannel::P;
                let (phase, cycle) = (CommunicationPhase::ALL[phase], Some(cycle));
                let source = wire::MACS[0];
                TelegramHeader { source, channel, kind, number, phase, switching, cycle }.write(&mut frame);
                feed(wire, &frame);
            }
        });
    }
}

/// A telegram with a wrong byte in its head is not taken for one, and the exchange goes on by the other channel.
#[test]
fn a_corrupted_head_loses_nothing_in_a_ring() {
    let mut wire = Wire::new(&[3, 7], true);
    wire.start(2000);
    for number in 0..50 {
        wire.master.set_command(0, &[number; 8]);
        wire.chain.slaves_mut()[0].set_feedback(&[number; 12]);
        wire.master.begin();
        for (port, end) in [(0, PortSide::Left), (1, PortSide::Right)] {
            let frames: Vec<_> = wire.master.telegrams(port).map(<[u8]>::to_vec).collect();
            for mut frame in frames {
                if port == 0 {
                    frame[15] ^= 1 << (number % 8);
                }
                wire.chain.take(end, &frame, &mut |side, frame| {
                    wire.master.take(if side == PortSide::Left { 0 } else { 1 }, frame);
                });
            }
        }
        wire.master.end();
        assert_eq!(wire.master.feedback(0), Some(&[number; 12][..]));
        assert_eq!(wire.chain.slaves_mut()[0].take_command(), Some(&[number; 8][..]));
    }
    assert_eq!(wire.chain.slaves()[0].counts().malformed, 100);
    wire.exchange(99);
    assert_eq!(wire.master.counts().longest, 0);
}
