//! `brake = { torque, delay }` of a `[[drive]]`: a brake on the motor's shaft, closed by springs while there is no current.
//!
//! A drive without this key has none: without torque its joint is held by nothing but the friction of its gear.

use crate::section::{POSITIVE, Section};

/// A holding brake.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Brake {
    /// \[N m\] Largest torque that the brake holds on the motor's shaft.
    pub torque: f64,
    /// \[s\] Time from power stage off until the brake holds; it opens at once.
    pub delay: f64,
}

impl Brake {
    /// The brake of a row, if it has one.
    pub(crate) fn of(row: &Section<'_, '_>) -> Option<Self> {
        let build = |table: &Section<'_, '_>| Self {
            torque: table.number("torque", "N m", POSITIVE),
            delay: table.number("delay", "s", 0.0..=1.0),
        };
        if row.has("brake") { row.table("brake", build) } else { None }
    }
}
