//! Verdict on a plan: every solver gives it, the planner acts on it.

use messages::{Detail, EventCode};

/// Obstacle in the way: code and detail of the event.
pub(crate) type Blocked = (EventCode, Detail);

/// First fault of a plan, if any.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlanVerdict {
    /// Solved, and it can be walked.
    Sound,
    /// The zero-moment point leaves the support polygon.
    LeavesSupport,
    /// A foot would have to hold more moment than its sole can.
    OverloadsSole,
    /// The ground would have to pull, or the body to fall faster than freely: `z.. <= -g`.
    Falling,
    /// More friction is needed than there is.
    Slips,
    /// The closed form (4.44) is for one mass at constant height, and this motion has more, or climbs.
    NotOneMass,
    /// A support polygon is empty.
    NoSupport,
    /// Phases do not follow one another: no length, wrong order, or too long for the distance of the knots.
    Degenerate,
    /// A leg cannot take its pose.
    OutOfReach,
    /// More phases or knots than there is room for.
    TooLong,
    /// Sweeps ran out before the optimum.
    Unsettled,
    /// An input is NaN or infinite, or something overflowed.
    NotFinite,
}

impl PlanVerdict {
    /// This, unless it is sound; then `next`.
    pub fn and(self, next: Self) -> Self {
        if self == Self::Sound { next } else { self }
    }
}
