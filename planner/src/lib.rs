//! Walking commands to plans: the planning half of thesis figure 4.1.
//!
//! | stage of figure 4.1 | thesis | errata | module |
//! |---|---|---|---|
//! | gait coordination, finite state machine | 4.2, figure 4.5 | | [`gait`], `touchdown`, [`origin`] |
//! | walking commands | 4.6.1 | | [`commands`], [`lease`] |
//! | step sequence planning | 4.3, (4.1)-(4.4) | 2.1, 2.2 | [`footsteps`], [`steps`] |
//! | steps that react to pushes | | | `reaction`, `step_adaptation` |
//! | reactive step sequence planning, algorithm 3 | 4.3.3 | | `reactive`, [`obstacles`], `told_boxes` |
//! | higher level behaviour | 4.3.4 | | [`skills`] |
//! | foot trajectories | 4.5, (4.22)-(4.28) | 2.5 | [`feet`] |
//! | foot rollover, toe joints | 4.5, (4.29), (4.30) | 2.5, gaps 7, 8 | [`foot_rollover`] |
//! | upper body orientation | 4.4.4, (4.11)-(4.13) | 2.3 | [`torso`] |
//! | contact force (ZMP) trajectory | 4.6.4, (4.40)-(4.43) | 2.10 | `segment`, [`zmp`], `active_set`, [`sole`] |
//! | centre-of-gravity trajectory | 4.6.3, 4.6.5, (4.31)-(4.54) | 2.6-2.9 | `balance`, [`com`], [`boundary`], `cog_method`: [`collocation`] or [`closed_form`] |
//! | contact force distribution | 4.8, (4.62) | gap 15 | [`load`] |
//! | all of them, in this order | | | [`walk`] |
//! | instead of the last five: a pattern with fixed parameters | Daniali 2013, 4.2 | its errata 2.6, 2.7 | `pattern` |
//!
//! [`Planner::step`] is pure: no clock, no input or output, no allocation after construction.

mod active_set;
mod balance;
pub mod boundary;
pub mod closed_form;
mod cog_method;
pub mod collocation;
pub mod com;
pub mod commands;
pub mod daemon;
pub mod feet;
pub mod foot_rollover;
pub mod footsteps;
pub mod gait;
pub mod lease;
pub mod load;
mod marks;
pub mod obstacles;
pub mod origin;
mod parameters;
mod pattern;
pub mod pattern_check;
pub mod planned_walk;
pub mod pose;
mod reaction;
mod reactive;
mod segment;
pub mod skills;
pub mod sole;
mod step_adaptation;
pub mod steps;
mod told_boxes;
pub mod torso;
mod touchdown;
mod two_quartics;
pub mod verdict;
pub mod walk;
pub mod walking_model;
pub mod zmp;

pub use gait::{Planner, PlannerOutput};
pub use planned_walk::LEAD;
