//! Bytes: checksum, heads, words, against values from other programs and against what was written.

use proptest::prelude::*;
use sercos::crc32;
use sercos::device::{Connection, DeviceControl, Idle, Status, Topology};
use sercos::header::{
    CYCLES, CommunicationPhase, HEADER, MAX_DATA, MIN_DATA, Malformed, RingChannel, TelegramHeader,
    TelegramKind,
};
use sercos::idn::{self, Attribute, Idn, ValueShape};
use sercos::layout::{DEVICE, DataPlace, LayoutError, SERVICE, Station, TelegramLayout};
use sercos::telegram::{cp0, cp12};

/// From `zlib.crc32` of Python.
#[test]
fn checksum_is_zlibs() {
    assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
    for (kind, phase, expected) in CRCS {
        let mut bytes = [0xFF; 16];
        bytes[6..12].copy_from_slice(&[2, 0, 0, 0, 0, 1]);
        bytes[12..].copy_from_slice(&[0x88, 0xCD, kind, phase]);
        assert_eq!(crc32(&bytes), expected, "{kind:#x} {phase:#x}");
    }
}

const CRCS: [(u8, u8, u32); 4] = [
    (0x00, 0x00, 0x5bd2_7f7a),
    (0x60, 0x14, 0x24f5_c0a0),
    (0xe1, 0x72, 0xa2bc_adc7),
    (0x20, 0x81, 0x54e9_e86e),
];

fn any_header() -> impl Strategy<Value = TelegramHeader> {
    let kinds = (any::<bool>(), any::<bool>(), 0..4u8, 0..5usize, any::<bool>());
    (any::<[u8; 6]>(), kinds, proptest::option::of(0..CYCLES)).prop_map(|(source, kinds, cycle)| {
        TelegramHeader {
            source,
            channel: if kinds.0 { RingChannel::S } else { RingChannel::P },
            kind: if kinds.1 { TelegramKind::At } else { TelegramKind::Mdt },
            number: kinds.2,
            phase: CommunicationPhase::ALL[kinds.3],
            switching: kinds.4,
            cycle,
        }
    })
}

proptest! {
    #[test]
    fn a_head_reads_as_written(header in any_header(), len in 0..MAX_DATA) {
        let mut frame = vec![0; HEADER + len];
        header.write(&mut frame);
        prop_assert_eq!(TelegramHeader::read(&frame), Ok(header));
    }

    /// Every change of one bit in the first 20 bytes is noticed.
    #[test]
    fn a_wrong_bit_is_noticed(header in any_header(), bit in 0..8 * HEADER) {
        let mut frame = vec![0; HEADER + MIN_DATA];
        header.write(&mut frame);
        frame[bit / 8] ^= 1 << (bit % 8);
        let foreign = (12..14).contains(&(bit / 8));
        let expected = if foreign { Malformed::Foreign } else { Malformed::Checksum };
        prop_assert_eq!(TelegramHeader::read(&frame), Err(expected));
    }

    #[test]
    fn random_bytes_are_no_telegram(frame in proptest::collection::vec(any::<u8>(), 0..1600)) {
        prop_assert!(TelegramHeader::read(&frame).is_err());
    }

    #[test]
    fn a_place_reads_as_written(telegram in 0..4usize, offset in 0..MAX_DATA, mdt in any::<bool>()) {
        let (kind, place) = (if mdt { TelegramKind::Mdt } else { TelegramKind::At }, DataPlace { telegram, offset });
        prop_assert_eq!(DataPlace::read(place.word(kind)), (kind, place));
    }

    /// No two fields share a byte, and all are within their telegrams.
    #[test]
    fn a_layout_has_no_overlap(sizes in proptest::collection::vec((0..200usize, 0..200usize), 1..40)) {
        let station = |(i, (command, feedback)): (usize, &(usize, usize))| Station {
            address: i as u16 + 1, command: *command, feedback: *feedback,
        };
        let stations: Vec<_> = sizes.iter().enumerate().map(station).collect();
        let Ok(layout) = TelegramLayout::new(&stations) else {
            let most = sizes.iter().map(|s| s.0.max(s.1) + 10).sum::<usize>();
            prop_assert!(most > 3 * MAX_DATA, "{most} bytes were refused");
            return Ok(());
        };
        for kind in [TelegramKind::Mdt, TelegramKind::At] {
            let lengths = if kind == TelegramKind::Mdt { layout.mdt } else { layout.at };
            let mut used = [[false; MAX_DATA]; 4];
            used[0][..8].fill(true);
            for (places, station) in layout.places.iter().zip(&stations) {
                let fields = match kind {
                    TelegramKind::Mdt => [(places.mdt_service, SERVICE), (places.control, DEVICE), (places.command, 2 + station.command)],
                    TelegramKind::At => [(places.at_service, SERVICE), (places.status, DEVICE), (places.feedback, 2 + station.feedback)],
                };
                for (place, len) in fields {
                    prop_assert!(place.offset + len <= lengths[place.telegram]);
                    for byte in &mut used[place.telegram][place.offset..place.offset + len] {
                        prop_assert!(!std::mem::replace(byte, true));
                    }
                }
            }
        }
    }
}

/// S-0-1002 is 0x000003EA; structure instance and element are the two bytes above.
#[test]
fn numbers_of_parameters() {
    assert_eq!(idn::CYCLE_TIME, Idn(0x3EA));
    assert_eq!(idn::connection(1, 5), Idn(0x0105_041A));
    assert_eq!(idn::connection(1, 5).to_string(), "S-0-1050.1.5");
    assert_eq!(Idn(0x0000_8001).to_string(), "P-0-0001.0.0");
    let attribute = Attribute::new(ValueShape::Long, false, true, false, false);
    assert_eq!(attribute, Attribute(0x6002_0001), "four bytes, write-protected in CP3 and CP4");
    assert_eq!(attribute.shape(), Some(ValueShape::Long));
    assert!(
        !attribute.protected_in(CommunicationPhase::Cp2) && attribute.protected_in(CommunicationPhase::Cp4)
    );
}

#[test]
fn words_of_devices_and_connections() {
    let status = Status::new(true, Topology::LoopP, Idle::S, true);
    assert_eq!(status.0, 0x5D00);
    assert_eq!((status.topology(), status.idle()), (Some(Topology::LoopP), Idle::S));
    let control = DeviceControl::default().with(true, true);
    assert_eq!(control.0, 0x0900);
    let control = control.command(Topology::LoopS);
    assert_eq!(control.0, 0x6900);
    assert_eq!(control.command(Topology::Through).0, 0x0900, "the toggle goes back");
    let mut connection = Connection::default();
    let words: Vec<_> = (0..17)
        .map(|_| {
            connection = connection.next();
            connection.0
        })
        .collect();
    assert_eq!(words[..3], [0x1003, 0x2001, 0x3003]);
    assert_eq!(words[15..], [0x0001, 0x1003], "the counter counts modulo 16");
}

#[test]
fn slaves_enter_their_addresses_in_their_order() {
    let mut at = [0; cp0::AT];
    cp0::clear(&mut at);
    assert_eq!(cp0::enter(&mut at, 3), Some(1));
    assert_eq!(cp0::enter(&mut at, 7), Some(2));
    assert_eq!(at[..8], [3, 0, 3, 0, 7, 0, 0xFF, 0xFF]);
    assert!(cp0::addresses(&at).eq([3, 7]));
    assert_eq!(cp12::LEN, 1280);
    assert_eq!((cp12::service(129), cp12::device(2)), ((1, 6), (0, 776)));
}

#[test]
fn stations_that_cannot_be_served_are_named() {
    let station = |address, command| Station { address, command, feedback: 4 };
    assert_eq!(TelegramLayout::new(&[]), Err(LayoutError::Stations(0)));
    assert_eq!(TelegramLayout::new(&[station(0, 4)]), Err(LayoutError::Address(0)));
    assert_eq!(TelegramLayout::new(&[station(5, 4), station(5, 4)]), Err(LayoutError::Twice(5)));
    let long: Vec<_> = (1..=5).map(|a| station(a, 1400)).collect();
    assert_eq!(TelegramLayout::new(&long), Err(LayoutError::Full(TelegramKind::Mdt)));
    assert!(TelegramLayout::new(&long[..4]).is_ok());
}
