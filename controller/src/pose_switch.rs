//! Switch to a plan that begins at the measured pose: the joints are led on from where they are.
//!
//! Seen from the torso, soles are where they were a cycle before. What the new plan has elsewhere is taken up: turns
//! about the horizontal axes by the modification of each foot, distances by its residue. Both fade, or are
//! force controlled, as everything is that the stabilizer has modified. Modified heights end here: the measured pose has them.

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
        let place = |at: &Desired, rotation: &Matrix3<f64>, height: f64| {
            let [x, y, z, _] = at.feet[foot].position;
            rotation.transpose() * (Vector3::new(x, y, z + height) - Vector3::from(at.body.position))
        };
        let axes = |at: &Desired, rotation: &Matrix3<f64>| {
            let heading = Rotation3::from_axis_angle(&Vector3::z_axis(), at.feet[foot].position[3]);
            let pitch = Rotation3::from_axis_angle(&Vector3::y_axis(), at.pitch[foot].position[0]);
            rotation.transpose() * (heading * pitch).matrix()
        };
        modification.residue[foot] += place(before, &old, m[0]) - place(now, &new, 0.0);
        modification.value[3 * foot] = 0.0;
        // Pitch after roll, as the task has it; what turns about the vertical is left to the task.
        let tilt = Rotation3::from_axis_angle(&Vector3::y_axis(), m[2])
            * Rotation3::from_axis_angle(&Vector3::x_axis(), m[1]);
        let turned = axes(now, &new).transpose() * axes(before, &old) * tilt.matrix();
        modification.value[3 * foot + 1] = turned[(2, 1)].atan2(turned[(2, 2)]);
        modification.value[3 * foot + 2] = -turned[(2, 0)].clamp(-1.0, 1.0).asin();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use curves::Sample;
    use std::f64::consts::FRAC_PI_2;

    /// Seen from the torso, where and how a sole is led to: the task of `stabilizer/task.rs`, written out.
    fn led(m: &Modification, at: &Desired, foot: usize) -> (Vector3<f64>, Matrix3<f64>) {
        let torso = torso::rotation(&Vector3::from(at.torso.position)).unwrap();
        let [x, y, z, heading] = at.feet[foot].position;
        let v = m.value.fixed_rows::<3>(3 * foot);
        let sole = Vector3::new(x, y, z + v[0]) - Vector3::from(at.body.position);
        let turn = |axis, angle| *Rotation3::from_axis_angle(&axis, angle).matrix();
        let (x, y, z) = (Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis());
        let tilt = turn(y, at.pitch[foot].position[0]) * turn(y, v[2]) * turn(x, v[1]);
        (torso.transpose() * sole + m.residue[foot], torso.transpose() * turn(z, heading) * tilt)
    }

    fn pose(lean: [f64; 2], body: [f64; 3], frame: f64) -> Desired {
        let sole = |y: f64| Sample::rest([0.02, y, 0.01, 0.1 - frame]);
        Desired {
            body: Sample::rest(body),
            torso: Sample::rest([FRAC_PI_2 + lean[0], FRAC_PI_2 + lean[1], 0.05 - frame]),
            feet: [sole(0.0), sole(0.2)],
            pitch: [Sample::rest([0.0]), Sample::rest([0.1])],
            toes: [Sample::rest([0.0]); 2],
            zmp: [0.0; 2],
            load: [1.0, 0.0],
        }
    }

    /// An upright plan, and one that leans by 9 degrees with the body elsewhere: soles are led to the same poses.
    #[test]
    fn soles_stay_where_they_are_seen_from_the_torso() {
        let mut m = Modification::default();
        m.value.copy_from_slice(&[0.004, 0.01, -0.02, 0.0, -0.01, 0.03]);
        let before = pose([0.0; 2], [0.0, 0.1, 0.77], 0.0);
        let now = pose([0.12, -0.1], [0.09, 0.03, 0.76], 0.0);
        let (was, turned) = (led(&m, &before, 0), m);
        let other = led(&m, &before, 1);
        take_up(&mut m, &before, &now);
        for (foot, (place, rotation)) in [was, other].into_iter().enumerate() {
            let (p, r) = led(&m, &now, foot);
            assert!((p - place).norm() < 1e-12);
            // What is left turns about the vertical, and is of second order.
            let off = Rotation3::from_matrix_unchecked(r.transpose() * rotation);
            assert!(off.angle() < 0.02, "{}", off.angle());
        }
        assert!((m.value[1] - turned.value[1]).abs() > 0.05, "the lean is taken up");
        // Nothing to take up.
        let same = m;
        take_up(&mut m, &now, &now);
        assert!((m.value - same.value).norm() < 1e-12 && (m.residue[0] - same.residue[0]).norm() < 1e-12);
    }

    /// A foot that was put 40 mm lower, and a plan that has measured the body that much higher above it: nothing is left to
    /// fade, and no leg gets longer.
    #[test]
    fn the_height_of_a_lowered_foot_is_handed_over() {
        let mut m = Modification::default();
        m.value[3] = -0.04;
        let (before, now) = (pose([0.0; 2], [0.0, 0.1, 0.77], 0.0), pose([0.0; 2], [0.0, 0.1, 0.81], 0.0));
        let (was, other) = (led(&m, &before, 1).0, led(&m, &before, 0).0);
        take_up(&mut m, &before, &now);
        assert_eq!(m.value[3], 0.0);
        assert!(m.residue[1].norm() < 1e-12 && (led(&m, &now, 1).0 - was).norm() < 1e-12);
        assert!((led(&m, &now, 0).0 - other).norm() < 1e-12, "the other foot stays where it is");
    }
}
