//! Task space as the sensors measure it.
//!
//! The inclination comes from the inertial measurement unit; heading and position from the foot that is planned to
//! carry more, which is taken to stand where the plan wants it.

use config::Robot;
use messages::{ControllerState, Sensors};
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector2, Vector3};

use crate::plan_follower::Desired;
use crate::task_space::TaskSpace;
use crate::torso::{self, TorsoAngles};

/// Measured upper body, centre of gravity and feet in the planning frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TaskEstimate {
    /// phi_x, phi_y from the IMU, alpha from the anchor foot \[rad\].
    pub angles: TorsoAngles,
    /// Their rates \[rad/s\].
    pub rates: Vector3<f64>,
    /// \[rad\] That heading less that of the IMU.
    pub turn: f64,
    /// world_from_torso with that heading.
    pub rotation: Matrix3<f64>,
    /// \[m\] Torso's origin.
    pub torso: Vector3<f64>,
    /// \[m/s\] @torso Velocity of the torso's origin, the anchor foot being at rest where it presses.
    pub torso_velocity: Vector3<f64>,
    /// \[m\] Centre of gravity.
    pub com: Vector3<f64>,
    /// \[m/s\] Its velocity, the anchor foot being at rest where it presses.
    pub com_velocity: Vector3<f64>,
    /// \[m, rad\] Sole frames: x, y, z, heading.
    pub feet: [[f64; 4]; 2],
    /// \[m\] Pressure point of each foot on the ground, NaN without load.
    pub pressure_points: [Vector2<f64>; 2],
    /// \[m\] Zero-moment point of the measured wrenches on the ground, NaN without load.
    pub zmp: Vector2<f64>,
    /// \[m\] Its distance to the edge of the support polygon, negative outside, NaN without load.
    pub zmp_margin: f64,
}

/// \[1\] Normal force from which a foot counts as loaded, in weights of the robot.
pub const LOADED: f64 = 1.0 / 30.0;
/// \[1\] The same from which its sole counts as part of the support polygon.
const TOUCHING: f64 = 1.0 / 600.0;

impl TaskEstimate {
    /// From the sensors, the kinematics of the measured joints and what is desired. The anchor is the foot that is
    /// planned to carry more, unless it has lost the ground and the other one has not.
    pub(crate) fn new(robot: &Robot, sensors: &Sensors, measured: &TaskSpace, desired: &Desired) -> Self {
        let [x, y, z, w] = sensors.imu.orientation;
        let imu = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)).to_rotation_matrix();
        let force = |i: usize| sensors.foot_wrench[i].force[2];
        // A swing foot that meets the ground early may press harder than the stance foot, and is not where it should be.
        let heavier = usize::from(desired.load[1] > desired.load[0]);
        let loaded = LOADED * robot.weight();
        let lost = force(heavier) <= loaded && force(1 - heavier) > loaded;
        let anchor = if lost { 1 - heavier } else { heavier };

        // The IMU knows where up is, the anchor foot where it was put: together the pose of the torso.
        let sole = measured.sole(anchor);
        let seen = imu.matrix() * sole.rotation;
        let planned = desired.feet[anchor].position;
        let turn = planned[3] - seen[(1, 0)].atan2(seen[(0, 0)]);
        let rotation = nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), turn).matrix() * imu.matrix();
        let torso = Vector3::new(planned[0], planned[1], planned[2]) - rotation * sole.position;
        let omega = rotation * Vector3::from(sensors.imu.angular_velocity);
        // A sole that turns does so about the place where it presses: that is at rest.
        let still = &pressed(robot, sensors, measured, anchor);
        // Everything else hangs on that pose.
        let mut estimate = Self {
            angles: torso::angles(&rotation),
            rates: torso::rates_from_omega(&rotation) * omega,
            turn,
            rotation,
            torso,
            torso_velocity: measured.torso_velocity(anchor, still),
            com: torso + rotation * measured.com(),
            com_velocity: rotation * measured.com_velocity(anchor, still),
            feet: std::array::from_fn(|i| {
                let s = measured.sole(i);
                let (p, r) = (torso + rotation * s.position, rotation * s.rotation);
                [p.x, p.y, p.z, r[(1, 0)].atan2(r[(0, 0)])]
            }),
            pressure_points: [Vector2::repeat(f64::NAN); 2],
            zmp: Vector2::repeat(f64::NAN),
            zmp_margin: f64::NAN,
        };
        estimate.find_zmp(robot, sensors, measured);
        estimate
    }

    /// (3.5), (3.6) about the ground under the soles, both feet.
    fn find_zmp(&mut self, robot: &Robot, sensors: &Sensors, measured: &TaskSpace) {
        let (mut moment, mut normal) = (Vector2::zeros(), 0.0);
        let mut corners = [Vector2::zeros(); 8];
        let mut count = 0;
        for foot in 0..2 {
            let place = measured.sensor(foot);
            let r = self.rotation * place.rotation;
            let f = r * Vector3::from(sensors.foot_wrench[foot].force);
            let m = r * Vector3::from(sensors.foot_wrench[foot].moment);
            let p = self.torso + self.rotation * place.position;
            let t = m + p.cross(&f);
            moment += Vector2::new(-t.y, t.x);
            normal += f.z;
            // A sole that presses is part of the support polygon, all of it.
            if f.z > TOUCHING * robot.weight() {
                self.pressure_points[foot] = Vector2::new(-t.y, t.x) / f.z;
                let [back, front, right, left] = robot.feet[foot].support;
                let [x, y, _, heading] = self.feet[foot];
                let (s, c) = heading.sin_cos();
                for (dx, dy) in [(back, right), (front, right), (front, left), (back, left)] {
                    corners[count] = Vector2::new(x + c * dx - s * dy, y + s * dx + c * dy);
                    count += 1;
                }
            }
        }
        if count > 0 {
            self.zmp = moment / normal;
            self.zmp_margin = depth_in_hull(&corners[..count], &self.zmp);
        }
    }

    /// Divergent component of motion, measured and, of a plan that leads the centre of gravity, against the desired one.
    /// The pendulum is as high as the centre of gravity stands above the lower foot.
    fn report_dcm(&self, desired: &Desired, state: &mut ControllerState) {
        let height = self.com.z - self.feet[0][2].min(self.feet[1][2]);
        let w = (multibody::GRAVITY_ACCELERATION / height).sqrt();
        let body = &desired.body;
        for i in 0..2 {
            state.dcm[i] = self.com[i] + self.com_velocity[i] / w;
            state.dcm_error[i] = body.position[i] + body.velocity[i] / w - state.dcm[i];
        }
    }

    /// Writes the measured part of the record.
    pub(crate) fn report(&self, desired: &Desired, state: &mut ControllerState) {
        state.com = self.com.into();
        state.com_velocity = self.com_velocity.into();
        self.report_dcm(desired, state);
        state.torso = self.torso.into();
        state.feet = self.feet;
        state.pressure_point = self.pressure_points.map(Into::into);
        state.zmp = self.zmp.into();
        state.zmp_margin = self.zmp_margin;
        for i in 0..2 {
            state.inclination_error[i] = desired.torso.position[i] - self.angles[i];
            state.inclination_rate_error[i] = desired.torso.velocity[i] - self.rates[i];
        }
    }
}

/// \[m\] @sole Pressure point of a foot, within its sole; the origin without load.
fn pressed(robot: &Robot, sensors: &Sensors, measured: &TaskSpace, foot: usize) -> Vector3<f64> {
    let (sole, sensor) = (measured.sole(foot), measured.sensor(foot));
    let wrench = &sensors.foot_wrench[foot];
    let turn = sole.rotation.transpose();
    let [force, moment] = [wrench.force, wrench.moment].map(|v| turn * sensor.rotation * Vector3::from(v));
    if force.z <= LOADED * robot.weight() {
        return Vector3::zeros();
    }
    let about = moment + (turn * (sensor.position - sole.position)).cross(&force);
    let [back, front, right, left] = robot.feet[foot].support;
    Vector3::new((-about.y / force.z).clamp(back, front), (about.x / force.z).clamp(right, left), 0.0)
}

/// Distance of `p` to the nearest edge of the convex hull of `points`, negative outside (then the largest distance to
/// a violated edge line).
fn depth_in_hull(points: &[Vector2<f64>], p: &Vector2<f64>) -> f64 {
    let mut depth = f64::INFINITY;
    for a in points {
        for b in points {
            let edge = b - a;
            let length = edge.norm();
            if length < 1e-9 {
                continue;
            }
            let left_of = |q: &Vector2<f64>| edge.perp(&(q - a)) / length;
            // An edge of the hull has all points on its left.
            if points.iter().all(|q| left_of(q) > -1e-9) {
                depth = depth.min(left_of(p));
            }
        }
    }
    depth
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan_follower::PlanFollower;

    #[test]
    fn depth_in_a_square_and_in_the_hull_of_two() {
        let square =
            |x: f64| [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(a, b)| Vector2::new(x + a, b));
        assert!((depth_in_hull(&square(0.0), &Vector2::new(0.3, 0.5)) - 0.3).abs() < 1e-12);
        assert!((depth_in_hull(&square(0.0), &Vector2::new(-0.2, 0.5)) + 0.2).abs() < 1e-12);
        let both: Vec<_> = square(0.0).into_iter().chain(square(3.0)).collect();
        assert!((depth_in_hull(&both, &Vector2::new(2.0, 0.1)) - 0.1).abs() < 1e-12, "between the feet");
    }

    /// A robot that turns as a whole about a corner of its sole, on which it stands: its centre of gravity moves about that corner,
    /// wherever the sole frame is.
    #[test]
    fn a_robot_that_turns_about_a_corner_moves_about_it() {
        let robot = Robot::load(&config::root(None).join("robots/lola")).unwrap();
        let mut measured = TaskSpace::new(&robot).unwrap();
        let omega = Vector3::new(0.3, -0.5, 0.8);
        let joints = vec![0.0; robot.joints.len()];
        measured.update_motion(&joints, &joints, &omega.into());
        let [back, front, right, left] = robot.feet[0].support;
        let desired = PlanFollower::new([[back, front]; 2]).sample(0.0);
        assert_eq!(desired.load, [1.0, 0.0]);
        for corner in [[back, right], [back, left], [front, right], [front, left]] {
            let (sole, sensor) = (measured.sole(0), measured.sensor(0));
            let at = sole.position + sole.rotation * Vector3::new(corner[0], corner[1], 0.0);
            let up = Vector3::new(0.0, 0.0, robot.weight());
            let back = sensor.rotation.transpose();
            let mut sensors = Sensors::default();
            sensors.imu.orientation = [0.0, 0.0, 0.0, 1.0];
            sensors.foot_wrench[0].force = (back * up).into();
            sensors.foot_wrench[0].moment = (back * (at - sensor.position).cross(&up)).into();
            let estimate = TaskEstimate::new(&robot, &sensors, &measured, &desired);
            let expected = omega.cross(&(measured.com() - at));
            let turned = estimate.rotation * expected;
            assert!((estimate.com_velocity - turned).norm() < 1e-9, "{corner:?}: {}", estimate.com_velocity);
        }
    }
}
