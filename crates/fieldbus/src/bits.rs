//! Length of a frame on its line: its bits, stuff bits counted one by one.
//!
//! ISO 11898-1. After five equal bits the sender inserts the opposite one, from the start of the frame to the end of
//! its checksum (classic) or of its data (CAN FD, whose checksum has stuff bits at fixed places instead). Behind that
//! stand delimiters, acknowledgement, end of frame and the three bits before the next frame, never stuffed.

use crate::capture::{
    BASE_BITS, BIT_RATE_SWITCH, Captured, ERROR, EXTENDED, EXTENDED_BITS, FD_LENGTHS, FrameType, REMOTE,
};

/// Checksum delimiter, acknowledgement and its delimiter, end of frame (7), intermission (3).
const TAIL: u32 = 1 + 2 + 7 + 3;
/// Generator of the checksum of classic frames, x^15 left out: x^14 + x^10 + x^8 + x^7 + x^4 + x^3 + 1.
const CRC15: u16 = 0x4599;

/// Bits of one frame on the line, by the rate they are sent at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Bits {
    /// \[1\] At the rate of arbitration.
    pub nominal: u32,
    /// \[1\] At the higher rate of CAN FD.
    pub data: u32,
}

impl Bits {
    /// \[s\] Time on the line at these bit rates \[bit/s\].
    pub fn seconds(&self, nominal: f64, data: f64) -> f64 {
        f64::from(self.nominal) / nominal + f64::from(self.data) / data
    }
}

/// A sender's bits with the stuff bits between them.
#[derive(Clone, Copy, Debug)]
struct Stuffed {
    sent: u32,
    last: bool,
    run: u32,
    crc: u16,
    /// The next bit is a stuff bit.
    due: bool,
}

impl Stuffed {
    /// The line is recessive before a frame begins with its dominant bit.
    fn new() -> Self {
        let mut bits = Self { sent: 0, last: true, run: 0, crc: 0, due: false };
        bits.put(0, 1);
        bits
    }

    /// The lowest `count` bits of `value`, highest first.
    fn put(&mut self, value: u32, count: u32) {
        for k in (0..count).rev() {
            let bit = value >> k & 1 == 1;
            let out = (self.crc >> 14 & 1 == 1) != bit;
            self.crc = (self.crc << 1 ^ if out { CRC15 } else { 0 }) & 0x7fff;
            self.send(bit);
        }
    }

    fn send(&mut self, bit: bool) {
        if std::mem::take(&mut self.due) {
            self.sent += 1;
            (self.last, self.run) = (!self.last, 1);
        }
        self.sent += 1;
        self.run = if bit == self.last { self.run + 1 } else { 1 };
        self.last = bit;
        self.due = self.run == 5;
    }

    /// Bits so far; a stuff bit behind the last one is part of them.
    fn closed(&self) -> u32 {
        self.sent + u32::from(self.due)
    }
}

/// The bits of a frame; none of an error frame, whose length depends on who answers it (14 to 23 bits).
pub fn of(frame: &Captured) -> Bits {
    if frame.id & ERROR != 0 {
        return Bits::default();
    }
    match frame.form {
        FrameType::Classic { code } => Bits { nominal: classic(frame, code), data: 0 },
        FrameType::Fd { flags } => fd(frame, flags),
    }
}

fn classic(frame: &Captured, code: u8) -> u32 {
    let mut bits = Stuffed::new();
    let remote = u32::from(frame.id & REMOTE != 0);
    if frame.id & EXTENDED != 0 {
        let id = frame.id & EXTENDED_BITS;
        bits.put(id >> 18, 11);
        bits.put(0b11, 2); // substitute remote request, identifier extension
        bits.put(id, 18);
        bits.put(remote << 2, 3); // remote request, two reserved
    } else {
        bits.put(frame.id & BASE_BITS, 11);
        bits.put(remote << 2, 3); // remote request, no extension, reserved
    }
    bits.put(u32::from(if code > 8 { code } else { frame.len }), 4);
    frame.payload().iter().for_each(|byte| bits.put(u32::from(*byte), 8));
    bits.put(bits.crc.into(), 15);
    bits.closed() + TAIL
}

fn fd(frame: &Captured, flags: u8) -> Bits {
    let mut bits = Stuffed::new();
    if frame.id & EXTENDED != 0 {
        let id = frame.id & EXTENDED_BITS;
        bits.put(id >> 18, 11);
        bits.put(0b11, 2);
        bits.put(id, 18);
    } else {
        bits.put(frame.id & BASE_BITS, 11);
    }
    let switched = flags & BIT_RATE_SWITCH;
    // Remote request substitution (0), in base frames no extension (0), FD (1), reserved (0), bit rate switch.
    let control = if frame.id & EXTENDED != 0 { 4 } else { 5 };
    bits.put(0b0100 | u32::from(switched), control);
    let nominal = bits.sent;
    bits.put(u32::from(flags >> 1 & 1), 1); // error state
    let code = FD_LENGTHS.iter().position(|n| *n == usize::from(frame.len)).unwrap_or(15);
    bits.put(code as u32, 4);
    frame.payload().iter().for_each(|byte| bits.put(u32::from(*byte), 8));
    // Four bits of stuff count, 17 or 21 of checksum; a stuff bit before the first of them and behind every four.
    let checked = 4 + if frame.len > 16 { 21 } else { 17 };
    let behind = bits.sent - nominal + checked + 1 + (checked - 1) / 4;
    if switched == 0 {
        Bits { nominal: nominal + behind + TAIL, data: 0 }
    } else {
        Bits { nominal: nominal + TAIL, data: behind }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(id: u32, data: &[u8], form: FrameType) -> Captured {
        let mut bytes = [0; 64];
        bytes[..data.len()].copy_from_slice(data);
        Captured { time_ns: 0, line: 0, id, len: data.len() as u8, data: bytes, form, way: None }
    }

    /// The check value of CRC-15/CAN in the catalogue of parametrised algorithms: "123456789" gives 059E.
    #[test]
    fn the_checksum_is_that_of_the_catalogue() {
        let mut bits = Stuffed { sent: 0, last: true, run: 0, crc: 0, due: false };
        b"123456789".iter().for_each(|byte| bits.put((*byte).into(), 8));
        assert_eq!(bits.crc, 0x059e);
    }

    /// Without stuff bits: 47 + 8 n for base, 67 + 8 n for extended identifiers, intermission included; at most one
    /// stuff bit for every four bits of what is stuffed.
    #[test]
    fn lengths_lie_between_no_stuff_bit_and_the_worst_case() {
        let mut seed = 1u32;
        let mut random = move || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            seed >> 8
        };
        let (mut least, mut most) = (u32::MAX, 0);
        for i in 0..20_000 {
            let n = (random() % 9) as usize;
            let data: Vec<u8> = (0..n).map(|_| if i % 3 == 0 { 0 } else { random() as u8 }).collect();
            for (id, fixed, stuffed) in
                [(random() & BASE_BITS, 47, 34), (random() & EXTENDED_BITS | EXTENDED, 67, 54)]
            {
                let bits = of(&frame(id, &data, FrameType::CLASSIC)).nominal;
                let bare = fixed + 8 * n as u32;
                assert!(
                    bits >= bare && bits <= bare + (stuffed + 8 * n as u32 - 1) / 4,
                    "{id:x} {data:x?}: {bits}"
                );
                (least, most) = (least.min(bits - bare), most.max(bits - bare));
            }
        }
        assert!(least == 0 && most >= 15, "stuff bits between {least} and {most}");
    }

    /// Counted by hand: identifier 0, no data. 19 dominant bits and checksum 0 are 34 equal bits; each stuff bit breaks
    /// the run, so that one stands behind every five of them: 6.
    #[test]
    fn a_frame_of_zeros_is_stuffed_as_counted_by_hand() {
        assert_eq!(of(&frame(0, &[], FrameType::CLASSIC)).nominal, 47 + 6);
    }

    #[test]
    fn an_fd_frame_of_64_bytes_has_the_bits_of_the_standard() {
        // Alternating bits: no stuff bits in the data. Identifier 555, bits 10101010101, behind dominant start: none.
        let alternating = frame(0x555, &[0x55; 64], FrameType::Fd { flags: BIT_RATE_SWITCH });
        let bits = of(&alternating);
        // Start, identifier, 5 control bits up to the switch, tail; error state, length (1111), data, 25 checked + 7.
        assert_eq!(bits, Bits { nominal: 1 + 11 + 5 + TAIL, data: 1 + 4 + 512 + 32 });
        let slow = of(&frame(0x555, &[0x55; 64], FrameType::Fd { flags: 0 }));
        assert_eq!((slow.nominal, slow.data), (bits.nominal + bits.data, 0));
        assert_eq!(of(&frame(0x555, &[0x55; 16], FrameType::Fd { flags: 1 })).data, 1 + 4 + 128 + 21 + 6);
    }

    #[test]
    fn a_stuff_bit_due_at_the_end_of_the_checksum_is_sent() {
        let mut bits = Stuffed { sent: 0, last: true, run: 0, crc: 0, due: false };
        bits.put(0, 5);
        assert_eq!((bits.sent, bits.closed()), (5, 6));
    }
}
