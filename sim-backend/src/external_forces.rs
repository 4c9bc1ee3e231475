//! External forces on the torso: pushes and the crane's rope; the ground is in `ground.rs`.

use multibody::Model;
use nalgebra::{Vector3, Vector6};

use crate::crane::Rope;
use crate::layout::orientation;

/// Forces on the torso besides those of gravity and ground.
#[derive(Clone, Copy, Debug, Default)]
pub struct ExternalForces {
    /// \[N\] @world Push at the torso's own centre of gravity.
    pub push: [f64; 3],
    /// \[N m\] @world Moment of the push about that point, if it acts beside it.
    pub push_moment: [f64; 3],
    /// Rope that holds the torso.
    pub rope: Option<Rope>,
}

impl ExternalForces {
    /// Sum of push and rope in a state x with these speeds: force \[N\], and moment about the world's origin \[N m\],
    /// world axes.
    pub(crate) fn total(&self, model: &Model, x: &[f64], speed: &[f64]) -> (Vector3<f64>, Vector3<f64>) {
        let place = Vector3::from_column_slice(&x[..3]);
        let pushed = place + orientation(x) * model.base_cog();
        let push = Vector3::from(self.push);
        let (mut force, mut moment) = (push, pushed.cross(&push) + Vector3::from(self.push_moment));
        if let Some(rope) = &self.rope {
            let (pull, at) = rope.in_state(x, speed);
            force += pull;
            moment += at.cross(&pull);
        }
        (force, moment)
    }

    /// Adds push and rope in a state x with these speeds to a generalized force (2.40).
    pub(crate) fn add_to(&self, model: &Model, x: &[f64], speed: &[f64], force: &mut [f64]) {
        if self.push == [0.0; 3] && self.rope.is_none() {
            return;
        }
        let (total, moment) = self.total(model, x, speed);
        for (f, b) in force.iter_mut().zip(at_base(x, &total, &moment).iter()) {
            *f += b;
        }
    }
}

/// Force and moment about the torso's origin, torso axes, of a force \[N\] and its moment about the world's origin
/// \[N m\], world axes.
pub(crate) fn at_base(x: &[f64], force: &Vector3<f64>, moment: &Vector3<f64>) -> Vector6<f64> {
    let inverse = orientation(x).inverse();
    let r = Vector3::from_column_slice(&x[..3]);
    let (f, m) = (inverse * force, inverse * (moment - r.cross(force)));
    Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z)
}
