//! The tests of this folder in one executable.

mod components;
mod joint_control;
mod methods;
mod objects;
mod power;
mod resolution;
mod rig;
mod robot;
mod sensors;
mod sensors_in_time;
mod servo;
mod step_limit;
mod stiff;
mod stiff_robot;
mod tables;
mod types;
