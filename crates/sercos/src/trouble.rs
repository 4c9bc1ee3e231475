//! Events of the master: changes of the ring, and why a start failed.

use crate::header::CommunicationPhase;
use crate::idn::Idn;
use crate::layout::LayoutError;
use crate::parameters::is_cycle_time;
use crate::ring::RingShape;
use crate::service::ServiceRefusal;
use std::fmt;

/// Something worth a line in the log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RingEvent {
    /// A phase has begun.
    Phase(CommunicationPhase),
    /// The ring is open, between these stations; none: the master.
    RingBroken(Option<u16>, Option<u16>),
    /// The ring is closed again.
    RingClosed,
    /// All stations are started anew, from CP0.
    Restart,
    /// A station's data are missing for longer than permitted.
    Lost(u16),
    /// Its data are back.
    Back(u16),
}

/// Cause of a failed start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StartTrouble {
    /// A cycle time that Sercos III does not know \[ns\].
    CycleTime(u32),
    /// Stations that cannot be served.
    Layout(LayoutError),
    /// No telegram comes back.
    NoTelegrams,
    /// Telegrams come back, and not as they should.
    Shape(RingShape),
    /// So many slaves instead of so many.
    Count {
        /// Slaves that wrote their address.
        found: usize,
        /// Stations of the configuration.
        expected: usize,
    },
    /// Nobody has this address.
    Missing(u16),
    /// An address that nobody was expected to have, or a second slave with one that is taken.
    Stranger(u16),
    /// The order of the slaves keeps changing.
    Unstable,
    /// A slave that wrote its address does not give its device status.
    Silent {
        /// Its address.
        address: u16,
        /// In this phase.
        phase: CommunicationPhase,
    },
    /// A slave refused a parameter.
    Refused {
        /// Its address.
        address: u16,
        /// The parameter.
        idn: Idn,
        /// How.
        refusal: ServiceRefusal,
    },
}

impl StartTrouble {
    /// Whether this cycle time can be run.
    ///
    /// # Errors
    /// It cannot.
    pub(crate) fn check_cycle_time(ns: u32) -> Result<(), Self> {
        if is_cycle_time(ns) { Ok(()) } else { Err(Self::CycleTime(ns)) }
    }
}

impl fmt::Display for StartTrouble {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::CycleTime(ns) => write!(
                f,
                "sercos: a cycle of {} µs does not exist; take 31.25, 62.5 or 125 µs, or a multiple of 250 µs up to \
                 65 ms",
                f64::from(*ns) / 1e3
            ),
            Self::Layout(error) => error.fmt(f),
            Self::NoTelegrams => write!(
                f,
                "sercos: no telegram came back in CP0; see that the slaves have power and are plugged into the \
                 master's port"
            ),
            Self::Shape(shape) => write!(
                f,
                "sercos: the ring is open at the start ({}); plug both ends into the master's two ports",
                match shape {
                    RingShape::Broken => "two lines",
                    RingShape::LineP => "a line at port 1",
                    RingShape::LineS => "a line at port 2",
                    _ => "telegrams of one direction are lost",
                }
            ),
            Self::Count { found, expected } => write!(
                f,
                "sercos: {found} slaves answered, {expected} are configured; see which has no power or does not \
                 belong here"
            ),
            Self::Missing(address) => {
                write!(f, "sercos: no slave has the address {address}; set it at the drive (S-0-1040)")
            }
            Self::Stranger(address) => write!(
                f,
                "sercos: a slave has the address {address}, which nobody or another one should have; set it at the \
                 drive (S-0-1040)"
            ),
            Self::Unstable => write!(
                f,
                "sercos: the order of the slaves was not the same for 100 cycles in a row; see to the plugs"
            ),
            Self::Silent { address, phase } => write!(
                f,
                "sercos: slave {address} gives no device status in CP{}; switch it off and on",
                *phase as u8
            ),
            Self::Refused { address, idn, refusal } => refused(f, *address, *idn, *refusal),
        }
    }
}

fn refused(f: &mut fmt::Formatter, address: u16, idn: Idn, refusal: ServiceRefusal) -> fmt::Result {
    write!(f, "sercos: slave {address}, {idn}: ")?;
    match refusal {
        ServiceRefusal::Code(code) => {
            write!(f, "refused with the code {code:#06x}; look it up in the slave's manual")
        }
        ServiceRefusal::Shape => {
            write!(f, "has another type than expected; see that the right device is at this address")
        }
        ServiceRefusal::Value(value) => write!(
            f,
            "has the value {}, not the configured one; see that the right device is at this address",
            value.number()
        ),
        ServiceRefusal::Command => {
            write!(f, "the check failed; compare the slave's connections with the configuration")
        }
        ServiceRefusal::Timeout => {
            write!(f, "the service channel does not answer; switch the slave off and on")
        }
    }
}

impl std::error::Error for StartTrouble {}
