//! The position half of figure 5.8: task velocities with their modification, and the joints without a task.

use curves::Sample;
use nalgebra::{Matrix3, Rotation3, Vector3};

use super::Controller;
use crate::approach::Approach;
use crate::following::Desired;
use crate::inverse_kinematics::{JointVector, TaskVector};
use crate::torso;

/// How joints without a task go to their comfortable angles.
const SETTLE: Approach = Approach { rate: 2.0, speed: 0.5, acceleration: 5.0 };

/// \[rad\] Toes are not held against the ground further than this from where they are.
const YIELD: f64 = 0.05;

impl Controller {
    /// Axes of the planned foot (heading x, y, normal of the sole) in torso axes.
    pub(super) fn foot_axes(&self, torso: &Matrix3<f64>, at: &Desired, foot: usize) -> Matrix3<f64> {
        let heading = Rotation3::from_axis_angle(&Vector3::z_axis(), at.feet[foot].position[3]);
        torso.transpose() * (heading * pitched(at.pitch[foot].position[0])).matrix()
    }

    /// x'_d1 with drift compensation K_x (x_d1 - x), torso axes (5.33), (5.35).
    pub(super) fn task_velocity(&self, torso: &Matrix3<f64>, end: &Desired) -> TaskVector {
        let back = torso.transpose();
        let omega = back * torso_omega(torso, end);
        let com = Vector3::from(end.com.position);
        let com_velocity = Vector3::from(end.com.velocity);
        let mut x = TaskVector::zeros();
        for foot in 0..2 {
            let s = &end.feet[foot];
            let axes = self.foot_axes(torso, end, foot);
            let [deformation, deforming] = self.deformation(foot);
            let m = self.modification.value.fixed_rows::<3>(3 * foot) + deformation;
            let m_rate = self.modification.rate.fixed_rows::<3>(3 * foot) + deforming;
            let vertical = back.column(2);

            let position =
                back * (Vector3::new(s.position[0], s.position[1], s.position[2]) - com) + vertical * m[0];
            let velocity = back * (Vector3::new(s.velocity[0], s.velocity[1], s.velocity[2]) - com_velocity)
                + vertical * m_rate[0]
                - omega.cross(&position);
            let tilt = Rotation3::from_axis_angle(&Vector3::y_axis(), m[2])
                * Rotation3::from_axis_angle(&Vector3::x_axis(), m[1]);
            let rotation = axes * tilt.matrix();
            let pitching = end.pitch[foot].velocity[0];
            let turning =
                axes * Vector3::new(m_rate[1], m_rate[2] + pitching, 0.0) + vertical * s.velocity[3] - omega;

            let is = self.desired.sole(foot);
            let position_error = position - (is.position - self.desired.com());
            let rotation_error = rotation_vector(&(rotation * is.rotation.transpose()));
            let k = self.drift();
            x.fixed_rows_mut::<3>(6 * foot).copy_from(&(velocity + position_error * k));
            x.fixed_rows_mut::<3>(6 * foot + 3).copy_from(&(turning + rotation_error * k));
        }
        x
    }

    /// As planned; a toe that is to lie flat and is bent by more than [`YIELD`], as on the edge of a board, gives way.
    /// One that moves as planned lags behind as far, and must not.
    fn toe_speed(&self, plan: &Sample<1>, toe: usize) -> f64 {
        let bent = self.state.tracking_error[toe]; // q_d - q
        let over = bent - bent.clamp(-YIELD, YIELD);
        let back = (plan.position[0] - self.angle[toe]) * self.drift();
        let moving = plan.velocity[0] != 0.0 || plan.acceleration[0] != 0.0;
        if over == 0.0 || moving {
            plan.velocity[0] + back.clamp(-SETTLE.speed, SETTLE.speed)
        } else {
            -over * self.drift()
        }
    }

    /// Speeds of the joints that no foot needs: toes as planned, the others to their comfortable angles.
    pub(super) fn given_speeds(&self, end: &Desired) -> JointVector {
        let mut speeds = JointVector::zeros();
        let settle = SETTLE.eased(self.share());
        for (j, joint) in self.robot.joints.iter().enumerate().filter(|(j, _)| !self.free[*j]) {
            speeds[j] = settle.next(joint.comfort - self.angle[j], self.speed[j], self.dt);
        }
        for (foot, toe) in self.robot.feet.iter().enumerate().filter_map(|(i, f)| Some((i, f.toe?))) {
            speeds[toe] = self.toe_speed(&end.toes[foot], toe);
        }
        speeds
    }
}

/// Rotation of a sole about its own y axis \[rad\].
pub(super) fn pitched(angle: f64) -> Rotation3<f64> {
    Rotation3::from_axis_angle(&Vector3::y_axis(), angle)
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
