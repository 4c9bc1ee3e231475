//! What can be wrong with a leg: its rows, and poses that it cannot take.

use std::fmt;

/// Entry of a Denavit-Hartenberg row that the closed form of a leg has no place for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegRowError {
    /// Row, from 0.
    pub row: usize,
    /// `a`, `alpha`, `d` or `theta`.
    pub entry: &'static str,
    /// \[m, rad\] What it is.
    pub value: f64,
    /// What it has to be.
    pub wanted: &'static str,
}

/// Why a leg has no angles for a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LegError {
    /// A number of the pose is not finite.
    NotFinite,
    /// The matrix of the pose is no rotation.
    NotARotation {
        /// Largest entry of R^T R - 1.
        error: f64,
        /// The largest that is accepted.
        tolerance: f64,
        /// The determinant is negative.
        mirrored: bool,
    },
    /// The hip centre lies nearer to the first axis of the ankle than the plane of the leg.
    InsideAnkleCylinder {
        /// \[m\] Of the hip centre from the axis.
        distance: f64,
        /// \[m\] Of the plane of the leg from the axis.
        radius: f64,
    },
    /// The hip centre lies level with the first axis of the ankle, whose angle is then not determined.
    AnkleSingular {
        /// \[m\] Height of the hip centre over the axis in the plane of the leg.
        rho: f64,
        /// \[m\] The least that is accepted.
        least: f64,
    },
    /// The straight leg is too short.
    TooFar {
        /// \[m\] From the second axis of the ankle to the hip centre, in the plane of the leg.
        distance: f64,
        /// \[m\] Thigh and shank, straight.
        reach: f64,
    },
    /// Thigh and shank differ by more than the distance.
    TooNear {
        /// \[m\] From the second axis of the ankle to the hip centre, in the plane of the leg.
        distance: f64,
        /// \[m\] Difference of thigh and shank.
        least: f64,
    },
    /// The knee would have to bend further than it can.
    KneeLimit {
        /// \[rad\] Bend of the knee.
        angle: f64,
        /// \[rad\] Its largest.
        limit: f64,
    },
    /// The first and the last axis of the hip coincide; only the sum of their angles is determined.
    HipSingular {
        /// Sine of the angle between them.
        sine: f64,
        /// The least that is accepted.
        least: f64,
    },
    /// A joint would leave its range, where ranges are known.
    JointLimit {
        /// Index of the joint in the robot's arrays.
        joint: usize,
        /// \[rad\] Its angle, in the robot's sign.
        value: f64,
        /// \[rad\]
        range: [f64; 2],
    },
}

impl std::error::Error for LegRowError {}

impl fmt::Display for LegRowError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { row, entry, value, wanted } = self;
        write!(f, "row {}: {entry} is {value}; the closed form takes {wanted}", row + 1)
    }
}

impl std::error::Error for LegError {}

impl fmt::Display for LegError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotFinite => f.write_str("the pose has a number that is not finite"),
            Self::NotARotation { mirrored: true, .. } => {
                f.write_str("the matrix of the pose is no rotation: its determinant is negative, not 1")
            }
            Self::NotARotation { error, tolerance, .. } => {
                write!(
                    f,
                    "the matrix of the pose is no rotation: R^T R is {error:.1e} off 1, at most {tolerance:.0e}"
                )
            }
            Self::InsideAnkleCylinder { distance, radius } => write!(
                f,
                "the hip centre is {distance:.6} m from the frontal axis of the ankle; it takes at least {radius:.6} m"
            ),
            Self::AnkleSingular { rho, least } => write!(
                f,
                "the hip centre is level with the frontal axis of the ankle ({rho:.1e} m, at least {least:.0e} m): its angle is not determined"
            ),
            Self::TooFar { distance, reach } => {
                write!(f, "the hip is {distance:.6} m from the ankle; the straight leg has {reach:.6} m")
            }
            Self::TooNear { distance, least } => {
                write!(f, "the hip is {distance:.6} m from the ankle; the folded leg has {least:.6} m")
            }
            Self::KneeLimit { angle, limit } => {
                let (angle, limit) = (angle.to_degrees(), limit.to_degrees());
                write!(f, "the knee would be bent by {angle:.3} deg; it bends up to {limit:.0} deg")
            }
            Self::HipSingular { sine, least } => write!(
                f,
                "flexion and rotation of the hip turn about one axis (sine {sine:.1e}, at least {least:.0e}): their angles are not determined"
            ),
            Self::JointLimit { joint, value, range } => {
                let [value, lo, hi] = [value, range[0], range[1]].map(f64::to_degrees);
                write!(f, "joint {joint} would be at {value:.3} deg; its range is {lo:.3} to {hi:.3} deg")
            }
        }
    }
}
