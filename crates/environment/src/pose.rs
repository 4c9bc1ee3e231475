//! Place and attitude of an object.

use nalgebra::{UnitQuaternion, Vector3};

/// Pose of an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// \[m\] @world Origin of the mesh.
    pub position: Vector3<f64>,
    /// world_from_mesh
    pub rotation: UnitQuaternion<f64>,
}

impl Pose {
    /// At the origin, not turned.
    pub fn identity() -> Self {
        Self { position: Vector3::zeros(), rotation: UnitQuaternion::identity() }
    }

    /// Turned by `roll`, then `pitch`, then `yaw` \[rad\] about x, y and z of the world, and moved to `position` \[m\].
    pub fn new(position: [f64; 3], [roll, pitch, yaw]: [f64; 3]) -> Self {
        Self { position: position.into(), rotation: UnitQuaternion::from_euler_angles(roll, pitch, yaw) }
    }

    /// `s` of the way to `other`: straight, and about one axis.
    pub(crate) fn towards(&self, other: &Self, s: f64) -> Self {
        if self == other {
            return *self;
        }
        let rotation = self.rotation.try_slerp(&other.rotation, s, 1e-9).unwrap_or(other.rotation);
        Self { position: self.position.lerp(&other.position, s), rotation }
    }
}
