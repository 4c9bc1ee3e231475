//! The tests of this folder in one executable.

mod block;
mod coupled;
mod failures;
mod pad;
mod problem;
mod sole;
