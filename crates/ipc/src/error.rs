//! Errors of making ports; nothing fails afterwards.

/// Error of making a space, a port or a queue.
#[derive(Debug)]
pub enum IpcError {
    /// Somebody else holds this place.
    AlreadyRunning {
        /// `supervisor` or the name of the process.
        who: String,
        /// Its process id, 0 if it could not be read.
        pid: u32,
        /// The run directory.
        dir: String,
    },
    /// Shared memory would not hold everything.
    NoRoom {
        /// \[B\] Space that the topics need.
        needed: u64,
        /// \[B\] Free space.
        free: u64,
    },
    /// Two programs do not agree on the layout of a record.
    Schema {
        /// The topic.
        topic: String,
        /// Name and layout hash of the record in this program.
        here: String,
    },
    /// Every writer slot of a topic belongs to a writer that was killed.
    SlotsUsedUp {
        /// The topic.
        topic: String,
        /// Number of slots.
        slots: usize,
    },
    /// Anything else, in words.
    Other(String),
}

impl std::fmt::Display for IpcError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::AlreadyRunning { who, pid, dir } => {
                write!(
                    f,
                    "{who} is already running in {dir}, pid {pid}: end it first, or choose another directory"
                )
            }
            Self::NoRoom { needed, free } => write!(
                f,
                "/dev/shm has {free} bytes free and the topics need {needed}: enlarge it (mount -o remount,size=...) \
                 or end what fills it"
            ),
            Self::Schema { topic, here } => write!(
                f,
                "topic {topic}: this program has {here}, the running system another layout: start all processes \
                 from one build"
            ),
            Self::SlotsUsedUp { topic, slots } => write!(
                f,
                "topic {topic}: all {slots} writer slots belong to processes that were killed: end the run and start \
                 it again"
            ),
            Self::Other(text) => f.write_str(text),
        }
    }
}

impl std::error::Error for IpcError {}

/// `what` with the reason of a library error.
pub(crate) fn because(what: impl std::fmt::Display, reason: impl std::fmt::Debug) -> IpcError {
    IpcError::Other(format!("{what}: {reason:?}"))
}
