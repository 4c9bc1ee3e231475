//! What the command `gangwerk` is made of, for the command itself and for tests and studies.

pub mod chain;
pub mod figures;
pub mod plot;
