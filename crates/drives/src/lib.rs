//! Drives: what lies between the terminals of a motor and the joints it moves.
//!
//! - [`Motor`]: voltage to current to torque (2.57), (2.58).
//! - [`Transmission`]: motor angle as a function of joint angles: harmonic drives, [`Knee`] roller screw (2.14)-(2.21),
//!   [`Ankle`] slider-crank with belt (2.22)-(2.33); first and second derivatives; errors where a linkage has none.
//! - [`Friction`]: of gears (2.61) and roller screws (2.65)-(2.68), with the load torque (2.63), (2.64).
//! - [`Elasticity`]: of harmonic drives (2.69).
//! - [`JointControl`]: laws of joint control (5.40), (5.43), (5.45), (5.49); [`elastic_joint`]: their stability
//!   (5.41)-(5.52), continuous and sampled.
//! - [`lookup`]: tables of a linkage with linear interpolation; [`FixedTable`]: the same in 32-bit integers, as Lola's local
//!   controllers have them.
//! - [`cia402`]: states of a drive, seen from itself and from its master; [`homing`]: the reference of its angle;
//!   [`thermal`]: temperature of its winding.
//! - [`fit`]: friction parameters from efficiencies (2.62); off-line, it allocates.
//!
//! Pure mathematics: no file, no clock, and no allocation after construction. All quantities of a motor are those of its
//! rotor relative to its stator: angle, speed \[rad/s\] and torque count about the rotor's axis, not about the joint's.

mod ankle;
pub mod cia402;
mod control;
pub mod elastic_joint;
mod elasticity;
pub mod fit;
pub mod fixed_table;
mod friction;
mod gear;
pub mod homing;
mod knee;
pub mod lookup;
mod motor;
mod reference;
pub mod thermal;
mod transmission;
mod turn;

pub use ankle::{Ankle, AnkleGeometry};
pub use control::{
    Cascade, ControlLaw, Feedback, GearSide, JointControl, Resolution, Sampled, Sampling, VoltageLaw,
};
pub use elasticity::Elasticity;
pub use fixed_table::FixedTable;
pub use friction::{Friction, HarmonicFriction, NoLoadTorque, ScrewFriction, Sliding};
pub use gear::{Gear, OutOfDomain};
pub use knee::{Knee, KneeGeometry};
pub use motor::Motor;
pub use transmission::Transmission;
