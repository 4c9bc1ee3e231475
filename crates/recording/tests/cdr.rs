//! CDR against bytes written by hand from the rules of XCDR1, and every record there and back.

use messages::record::{Field, Read, Visit, Zero};
use messages::topics::{ForType, with_type};
use messages::{Event, Frame, Header, Record, TOPICS, Topic, record};
use proptest::prelude::*;
use recording::cdr::{CdrDecoder, CdrEncoder, decode};
use recording::definition::definition;

record! {
    /// One of everything, in the order that needs most padding.
    part Mixed {
        /// \[1\]
        a: u8,
        /// \[1\]
        b: u32,
        /// \[1\]
        c: u8,
        /// \[1\]
        d: f64,
        /// \[1\]
        e: [u8; 3],
        /// \[1\]
        f: [u32; 2],
        /// \[1\]
        g: u64,
    }
}

const MIXED: Mixed = Mixed { a: 1, b: 0x0203_0405, c: 6, d: 1.0, e: [7, 8, 9], f: [10, 11], g: 12 };

/// Each scalar aligned to its size, counted behind the encapsulation header.
#[rustfmt::skip]
const MIXED_BYTES: [u8; 52] = [
    0, 1, 0, 0,
    1, 0, 0, 0,                   // a, 3 of padding
    5, 4, 3, 2,                   // b
    6, 0, 0, 0, 0, 0, 0, 0,       // c, 7 of padding
    0, 0, 0, 0, 0, 0, 0xf0, 0x3f, // d
    7, 8, 9, 0,                   // e, 1 of padding
    10, 0, 0, 0, 11, 0, 0, 0,     // f
    0, 0, 0, 0,                   // padding from 36 to 40
    12, 0, 0, 0, 0, 0, 0, 0,      // g
];

#[test]
fn scalars_are_aligned_to_their_size() {
    assert_eq!(CdrEncoder::new().encode(&MIXED), MIXED_BYTES);
    assert_eq!(decode::<Mixed>(&MIXED_BYTES), Some(MIXED));
}

#[test]
fn strings_sequences_and_times() {
    #[rustfmt::skip]
    let expected = [
        0, 1, 0, 0,
        4, 0, 0, 0, b'a', b'b', b'c', 0,  // the count holds the closing zero
        1, 0, 0, 0, 0, 0, 0, 0,           // one element; padding from 12 to 16
        0, 0, 0, 0, 0, 0, 0, 0x40,        // 2.0
        3, 0, 0, 0, 4, 0, 0, 0,           // 3 s, 4 ns
    ];
    let mut e = CdrEncoder::new();
    e.begin().string("abc");
    e.count(1);
    e.f64(2.0);
    e.stamp(3_000_000_004);
    assert_eq!(e.payload(), expected);
    let mut d = CdrDecoder::new(e.payload()).unwrap();
    assert_eq!((d.string(), d.u32(), d.f64(), d.i32(), d.u32()), ("abc", 1, 2.0, 3, 4));
    assert_eq!((d.left(), d.ran_dry()), (0, false));
}

#[test]
fn payloads_of_the_wrong_length_are_refused() {
    for n in 0..MIXED_BYTES.len() {
        assert_eq!(decode::<Mixed>(&MIXED_BYTES[..n]), None, "{n} bytes");
    }
    assert_eq!(decode::<Mixed>(&[&MIXED_BYTES[..], &[0]].concat()), None);
    let mut big_endian = MIXED_BYTES;
    big_endian[1] = 0;
    assert_eq!(decode::<Mixed>(&big_endian), None);
}

#[test]
fn a_string_longer_than_its_payload_is_empty() {
    let mut d = CdrDecoder::new(&[0, 1, 0, 0, 0xff, 0xff, 0xff, 0xff, b'a', 0]).unwrap();
    assert_eq!(d.string(), "");
    assert!(d.ran_dry());
}

#[test]
fn definitions_name_every_part_once_with_its_package() {
    let text = definition::<Event>();
    let separator = "=".repeat(80);
    let expected = format!(
        "gangwerk_msgs/Header header\nuint64 code\nuint64 detail\n{separator}\nMSG: gangwerk_msgs/Header\n\
         uint64 tick\nuint64 stamp_ns\nuint64 epoch\n"
    );
    assert_eq!(text, expected);
    for topic in TOPICS {
        with_type(topic.name, PartsOnce);
    }
}

struct PartsOnce;
impl ForType<()> for PartsOnce {
    fn call<T: Record>(self, topic: &'static Topic) {
        let text = definition::<T>();
        let mut parts: Vec<&str> = text.lines().filter(|l| l.starts_with("MSG: ")).collect();
        let all = parts.len();
        parts.sort_unstable();
        parts.dedup();
        assert_eq!(parts.len(), all, "{}", topic.name);
        assert!(parts.contains(&"MSG: gangwerk_msgs/Header"), "{}", topic.name);
    }
}

/// Hands out numbers that depend on the seed and on how many were handed out: no two parts of a record are equal.
struct Counting(u64);
impl Counting {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0
    }
}
impl Read for Counting {
    fn f64(&mut self) -> f64 {
        f64::from_bits(self.next())
    }
    fn u64(&mut self) -> u64 {
        self.next()
    }
    fn u32(&mut self) -> u32 {
        (self.next() >> 32) as u32
    }
    fn u8(&mut self) -> u8 {
        (self.next() >> 56) as u8
    }
}

/// Shows the bits of all scalars, so that NaN equals itself.
#[derive(Default, PartialEq, Debug)]
struct Bits(Vec<u64>);
impl Visit for Bits {
    fn f64(&mut self, value: f64) {
        self.0.push(value.to_bits());
    }
    fn u64(&mut self, value: u64) {
        self.0.push(value);
    }
    fn u32(&mut self, value: u32) {
        self.0.push(value.into());
    }
    fn u8(&mut self, value: u8) {
        self.0.push(value.into());
    }
}

fn bits<T: Field>(value: &T) -> Bits {
    let mut bits = Bits::default();
    value.visit(&mut bits);
    bits
}

struct RoundTrip(u64);
impl ForType<()> for RoundTrip {
    fn call<T: Record>(self, topic: &'static Topic) {
        let record = T::read(&mut Counting(self.0));
        let mut encoder = CdrEncoder::new();
        let payload = encoder.encode(&record);
        let back = decode::<T>(payload).unwrap_or_else(|| panic!("{}: not decoded", topic.name));
        assert_eq!(bits(&back), bits(&record), "{}", topic.name);
        assert_eq!(back.header(), record.header());
        assert!(decode::<T>(&payload[..payload.len() - 1]).is_none());
    }
}

proptest! {
    #[test]
    fn every_record_comes_back_bit_by_bit(seed: u64) {
        for topic in TOPICS {
            with_type(topic.name, RoundTrip(seed));
        }
    }

    #[test]
    fn no_payload_panics(bytes: Vec<u8>) {
        let _ = decode::<Event>(&bytes);
        let _ = CdrDecoder::new(&bytes).map(|mut d| (d.string().len(), d.u8(), d.string().len()));
    }
}

#[test]
fn zero_and_padding_of_the_largest_part() {
    let frame = Frame::ZERO;
    let header = Header { tick: 1, stamp_ns: 2, epoch: 3 };
    assert_eq!(CdrEncoder::new().encode(&frame).len(), 4 + 3 * 4 + 64);
    assert_eq!(decode::<Header>(CdrEncoder::new().encode(&header)), Some(header));
}
