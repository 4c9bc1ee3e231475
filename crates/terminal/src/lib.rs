//! Printing that never holds anybody up and never panics.
//!
//! A terminal can be paused (Ctrl-S), a pager can stop reading, a disk can be full, a reader can be gone. Then lines are lost,
//! and counted; the robot and its supervisor go on.
//!
//! - [`Console`]: one thread owns the terminal, progress bar included; others hand it lines through a bounded queue.
//! - [`Fold`]: the same line again and again, told once; the pure part.
//! - [`Feed`]: the standard error of a child, line by line into a console, through a pipe that does not block the child.
//! - [`Quiet`]: standard error for diagnostics of a process: what cannot be written is dropped.
//! - `println!` and `eprintln!` of this crate replace those of the standard library, which panic: a result that cannot be
//!   written ends the program with an error, a remark that cannot be written is dropped.

mod console;
mod feed;
mod fold;
mod print;

pub use console::Console;
pub use feed::Feed;
pub use fold::Fold;
pub use print::{Quiet, divert, remark, result};
