//! Datagrams of a vision system at the gate of `gangwerk gateway`.

use std::net::SocketAddr;

use gateway::gate::Gate;
use gateway::wire::Datagram;
use messages::command_text::CommandInfo;

use crate::{byte, chunk};

/// \[ns\] Stamp of the trigger that is answered.
const STAMP: u64 = 1_000_000_000;

/// Datagrams, each behind its length in words of eight bytes, a byte of them fewer at a time, from one of four senders.
pub(crate) fn datagram(mut bytes: &[u8]) {
    let (mut gate, mut now, mut offered, mut admitted) = (Gate::default(), STAMP, 0, 0_u64);
    gate.triggered(STAMP);
    while let Some(first) = byte(&mut bytes) {
        let whole = chunk(&mut bytes, 8);
        let datagram = &whole[..whole.len().saturating_sub(usize::from(first >> 4 & 7))];
        now += u64::from(first) << 20;
        let from = SocketAddr::from(([127, 0, 0, 1], u16::from(first & 3)));
        if let Ok(command) = gate.admit(datagram, from, now) {
            admitted += 1;
            assert_eq!(command.check(), Ok(()), "out of its range");
            let again = Datagram::decode(datagram).ok().and_then(|d| d.encode());
            assert_eq!(again.as_deref(), Some(datagram));
        }
        offered += 1;
    }
    assert_eq!(admitted + gate.refused.iter().sum::<u64>(), offered, "each is counted once");
}

pub(crate) fn seeds() -> Vec<Vec<u8>> {
    let told = |name: &str, values: &[f64], sequence: u64| {
        let command = CommandInfo::find(name)?.command(values).ok()?;
        Datagram { sender: 7, sequence, stamp: STAMP, command }.encode()
    };
    let all: Vec<Vec<u8>> = [
        told("walk/velocity", &[0.3, 0.0, 0.1], 1),
        told("head/fixate", &[3.0, 0.5, 1.2], 2),
        told("vision/box", &[7.0, 1.5, 0.2, 0.0, 0.3, 0.06, 1.2, 0.1, 2.0], 3),
        told("vision/gone", &[7.0], 4),
    ]
    .into_iter()
    .flatten()
    .collect();
    assert!(all.len() == 4 && all.iter().all(|d| Datagram::decode(d).is_ok()));
    let framed = |d: &Vec<u8>| [&[0, (d.len() / 8) as u8][..], d].concat();
    vec![all.iter().flat_map(framed).collect(), all.iter().rev().flat_map(framed).collect()]
}
