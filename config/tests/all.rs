//! The tests of this folder in one executable.

mod archie;
mod bus_faults;
mod cog_method;
mod components;
mod dbc;
mod drive_errors;
mod drives;
mod errors;
mod frames;
mod friction_ramp;
mod johnnie;
mod legs;
mod lola;
mod names;
mod pattern;
mod robot;
mod sensors;
mod shipped;
mod terrain;
mod tolerance;
mod urdf;
