//! The tests of this folder in one executable.

mod cdr;
mod log;
mod memory;
mod repair;
mod traffic;
