//! The tests of this folder in one executable.

mod bus_faults;
mod bus_faults_type3;
mod gallery;
mod legs;
mod limits;
mod stalls;
