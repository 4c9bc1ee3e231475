//! Test harness for the executable `gangwerk`: a directory of its own for each test, and processes that end with it.

mod place;
mod running;
mod stalls;

pub use place::{Site, WALK, root};
pub use running::{Running, Said, doze, left_out, shared_turn, signal, turn};
pub use rustix::process::Signal;
pub use stalls::Stalls;

/// The executable that is tested: the file that `GANGWERK` names while the tests are built, or the one built beside them.
#[macro_export]
macro_rules! executable {
    () => {
        match option_env!("GANGWERK") {
            Some(file) => file,
            None => env!("CARGO_BIN_EXE_gangwerk"),
        }
    };
}
