//! Speed against accuracy, and where methods fail: `gangwerk study ...`.
//!
//! | study | question |
//! |---|---|
//! | [`accuracy`] | which method is cheapest for a given accuracy? |
//! | [`push`] | which impulse does the walking robot survive? |
//! | [`stability`] | how near to falling is a walk, how fast does it forget, what does it survive? |
//! | [`limits`] | where do methods fail, and is it told? |
//! | [`speed`], [`simulation_speed`] | how fast is each part, and how accurate is it at that speed? |
//! | [`bus`] | what does the field bus cost, in time, room on its lines and accuracy of the walk? |
//! | [`lines`] | how punctual is a cycle over CAN lines, beside cyclictest? |
//! | [`tables`] | what do look-up tables, counts and a slower bus cost the joints? |
//! | [`arm_swing`] | what do swinging arms take from the soles? |
//! | [`figures_of_thesis`] | are the figures of the thesis found again? |
//! | [`scorecard`] | does everything walk that is to walk, and how well beside what others reached? |
//! | [`stalls`] | what does a walking robot do when a process is stopped and goes on? |
//! | [`bus_faults`] | what does a walking robot do when the bus fails? |
//! | [`cycles`] | how well did the processes of a run keep real time? |
//!
//! They work on [`chain`], a whole robot in one process; [`second`] replays a part of it.

pub mod accuracy;
pub mod arm_swing;
pub mod bus;
pub mod bus_faults;
pub mod cycles;
pub mod figures_of_thesis;
pub mod limits;
pub mod lines;
pub mod push;
pub mod scorecard;
pub mod second;
pub mod simulation_speed;
pub mod speed;
pub mod stability;
pub mod stalls;
pub mod tables;
