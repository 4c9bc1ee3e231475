//! TRC logs of PEAK's tools, versions 1.0 to 2.1; python-can writes 2.1, too.
//!
//! | version | columns |
//! |---|---|
//! | 1.0 | number, time \[ms\], identifier, length code, data |
//! | 1.1 | number, time, direction, identifier, length code, data |
//! | 1.2 | number, time, bus, direction, identifier, length code, data |
//! | 1.3 | the same with a reserved one behind the identifier |
//! | 2.0, 2.1 | as `;$COLUMNS=` says: N number, O time, T type, B bus, I identifier, d direction, R reserved, l length, L code, D data |
//!
//! Times are those since the begin of the measurement. Bus 1 is read as `can0`. States, events and counters of errors are
//! no frames and left out.

use crate::capture::{
    BASE_BITS, CLASSIC_BYTES, Capture, CaptureDirection, Captured, EXTENDED, EXTENDED_BITS, FD_LENGTHS,
    FrameType, REMOTE,
};
use crate::text_log::{self, BrokenLines, Format, bytes, error_frame, fixed, number};
use std::borrow::Cow;
use std::io::{self, BufRead};

/// Reads lines, frames in the order of the lines.
///
/// # Errors
/// Reading failed.
pub fn parse(from: impl BufRead) -> io::Result<(Capture, BrokenLines)> {
    text_log::parse(from, Trc { columns: "NOILD".into() })
}

/// The columns, a letter each; D, the data, stands last.
struct Trc {
    columns: String,
}

impl Format for Trc {
    fn line<'a>(&mut self, text: &'a str) -> Result<Option<(Cow<'a, str>, Captured)>, String> {
        if let Some(comment) = text.trim_start().strip_prefix(';') {
            return self.comment(comment).map(|()| None);
        }
        let mut words = text.split_ascii_whitespace();
        let row: Vec<(char, &str)> = self.columns.chars().filter(|c| *c != 'D').zip(&mut words).collect();
        let of = |column: char| row.iter().find(|(c, _)| *c == column).map(|(_, word)| *word);
        // Milliseconds, with or without parts of them.
        let time = of('O')
            .and_then(|word| fixed(word, 6).or_else(|| Some(u64::from(number(word, 10)?) * 1_000_000)));
        let time_ns = time.ok_or("the time in milliseconds is missing")?;
        let bus = of('B').map_or(Some(1), |word| number(word, 10)).ok_or("the bus is not a number")?;
        let name = format!("can{}", bus.saturating_sub(1));
        let frame = match (of('T'), of('d')) {
            (Some("ER"), _) | (None, Some("Error")) => Some(error_frame()),
            (Some(kind @ ("DT" | "RR" | "FD" | "FB" | "FE" | "BI")), way) => {
                self.frame(kind, way, &of, words)?
            }
            (None, way) => self.frame("DT", way, &of, words)?,
            (Some(kind), _) if kind.len() == 2 && kind.bytes().all(|b| b.is_ascii_uppercase()) => None,
            (Some(kind), _) => return Err(format!("`{kind}` is not a type of lines")),
        };
        Ok(frame.map(|frame| (name.into(), Captured { time_ns, ..frame })))
    }
}

impl Trc {
    /// The version, or the columns.
    fn comment(&mut self, text: &str) -> Result<(), String> {
        if let Some(version) = text.strip_prefix("$FILEVERSION=") {
            let columns = match version.trim() {
                "1.0" => "NOILD",
                "1.1" => "NOdILD",
                "1.2" => "NOBdILD",
                "1.3" => "NOBdIRLD",
                "2.0" | "2.1" => "NOTIdLD",
                other => return Err(format!("version {other} is not known: 1.0 to 1.3, 2.0 and 2.1 are")),
            };
            self.columns = columns.into();
        } else if let Some(columns) = text.strip_prefix("$COLUMNS=") {
            self.columns = columns.chars().filter(char::is_ascii_alphabetic).collect();
        }
        Ok(())
    }

    /// A line with a frame; none if it tells the state of the bus.
    fn frame<'a>(
        &self,
        kind: &str,
        way: Option<&str>,
        of: &impl Fn(char) -> Option<&'a str>,
        data: impl Iterator<Item = &'a str>,
    ) -> Result<Option<Captured>, String> {
        let way = match way {
            Some("Rx") => Some(CaptureDirection::Received),
            Some("Tx") => Some(CaptureDirection::Sent),
            Some("Warng") => return Ok(None),
            Some(other) => return Err(format!("`{other}` stands where Rx or Tx must")),
            None => None,
        };
        let id = match of('I') {
            Some("FFFFFFFF") => return Ok(None), // state of the bus in version 1.0
            Some(word) => identifier(word)?,
            None => return Err("it ends before the identifier".into()),
        };
        let fd = !matches!(kind, "DT" | "RR");
        let len = match (of('l'), of('L')) {
            (Some(len), _) => number(len, 10).map(|len| len as usize),
            (None, Some(code)) => number(code, 10).and_then(|code| FD_LENGTHS.get(code as usize).copied()),
            (None, None) => None,
        };
        let len = len.ok_or("the length is missing")?;
        let code = of('L').and_then(|code| number(code, 10)).unwrap_or(0) as u8;
        let mut data = data.peekable();
        if kind == "RR" || data.peek() == Some(&"RTR") {
            let len = len.min(CLASSIC_BYTES) as u8;
            return Ok(Some(Captured { id: id | REMOTE, len, way, ..error_frame() }));
        }
        let (len, form) = match kind {
            _ if !fd && of('l').is_none() => {
                (len.min(CLASSIC_BYTES), FrameType::Classic { code: if code > 8 { code } else { 0 } })
            }
            _ if !fd => (len, FrameType::CLASSIC),
            "FD" => (len, FrameType::Fd { flags: 4 }),
            "FB" => (len, FrameType::Fd { flags: 4 | 1 }),
            "BI" => (len, FrameType::Fd { flags: 4 | 2 }),
            _ => (len, FrameType::Fd { flags: 4 | 1 | 2 }),
        };
        let most = if fd { 64 } else { CLASSIC_BYTES };
        if len > most || !FD_LENGTHS.contains(&len) {
            return Err(format!("no such frame has {len} bytes"));
        }
        Ok(Some(Captured {
            id,
            len: len as u8,
            data: bytes(&mut data, len, 16)?,
            form,
            way,
            ..error_frame()
        }))
    }
}

/// Four digits: 11 bits; more: 29.
fn identifier(word: &str) -> Result<u32, String> {
    let (most, flag) = if word.len() > 4 { (EXTENDED_BITS, EXTENDED) } else { (BASE_BITS, 0) };
    let id = number(word, 16).filter(|id| *id <= most);
    id.map(|id| id | flag).ok_or_else(|| format!("`{word}` is not an identifier, or longer than it may be"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::candump;

    /// The frames as a candump log without the zeros before the time, and what is broken.
    fn read(text: &str) -> (String, BrokenLines) {
        let (mut capture, broken) = parse(text.as_bytes()).unwrap();
        capture.frames.iter_mut().for_each(|frame| frame.way = None);
        let mut lines = Vec::new();
        candump::write(&mut lines, &capture).unwrap();
        let short = String::from_utf8(lines).unwrap();
        let short: Vec<&str> = short.lines().map(|line| line.trim_start_matches(['(', '0'])).collect();
        (short.join("|"), broken)
    }

    /// A line of each version as PEAK's description of the format shows them.
    #[test]
    fn every_version_is_read() {
        for (text, wanted) in [
            (
                ";  comment\n     1)     1841 0001 8 00 00 00 00 00 00 00 00\n     2) 1900 0300 0\n     3) 2000 FFFFFFFF 4 00 00 00 08\n\
              \n     4) 2100 18EFC034 4 RTR\n",
                "1.841000) can0 001#0000000000000000|1.900000) can0 300#|2.100000) can0 18EFC034#R4",
            ),
            (
                ";$FILEVERSION=1.1\n;$STARTTIME=39878.6772258947\n 1) 1059.9  Rx         0300  7  00 00 00 00 04 00 00\n\
              2) 1283.231 Tx 18EFC034 1 27\n 3) 1300.0 Warng FFFFFFFF 4 00 00 00 08\n",
                "1.059900) can0 300#00000000040000|1.283231) can0 18EFC034#27",
            ),
            (";$FILEVERSION=1.2\n 1) 1059.900 2  Rx 0300  2  00 04\n", "1.059900) can1 300#0004"),
            (
                ";$FILEVERSION=1.3\n 1) 1059.900 1  Rx 0300 -  2  00 04\n 2) 1061.0 1 Error 0008 - 5 00 19 08 08 00\n",
                "1.059900) can0 300#0004|1.061000) can0 20000000#0000000000000000",
            ),
            (
                ";$FILEVERSION=2.0\n;$STARTTIME=43008.920986006946\n;$COLUMNS=N,O,T,I,d,l,D\n 1 1059.900 DT 0300 Rx 7 00 00 00 00 04 00 00\n\
              2 1283.231 FB 18EFC034 Rx 12 01 02 03 04 05 06 07 08 09 0A 0B 0C\n 3 1300.0 ST - Rx 00 00 00 08\n 4 1400.0 RR 0100 Rx 2\n\
              5 1500.0 ER - Rx 5 04 00 02 00 00\n",
                "1.059900) can0 300#00000000040000|1.283231) can0 18EFC034##50102030405060708090A0B0C|1.400000) can0 100#R2|\
              1.500000) can0 20000000#0000000000000000",
            ),
            (
                ";$FILEVERSION=2.1\n;$COLUMNS=N,O,T,B,I,d,R,L,D\n 1 1.0 FE 2 00000300 Tx - 9 01 02 03 04 05 06 07 08 09 0A 0B 0C\n\
              2 2.0 DT 1 0123 Rx - 11 01 02 03 04 05 06 07 08\n 3 3.0 FD 1 0123 Rx - 0\n",
                ".001000) can1 00000300##70102030405060708090A0B0C|.002000) can0 123#0102030405060708_B|.003000) can0 123##4",
            ),
        ] {
            let (frames, broken) = read(text);
            assert_eq!(broken.count, 0, "{text}{broken}");
            assert_eq!(frames, wanted.replace("              ", ""), "{text}");
        }
    }

    #[test]
    fn broken_lines_are_named() {
        for (line, why) in [
            ("garbage", "time in milliseconds"),
            (";$FILEVERSION=9.9", "version 9.9"),
            (" 1) 5", "before the identifier"),
            (" 1) 5 0800 0", "longer than it may be"),
            (" 1) 5 0100 2 00", "1 bytes of data, not 2"),
            (" 1) 5 0100 1 0G", "`0G` in the data"),
            (";$FILEVERSION=1.1\n 1) 5.0 Up 0100 0", "where Rx or Tx must"),
            (
                ";$COLUMNS=N,O,T,I,d,l,D\n 1 5.0 DT 0100 Rx 9 00 00 00 00 00 00 00 00 00",
                "no such frame has 9",
            ),
            (";$COLUMNS=N,O,T,I,d,l,D\n 1 5.0 what 0100 Rx 0", "not a type"),
        ] {
            let (frames, broken) = read(line);
            assert!(
                frames.is_empty() && broken.count == 1 && broken.first[0].why.contains(why),
                "{line}: {broken}"
            );
        }
    }
}
