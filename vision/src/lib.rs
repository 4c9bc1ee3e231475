//! Vision system that explores (thesis 6.1): `gangwerk explore`, `docs/vision.md`.
//!
//! A program beside the robot: a client of its vision interface over UDP, with a simulated camera for eyes. What a cluster of
//! computers did for Lola is done here with as little as a room needs.
//!
//! | module | what |
//! |---|---|
//! | [`local_map`] | points of the last seconds → where something stands |
//! | [`tentacles`] | arcs ahead, and how far each of them is free |
//! | [`pilot`] | trigger and points → velocity, and where to look |
//! | [`mod@line`] | both as datagrams |
//! | [`program`] | these at work on a socket; the camera is [`sim_backend::eye`] |

pub mod line;
pub mod local_map;
pub mod pilot;
pub mod program;
pub mod tentacles;

pub use line::Line;
pub use pilot::{Pilot, Speeds};
