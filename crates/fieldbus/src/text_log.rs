//! Recordings as text, whoever wrote them: candump logs, ASC of Vector's tools, TRC of PEAK's.
//!
//! Reading is strict: a file with one broken line is refused as a whole, and the error names all of them, because
//! traffic that is not complete must not move a robot. [`Strictness::Lenient`] leaves broken lines out and tells.

use crate::capture::{Capture, Captured, ERROR, FrameType};
use crate::{asc, candump, trc};
use std::borrow::Cow;
use std::fmt;
use std::io::{self, BufRead, Read};
use std::path::{Path, PathBuf};

/// \[B\] Longest line that is looked at; the longest frame needs less than 400.
const LONGEST_LINE: u64 = 4096;
/// Broken lines that an error shows.
const SHOWN: usize = 10;

/// Handling of a file with broken lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Strictness {
    /// It is refused.
    Strict,
    /// Broken lines are left out.
    Lenient,
}

/// A line that cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BrokenLine {
    /// From 1.
    pub number: usize,
    /// Its beginning.
    pub text: String,
    /// Problem.
    pub why: String,
}

/// All broken lines of a file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BrokenLines {
    /// The file.
    pub path: PathBuf,
    /// The first of them.
    pub first: Vec<BrokenLine>,
    /// Count.
    pub count: usize,
    /// Lines of the file.
    pub of: usize,
}

impl BrokenLines {
    fn add(&mut self, number: usize, text: &str, why: String) {
        self.count += 1;
        if self.first.len() < SHOWN {
            let text = text.chars().take(100).collect();
            self.first.push(BrokenLine { number, text, why });
        }
    }
}

impl fmt::Display for BrokenLines {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} of {} lines are broken:", self.path.display(), self.count, self.of)?;
        for line in &self.first {
            write!(f, "\n  line {}: {}\n    {}", line.number, line.why, line.text)?;
        }
        if self.count > self.first.len() {
            write!(f, "\n  and {} more", self.count - self.first.len())?;
        }
        Ok(())
    }
}

/// Reason for not reading a file.
#[derive(Debug)]
pub enum TextLogError {
    /// It could not be opened or read.
    Read(PathBuf, io::Error),
    /// It has broken lines.
    Broken(BrokenLines),
    /// There is no frame in it.
    Empty(PathBuf),
    /// It is no text: a binary log of Vector's tools.
    Binary(PathBuf),
}

impl fmt::Display for TextLogError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read(path, e) => write!(f, "{}: cannot read it: {e}", path.display()),
            Self::Broken(broken) => write!(
                f,
                "{broken}\nNothing was done. Repair the file, or take what can be read with --lenient."
            ),
            Self::Empty(path) => write!(
                f,
                "{}: no frame in it; candump -l and `gangwerk can record` write such files",
                path.display()
            ),
            Self::Binary(path) => write!(
                f,
                "{}: this is a binary log (BLF); python-can makes text of it: python3 -m can.logconvert {} {}",
                path.display(),
                path.display(),
                path.with_extension("log").display()
            ),
        }
    }
}

impl std::error::Error for TextLogError {}

/// Reads a file, in whichever of the formats it is; frames come in the order of time, see [`Capture::sort`]. Also returns
/// what was left out: nothing with [`Strictness::Strict`].
///
/// # Errors
/// It cannot be read, is binary, has broken lines, or no frame at all.
pub fn read(path: &Path, strictness: Strictness) -> Result<(Capture, BrokenLines), TextLogError> {
    let unreadable = |e| TextLogError::Read(path.into(), e);
    let mut from = io::BufReader::new(std::fs::File::open(path).map_err(unreadable)?);
    let begin = from.fill_buf().map_err(unreadable)?;
    let first = String::from_utf8_lossy(begin).trim_start().chars().take(5).collect::<String>();
    // By how it begins, else by its ending.
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
    let ends = |with: &str| ending.as_ref().is_some_and(|ending| ending == with);
    let (mut capture, mut broken) = match first.to_ascii_lowercase().as_str() {
        // Vector's binary format, which is named BLF and begins with LOGG.
        first if first.starts_with("logg") => return Err(TextLogError::Binary(path.into())),
        first if ends("trc") || first.starts_with(';') => trc::parse(from),
        "date " | "base " => asc::parse(from),
        _ if ends("asc") => asc::parse(from),
        _ => candump::parse(from),
    }
    .map_err(unreadable)?;
    broken.path = path.into();
    if broken.count > 0 && strictness == Strictness::Strict {
        return Err(TextLogError::Broken(broken));
    }
    if capture.frames.is_empty() {
        return Err(TextLogError::Empty(path.into()));
    }
    capture.sort();
    Ok((capture, broken))
}

/// One format: what a line of it says.
pub(crate) trait Format {
    /// A frame with the name of its interface; none if the line says something else, such as a comment.
    ///
    /// # Errors
    /// Problem of the line.
    fn line<'a>(&mut self, text: &'a str) -> Result<Option<(Cow<'a, str>, Captured)>, String>;
}

/// Reads lines, frames in the order of the lines.
pub(crate) fn parse(mut from: impl BufRead, mut format: impl Format) -> io::Result<(Capture, BrokenLines)> {
    let (mut capture, mut broken) = (Capture::default(), BrokenLines::default());
    let mut line = Vec::new();
    while next_line(&mut from, &mut line)? {
        broken.of += 1;
        let text = String::from_utf8_lossy(&line);
        let text = text.trim_end_matches(['\n', '\r']);
        if text.trim().is_empty() {
            continue;
        }
        match format.line(text) {
            Ok(Some((name, mut frame))) => {
                frame.line = capture.line(&name);
                capture.frames.push(frame);
            }
            Ok(None) => {}
            Err(why) => broken.add(broken.of, text, why),
        }
    }
    Ok((capture, broken))
}

/// The next line; `false` at the end of the file. Of a line that never ends the beginning.
fn next_line(from: &mut impl BufRead, line: &mut Vec<u8>) -> io::Result<bool> {
    line.clear();
    if from.by_ref().take(LONGEST_LINE).read_until(b'\n', line)? == 0 {
        return Ok(false);
    }
    let whole = line.last() == Some(&b'\n') || (line.len() as u64) < LONGEST_LINE;
    if !whole {
        skip_line(from)?;
    }
    Ok(true)
}

fn skip_line(from: &mut impl BufRead) -> io::Result<()> {
    loop {
        let buffer = from.fill_buf()?;
        let (used, end) = match buffer.iter().position(|b| *b == b'\n') {
            Some(at) => (at + 1, true),
            None => (buffer.len(), buffer.is_empty()),
        };
        from.consume(used);
        if end {
            return Ok(());
        }
    }
}

/// An error frame of a tool that keeps no class of it.
pub(crate) fn error_frame() -> Captured {
    Captured { time_ns: 0, line: 0, id: ERROR, len: 8, data: [0; 64], form: FrameType::CLASSIC, way: None }
}

/// `12.0345` in units of `10^-digits`; what stands further behind the point is cut off.
pub(crate) fn fixed(word: &str, digits: usize) -> Option<u64> {
    let (whole, fraction) = word.split_once('.')?;
    let both = [whole, &fraction[..fraction.len().min(digits)]];
    if whole.is_empty() || !both.concat().bytes().all(|b| b.is_ascii_digit()) {
        return None;
    }
    format!("{}{:0<digits$}", both[0], both[1]).parse().ok()
}

/// A number without a sign, in base 10 or 16; Rust's own parser also takes a sign.
pub(crate) fn number(word: &str, base: u32) -> Option<u32> {
    let plain = word.chars().all(|c| c.is_digit(base));
    plain.then(|| u32::from_str_radix(word, base).ok())?
}

/// The payload: so many of the words, each a byte.
pub(crate) fn bytes<'a>(
    words: &mut impl Iterator<Item = &'a str>,
    len: usize,
    base: u32,
) -> Result<[u8; 64], String> {
    let mut data = [0; 64];
    for (i, byte) in data.iter_mut().take(len).enumerate() {
        let word = words.next().ok_or_else(|| format!("{i} bytes of data, not {len}"))?;
        let value = number(word, base).and_then(|value| u8::try_from(value).ok());
        *byte = value.ok_or_else(|| format!("`{word}` in the data is not a byte"))?;
    }
    Ok(data)
}
