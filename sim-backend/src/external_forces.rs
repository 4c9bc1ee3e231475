//! What acts on the robot besides the ground.

use multibody::{Data, Model};
use nalgebra::{Vector3, Vector6};

use crate::crane::Rope;
use crate::feet::Feet;
use crate::plant::orientation;

/// What acts on the robot besides the ground.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outside {
    /// \[N\] @world Push at the torso's own centre of gravity.
    pub push: [f64; 3],
    /// Motor supply.
    pub powered: bool,
    /// Drives whose power stage is off all the same, one bit each.
    pub off: u64,
    /// Drives whose brakes are closed, one bit each; one without a brake does not care.
    pub braked: u64,
    /// Drives that have not had torque yet, one bit each: until then somebody holds their joints in the start pose.
    pub held: u64,
    /// Rope that holds the torso.
    pub rope: Option<Rope>,
}

impl Outside {
    /// Sum of push and rope in a state x with these speeds: force \[N\], and moment about the world's origin \[N m\],
    /// world axes.
    pub(crate) fn total(&self, model: &Model, x: &[f64], speed: &[f64]) -> (Vector3<f64>, Vector3<f64>) {
        let place = Vector3::from_column_slice(&x[..3]);
        let pushed = place + orientation(x) * model.base_cog();
        let push = Vector3::from(self.push);
        let (mut force, mut moment) = (push, pushed.cross(&push));
        if let Some(rope) = &self.rope {
            let (pull, at) = rope.in_state(x, speed);
            force += pull;
            moment += at.cross(&pull);
        }
        (force, moment)
    }
}

/// Generalized force of ground, push and rope (2.40) in a state x with these speeds.
pub(crate) fn outside_force(
    model: &Model,
    data: &Data,
    feet: &Feet,
    outside: &Outside,
    (x, speed): (&[f64], &[f64]),
    force: &mut [f64],
) {
    force.fill(0.0);
    feet.add_to(model, data, force);
    if outside.push == [0.0; 3] && outside.rope.is_none() {
        return;
    }
    let (total, moment) = outside.total(model, x, speed);
    for (f, b) in force.iter_mut().zip(at_base(x, &total, &moment).iter()) {
        *f += b;
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
