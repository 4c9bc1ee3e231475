//! Rotation about a joint's axis, applied to vectors: Rodrigues' formula.

use nalgebra::Vector3;

/// Rotation by an angle about a unit vector: takes components in the child's frame to those in the parent's.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rotation {
    axis: Vector3<f64>,
    sin: f64,
    cos: f64,
}

impl Rotation {
    /// `axis` is a unit vector, `angle` in rad.
    pub(crate) fn new(axis: Vector3<f64>, angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self { axis, sin, cos }
    }

    /// The vector, turned.
    pub(crate) fn of(&self, v: &Vector3<f64>) -> Vector3<f64> {
        v * self.cos + self.axis.cross(v) * self.sin + self.axis * (self.axis.dot(v) * (1.0 - self.cos))
    }
}
