//! Errors of writing and reading a log.

use std::fmt;
use std::path::{Path, PathBuf};

/// Error, and what to do next.
#[derive(Debug)]
pub enum RecordingError {
    /// The file could not be made.
    Create(PathBuf, std::io::Error),
    /// The original of an earlier repair is there, where another one would go.
    OriginalKept(PathBuf),
    /// Somebody is writing the file.
    BeingWritten(PathBuf),
    /// The file could not be opened or read.
    Read(PathBuf, std::io::Error),
    /// Writing failed; nothing more can be written to this file.
    Write(String),
    /// The file is not an MCAP file at all.
    NotALog(PathBuf, String),
    /// The file is an MCAP file, but not one of ours.
    Foreign(PathBuf),
    /// The file holds no frames of CAN lines.
    NoTraffic(PathBuf),
    /// The topic was written with another layout of its record.
    OtherLayout {
        /// The log.
        path: PathBuf,
        /// The topic.
        topic: &'static str,
        /// Its record type.
        record: &'static str,
        /// Software that wrote the log.
        software: String,
    },
    /// The file is damaged at this message number.
    Damaged(PathBuf, u64, String),
    /// The file is damaged, or has become shorter, at this byte.
    DamagedAt(PathBuf, u64, String),
}

impl RecordingError {
    pub(crate) fn write(error: impl fmt::Display) -> Self {
        Self::Write(error.to_string())
    }

    pub(crate) fn not_a_log(path: &Path, why: impl fmt::Display) -> Self {
        Self::NotALog(path.into(), why.to_string())
    }
}

impl fmt::Display for RecordingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            // Files that cannot be used at all.
            Self::Create(path, e) => {
                write!(
                    f,
                    "{}: cannot make the log: {e}; choose a directory that exists and is writable",
                    path.display()
                )
            }
            Self::OriginalKept(path) => {
                write!(f, "{}: holds the original of an earlier repair; move it away first", path.display())
            }
            Self::BeingWritten(path) => {
                write!(
                    f,
                    "{}: it is being written; wait for the end of the run, or choose another file",
                    path.display()
                )
            }
            Self::Read(path, e) => write!(f, "{}: cannot read the log: {e}", path.display()),
            Self::Write(e) => write!(f, "the log can no longer be written: {e}; is the disk full?"),
            // Files with something else in them.
            Self::NotALog(path, why) => {
                write!(
                    f,
                    "{}: not an MCAP file ({why}); logs end in .mcap and are written by `gangwerk`",
                    path.display()
                )
            }
            Self::Foreign(path) => {
                write!(f, "{}: an MCAP file without the metadata record of a gangwerk log", path.display())
            }
            Self::NoTraffic(path) => write!(
                f,
                "{}: no CAN frames in it; `gangwerk can record` writes such logs, `gangwerk run` does not",
                path.display()
            ),
            Self::OtherLayout { path, topic, record, software } => write!(
                f,
                "{}: topic {topic} holds another layout of {record} than this program's; read it with the version \
                 that wrote it ({software})",
                path.display()
            ),
            // Damage.
            Self::Damaged(path, message, why) => {
                write!(f, "{}: damaged after message {message}: {why}", path.display())
            }
            Self::DamagedAt(path, byte, why) => write!(
                f,
                "{}: damaged at byte {byte}: {why}; `gangwerk log repair` keeps all other chunks",
                path.display()
            ),
        }
    }
}

impl std::error::Error for RecordingError {}
