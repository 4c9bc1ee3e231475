//! Drives: what lies between the terminals of a motor and the joints it moves.
//!
//! - [`Motor`]: voltage to current to torque (2.57), (2.58).
//! - [`Transmission`]: motor angle as a function of joint angles: harmonic drives, [`Knee`] roller screw (2.14)-(2.21),
//!   [`Ankle`] slider-crank with belt (2.22)-(2.33); first and second derivatives; errors where a linkage has none.
//! - [`Friction`]: of gears (2.61) and roller screws (2.65)-(2.68), with the load torque (2.63), (2.64).
//! - [`Elasticity`]: of harmonic drives (2.69).
//! - [`JointControl`]: laws of joint control (5.40), (5.43), (5.45), (5.49); [`elastic_joint`]: their stability
//!   (5.41)-(5.52), continuous and sampled. [`CascadePi`]: sampled cascade with an integral (Daniali 2013, 5.3), which has
//!   its speed from a [`SpeedEstimator`].
//! - [`lookup`]: tables of a linkage with linear interpolation; [`FixedTable`]: the same in 32-bit integers, as Lola's local
//!   controllers have them.
//! - [`cia402`]: states of a drive, seen from itself and from its master; [`homing`]: the reference of its angle;
//!   [`thermal`]: temperature of its winding.
//! - [`point_table`]: cubics between the points of a table, as drives play it; [`table_player`]: a drive that does.
//! - [`fit`]: friction parameters from efficiencies (2.62); off-line, it allocates.
//!
//! Pure mathematics: no file, no clock, and no allocation after construction. All quantities of a motor are those of its
//! rotor relative to its stator: angle, speed \[rad/s\] and torque count about the rotor's axis, not about the joint's.

mod ankle;
mod cascade_pi;
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
pub mod point_table;
mod reference;
mod speed_estimator;
pub mod table_player;
pub mod thermal;
mod transmission;
mod turn;

pub use ankle::{Ankle, AnkleGeometry};
pub use cascade_pi::{CascadeMemory, CascadeOutput, CascadePi, ServoMotor, ServoReference};
pub use control::{
    Cascade, ControlLaw, Feedback, GearSide, JointControl, Resolution, SamplePeriods, Sampled, Sampling,
    VoltageLaw,
};
pub use elasticity::Elasticity;
pub use fixed_table::FixedTable;
pub use friction::{Friction, HarmonicFriction, NoLoadTorque, ScrewFriction, Sliding};
pub use gear::{Gear, OutOfDomain};
pub use knee::{Knee, KneeGeometry};
pub use motor::Motor;
pub use speed_estimator::SpeedEstimator;
pub use transmission::Transmission;
