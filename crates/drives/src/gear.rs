//! State of a transmission: motor angle and derivatives, or why it has none.
//!
//! | symbol | name | unit | frame |
//! |---|---|---|---|
//! | φ | `Gear::angle` | rad | rotor against stator |
//! | ∂φ/∂q | `Gear::ratio`, the non-zero entries of row 3 of J_Rrel | 1 | |
//! | φ'' : q̇ q̇ | `Gear::bias`, rotor acceleration at q̈ = 0 | rad/s² | |
//!
//! The rotor's relative acceleration is `ratio · q̈ + bias`; a motor torque T acts on joint j with `ratio[j] T`.

use std::fmt;

/// A transmission in one state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gear {
    /// \[rad\] Angle φ of the motor; 0 where all joint angles are.
    pub angle: f64,
    /// \[1\] ∂φ/∂q for every joint; 0 behind the last one.
    pub ratio: [f64; 3],
    /// \[rad/s^2\] Acceleration φ'' of the motor while the joints' is zero.
    pub bias: f64,
}

/// Why a transmission has no value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OutOfDomain {
    /// The coupler of an ankle does not reach from the foot to the screw, or stands across it.
    Coupler {
        /// \[m^2\] D of errata 1, F5; the coupler reaches while it is positive.
        margin: f64,
    },
    /// The line of a knee's screw passes through the joint, or has passed to its other side.
    Lever {
        /// \[m\] Lever of the screw about the joint, positive on the side it has at angle 0.
        margin: f64,
    },
    /// No joint angles belong to these motor angles, or none were found from this guess.
    NoAngle {
        /// \[rad\] Least distance of a motor angle that was met.
        residual: f64,
    },
    /// A joint angle lies outside of a look-up table.
    Table {
        /// \[rad\] The angle.
        angle: f64,
    },
    /// A joint angle or speed is not finite, or too large for a finite result.
    NotFinite,
}

impl Gear {
    /// \[rad/s\] Speed of the motor at joint speeds `qd`.
    pub fn speed(&self, qd: [f64; 3]) -> f64 {
        self.ratio[0] * qd[0] + self.ratio[1] * qd[1] + self.ratio[2] * qd[2]
    }

    /// \[rad/s^2\] Acceleration of the motor at joint accelerations `qdd`.
    pub fn acceleration(&self, qdd: [f64; 3]) -> f64 {
        self.speed(qdd) + self.bias
    }
}

impl fmt::Display for OutOfDomain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Coupler { margin } => write!(
                f,
                "ankle linkage at its dead point: margin D = {margin:.3e} m^2 must be positive; keep the ankle away \
                 from it or make the coupler longer"
            ),
            Self::Lever { margin } => write!(
                f,
                "knee linkage at its dead point: lever = {margin:.3e} m must be positive; keep the knee away from it"
            ),
            Self::NoAngle { residual } => {
                write!(
                    f,
                    "no joint angles belong to these motor angles; the nearest miss them by {residual:.3e} rad"
                )
            }
            Self::Table { angle } => {
                write!(f, "joint angle {angle:.3} rad lies outside of the look-up table")
            }
            Self::NotFinite => write!(f, "joint angle or speed not finite"),
        }
    }
}

impl std::error::Error for OutOfDomain {}
