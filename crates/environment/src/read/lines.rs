//! Text handed to a library line by line, so that its errors, which name no line, can be given one.

use std::io::{BufRead, Read, Result, Seek, SeekFrom};

/// Bytes that end with each line, whatever the reader asks for.
pub(super) struct LineReader<'a> {
    bytes: &'a [u8],
    at: usize,
    /// End of the line `at` lies in.
    end: usize,
    /// Number of the line last handed out, from 1.
    pub(super) line: usize,
}

impl<'a> LineReader<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, at: 0, end: 0, line: 0 }
    }
}

impl BufRead for LineReader<'_> {
    fn fill_buf(&mut self) -> Result<&[u8]> {
        if self.at == self.end && self.at < self.bytes.len() {
            let rest = &self.bytes[self.at..];
            self.end = self.at + rest.iter().position(|b| *b == b'\n').map_or(rest.len(), |n| n + 1);
            self.line += 1;
        }
        Ok(&self.bytes[self.at..self.end])
    }

    fn consume(&mut self, amount: usize) {
        self.at = (self.at + amount).min(self.end);
    }
}

impl Read for LineReader<'_> {
    fn read(&mut self, into: &mut [u8]) -> Result<usize> {
        let line = self.fill_buf()?;
        let n = line.len().min(into.len());
        into[..n].copy_from_slice(&line[..n]);
        self.consume(n);
        Ok(n)
    }
}

impl Seek for LineReader<'_> {
    /// Back to the beginning is all that readers need, and all there is.
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        if to != SeekFrom::Start(0) {
            return Err(std::io::ErrorKind::Unsupported.into());
        }
        *self = Self::new(self.bytes);
        Ok(0)
    }
}
