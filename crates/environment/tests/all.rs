//! The tests of this folder in one executable.

mod boxes;
mod meshes;
mod rays;
mod readers;
mod schedules;
mod triangles;
