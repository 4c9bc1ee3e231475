//! The tests of this folder in one executable.

mod cia402;
mod elastic_joint;
mod electrical;
mod fitting;
mod fixed_table;
mod friction;
mod linkages;
mod lookup;
mod transmissions;
mod vectors;
