//! How stable a walk is: what the measures of the thesis's chapter 3 say, and what a robot really survives.
//!
//! | part | question |
//! |---|---|
//! | [`points`], [`cone`], [`contact_cone`], [`walk`], [`log`] | how near did a logged walk come to the limits of its contact? |
//! | [`poincare`], [`floquet`] | how fast does the periodic gait forget a small disturbance? |
//! | [`viability`] | which disturbances and errors does it survive? |
//!
//! The first are conditions that every motion meets while its feet stand (3.3.4), the second is stability in the small
//! (3.5), the third is what the thesis followed (3.4): simulate, and see whether the robot falls.

pub mod cone;
pub mod contact_cone;
mod errors;
pub mod floquet;
pub mod log;
mod picture;
pub mod poincare;
pub mod points;
pub mod viability;
pub mod walk;
