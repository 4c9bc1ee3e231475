//! Sercos telegrams at both ends of a ring that stands in CP2 or runs.

#[path = "../../../crates/sercos/tests/wire/mod.rs"]
#[allow(dead_code, reason = "the part that is needed here")]
mod wire;

use crate::{byte, chunk};
use sercos::header::{CommunicationPhase, HEADER, RingChannel, TelegramHeader, TelegramKind};
use sercos::{PortSide, Stage};
use wire::Wire;

/// The first byte chooses the ring; then telegrams: a byte that chooses the head, and perhaps the end it comes from.
pub(crate) fn telegram(mut bytes: &[u8]) {
    let Some(first) = byte(&mut bytes) else { return };
    let mut wire = Wire::new(&[3, 7, 12], first & 1 == 0);
    let until = if first & 2 == 0 { Stage::Running } else { Stage::Starting(CommunicationPhase::Cp2) };
    for _ in 0..2000 {
        if wire.cycle() == until {
            break;
        }
    }
    while let Some(head) = byte(&mut bytes) {
        let cycle = byte(&mut bytes).unwrap_or(0);
        let data = chunk(&mut bytes, 6);
        let frame = if head == 0xff { data.to_vec() } else { telegram_of(head, cycle, data) };
        let (port, end) = if cycle & 0x80 == 0 { (0, PortSide::Left) } else { (1, PortSide::Right) };
        wire.master.begin();
        wire.master.take(port, &frame);
        wire.chain.take(end, &frame, &mut |side, frame| {
            wire.master.take(if side == PortSide::Left { 0 } else { 1 }, frame);
        });
        wire.master.end();
        if cycle & 0x40 != 0 {
            wire.cycle();
        }
    }
    for _ in 0..5 {
        wire.cycle();
    }
}

/// A telegram with a right head.
fn telegram_of(head: u8, cycle: u8, data: &[u8]) -> Vec<u8> {
    let mut frame = vec![0; HEADER];
    frame.extend(data);
    let header = TelegramHeader {
        source: wire::MACS[0],
        channel: if head & 1 == 0 { RingChannel::P } else { RingChannel::S },
        kind: if head & 2 == 0 { TelegramKind::At } else { TelegramKind::Mdt },
        number: head >> 2 & 3,
        phase: CommunicationPhase::ALL[usize::from(head >> 4 & 7) % CommunicationPhase::ALL.len()],
        switching: head & 0x80 != 0,
        cycle: Some(cycle & 7),
    };
    header.write(&mut frame);
    frame
}

pub(crate) fn seeds() -> Vec<Vec<u8>> {
    let telegrams = |ring: u8| {
        let mut bytes = vec![ring];
        for head in [0x00, 0x02, 0x12, 0x20, 0x22, 0x32, 0x42, 0x40, 0xc2, 0xff] {
            bytes.extend([head, head >> 3 | 0x40, 20]);
            bytes.extend((0..120).map(|n| if n % 7 == 0 { n } else { 0 }));
        }
        bytes
    };
    (0..4).map(telegrams).collect()
}
