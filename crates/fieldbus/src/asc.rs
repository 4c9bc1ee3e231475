//! ASC logs, as Vector's tools, can-utils' log2asc and python-can write them.
//!
//! ```text
//! date Thu Apr 20 10:44:05.123 2017
//! base hex  timestamps absolute
//!    0.015991 1  64              Rx   d 8 FF FE 00 00 00 00 00 00  Length = 228000 BitCount = 118 ID = 100
//!    0.020000 1  18EBFF00x       Rx   r 8
//!    0.021000 CANFD   2 Rx   123   Name   1 0 a 16 00 01 …   0 0 3000 0 0 0 0 0
//! ```
//!
//! Times are \[s\] since the begin of the measurement, or since the line before. Channel 1 is read as `can0`, as
//! can-utils does. Behind the data of CAN FD stand duration, length and flags (10 remote, 1000 FD). Other events are no
//! frames and left out.

use crate::capture::{
    BASE_BITS, CLASSIC_BYTES, Capture, CaptureDirection, Captured, EXTENDED, EXTENDED_BITS, FD_LENGTHS,
    FrameType, REMOTE,
};
use crate::text_log::{self, BrokenLines, Format, bytes, error_frame, fixed, number};
use std::borrow::Cow;
use std::io::{self, BufRead};

/// Flag behind the data: a remote frame.
const FLAG_REMOTE: u32 = 0x10;
/// Flag behind the data: CAN FD, not a classic frame.
const FLAG_FD: u32 = 0x1000;
/// Words that begin lines without a time.
const HEADS: [&str; 8] = ["date", "base", "internal", "no", "begin", "end", "previous", "//"];

/// Reads lines, frames in the order of the lines.
///
/// # Errors
/// Reading failed.
pub fn parse(from: impl BufRead) -> io::Result<(Capture, BrokenLines)> {
    text_log::parse(from, Asc { base: 16, relative: false, now_ns: 0 })
}

/// Content of the header, and the column of the time.
struct Asc {
    /// Of identifiers and data: 10 or 16.
    base: u32,
    /// Times are those since the line before.
    relative: bool,
    now_ns: u64,
}

type Frame = Result<Option<(u32, Captured)>, String>;

impl Format for Asc {
    fn line<'a>(&mut self, text: &'a str) -> Result<Option<(Cow<'a, str>, Captured)>, String> {
        let mut words = text.split_ascii_whitespace();
        let first = words.next().unwrap_or_default();
        let Some(stamp) = fixed(first, 9) else { return self.head(first, words) };
        self.now_ns = if self.relative { self.now_ns.saturating_add(stamp) } else { stamp };
        let frame = match words.next().unwrap_or_default() {
            "CANFD" => self.fd(&mut words)?,
            channel => match number(channel, 10) {
                Some(channel) => self.classic(channel, &mut words)?,
                None => None, // "Start of measurement" and the like
            },
        };
        let named = |(channel, frame): (u32, Captured)| {
            let name = format!("can{}", channel.saturating_sub(1));
            (name.into(), Captured { time_ns: self.now_ns, ..frame })
        };
        Ok(frame.map(named))
    }
}

impl Asc {
    /// A line without a time.
    fn head<'a, T>(
        &mut self,
        first: &str,
        words: impl Iterator<Item = &'a str>,
    ) -> Result<Option<T>, String> {
        let head = first.to_ascii_lowercase();
        if !HEADS.iter().any(|known| head == *known || (*known == "//" && head.starts_with("//"))) {
            return Err(format!("`{first}` is neither a time in seconds nor a word of a header"));
        }
        if head == "base" {
            let words: Vec<String> = words.map(str::to_ascii_lowercase).collect();
            self.base = if words.iter().any(|word| word == "dec") { 10 } else { 16 };
            self.relative = words.iter().any(|word| word == "relative");
        }
        Ok(None)
    }

    /// `ID[x] Rx d LENGTH DATA…`, `ID[x] Rx r [LENGTH]`, `ErrorFrame`; statistics and requests to send are no frames.
    fn classic<'a>(&self, channel: u32, words: &mut impl Iterator<Item = &'a str>) -> Frame {
        let id = words.next().ok_or("it ends behind the channel")?;
        if id.eq_ignore_ascii_case("ErrorFrame") {
            return Ok(Some((channel, error_frame())));
        }
        // "Statistic:", "Status:" and the like are no frames.
        if id.ends_with(':') {
            return Ok(None);
        }
        let id = self.identifier(id)?;
        let Some(way) = way(words.next())? else { return Ok(None) };
        let kind = words.next().unwrap_or_default();
        let length = words.next();
        // Classic CAN sends 8 bytes for every length code above 8.
        let code = length.map_or(Some(0), |word| number(word, 16)).filter(|code| *code < 16);
        let code = code.ok_or_else(|| format!("`{}` is not a length code", length.unwrap_or_default()))?;
        let len = CLASSIC_BYTES.min(code as usize);
        let frame = match (kind, length) {
            ("r" | "R", _) => {
                Captured { id: id | REMOTE, len: len as u8, form: FrameType::CLASSIC, ..error_frame() }
            }
            ("d" | "D", Some(_)) => {
                let form = FrameType::Classic { code: if code > 8 { code as u8 } else { 0 } };
                Captured { id, len: len as u8, data: bytes(words, len, self.base)?, form, ..error_frame() }
            }
            _ => return Err(format!("`{kind}`: d and a length, or r must stand behind the direction")),
        };
        Ok(Some((channel, Captured { way: Some(way), ..frame })))
    }

    /// `CHANNEL Rx ID[x] [NAME] BRS ESI CODE LENGTH DATA… DURATION BITS FLAGS …`.
    fn fd<'a>(&self, words: &mut impl Iterator<Item = &'a str>) -> Frame {
        let channel =
            words.next().and_then(|word| number(word, 10)).ok_or("behind CANFD the channel is missing")?;
        let Some(way) = way(words.next())? else { return Ok(None) };
        let id = words.next().unwrap_or_default();
        if id.eq_ignore_ascii_case("ErrorFrame") {
            return Ok(Some((channel, Captured { way: Some(way), ..error_frame() })));
        }
        let id = self.identifier(id)?;
        // A name cannot begin with a digit.
        let switch = words.next().filter(|word| number(word, 10).is_some()).or_else(|| words.next());
        let bit = |word: Option<&str>, what| match word {
            Some("0") => Ok(0),
            Some("1") => Ok(1),
            _ => Err(format!("{what} must be 0 or 1")),
        };
        let switch = bit(switch, "the bit rate switch")?;
        let state = bit(words.next(), "the error state")?;
        let code = words.next().and_then(|word| number(word, 16)).filter(|code| *code < 16);
        let code = code.ok_or("behind the error state the length code is missing")?;
        let len =
            words.next().and_then(|word| number(word, 10)).ok_or("behind the code the length is missing")?;
        let len = usize::try_from(len).ok().filter(|len| FD_LENGTHS.contains(len));
        let len = len.ok_or("no CAN FD frame is that long (0 to 8, 12, 16, 20, 24, 32, 48, 64)")?;
        let data = bytes(words, len, self.base)?;
        let flags = words.nth(2).and_then(|word| number(word, 16)).unwrap_or(FLAG_FD);
        // Such lines hold classic frames, too.
        let (id, len, form) = match flags {
            _ if flags & FLAG_REMOTE != 0 => {
                (id | REMOTE, CLASSIC_BYTES.min(code as usize), FrameType::CLASSIC)
            }
            _ if flags & FLAG_FD != 0 => (id, len, FrameType::Fd { flags: 4 | switch | state << 1 }),
            _ if len > CLASSIC_BYTES => {
                return Err(format!("{len} bytes of data in a classic frame, at most 8"));
            }
            _ => (id, len, FrameType::CLASSIC),
        };
        Ok(Some((channel, Captured { id, len: len as u8, data, form, way: Some(way), ..error_frame() })))
    }

    /// `123`, or with 29 bits `123x`.
    fn identifier(&self, word: &str) -> Result<u32, String> {
        let (digits, most, flag) = match word.strip_suffix(['x', 'X']) {
            Some(digits) => (digits, EXTENDED_BITS, EXTENDED),
            None => (word, BASE_BITS, 0),
        };
        let id = number(digits, self.base).filter(|id| *id <= most);
        id.map(|id| id | flag)
            .ok_or_else(|| format!("`{word}` is not an identifier, or longer than it may be"))
    }
}

/// Direction; none for what was only asked to be sent.
fn way(word: Option<&str>) -> Result<Option<CaptureDirection>, String> {
    match word.unwrap_or_default().to_ascii_lowercase().as_str() {
        "rx" => Ok(Some(CaptureDirection::Received)),
        "tx" => Ok(Some(CaptureDirection::Sent)),
        "txrq" => Ok(None),
        other => Err(format!("`{other}` stands where Rx or Tx must")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::candump;

    /// The frames as a candump log, and what is broken.
    fn read(text: &str) -> (String, BrokenLines) {
        let (mut capture, broken) = parse(text.as_bytes()).unwrap();
        capture.frames.iter_mut().for_each(|frame| frame.way = None);
        let mut lines = Vec::new();
        candump::write(&mut lines, &capture).unwrap();
        (String::from_utf8(lines).unwrap(), broken)
    }

    #[test]
    fn every_form_of_frame_is_read_and_events_are_none() {
        let (frames, broken) = read(
            "date Sat Sep 30 15:06:13.191 2017\r\nbase hex  timestamps absolute\r\n\
            internal events logged\r\n// version 9.0.0\r\nBegin Triggerblock Sat Sep 30 15:06:13.191 2017\r\n   \
            0.000000 Start of measurement\r\n   0.015991 CAN 1 Status:chip status error active\r\n   \
            0.015991 1  Statistic: D 0 R 0 XD 0 XR 0 E 0 O 0 B 0.00%\r\n   \
            2.501000 1  ErrorFrame\r\n   3.013000 1  64              Tx   d 8 00 01 02 03 04 05 06 FF  Length = 0\r\n   \
            3.014 2  18EBFF00x       Rx   d 1 0A\r\n   3.1 1  10  Rx   r\r\n   3.2 1  10  Rx   r 8\r\n   \
            3.3 1 7ff Rx d f 1 2 3 4 5 6 7 8\r\n   3.4 1  10 TxRq d 1 00\r\n  \
            30.506898 CANFD   2 Rx  4EE  A_Name  1 1 9 12 00 01 02 03 04 05 06 07 08 09 0A 0B 0 0 7000 0\r\n  \
            30.6 CANFD   2 Tx   12345678x  0 0 0 0 0 0 1000\r\n  30.7 CANFD 2 Tx 12  0 0 1 1 AA 0 0 0\r\n  \
            30.8 CANFD 2 Tx 12  0 0 8 0 0 0 10\r\n  30.9 CANFD   1 Rx  ErrorFrame Not Acknowledge error\r\nEnd TriggerBlock\r\n",
        );
        assert_eq!(broken.count, 0, "{broken}");
        let wanted = "2.501000 can0 20000000#0000000000000000|3.013000 can0 064#00010203040506FF|3.014000 can1 18EBFF00#0A|\
            3.100000 can0 010#R|3.200000 can0 010#R8|3.300000 can0 7FF#0102030405060708_F|\
            30.506898 can1 4EE##7000102030405060708090A0B|30.600000 can1 12345678##4|30.700000 can1 012#AA|\
            30.800000 can1 012#R8|30.900000 can0 20000000#0000000000000000";
        let short: Vec<String> =
            frames.lines().map(|line| line.trim_start_matches(['(', '0']).replacen(')', "", 1)).collect();
        assert_eq!(short.join("|"), wanted);
    }

    #[test]
    fn decimal_numbers_and_times_since_the_line_before() {
        let (frames, broken) = read(
            "base dec timestamps relative\n0.5 log trigger event\n0.25 1 100 Rx d 2 255 16\n0.25 1 100 Rx d 0\n",
        );
        assert_eq!(broken.count, 0, "{broken}");
        assert_eq!(frames, "(0000000000.750000) can0 064#FF10\n(0000000001.000000) can0 064#\n");
    }

    #[test]
    fn broken_lines_are_named() {
        for (line, why) in [
            ("garbage", "neither a time"),
            ("1.0 1", "ends behind the channel"),
            ("1.0 1 800 Rx d 0", "longer than it may be"),
            ("1.0 1 20000000x Rx d 0", "longer than it may be"),
            ("1.0 1 12 Sx d 0", "where Rx or Tx must"),
            ("1.0 1 12 Rx q 0", "d and a length, or r"),
            ("1.0 1 12 Rx d 2 00", "1 bytes of data, not 2"),
            ("1.0 1 12 Rx d 1 100", "`100` in the data"),
            ("1.0 1 12 Rx d 10", "not a length code"),
            ("1.0 CANFD", "channel is missing"),
            ("1.0 CANFD 1 Rx 12 2 0 0 0", "bit rate switch"),
            ("1.0 CANFD 1 Rx 12 1 0 9 9", "no CAN FD frame"),
            ("1.0 CANFD 1 Rx 12 1 0 9 12 00", "1 bytes of data, not 12"),
        ] {
            let (frames, broken) = read(line);
            assert!(frames.is_empty() && broken.first[0].why.contains(why), "{line}: {broken}");
        }
    }
}
