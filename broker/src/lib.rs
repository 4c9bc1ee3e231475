//! The command plane (thesis 7.4): messages by (domain, id), between processes and over streams; `docs/protocol.md`.
//!
//! - [`client`]: a process's connection to the global broker; its real-time side never waits, locks or allocates.
//! - [`exchange`]: the global broker: who subscribed to which domain, what is admitted, answers, and what each has lost.
//! - [`admission`], [`lease`]: whether a command may pass, and who may move the robot: pure, with time as an argument.
//! - [`daemon`]: the process around it, `gangwerk broker --run DIR`.
//! - [`doors`], [`connection`], [`stream_client`]: the same messages over a Unix socket in the run directory, or over TCP.
//! - [`awaited`], [`identity`]: what such clients need besides: requests on their way, and who holds the lease.
//! - [`observation`]: parameters, events and state of the running robot, for clients that watch.
//! - [`message`], [`refusal`]: how a message looks in queues and in frames, and what makes it refused.
//!
//! What the robot does never waits for the broker: without it, publishing counts a loss and receiving finds nothing.

pub mod admission;
pub mod awaited;
pub mod client;
pub mod connection;
pub mod daemon;
pub mod doors;
pub mod exchange;
pub mod identity;
pub mod inlet;
pub mod keys;
pub mod lease;
pub mod log_gate;
mod members;
pub mod message;
pub mod observation;
mod pending;
pub mod refusal;
pub mod stream_client;

pub use awaited::Awaited;
pub use client::Client;
pub use members::Outgoing;
pub use refusal::Refusal;
pub use stream_client::StreamClient;
