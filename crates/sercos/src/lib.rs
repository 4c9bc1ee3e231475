//! Sercos III, cyclic part: telegrams, communication phases, a master and simulated slaves, a raw Ethernet socket.
//!
//! Public facts only; which, and what was chosen where they are silent: `docs/sercos.md`.
//!
//! | part | where |
//! |---|---|
//! | bytes | [`header`], [`telegram`], [`device`], [`idn`], [`layout`] |
//! | service channel and parameters | `service`, `parameters`, `programme` |
//! | master, ring | `master`, `ring`, `trouble` |
//! | simulated slaves | `slave`, `chain` |
//! | frames of a robot as data of connections | [`packing`] |
//! | interfaces | `socket`, `near` (master), `far` (slaves) |
//!
//! All but the last row are pure: no clock, no socket. Nothing allocates once a cycle has begun.

mod chain;
mod crc;
pub mod device;
mod far;
pub mod header;
pub mod idn;
pub mod layout;
mod master;
mod near;
pub mod packing;
mod parameters;
mod programme;
mod ring;
mod service;
mod slave;
mod socket;
pub mod telegram;
mod trouble;

pub use chain::SlaveChain;
pub use crc::crc32;
pub use far::Far;
pub use header::CommunicationPhase;
pub use layout::Station;
pub use master::{Master, MasterSetup, Stage};
pub use near::Near;
pub use service::ServiceRefusal;
pub use slave::{PortSide, Slave, SlaveCounts};
pub use socket::{Socket, SocketError};
pub use trouble::{RingEvent, StartTrouble};
