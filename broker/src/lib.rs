//! The command plane (thesis 7.4): messages by (domain, id), inside a process, between processes, over TCP.
//!
//! - [`local`]: inside one process: a published message calls its subscribers directly.
//! - [`client`]: a process's connection to the global broker; its real-time side never waits, locks or allocates.
//! - [`exchange`]: the global broker: who subscribed to which domain, and what each one has lost.
//! - [`daemon`]: the process around it, `gangwerk broker --run DIR`.
//! - [`tcp`] and [`tcp_client`]: the same messages for programs on the network side, on the loopback interface only.
//! - [`message`]: how a message looks in queues and in TCP frames, and what makes it refused.
//!
//! What the robot does never waits for the broker: without it, publishing counts a loss and receiving finds nothing.

pub mod client;
pub mod daemon;
pub mod exchange;
pub mod local;
pub mod message;
pub mod tcp;
pub mod tcp_client;

pub use client::Client;
pub use local::LocalBroker;
pub use message::Refusal;
pub use tcp_client::TcpClient;
