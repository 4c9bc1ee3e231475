//! Time and scheduling: the only crate that reads a clock or talks to the scheduler.
//!
//! - [`prepare_thread`]: memory locked, stack and heap touched, priority, core, no processor sleep; says what it got.
//! - [`clock`]: monotonic now and absolute sleep. [`Period`]: a grid of wake-ups and what happens on overrun.
//! - [`CycleMeter`]: lateness, execution time, page faults and allocations of a cycle, as `cycle_stats` publishes them.
//! - [`CountingAllocator`]: counts what the cycle's thread allocates after arming.
//! - [`Bucket`]: how many messages per second somebody may send.
//! - [`black_box`], [`last_words`]: what a process leaves when it dies.
//! - [`Stop`]: the request to end, by signal.
//! - [`subnormals`]: whether arithmetic met numbers that cost a hundred times as much.
//! - [`preflight`]: what this machine gives to real time; [`cyclictest()`]: the same, measured.

pub mod allocations;
pub mod black_box;
mod bucket;
pub mod clock;
mod cyclictest;
mod histogram;
pub mod last_words;
mod meter;
mod period;
mod preflight;
mod sanitizer;
mod stop;
pub mod subnormals;
mod thread;

pub use allocations::CountingAllocator;
pub use bucket::Bucket;
pub use cyclictest::cyclictest;
pub use histogram::Histogram;
pub use meter::CycleMeter;
pub use period::{CycleVerdict, Period};
pub use preflight::{Check, Grade, open_files, preflight};
pub use stop::{Stop, end_with_reader, ignore_sigxfsz, terminate};
pub use thread::{Granted, ThreadSchedule, prepare_side_thread, prepare_thread, run_on_any_core};
