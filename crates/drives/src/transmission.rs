//! Transmission: the angle of a motor as a function of the joint angles, with both derivatives: [`Gear`].
//!
//! Source: thesis 2.2.3; errata 1, F3 (sign of N), F4, F5 (second derivatives, domain).

use crate::{Ankle, Gear, Knee, OutOfDomain};

/// Coupling of one motor to its joints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Transmission {
    /// Harmonic drive on one joint.
    Harmonic {
        /// \[1\] N = φ/q, signed: with the circular spline on the stator's side, and the rotor's axis parallel to the
        /// joint's, the rotor turns against the joint: N < 0 (errata 1, F3).
        ratio: f64,
    },
    /// Roller screw across one joint.
    Knee(Knee),
    /// Roller screw with coupler on two joints, driven past the knee: joints \[knee, adduction, flexion\].
    Ankle(Ankle),
}

impl Transmission {
    /// Number of joints it couples to.
    pub fn joints(&self) -> usize {
        match self {
            Self::Harmonic { .. } | Self::Knee(_) => 1,
            Self::Ankle(_) => 3,
        }
    }

    /// Motor angle and derivatives at joint angles `q` \[rad\] and speeds `qd` \[rad/s\]; entries behind the last joint
    /// are not read.
    pub fn at(&self, q: [f64; 3], qd: [f64; 3]) -> Result<Gear, OutOfDomain> {
        let gear = match self {
            Self::Harmonic { ratio } => Gear { angle: ratio * q[0], ratio: [*ratio, 0.0, 0.0], bias: 0.0 },
            Self::Knee(knee) => knee.at(q[0], qd[0])?,
            Self::Ankle(ankle) => ankle.at(q, qd)?,
        };
        let finite =
            gear.angle.is_finite() && gear.bias.is_finite() && gear.ratio.iter().all(|n| n.is_finite());
        if finite { Ok(gear) } else { Err(OutOfDomain::NotFinite) }
    }
}
