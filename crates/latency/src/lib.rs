//! Ways from one process to another, one beside the other: the topics of this system, iceoryx2 without anything around it, and
//! what the operating system has. `gangwerk latency` measures them.

mod link;
pub mod raw;
pub mod system;
pub mod topics;

pub use link::{LIMIT, Link, LinkEnd, Opened, SIZE, spin};
