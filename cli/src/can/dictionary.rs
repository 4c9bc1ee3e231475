//! Meaning of identifiers and bytes: by the layouts of one of our robots, or by any DBC file.

use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use config::database::Database;
use fieldbus::capture::{Captured, ERROR, EXTENDED, EXTENDED_BITS, REMOTE};
use fieldbus::cycles::counter;

use super::Only;
use super::decoder::{FrameDecoder, signals};

/// Source of the frames.
#[derive(clap::Args)]
pub struct Source {
    /// Robot whose frames these are.
    #[arg(long, value_name = "NAME")]
    pub robot: Option<String>,
    /// A DBC file, of whatever machine.
    #[arg(long, value_name = "FILE", conflicts_with = "robot")]
    pub dbc: Option<PathBuf>,
}

impl Source {
    /// Reads it; none if none was named.
    ///
    /// # Errors
    /// There is no such robot, or file.
    pub(super) fn load(&self, config: &Path) -> Result<Option<Dictionary>, Box<dyn Error>> {
        Ok(match (&self.robot, &self.dbc) {
            (Some(name), _) => Some(Dictionary::Robot(Box::new(FrameDecoder::load(config, name)?))),
            (None, Some(path)) => Some(Dictionary::File(Database::load(path)?)),
            (None, None) => None,
        })
    }
}

/// Frames by name.
pub(super) enum Dictionary {
    /// Of a robot: which node is behind which interface is learnt from the frames.
    Robot(Box<FrameDecoder>),
    /// Of a file, the same on all interfaces.
    File(Database),
}

/// Meaning of a frame.
pub(super) enum Meaning {
    /// Its identifier is not known.
    Unknown,
    /// Its message has a name and another length.
    WrongLength(String, u64),
    /// Name of its message, and a line for each signal.
    Known(String, String),
}

impl Dictionary {
    /// Learns from frames: all of a recording before it is looked at, or each as it comes.
    pub(super) fn learn(&mut self, frame: &Captured) {
        if let Self::Robot(decoder) = self {
            decoder.learn(frame);
        }
    }

    /// Whether a frame goes the way asked for.
    pub(super) fn goes(&self, frame: &Captured, only: Option<Only>) -> bool {
        match self {
            Self::Robot(decoder) => decoder.goes(frame, only),
            Self::File(_) => true,
        }
    }

    /// Counter of a frame, and its bits.
    pub(super) fn counter(&self, frame: &Captured) -> Option<(u64, u32)> {
        match self {
            Self::Robot(decoder) => counter(decoder.message(frame)?, frame),
            Self::File(_) => None,
        }
    }

    /// Name of the message of an identifier on a line.
    pub(super) fn name(&self, line: u32, id: u32) -> String {
        let known = match self {
            _ if id & ERROR != 0 => return "error frame".into(),
            Self::Robot(decoder) => decoder.name(line, id),
            Self::File(database) => database.message(id & !REMOTE).map(|m| m.name.clone()),
        };
        known.unwrap_or_else(|| "unknown".into())
    }

    /// Meaning of a frame; of a remote frame its name alone.
    pub(super) fn meaning(&self, frame: &Captured) -> Meaning {
        let (name, len) = match self {
            Self::Robot(decoder) => match decoder.message(frame) {
                Some(m) => (m.name.clone(), u64::from(m.len)),
                None => return Meaning::Unknown,
            },
            Self::File(database) => match database.message(frame.id & (EXTENDED | EXTENDED_BITS)) {
                Some(m) => (m.name.clone(), m.len),
                None => return Meaning::Unknown,
            },
        };
        if u64::from(frame.len) != len {
            return Meaning::WrongLength(name, len);
        }
        let text = match self {
            Self::Robot(decoder) => decoder.message(frame).map(|m| signals(m, frame)),
            Self::File(database) => {
                database.message(frame.id & (EXTENDED | EXTENDED_BITS)).map(|m| carried(m, frame))
            }
        };
        Meaning::Known(name, text.unwrap_or_default())
    }
}

/// One line for each signal: name, value, unit, and the word for the value.
fn carried(message: &config::database::Described, frame: &Captured) -> String {
    let mut text = String::new();
    for signal in message.carries(frame.payload()) {
        let number = signal.exact.map_or_else(|| signal.value.to_string(), |exact| exact.to_string());
        let _ = write!(text, "    {} = {number}", signal.name);
        let _ = if signal.unit.is_empty() { Ok(()) } else { write!(text, " {}", signal.unit) };
        let _ = writeln!(text, "{}", signal.word.map_or(String::new(), |word| format!(" ({word})")));
    }
    text
}
