//! What the command `gangwerk` is made of, for the command itself and for tests and studies.

pub mod can;
pub mod choose;
pub mod fit_friction;
pub mod param;
pub mod plot;
pub mod run;
pub mod scorecard;
pub mod sim;
pub mod topic;

pub use studies::{chain, figures};

/// Where the processes of a robot meet, unless said otherwise: on a tmpfs.
pub const RUN_DIR: &str = "/dev/shm/gangwerk";
