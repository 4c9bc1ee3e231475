//! `parameters/PROCESS`: what a process is set to.

use crate::{Header, record};

/// Room for parameters in a record.
pub(crate) const MAX_PARAMETERS: usize = 64;

record! {
    /// Present values of all parameters, in the order of their table. Written at start and after a change.
    record Parameters {
        /// The cycle from which they hold.
        header: Header,
        /// \[1\] Count.
        count: u64,
        /// Each in its own unit.
        values: [f64; MAX_PARAMETERS],
    }
}
