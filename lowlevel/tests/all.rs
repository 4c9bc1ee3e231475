//! The tests of this folder in one executable.

mod fieldbus;
mod joint_loop;
mod start_up;
