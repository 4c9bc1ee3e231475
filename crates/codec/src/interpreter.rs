//! Telegrams of the binary interpreter in Elmo's drives: commands of two letters with an index and a number, one frame each.
//!
//! | bytes | contents |
//! |---|---|
//! | 0, 1 | letters, ASCII |
//! | 2, 3 | index, 14 bits, low byte first; bit 6 of byte 3: asks for the number, in an answer: refused; bit 7: the number is a `float` |
//! | 4 to 7 | the number, 32 bits, low byte first; in an answer that refuses, why |
//!
//! A drive answers each command with the same letters and index, and with the number that it now has. Commands go to receive
//! PDO 2 (0x300 + n), answers come as transmit PDO 2 (0x280 + n). Source: Elmo, CANopen DSP 301 implementation guide, binary
//! interpreter. Ours: every telegram has eight bytes, questions and commands without a number too; `BG` has a number.

use messages::Frame;

/// \[byte\] Length of a telegram.
pub const LEN: u32 = 8;
/// \[1\] Largest index.
pub const MOST_INDEX: u16 = 0x3FFF;

/// Points of the table: `QP[1]` to `QP[1024]`.
pub const QP: [u8; 2] = *b"QP";
/// Motion from the table: `MP[1]` first and `MP[2]` last point, `MP[3]` 1: cyclic, `MP[4]` samples from point to point.
pub const MP: [u8; 2] = *b"MP";
/// Table motion, from this point on; takes a begin back that has not come yet.
pub const PT: [u8; 2] = *b"PT";
/// Begin of the motion, with the SYNC whose counter is the number.
pub const BG: [u8; 2] = *b"BG";
/// Stop on the ramp.
pub const ST: [u8; 2] = *b"ST";
/// Variables of the drive; `WS[28]`: sampling period of the position controller \[us\].
pub const WS: [u8; 2] = *b"WS";
/// Index of the sampling period in [`WS`].
pub const SAMPLING: u16 = 28;

/// Reason why a drive refuses a command, as it stands in the place of the number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Refusal {
    /// No such letters.
    Command = 2,
    /// No such index.
    Index = 3,
    /// Number out of range.
    Number = 21,
    /// Only while the motor has torque and stands, or the other way round.
    NotNow = 58,
}

/// One telegram.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Telegram {
    /// Two letters.
    pub letters: [u8; 2],
    /// \[1\] @range 0..=[`MOST_INDEX`]
    pub index: u16,
    /// To a drive: asks for the number. From a drive: refused.
    pub flag: bool,
    /// The number is a single-precision floating point number.
    pub float: bool,
    /// Bits of the number.
    pub bits: u32,
}

impl Telegram {
    /// Command that sets an integer.
    pub const fn set(letters: [u8; 2], index: u16, value: i32) -> Self {
        Self { letters, index, flag: false, float: false, bits: value as u32 }
    }

    /// Command that sets a floating point number.
    pub const fn set_real(letters: [u8; 2], index: u16, value: f32) -> Self {
        Self { letters, index, flag: false, float: true, bits: value.to_bits() }
    }

    /// Question for a number.
    pub const fn ask(letters: [u8; 2], index: u16) -> Self {
        Self { letters, index, flag: true, float: false, bits: 0 }
    }

    /// Answer with an integer.
    pub const fn answer(&self, value: i32) -> Self {
        Self { flag: false, float: false, bits: value as u32, ..*self }
    }

    /// Answer that refuses.
    pub const fn refuse(&self, why: Refusal) -> Self {
        Self { flag: true, float: false, bits: why as u32, ..*self }
    }

    /// The number as an integer.
    pub const fn integer(&self) -> i32 {
        self.bits as i32
    }

    /// Its bytes.
    pub const fn bytes(&self) -> [u8; LEN as usize] {
        let [low, high] = (self.index & MOST_INDEX).to_le_bytes();
        let [a, b, c, d] = self.bits.to_le_bytes();
        let high = high | (self.flag as u8) << 6 | (self.float as u8) << 7;
        [self.letters[0], self.letters[1], low, high, a, b, c, d]
    }

    /// A telegram from its bytes; none if they are fewer or more, or its letters are none.
    pub fn read(bytes: &[u8]) -> Option<Self> {
        let &[x, y, low, high, a, b, c, d] = bytes else { return None };
        (x.is_ascii_uppercase() && y.is_ascii_uppercase()).then(|| Self {
            letters: [x, y],
            index: u16::from_le_bytes([low, high & 0x3F]),
            flag: high >> 6 & 1 == 1,
            float: high >> 7 == 1,
            bits: u32::from_le_bytes([a, b, c, d]),
        })
    }

    /// The same as a frame.
    pub fn frame(&self, line: u32, id: u32) -> Frame {
        let mut frame = Frame { line, id, len: LEN, ..Frame::default() };
        frame.data[..LEN as usize].copy_from_slice(&self.bytes());
        frame
    }

    /// The telegram in a frame, if it is one.
    pub fn of(frame: &Frame) -> Option<Self> {
        Self::read(frame.data.get(..frame.len as usize)?)
    }
}

/// As a person writes it at the drive's terminal: `QP[1]=-7644`, `WS[28]`.
impl std::fmt::Display for Telegram {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [a, b] = self.letters.map(char::from);
        write!(f, "{a}{b}")?;
        if self.index > 0 {
            write!(f, "[{}]", self.index)?;
        }
        match (self.flag, self.float) {
            (true, _) if self.bits > 0 => write!(f, " refused: {}", self.bits),
            (true, _) => Ok(()),
            (_, true) => write!(f, "={}", f32::from_bits(self.bits)),
            (_, false) => write!(f, "={}", self.integer()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `CL[1]` and `AC` are examples of Elmo's guide (pp. 37, 44); `QP[1]` is the first point of an ankle in thesis 6.2.
    #[test]
    fn published_telegrams() {
        let hex = |t: &Telegram| t.bytes().map(|b| format!("{b:02X}")).join(" ");
        assert_eq!(hex(&Telegram::set_real(*b"CL", 1, 1.0)), "43 4C 01 80 00 00 80 3F");
        assert_eq!(hex(&Telegram::set(*b"AC", 0, 150_000)), "41 43 00 00 F0 49 02 00");
        assert_eq!(hex(&Telegram::set(QP, 1, -7644)), "51 50 01 00 24 E2 FF FF");
    }

    #[test]
    fn whatever_is_written_is_read_again() {
        for index in [0, 1, 28, 255, 256, 1024, MOST_INDEX] {
            for bits in [0, 1, 0x8000_0000, u32::MAX, 0xFFFF_E224] {
                for (flag, float) in [(false, false), (true, false), (false, true), (true, true)] {
                    let t = Telegram { letters: QP, index, flag, float, bits };
                    assert_eq!(Telegram::read(&t.bytes()), Some(t));
                    assert_eq!(Telegram::of(&t.frame(1, 0x307)), Some(t));
                }
            }
        }
    }

    #[test]
    fn what_is_no_telegram_is_not_read() {
        let good = Telegram::set(QP, 1, 5).bytes();
        assert!(Telegram::read(&good[..7]).is_none() && Telegram::read(&[]).is_none());
        let mut bent = good;
        bent[1] = 0xD0;
        assert!(Telegram::read(&bent).is_none());
        assert!(Telegram::of(&Frame { len: 99, ..Frame::default() }).is_none(), "longer than a frame");
    }

    #[test]
    fn telegrams_in_words() {
        let words: Vec<String> = [
            Telegram::set(QP, 1, -7644),
            Telegram::ask(WS, SAMPLING),
            Telegram::set_real(*b"CL", 1, 2.5),
            Telegram::set(BG, 0, 0),
            Telegram::set(QP, 2000, 0).refuse(Refusal::Index),
        ]
        .iter()
        .map(Telegram::to_string)
        .collect();
        assert_eq!(words, ["QP[1]=-7644", "WS[28]", "CL[1]=2.5", "BG=0", "QP[2000] refused: 3"]);
    }
}
