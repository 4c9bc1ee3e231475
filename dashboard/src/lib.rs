//! The operator's desk: one page in a browser that sees, steers, tunes and plots a running robot (thesis 7.3); `docs/dashboard.md`.
//!
//! | module | what |
//! |---|---|
//! | [`daemon`] | the process: threads, address, token |
//! | [`door`], [`socket`], [`admission`], `impatient` | HTTP on the loopback interface, one WebSocket per page, who may come in, who reads |
//! | [`arrival`] | how long what a socket says may have waited in a server that stood still |
//! | [`observer`] | thread that reads the topics of the robot and gives every page its frames; waits for the next robot |
//! | [`replay`] | the same out of a log in place of a robot |
//! | [`description`], [`picture`], [`state`], [`estimate`], [`plotting`], [`health`] | what a page is told: once, at 60 Hz, as samples, about processes |
//! | [`subscribers`] | pages that are there, and what each of them has lost |
//! | [`operator`] | one client of the broker per page or viewer that commands |
//! | [`catalogue`], `top_view`, [`starter`] | scenes, pictures of them, and runs of them that a page starts and ends; only where `--start` allows it |
//! | [`foxglove`] | second door, for Foxglove and Lichtblick |
//! | [`book`] | `docs/`, rendered, under `/book/` |
//! | [`requests`] | what a page asks for |
//!
//! It observes: no topic has it as a writer, and no process knows of it or waits for it. What it commands goes through the
//! broker under the command lease; only the emergency stop has a way of its own. It starts simulated robots only, and only if
//! whoever started it allows that.

pub mod admission;
pub mod arrival;
pub mod book;
pub mod catalogue;
pub mod daemon;
pub mod description;
pub mod door;
pub mod estimate;
pub mod foxglove;
pub mod health;
mod impatient;
pub mod observer;
pub mod operator;
mod page;
pub mod picture;
pub mod plotting;
pub mod replay;
pub mod requests;
pub mod socket;
pub mod starter;
pub mod state;
pub mod subscribers;
mod top_view;

pub use daemon::{Addresses, Options, serve, serve_recording};
