//! Files of can-utils: what `candump -l` and `candump -L` write and `canplayer` and `log2asc` read.
//!
//! Reading is strict: a file with one broken line is refused as a whole, and the error names all of them, because
//! traffic that is not complete must not move a robot. [`Strictness::Lenient`] leaves broken lines out and tells.

use crate::candump_line;
use crate::capture::Capture;
use std::fmt;
use std::io::{self, BufRead, Read, Write};
use std::path::{Path, PathBuf};

/// \[B\] Longest line that is looked at; the longest frame needs 170.
const LONGEST_LINE: u64 = 4096;
/// Broken lines that an error shows.
const SHOWN: usize = 10;

/// What is done with a file that has broken lines.
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
    /// What is wrong with it.
    pub why: String,
}

/// All broken lines of a file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BrokenLines {
    /// The file.
    pub path: PathBuf,
    /// The first of them.
    pub first: Vec<BrokenLine>,
    /// How many there are.
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

/// Why a file was not read.
#[derive(Debug)]
pub enum CandumpError {
    /// It could not be opened or read.
    Read(PathBuf, io::Error),
    /// It has broken lines.
    Broken(BrokenLines),
    /// There is no frame in it.
    Empty(PathBuf),
}

impl fmt::Display for CandumpError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read(path, e) => write!(f, "{}: cannot read it: {e}", path.display()),
            Self::Broken(broken) => write!(
                f,
                "{broken}\nNothing was done. Repair the file, or take what can be read with --lenient."
            ),
            Self::Empty(path) => write!(
                f,
                "{}: no frame in it; candump -l or `gangwerk can record` write such files",
                path.display()
            ),
        }
    }
}

impl std::error::Error for CandumpError {}

/// Reads a file; frames come in the order of time, see [`Capture::sort`]. Also returns what was left out: nothing
/// with [`Strictness::Strict`].
///
/// # Errors
/// It cannot be read, has broken lines, or no frame at all.
pub fn read(path: &Path, strictness: Strictness) -> Result<(Capture, BrokenLines), CandumpError> {
    let unreadable = |e| CandumpError::Read(path.into(), e);
    let file = std::fs::File::open(path).map_err(unreadable)?;
    let (mut capture, mut broken) = parse(io::BufReader::new(file)).map_err(unreadable)?;
    broken.path = path.into();
    if broken.count > 0 && strictness == Strictness::Strict {
        return Err(CandumpError::Broken(broken));
    }
    if capture.frames.is_empty() {
        return Err(CandumpError::Empty(path.into()));
    }
    capture.sort();
    Ok((capture, broken))
}

/// Reads lines, frames in the order of the lines.
///
/// # Errors
/// Reading failed.
pub fn parse(mut from: impl BufRead) -> io::Result<(Capture, BrokenLines)> {
    let mut reader = LineReader::default();
    let mut line = Vec::new();
    while reader.next_line(&mut from, &mut line)? {
        reader.take(&line);
    }
    reader.broken.of = reader.number;
    Ok((reader.capture, reader.broken))
}

/// What has been read so far.
#[derive(Default)]
struct LineReader {
    capture: Capture,
    broken: BrokenLines,
    number: usize,
    /// Newest time of each interface \[ns\].
    newest: Vec<u64>,
}

impl LineReader {
    /// The next line without its end; `false` at the end of the file. Of a line that never ends the beginning.
    fn next_line(&mut self, from: &mut impl BufRead, line: &mut Vec<u8>) -> io::Result<bool> {
        line.clear();
        if from.by_ref().take(LONGEST_LINE).read_until(b'\n', line)? == 0 {
            return Ok(false);
        }
        let whole = line.last() == Some(&b'\n') || (line.len() as u64) < LONGEST_LINE;
        if !whole {
            skip_line(from)?;
        }
        self.number += 1;
        Ok(true)
    }

    fn take(&mut self, line: &[u8]) {
        let text = String::from_utf8_lossy(line);
        let text = text.trim_end_matches(['\n', '\r']);
        if text.trim().is_empty() {
            return;
        }
        match candump_line::parse(text) {
            Ok((name, mut frame)) => {
                frame.line = self.capture.line(name);
                self.newest.resize(self.capture.lines.len(), 0);
                let newest = &mut self.newest[frame.line as usize];
                if frame.time_ns < *newest {
                    let back = (*newest - frame.time_ns) as f64 * 1e-9;
                    let why =
                        format!("time of {name} goes back by {back:.6} s: was the clock set meanwhile?");
                    return self.broken.add(self.number, text, why);
                }
                *newest = frame.time_ns;
                self.capture.frames.push(frame);
            }
            Err(why) => self.broken.add(self.number, text, why),
        }
    }
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

/// Writes the lines of a recording.
pub struct Writer<W: Write> {
    to: W,
    width: usize,
    text: String,
}

impl<W: Write> Writer<W> {
    /// A writer for frames of these interfaces.
    pub fn new<S: AsRef<str>>(to: W, lines: &[S]) -> Self {
        let width = lines.iter().map(|name| name.as_ref().len()).max().unwrap_or(0);
        Self { to, width, text: String::new() }
    }

    /// Writes one frame of the interface `name`.
    ///
    /// # Errors
    /// Writing failed.
    pub fn write(&mut self, name: &str, frame: &crate::Captured) -> io::Result<()> {
        self.text.clear();
        candump_line::write(&mut self.text, name, self.width, frame);
        self.text.push('\n');
        self.to.write_all(self.text.as_bytes())
    }

    /// Hands everything to the operating system.
    ///
    /// # Errors
    /// Writing failed.
    pub fn finish(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}

/// Writes a whole recording.
///
/// # Errors
/// Writing failed.
pub fn write(to: impl Write, capture: &Capture) -> io::Result<()> {
    let mut writer = Writer::new(to, &capture.lines);
    for frame in &capture.frames {
        writer.write(&capture.lines[frame.line as usize], frame)?;
    }
    writer.finish()
}
