//! The standard error of a child, as lines on a console.

use crate::console::Console;
use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
use std::io::{self, PipeReader, Read, pipe};
use std::process::Stdio;

/// Longest line \[B\]; a longer one is shown in pieces.
const LONGEST: usize = 4096;

/// A pipe whose writer never waits: what does not fit is lost to the child, not its time.
pub struct Feed {
    reader: PipeReader,
}

impl Feed {
    /// The pipe, and its writer's end for the child.
    ///
    /// # Errors
    /// The process has no descriptors left.
    pub fn new() -> io::Result<(Self, Stdio)> {
        let (reader, writer) = pipe()?;
        // The flag belongs to this end alone: the reader's end still waits.
        fcntl_setfl(&writer, fcntl_getfl(&writer)? | OFlags::NONBLOCK)?;
        Ok((Self { reader }, writer.into()))
    }

    /// Starts a thread that hands every line to `console`, until the child has closed its end.
    ///
    /// # Errors
    /// The thread cannot be started.
    pub fn into_lines(self, console: Console) -> io::Result<()> {
        let forward = move || self.forward(|line| console.say(line));
        std::thread::Builder::new().name("feed".into()).stack_size(128 << 10).spawn(forward)?;
        Ok(())
    }

    fn forward(mut self, mut say: impl FnMut(String)) {
        let (mut line, mut bytes) = (Vec::new(), [0; LONGEST]);
        while let Ok(count @ 1..) = self.reader.read(&mut bytes) {
            for &byte in &bytes[..count] {
                if byte != b'\n' {
                    line.push(byte);
                }
                if byte == b'\n' || line.len() >= LONGEST {
                    say(String::from_utf8_lossy(&line).into_owned());
                    line.clear();
                }
            }
        }
        if !line.is_empty() {
            say(String::from_utf8_lossy(&line).into_owned());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::process::Command;

    #[test]
    fn lines_arrive_whole_and_endless_ones_in_pieces() {
        let (feed, writer) = Feed::new().unwrap();
        let script = "printf 'one\\ntw' >&2; printf 'o\\n' >&2; head -c 5000 /dev/zero | tr '\\0' x >&2";
        let mut child = Command::new("sh").args(["-c", script]).stderr(writer).spawn().unwrap();
        let mut lines = Vec::new();
        feed.forward(|line| lines.push(line));
        child.wait().unwrap();
        let lengths: Vec<_> = lines.iter().map(String::len).collect();
        assert_eq!(
            (&lines[..2], lengths[2..].iter().sum::<usize>()),
            (&["one".to_owned(), "two".to_owned()][..], 5000)
        );
        assert!(lengths.iter().all(|&n| n <= LONGEST));
    }

    #[test]
    fn a_child_whose_lines_nobody_reads_does_not_wait() {
        let (feed, writer) = Feed::new().unwrap();
        // Twice what the pipe holds; dd ends with an error when it would have to wait.
        let script = "dd if=/dev/zero bs=4096 count=40 >&2 2>/dev/null; exit 7";
        let code = Command::new("sh").args(["-c", script]).stderr(writer).status().unwrap().code();
        assert_eq!(code, Some(7));
        drop(feed);
    }
}
