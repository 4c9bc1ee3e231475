//! First difference between a replay and its run.

use std::fmt;

use messages::Process;

/// First difference.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ReplayProblem {
    /// The log holds nothing of the cycles of this process.
    NoCycles {
        /// The process.
        process: Process,
    },
    /// Records are missing, which the replay needs.
    Missing {
        /// Their topic.
        topic: &'static str,
        /// Tick of the cycle that needs them.
        tick: u64,
        /// What is known about them.
        why: String,
    },
    /// The layout of a record is another one.
    Layout {
        /// Its topic.
        topic: &'static str,
    },
    /// A record differs.
    Differs {
        /// The process that wrote it.
        process: Process,
        /// Its topic.
        topic: &'static str,
        /// Its tick.
        tick: u64,
        /// Name of the field.
        field: String,
        /// Value in the log.
        logged: String,
        /// Value that the replay makes.
        replayed: String,
    },
    /// The log holds a record that the replay does not make.
    NotMade {
        /// The process that wrote it.
        process: Process,
        /// Its topic.
        topic: &'static str,
        /// Its tick.
        tick: u64,
    },
    /// The log cannot be read further.
    Broken(String),
    /// The log ends here, in the middle, because its writer died.
    EndOfCut,
}

impl fmt::Display for ReplayProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoCycles { process } => {
                write!(f, "the log holds no cycle of {}: it was not made by `gangwerk run`", process.name())
            }
            Self::Missing { topic, tick, why } => {
                write!(f, "the log is not complete: topic {topic}, needed at tick {tick}: {why}")
            }
            Self::Layout { topic } => {
                write!(
                    f,
                    "topic {topic} holds another layout than this program's: replay it with the version that wrote it"
                )
            }
            Self::Differs { process, topic, tick, field, logged, replayed } => write!(
                f,
                "{} differs: topic {topic}, tick {tick}, field {field}: {logged} in the log, {replayed} in the replay",
                process.name()
            ),
            Self::NotMade { process, topic, tick } => {
                write!(
                    f,
                    "{} differs: topic {topic}, tick {tick}: the replay does not make this record",
                    process.name()
                )
            }
            Self::Broken(why) => write!(f, "{why}"),
            Self::EndOfCut => write!(f, "the log ends in the middle"),
        }
    }
}

impl std::error::Error for ReplayProblem {}
