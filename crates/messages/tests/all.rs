//! The tests of this folder in one executable.

mod architecture;
mod command_text;
mod phases;
mod wire;
