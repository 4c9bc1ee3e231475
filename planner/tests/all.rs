//! The tests of this folder in one executable.

mod catching_steps;
mod cog_methods;
mod foot_rollover;
mod methods;
mod obstacles;
mod pattern;
mod random;
mod robot;
mod slope;
mod small_turns;
mod stops;
mod told_boxes;
mod touchdown;
mod vectors;
mod walking;
mod widths;
