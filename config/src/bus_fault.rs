//! Faults of the field bus that a scene brings about: rows `[[bus_fault]]`.
//!
//! ```toml
//! [[bus_fault]]
//! time = 8.0 # [s]
//! duration = 0.05 # [s]; without it: to the end of the scene
//! kind = "lost" # see FaultKind
//! node = "left_knee" # the local controller, so the line, it happens to; without it: all
//! direction = "from_drives" # "to_drives", "both" (the default)
//! share = 0.1 # [1] probability; 1 if it is not there
//! cycles = 3 # [1] of lost: how long one loss takes; of late and duplicated: how much later
//! ```

use crate::section::{NOT_NEGATIVE, POSITIVE, Section};

/// Kind of fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaultKind {
    /// Frames vanish: each with probability `share`; or, with `cycles`, all of a line for that many cycles at a time.
    Lost,
    /// Frames come `cycles` cycles later.
    Late,
    /// Frames come twice, the second time `cycles` cycles later (0: in the same cycle).
    Duplicated,
    /// The frames of one cycle and line come in another order.
    Reordered,
    /// Bits flip, and the checksum notices: the frame is lost and both ends count an error.
    Corrupted,
    /// One bit of identifier, length or payload flips, and the checksum does not notice.
    Flipped,
    /// A node says nothing and hears nothing, though its bus controller goes on acknowledging.
    Silent,
    /// The cable is pulled: nothing passes, nobody acknowledges.
    Pulled,
    /// The two wires of the line touch: every attempt to send is an error, until both ends are off the bus.
    Shorted,
}

impl FaultKind {
    /// All of them, in the order of [`FaultKind::WORDS`].
    pub const ALL: [Self; 9] = [
        Self::Lost,
        Self::Late,
        Self::Duplicated,
        Self::Reordered,
        Self::Corrupted,
        Self::Flipped,
        Self::Silent,
        Self::Pulled,
        Self::Shorted,
    ];
    /// Their names in scene files.
    pub const WORDS: [&str; 9] =
        ["lost", "late", "duplicated", "reordered", "corrupted", "flipped", "silent", "pulled", "shorted"];

    /// Whether it happens to a whole line, in both directions, without chance.
    pub(crate) fn is_of_line(self) -> bool {
        matches!(self, Self::Silent | Self::Pulled | Self::Shorted)
    }
}

/// Frames of which way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameDirection {
    /// From lowlevel to the drives.
    ToDrives,
    /// From the drives to lowlevel.
    FromDrives,
}

/// One `[[bus_fault]]`.
#[derive(Clone, Debug, PartialEq)]
pub struct BusFault {
    /// \[s\] Begin.
    pub time: f64,
    /// \[s\] Duration; infinite if the row does not say it.
    pub duration: f64,
    /// Kind of fault.
    pub kind: FaultKind,
    /// Name of the local controller whose line it happens to; none: all lines.
    pub node: Option<String>,
    /// Which way; none: both.
    pub way: Option<FrameDirection>,
    /// \[1\] Probability: per frame, for [`FaultKind::Reordered`] and bursts of [`FaultKind::Lost`] per cycle.
    pub share: f64,
    /// \[1\] Cycles, see [`FaultKind`].
    pub cycles: u32,
}

/// Most cycles a frame may be late.
pub const MOST_LATE: u32 = 100;

impl BusFault {
    /// A fault of all lines, both ways, that takes every frame, from `time` \[s\] for `duration` \[s\].
    pub fn new(kind: FaultKind, time: f64, duration: f64) -> Self {
        let cycles = u32::from(kind == FaultKind::Late);
        Self { time, duration, kind, node: None, way: None, share: 1.0, cycles }
    }

    pub(crate) fn build(row: &Section<'_, '_>) -> Self {
        let kind = FaultKind::ALL[row.word("kind", &FaultKind::WORDS)];
        let duration = row.has("duration").then(|| row.number("duration", "s", POSITIVE));
        let mut fault =
            Self::new(kind, row.number("time", "s", NOT_NEGATIVE), duration.unwrap_or(f64::INFINITY));
        fault.node = row.has("node").then(|| row.text("node"));
        // Bus-off and a pulled cable strike whole lines: what narrows a fault to frames has no meaning.
        if kind.is_of_line() {
            for key in ["direction", "share", "cycles"].into_iter().filter(|key| row.has(key)) {
                let word = FaultKind::WORDS[kind as usize];
                row.problem(key, format!("`{word}` is of a whole line, always; leave it out"));
            }
            return fault;
        }
        if row.has("direction") {
            let ways = [Some(FrameDirection::ToDrives), Some(FrameDirection::FromDrives), None];
            fault.way = ways[row.word("direction", &["to_drives", "from_drives", "both"])];
        }
        if row.has("share") {
            fault.share = row.number("share", "", 0.0..=1.0);
        }
        // `cycles` is a delay, a number of repetitions, or the length of a burst.
        match kind {
            FaultKind::Late => fault.cycles = row.integer("cycles", 1..=MOST_LATE.into()) as u32,
            FaultKind::Duplicated if row.has("cycles") => {
                fault.cycles = row.integer("cycles", 0..=MOST_LATE.into()) as u32;
            }
            FaultKind::Lost if row.has("cycles") => fault.cycles = row.integer("cycles", 1..=10_000) as u32,
            _ if row.has("cycles") => {
                row.problem("cycles", "only `lost`, `late` and `duplicated` have it; leave it out");
            }
            _ => {}
        }
        fault
    }
}
