//! The tests of this folder in one executable.

mod bad_descriptions;
mod free_flight;
mod identities;
mod leg_as_printed;
mod leg_failures;
mod leg_round_trip;
mod leg_vectors;
mod legs;
mod rotors;
mod thesis_vectors;
mod tree;
