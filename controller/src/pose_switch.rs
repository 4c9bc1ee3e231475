//! Switch to a plan that begins at the measured pose: the joints are led on from where they are.
//!
//! Seen from the torso, soles are where they were a cycle before. What the new plan has elsewhere is taken up: turns
//! about the horizontal axes by the modification of each foot, distances by its residue. Both fade, or are
//! force controlled, as everything is that the stabilizer has modified.

use crate::force_control::Modification;
use crate::plan_follower::Desired;
use crate::torso;
use nalgebra::{Matrix3, Rotation3, Vector3};

/// Takes up the step from the pose `before`, which the last cycle led to, to that of the new plan `now`.
pub(crate) fn take_up(modification: &mut Modification, before: &Desired, now: &Desired) {
    let [old, new] = [before, now].map(|at| torso::rotation(&Vector3::from(at.torso.position)));
    let (Some(old), Some(new)) = (old, new) else { return };
    for foot in 0..2 {
        let m = modification.value.fixed_rows::<3>(3 * foot).into_owned();
        let place = |at: &Desired, rotation: &Matrix3<f64>| {
            let [x, y, z, _] = at.feet[foot].position;
            rotation.transpose() * (Vector3::new(x, y, z + m[0]) - Vector3::from(at.body.position))
        };
        let axes = |at: &Desired, rotation: &Matrix3<f64>| {
            let heading = Rotation3::from_axis_angle(&Vector3::z_axis(), at.feet[foot].position[3]);
            let pitch = Rotation3::from_axis_angle(&Vector3::y_axis(), at.pitch[foot].position[0]);
            rotation.transpose() * (heading * pitch).matrix()
        };
        modification.residue[foot] += place(before, &old) - place(now, &new);
        // Pitch after roll, as the task has it; what turns about the vertical is left to the task.
        let tilt = Rotation3::from_axis_angle(&Vector3::y_axis(), m[2])
            * Rotation3::from_axis_angle(&Vector3::x_axis(), m[1]);
        let turned = axes(now, &new).transpose() * axes(before, &old) * tilt.matrix();
        modification.value[3 * foot + 1] = turned[(2, 1)].atan2(turned[(2, 2)]);
        modification.value[3 * foot + 2] = -turned[(2, 0)].clamp(-1.0, 1.0).asin();
    }
}
