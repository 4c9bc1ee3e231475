//! Files of can-utils: what `candump -l` and `candump -L` write and `canplayer` and `log2asc` read.

use crate::candump_line;
use crate::capture::{Capture, Captured};
use crate::text_log::{self, BrokenLines, Format};
use std::borrow::Cow;
use std::io::{self, BufRead, Write};

/// Lines of a candump log: each is a frame.
#[derive(Default)]
struct Candump;

impl Format for Candump {
    fn line<'a>(&mut self, text: &'a str) -> Result<Option<(Cow<'a, str>, Captured)>, String> {
        candump_line::parse(text).map(|(name, frame)| Some((name.into(), frame)))
    }
}

/// Reads lines, frames in the order of the lines.
///
/// # Errors
/// Reading failed.
pub fn parse(from: impl BufRead) -> io::Result<(Capture, BrokenLines)> {
    text_log::parse(from, Candump)
}

/// Writes the lines of a recording.
pub struct CandumpWriter<W: Write> {
    to: W,
    width: usize,
    text: String,
}

impl<W: Write> CandumpWriter<W> {
    /// A writer for frames of these interfaces.
    pub fn new<S: AsRef<str>>(to: W, lines: &[S]) -> Self {
        let width = lines.iter().map(|name| name.as_ref().len()).max().unwrap_or(0);
        Self { to, width, text: String::new() }
    }

    /// Writes one frame of the interface `name`.
    ///
    /// # Errors
    /// Writing failed.
    pub fn write(&mut self, name: &str, frame: &Captured) -> io::Result<()> {
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
    let mut writer = CandumpWriter::new(to, &capture.lines);
    for frame in &capture.frames {
        writer.write(&capture.lines[frame.line as usize], frame)?;
    }
    writer.finish()
}
