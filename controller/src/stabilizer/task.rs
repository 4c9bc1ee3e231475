//! Task velocities (figure 5.8) with their modification (5.33), (5.35), and how modifications move the soles
//! (5.30).

use nalgebra::{Matrix3, Matrix6, Rotation3, SMatrix, Vector3};

use super::cycle::ControlCycle;
use crate::force_control::Modification;
use crate::inverse_kinematics::{TASK, TaskVector};
use crate::plan_follower::Desired;
use crate::torso;

/// One unit of each component of the modification, (z, roll, pitch) right, then left, as task velocities.
pub(super) fn unit_modifications(cycle: &ControlCycle<'_>) -> SMatrix<f64, TASK, 6> {
    let mut unit = SMatrix::<f64, TASK, 6>::zeros();
    for foot in 0..2 {
        let axes = cycle.foot_axes(foot);
        unit.fixed_view_mut::<3, 1>(6 * foot, 3 * foot).copy_from(&axes.column(2));
        unit.fixed_view_mut::<3, 1>(6 * foot + 3, 3 * foot + 1).copy_from(&axes.column(0));
        unit.fixed_view_mut::<3, 1>(6 * foot + 3, 3 * foot + 2).copy_from(&axes.column(1));
    }
    unit
}

/// N: lift, roll and pitch of both soles against the torso per unit of modification, from the `speeds` of the joints that
/// realise it (5.30); `free` marks the joints that take part.
pub(super) fn sole_motion<const JOINTS: usize>(
    cycle: &ControlCycle<'_>,
    speeds: &SMatrix<f64, JOINTS, 6>,
    free: &[bool],
) -> Matrix6<f64> {
    let mut motion = Matrix6::zeros();
    for foot in 0..2 {
        let rows = cycle.foot_axes(foot).transpose();
        let mut of_foot = SMatrix::<f64, 3, 6>::zeros();
        let columns = cycle.kinematics.sole_jacobian(foot).column_iter().enumerate();
        for (j, twist) in columns.filter(|(j, _)| free[*j]) {
            let (linear, turn) = (rows * twist.fixed_rows::<3>(0), rows * twist.fixed_rows::<3>(3));
            of_foot += Vector3::new(linear.z, turn.x, turn.y) * speeds.row(j);
        }
        motion.fixed_rows_mut::<3>(3 * foot).copy_from(&of_foot);
    }
    motion
}

/// x'_d1 with drift compensation K_x (x_d1 - x), torso axes (5.33), (5.35); `drift` is K_x \[1/s\], `deformation` that of
/// each sole and its rate.
pub(super) fn task_velocity(
    cycle: &ControlCycle<'_>,
    modification: &Modification,
    deformation: &[[Vector3<f64>; 2]; 2],
    drift: f64,
) -> TaskVector {
    let (end, torso) = (cycle.end, &cycle.torso);
    let back = torso.transpose();
    let omega = back * torso_omega(torso, end);
    let com = Vector3::from(end.body.position);
    let com_velocity = Vector3::from(end.body.velocity);
    let mut x = TaskVector::zeros();
    for foot in 0..2 {
        let s = &end.feet[foot];
        let axes = cycle.foot_axes(foot);
        let [deformed, deforming] = deformation[foot];
        let m = modification.value.fixed_rows::<3>(3 * foot) + deformed;
        let m_rate = modification.rate.fixed_rows::<3>(3 * foot) + deforming;
        let vertical = back.column(2);

        // Sole against the centre of gravity, seen from the torso, which turns itself.
        let mut position =
            back * (Vector3::new(s.position[0], s.position[1], s.position[2]) - com) + vertical * m[0];
        let mut velocity = back * (Vector3::new(s.velocity[0], s.velocity[1], s.velocity[2]) - com_velocity)
            + vertical * m_rate[0]
            - omega.cross(&position);
        if modification.residue[foot] != Vector3::zeros() {
            position += modification.residue[foot];
            velocity += modification.residue_rate[foot];
        }
        let tilt = Rotation3::from_axis_angle(&Vector3::y_axis(), m[2])
            * Rotation3::from_axis_angle(&Vector3::x_axis(), m[1]);
        let rotation = axes * tilt.matrix();
        let pitching = end.pitch[foot].velocity[0];
        let turning =
            axes * Vector3::new(m_rate[1], m_rate[2] + pitching, 0.0) + vertical * s.velocity[3] - omega;

        // Integrated speeds drift: what is left between target and kinematics is taken back.
        let is = cycle.kinematics.sole(foot);
        let position_error = position - (is.position - cycle.kinematics.com());
        let rotation_error = rotation_vector(&(rotation * is.rotation.transpose()));
        x.fixed_rows_mut::<3>(6 * foot).copy_from(&(velocity + position_error * drift));
        x.fixed_rows_mut::<3>(6 * foot + 3).copy_from(&(turning + rotation_error * drift));
    }
    x
}

/// \[rad/s\] @I Planned angular velocity of the torso.
fn torso_omega(torso: &Matrix3<f64>, at: &Desired) -> Vector3<f64> {
    let rates = Vector3::from(at.torso.velocity);
    if rates == Vector3::zeros() {
        return rates;
    }
    torso::rates_from_omega(torso).try_inverse().map_or(Vector3::zeros(), |m| m * rates)
}

/// Rotation vector of a small rotation.
fn rotation_vector(r: &Matrix3<f64>) -> Vector3<f64> {
    // Twice the quaternion's vector part to first order; the drift loop sees it every cycle.
    Vector3::new(r[(2, 1)] - r[(1, 2)], r[(0, 2)] - r[(2, 0)], r[(1, 0)] - r[(0, 1)]) * 0.5
}
