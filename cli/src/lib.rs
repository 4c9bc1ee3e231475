//! Parts of the command `gangwerk`, for the command itself, for the Python package and for tests.

// println! and eprintln! here do not panic: a result that cannot be written is an error, a remark is dropped.
#[macro_use(println, eprintln)]
extern crate terminal;

pub mod can;
pub mod choose;
pub mod estop;
pub mod exit;
pub mod faults;
pub mod film;
pub mod fit_friction;
pub mod latency;
pub mod log;
pub mod operator;
pub mod param;
pub mod plot;
pub mod preview;
pub mod replay;
pub mod run;
pub mod scorecard;
pub mod shipped;
pub mod sim;
pub mod topic;

/// Git commit that this program was built from, `-dirty` with changes; empty: unknown.
pub const COMMIT: &str = env!("GANGWERK_COMMIT");

/// Version with that commit.
pub const VERSION: &str = env!("GANGWERK_VERSION");
