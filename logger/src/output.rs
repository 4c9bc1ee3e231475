//! The file behind the log, or the lack of one.

use messages::{Record, Topic};
use recording::{Recorder, RecordingError};
use std::path::{Path, PathBuf};

/// Opens part 1, 2, ... of a log.
pub type Open = Box<dyn FnMut(u32) -> Result<Recorder, RecordingError>>;

/// File names of the parts of a log: `walk.mcap`, `walk.2.mcap`, ...
#[derive(Clone, Debug)]
pub struct Parts(PathBuf);

impl Parts {
    /// The first part has the name itself.
    pub fn new(path: &Path) -> Self {
        Self(path.into())
    }

    /// Name of a part, counted from 1.
    pub fn path(&self, part: u32) -> PathBuf {
        if part <= 1 { self.0.clone() } else { self.0.with_extension(format!("{part}.mcap")) }
    }
}

/// A log that goes on when its disk does not: what cannot be written is counted, and when writing is possible again a
/// new part begins.
pub struct LogOutput {
    open: Open,
    recorder: Option<Recorder>,
    part: u32,
    dropped: u64,
    /// Records written since the last flush: nobody knows whether they reached the disk until the next one.
    unflushed: u64,
    /// Writing failed at some time: records are missing, or the index at the end of a part is.
    broken: bool,
    /// Writing does not work at present, and that was said.
    failing: bool,
    /// Another run writes the file that was to be opened last.
    anothers: bool,
    complaint: Option<String>,
}

impl LogOutput {
    /// Opens the first part. If that fails the run has no log yet; see [`LogOutput::complaint`] and [`LogOutput::retry`].
    pub fn new(open: Open) -> Self {
        let mut output = Self {
            open,
            recorder: None,
            part: 0,
            dropped: 0,
            unflushed: 0,
            broken: false,
            failing: false,
            anothers: false,
            complaint: None,
        };
        output.retry();
        output
    }

    /// Writes the record with this number of its topic, or counts it as dropped.
    pub fn write<T: Record>(&mut self, topic: &Topic, record: &T, number: u32) {
        let Some(recorder) = &mut self.recorder else {
            self.dropped += 1;
            return;
        };
        let written = recorder.write_numbered(topic, record, number);
        self.unflushed += 1;
        if let Err(error) = written {
            self.give_up(&error);
        }
    }

    /// Hands everything written so far to the operating system.
    pub fn flush(&mut self) {
        match self.recorder.as_mut().map(Recorder::flush) {
            Some(Ok(())) => self.unflushed = 0,
            Some(Err(error)) => self.give_up(&error),
            None => {}
        }
    }

    /// Begins a new part if there is none; to be called now and then.
    pub fn retry(&mut self) {
        if self.recorder.is_some() {
            return;
        }
        match (self.open)(self.part + 1) {
            Ok(recorder) => {
                self.part += 1;
                self.recorder = Some(recorder);
                self.failing = false;
            }
            Err(error) => self.complain(&error),
        }
    }

    /// Closes the log.
    pub fn finish(&mut self) {
        if let Some(Err(error)) = self.recorder.take().map(Recorder::finish) {
            self.dropped += std::mem::take(&mut self.unflushed);
            self.complain(&error);
        }
    }

    /// Records that could not be written since the beginning; of those since the last good flush before a failure
    /// some may have reached the file.
    pub fn dropped(&self) -> u64 {
        self.dropped
    }

    /// Whether there is no part yet because another run writes the file that this one was to begin with.
    pub(crate) fn is_anothers(&self) -> bool {
        self.anothers && self.part == 0
    }

    /// Whether records reach a file at present.
    pub(crate) fn is_writing(&self) -> bool {
        self.recorder.is_some()
    }

    /// Whether writing failed at some time: the log is not complete.
    pub fn is_broken(&self) -> bool {
        self.broken
    }

    /// Cause of a failed write, once for each failure.
    pub fn complaint(&mut self) -> Option<String> {
        self.complaint.take()
    }

    fn give_up(&mut self, error: &RecordingError) {
        self.dropped += std::mem::take(&mut self.unflushed);
        self.complain(error);
        // Closing it tries to write the index; on a full disk that fails too, and no more than that.
        self.recorder = None;
    }

    /// The same complaint again and again is no news: only the first one until writing works again.
    fn complain(&mut self, error: &RecordingError) {
        self.broken = true;
        self.anothers = matches!(error, RecordingError::BeingWritten(_));
        if !self.failing {
            self.failing = true;
            self.complaint = Some(error.to_string());
        }
    }
}
