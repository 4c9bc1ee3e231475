//! Causes of refusals, in the order of their counts in a trigger.

/// Cause of a refusal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// No such datagram: magic, kind or length.
    Malformed,
    /// Another version of the layout.
    Version,
    /// A number that is none.
    NotFinite,
    /// A number out of the range of any use, or not whole where it must be.
    Range,
    /// Somebody else has the session, or it came from another host or another user of this machine.
    Sender,
    /// It answers a trigger of more than half a second ago, or none.
    Age,
    /// Its sequence is not above the last one: replayed, doubled, or late.
    Order,
    /// More than the gateway takes.
    Rate,
    /// She was stopped, or taken over, by somebody else, and it moves her or her head; a velocity of zero comes first.
    Held,
    /// Robot or broker refused it, or is not there.
    Robot,
}

impl Cause {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::Malformed,
        Self::Version,
        Self::NotFinite,
        Self::Range,
        Self::Sender,
        Self::Age,
        Self::Order,
        Self::Rate,
        Self::Held,
        Self::Robot,
    ];

    /// Name for the operator.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Malformed => "malformed",
            Self::Version => "version",
            Self::NotFinite => "not a number",
            Self::Range => "range",
            Self::Sender => "sender",
            Self::Age => "age",
            Self::Order => "order",
            Self::Rate => "rate",
            Self::Held => "held",
            Self::Robot => "robot",
        }
    }
}
