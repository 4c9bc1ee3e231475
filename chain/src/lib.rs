//! A whole robot in one process, without clock and shared memory: `gangwerk sim`, and what studies and scorecard stand on.
//!
//! | module | what |
//! |---|---|
//! | [`Chain`] | every process's step, one after the other: one call is one bus cycle |
//! | [`figures`] | figures of a walk, gathered cycle by cycle |
//! | [`ending`] | how a run ended, and of several causes the first |
//! | [`LogWriter`] | its log |
//! | [`depth`] | `depth = "auto"`: the cheapest model that is as accurate as a scene asks |
//! | [`parallel`] | many chains on all cores |

mod chain;
pub mod depth;
pub mod ending;
pub mod figures;
mod log_writer;
pub mod parallel;

pub use chain::{Chain, Cycle};
pub use log_writer::LogWriter;
