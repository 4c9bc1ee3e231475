//! Trim of the inclination: what the inertial measurement unit reads too much, learned while the robot stands.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | c, c_z | centre of gravity as it is estimated, and its height over the ground | m |
//! | p | measured zero-moment point | m |
//! | b | trim: roll and pitch that are taken away from what is measured, @torso | rad |
//! | T | time constant | s |
//!
//! The centre of gravity of a robot that stands is over its zero-moment point, on any ground. If it is not, she leans more or less
//! than is measured, by (p - c)/c_z: the unit is mounted askew, or the centre of gravity is not where it is believed to
//! be. Either is taken away by `db/dt = -(p - c)/(c_z T)`. While she walks the trim stays: both sway there.

use nalgebra::{Quaternion, UnitQuaternion, Vector2, Vector3};

use crate::estimate::TaskEstimate;

/// \[s\] T.
const TIME_CONSTANT: f64 = 1.0;
/// \[m\] Largest distance, forward or to the side, that is taken for an error of the inclination: half of what a push of 15 N
/// makes.
const BELIEVED: f64 = 0.016;
/// \[rad\] Largest trim about each axis.
const LARGEST: f64 = 0.02;
/// \[1\] Share of the weight that the feet carry at least.
const CARRIED: f64 = 0.7;

/// Trim of the inclination.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct InclinationTrim {
    /// \[rad\]
    b: Vector2<f64>,
}

impl InclinationTrim {
    /// Takes the trim away from a measured orientation, world_from_torso (x, y, z, w).
    pub(crate) fn correct(&self, orientation: &mut [f64; 4]) {
        if self.b == Vector2::zeros() {
            return;
        }
        let [x, y, z, w] = *orientation;
        let measured = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
        let level = measured * UnitQuaternion::from_scaled_axis(Vector3::new(-self.b.x, -self.b.y, 0.0));
        *orientation = level.coords.into();
    }

    /// \[rad\] Roll and pitch that are taken away.
    pub(crate) fn angles(&self) -> [f64; 2] {
        self.b.into()
    }

    /// Learns from a cycle of `dt` \[s\] of standing, in which the feet carry `share` \[1\] of the weight.
    pub(crate) fn learn(&mut self, estimate: &TaskEstimate, share: f64, dt: f64) {
        if share < CARRIED {
            return;
        }
        let off = estimate.zmp - estimate.com.xy();
        let (s, c) = estimate.angles.z.sin_cos();
        let [forward, left] = [c * off.x + s * off.y, c * off.y - s * off.x];
        // A larger offset is a push, not a sensor mounted askew.
        let believed = |off: f64| if off.abs() < BELIEVED { off } else { 0.0 };
        let height = estimate.com.z - estimate.feet[0][2].min(estimate.feet[1][2]);
        // Roll brings the centre of gravity to the right, pitch to the front.
        let b = self.b + Vector2::new(believed(left), -believed(forward)) * (dt / (TIME_CONSTANT * height));
        self.b = b.map(|x| x.clamp(-LARGEST, LARGEST));
    }
}
