//! Second door: the Foxglove WebSocket protocol, so that Foxglove and Lichtblick plot and tune a running robot (`docs/foxglove.md`).
//!
//! | module | what |
//! |---|---|
//! | [`door`] | who may come in: Host, Origin, subprotocol, token |
//! | [`socket`] | one viewer: its requests to the watcher, its commands to the operator |
//! | [`requests`], [`replies`] | messages of the protocol |
//! | [`watcher`], [`viewer`] | thread that reads the topics which anybody has subscribed to; what each viewer is sent of them |
//!
//! Channels, messages and times are those of a log, by [`recording::Composer`]. Without the token a viewer looks on; with it, it sets
//! parameters and gives walking commands as a page does, as a client of the broker of its own.

pub mod door;
pub mod replies;
pub mod requests;
pub mod socket;
pub mod viewer;
pub mod watcher;

pub use door::ViewerDoor;
pub use socket::Lobby;
pub use watcher::{ViewerNotice, Watcher};
