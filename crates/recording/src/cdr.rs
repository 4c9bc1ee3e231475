//! XCDR1 little endian, the message encoding of ROS 2 bags: how a record becomes bytes and back.
//!
//! A payload begins with the encapsulation header `00 01 00 00`; behind it every scalar is aligned to its own size,
//! counted from the end of that header. Fixed-size arrays and nested structs add nothing; strings carry a `uint32`
//! length that includes the closing zero; sequences carry a `uint32` number of elements.

use messages::record::{Field, Read, Visit};

/// Plain CDR, little endian.
const ENCAPSULATION: [u8; 4] = [0, 1, 0, 0];

/// Writes a payload.
#[derive(Clone, Debug, Default)]
pub struct CdrEncoder {
    bytes: Vec<u8>,
}

impl CdrEncoder {
    /// An encoder that has not allocated yet.
    pub const fn new() -> Self {
        Self { bytes: Vec::new() }
    }

    /// Forgets the last payload, keeps its memory, begins the next one.
    pub fn begin(&mut self) -> &mut Self {
        self.bytes.clear();
        self.bytes.extend_from_slice(&ENCAPSULATION);
        self
    }

    /// The payload so far.
    pub fn payload(&self) -> &[u8] {
        &self.bytes
    }

    /// Begins a payload that consists of one record.
    pub fn encode<T: Field>(&mut self, value: &T) -> &[u8] {
        value.visit(self.begin());
        self.payload()
    }

    fn put<const N: usize>(&mut self, bytes: [u8; N]) {
        let behind_header = self.bytes.len() - ENCAPSULATION.len();
        let padding = behind_header.wrapping_neg() % N;
        self.bytes.extend_from_slice(&[0; 8][..padding]);
        self.bytes.extend_from_slice(&bytes);
    }

    /// A scalar `int32`.
    pub fn i32(&mut self, value: i32) {
        self.put(value.to_le_bytes());
    }

    /// A scalar `float32`.
    pub fn f32(&mut self, value: f32) {
        self.put(value.to_le_bytes());
    }

    /// A `string`.
    pub fn string(&mut self, text: &str) {
        self.count(text.len() + 1);
        self.bytes.extend_from_slice(text.as_bytes());
        self.bytes.push(0);
    }

    /// Number of elements of a sequence; the elements follow.
    pub fn count(&mut self, n: usize) {
        self.u32(n as u32);
    }

    /// Elements without a count: `float64[N]`, or the rest of a sequence.
    pub(crate) fn f64s(&mut self, values: &[f64]) {
        for &x in values {
            self.f64(x);
        }
    }

    /// `builtin_interfaces/Time`.
    pub fn stamp(&mut self, stamp_ns: u64) {
        self.i32((stamp_ns / 1_000_000_000) as i32);
        self.u32((stamp_ns % 1_000_000_000) as u32);
    }
}

impl Visit for CdrEncoder {
    fn f64(&mut self, value: f64) {
        self.put(value.to_le_bytes());
    }
    fn u64(&mut self, value: u64) {
        self.put(value.to_le_bytes());
    }
    fn u32(&mut self, value: u32) {
        self.put(value.to_le_bytes());
    }
    fn u8(&mut self, value: u8) {
        self.bytes.push(value);
    }
    fn sequence(&mut self, len: usize) {
        self.count(len);
    }
}

/// Reads a payload.
#[derive(Clone, Debug)]
pub struct CdrDecoder<'a> {
    body: &'a [u8],
    at: usize,
    dry: bool,
}

impl<'a> CdrDecoder<'a> {
    /// A decoder behind the encapsulation header; `None` if the payload does not begin with ours.
    pub fn new(payload: &'a [u8]) -> Option<Self> {
        let body = payload.strip_prefix(&ENCAPSULATION)?;
        Some(Self { body, at: 0, dry: false })
    }

    fn take<const N: usize>(&mut self) -> [u8; N] {
        let start = self.at + self.at.wrapping_neg() % N;
        match self.body.get(start..start + N) {
            Some(bytes) => {
                self.at = start + N;
                bytes.try_into().unwrap_or([0; N])
            }
            None => {
                self.dry = true;
                [0; N]
            }
        }
    }

    /// A scalar `int32`.
    pub fn i32(&mut self) -> i32 {
        i32::from_le_bytes(self.take())
    }

    /// A `string`; empty if the payload has run dry or the text is not UTF-8.
    pub fn string(&mut self) -> &'a str {
        let n = self.u32() as usize;
        let text = self.at.checked_add(n).and_then(|end| self.body.get(self.at..end));
        match text.and_then(|t| t.strip_suffix(&[0])).map(std::str::from_utf8) {
            Some(Ok(text)) => {
                self.at += n;
                text
            }
            _ => {
                self.dry = true;
                ""
            }
        }
    }

    /// Whether more was asked for than the payload holds.
    pub fn ran_dry(&self) -> bool {
        self.dry
    }

    /// Bytes not asked for yet.
    pub fn left(&self) -> usize {
        self.body.len() - self.at
    }
}

impl Read for CdrDecoder<'_> {
    fn f64(&mut self) -> f64 {
        f64::from_le_bytes(self.take())
    }
    fn u64(&mut self) -> u64 {
        u64::from_le_bytes(self.take())
    }
    fn u32(&mut self) -> u32 {
        u32::from_le_bytes(self.take())
    }
    fn u8(&mut self) -> u8 {
        self.take::<1>()[0]
    }
}

/// The record of a payload; `None` if the payload is shorter or longer than the record.
pub fn decode<T: Field>(payload: &[u8]) -> Option<T> {
    let mut decoder = CdrDecoder::new(payload)?;
    let value = T::read(&mut decoder);
    (!decoder.ran_dry() && decoder.left() == 0).then_some(value)
}
