//! The tests of this folder in one executable.

mod commands_explored;
mod commands_walked;
mod depth;
mod feedback;
mod gaze;
mod inclination_trim;
mod joint_tables;
mod reaction;
mod rearming;
mod standing_up;
mod start_up;
mod start_up_explored;
mod static_walk;
mod steps;
mod steps_over;
mod subnormals;
mod supply_explored;
mod told_boxes;
