//! One line of a candump log: `(sec.usec) interface ID#DATA`, and its parts.
//!
//! | part | written as |
//! |---|---|
//! | time | seconds in ten digits, six digits behind the point; read are nine, too |
//! | identifier | 3 hex digits: 11 bits; 8: 29 bits, or an error frame if bit 29 is set |
//! | classic data | `#` and up to 8 bytes; behind 8 bytes perhaps `_` and the length code 9 to F |
//! | remote frame | `#R` and the bytes it asks for, none if 0 |
//! | CAN FD | `##`, one digit of flags, up to 64 bytes |
//! | way | ` R` or ` T` at the end, of `candump -x` |

use crate::capture::{
    BASE_BITS, CLASSIC_BYTES, CaptureDirection, Captured, ERROR, EXTENDED, EXTENDED_BITS, FD_LENGTHS,
    FrameType, REMOTE,
};
use std::fmt::Write;

/// \[B\] Longest name of a Linux interface.
const LONGEST_NAME: usize = 15;

type Parsed<T> = Result<T, String>;

/// A line's frame and the name of its interface.
///
/// # Errors
/// Problem of the line.
pub fn parse(text: &str) -> Parsed<(&str, Captured)> {
    let mut words = text.split_ascii_whitespace();
    let time_ns = words.next().map_or_else(|| Err("the line is empty".into()), time)?;
    let name = interface(words.next().ok_or("it ends behind the time: interface and frame are missing")?)?;
    let frame = words.next().ok_or("it ends behind the interface: the frame is missing")?;
    let way = words.next().map(way).transpose()?;
    if let Some(more) = words.next() {
        return Err(format!("`{more}` stands behind the end of the frame"));
    }
    let (id, len, data, form) = parse_frame(frame)?;
    Ok((name, Captured { time_ns, line: 0, id, len, data, form, way }))
}

/// `(sec.usec)` in nanoseconds.
fn time(word: &str) -> Parsed<u64> {
    let wrong = || format!("`{word}` is not a time: (seconds.microseconds) begins every line");
    let inner = word.strip_prefix('(').and_then(|w| w.strip_suffix(')')).ok_or_else(wrong)?;
    let (seconds, fraction) = inner.split_once('.').ok_or_else(wrong)?;
    let scale = match fraction.len() {
        6 => 1000,
        9 => 1,
        _ => return Err(format!("`{word}`: six digits must stand behind the point (or nine, nanoseconds)")),
    };
    let seconds = decimal(seconds).ok_or_else(wrong)?;
    let fraction = decimal(fraction).ok_or_else(wrong)?;
    seconds
        .checked_mul(1_000_000_000)
        .and_then(|ns| ns.checked_add(fraction * scale))
        .ok_or_else(|| format!("`{word}` is later than any clock tells"))
}

/// Digits only: Rust's own parser also takes a sign.
fn decimal(text: &str) -> Option<u64> {
    text.bytes().all(|b| b.is_ascii_digit()).then(|| text.parse().ok())?
}

fn interface(word: &str) -> Parsed<&str> {
    let fits = word.len() <= LONGEST_NAME && !word.contains(['/', '#', '(', ')']);
    fits.then_some(word)
        .ok_or_else(|| format!("`{word}` is not the name of an interface (at most {LONGEST_NAME} letters)"))
}

fn way(word: &str) -> Parsed<CaptureDirection> {
    match word {
        "R" => Ok(CaptureDirection::Received),
        "T" => Ok(CaptureDirection::Sent),
        _ => Err(format!("`{word}` stands behind the frame: only R (received) or T (sent) may")),
    }
}

type FrameParts = (u32, u8, [u8; 64], FrameType);

/// `ID#DATA`, `ID#R4`, `ID##1DATA`.
fn parse_frame(word: &str) -> Parsed<FrameParts> {
    let (id, rest) = word.split_once('#').ok_or_else(|| format!("`{word}` is not a frame: it has no #"))?;
    let id = identifier(id)?;
    match rest.strip_prefix('#') {
        Some(fd) => parse_fd(id, fd),
        None => match rest.strip_prefix('R') {
            Some(remote) => parse_remote(id, remote),
            None => parse_classic(id, rest),
        },
    }
}

fn identifier(text: &str) -> Parsed<u32> {
    let number = hex_number(text).ok_or_else(|| format!("`{text}` is not an identifier in hex digits"))?;
    match text.len() {
        3 if number <= BASE_BITS => Ok(number),
        3 => Err(format!("identifier {text} has more than 11 bits (at most 7FF)")),
        8 if number & ERROR != 0 && number <= ERROR | EXTENDED_BITS => Ok(number),
        8 if number <= EXTENDED_BITS => Ok(number | EXTENDED),
        8 => Err(format!("identifier {text} has more than 29 bits (at most 1FFFFFFF)")),
        n => Err(format!("identifier {text} has {n} hex digits: 3 (11 bits) or 8 (29 bits, error frames)")),
    }
}

/// Up to eight hex digits; Rust's own parser also takes a sign.
fn hex_number(text: &str) -> Option<u32> {
    (!text.is_empty() && text.len() <= 8 && text.bytes().all(|b| b.is_ascii_hexdigit()))
        .then(|| u32::from_str_radix(text, 16).ok())?
}

fn parse_fd(id: u32, text: &str) -> Parsed<FrameParts> {
    if id & ERROR != 0 {
        return Err("an error frame cannot be a CAN FD frame".into());
    }
    let flags = text.get(..1).and_then(hex_number).ok_or("behind ## one hex digit of flags is missing")?;
    let (len, data) = bytes(&text[1..], 64)?;
    if !FD_LENGTHS.contains(&len) {
        return Err(format!("no CAN FD frame has {len} bytes (0 to 8, 12, 16, 20, 24, 32, 48, 64)"));
    }
    Ok((id, len as u8, data, FrameType::Fd { flags: flags as u8 }))
}

fn parse_remote(id: u32, text: &str) -> Parsed<FrameParts> {
    if id & ERROR != 0 {
        return Err("an error frame cannot be a remote frame".into());
    }
    let len = if text.is_empty() { Some(0) } else { hex_number(text) };
    match len {
        Some(len) if len <= 8 && text.len() <= 1 => Ok((id | REMOTE, len as u8, [0; 64], FrameType::CLASSIC)),
        _ => Err(format!("`R{text}`: a remote frame asks for 0 to 8 bytes")),
    }
}

fn parse_classic(id: u32, text: &str) -> Parsed<FrameParts> {
    let (hex, code) = match text.split_once('_') {
        None => (text, 0),
        Some((hex, code)) => match hex_number(code) {
            Some(code @ 9..=15) if hex.len() == 2 * CLASSIC_BYTES => (hex, code as u8),
            _ => return Err(format!("`_{code}`: only behind 8 bytes, and 9 to F")),
        },
    };
    let (len, data) = bytes(hex, CLASSIC_BYTES)?;
    if id & ERROR != 0 && len != CLASSIC_BYTES {
        return Err(format!("an error frame has 8 bytes, not {len}"));
    }
    Ok((id, len as u8, data, FrameType::Classic { code }))
}

/// Bytes in hex digits, at most `most` of them.
fn bytes(text: &str, most: usize) -> Parsed<(usize, [u8; 64])> {
    let digits = text.as_bytes();
    if let Some(wrong) = text.chars().find(|c| !c.is_ascii_hexdigit()) {
        return Err(format!("`{wrong}` in the data is not a hex digit"));
    }
    let len = digits.len() / 2;
    if !digits.len().is_multiple_of(2) {
        return Err(format!("the data end in the middle of a byte ({} hex digits)", digits.len()));
    }
    if len > most {
        return Err(format!("{len} bytes of data, at most {most}"));
    }
    let mut data = [0; 64];
    for (byte, pair) in data.iter_mut().zip(digits.chunks_exact(2)) {
        *byte = 16 * nibble(pair[0]) + nibble(pair[1]);
    }
    Ok((len, data))
}

/// Value of a hex digit.
fn nibble(digit: u8) -> u8 {
    match digit {
        b'0'..=b'9' => digit - b'0',
        _ => (digit | 0x20) - b'a' + 10,
    }
}

/// Appends the line of a frame as `candump -L` writes it, without line end; names are filled up to `width` letters
/// from the left, as candump does for several interfaces. Parts of a microsecond are cut off.
pub fn write(text: &mut String, name: &str, width: usize, frame: &Captured) {
    let micros = frame.time_ns / 1000;
    let (seconds, micros) = (micros / 1_000_000, micros % 1_000_000);
    let _ = write!(text, "({seconds:010}.{micros:06}) {name:>width$} ");
    write_frame(text, frame);
    match frame.way {
        Some(CaptureDirection::Received) => text.push_str(" R"),
        Some(CaptureDirection::Sent) => text.push_str(" T"),
        None => {}
    }
}

/// Appends `ID#DATA`.
pub(crate) fn write_frame(text: &mut String, frame: &Captured) {
    let id = frame.id;
    let _ = match id {
        _ if id & ERROR != 0 => write!(text, "{:08X}#", id & (ERROR | EXTENDED_BITS)),
        _ if id & EXTENDED != 0 => write!(text, "{:08X}#", id & EXTENDED_BITS),
        _ => write!(text, "{:03X}#", id & BASE_BITS),
    };
    if id & (REMOTE | ERROR) == REMOTE {
        text.push('R');
        if frame.len > 0 {
            let _ = write!(text, "{:X}", frame.len);
        }
        return;
    }
    if let FrameType::Fd { flags } = frame.form {
        let _ = write!(text, "#{:X}", flags & 0xf);
    }
    for byte in frame.payload() {
        let _ = write!(text, "{byte:02X}");
    }
    if let FrameType::Classic { code: code @ 9..=15 } = frame.form {
        let _ = write!(text, "_{code:X}");
    }
}
