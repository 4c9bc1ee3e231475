//! Load of a force/torque sensor: the wrench that moves the bodies below it and bears their weight.
//!
//! F_i = sum of m (a - g) over these bodies and T_i, its moment about the sensor: the share of inverse dynamics that
//! passes the sensor, in the sensor's axes. While the robot hangs at rest with level feet it is F_0, T_0.

use messages::Wrench;
use multibody::{Data, Frame, Model};
use nalgebra::UnitQuaternion;

/// F_i, T_i \[N, N m\] in the axes of `sensor`, for the motion that [`Model::inverse_dynamics`] was last asked about, with
/// `data` holding the poses of the same configuration ([`Model::forward_kinematics`]).
pub fn inertial(model: &Model, data: &Data, sensor: &Frame) -> Wrench {
    let (force, moment) = model.carried_wrench(data, sensor);
    let back = model.frame_pose(data, sensor).rotation.inverse();
    Wrench { force: (back * force).into(), moment: (back * moment).into() }
}

/// F_0, T_0 of each sensor with the joints at `joints` \[rad\]; the whole robot is turned until that sensor is level.
/// Allocates: for the start.
pub fn hanging(model: &Model, sensors: &[Frame; 2], joints: &[f64]) -> [Wrench; 2] {
    let mut data = Data::new(model);
    let (mut q, rest) = (model.neutral(), vec![0.0; model.nv()]);
    let mut force = vec![0.0; model.nv()];
    let upright = q[3..7].to_owned();
    q[7..].copy_from_slice(joints);
    std::array::from_fn(|i| {
        q[3..7].copy_from_slice(&upright);
        model.forward_kinematics(&mut data, &q);
        let level =
            UnitQuaternion::from_rotation_matrix(&model.frame_pose(&data, &sensors[i]).rotation).inverse();
        q[3..7].copy_from_slice(level.coords.as_slice());
        model.forward_kinematics(&mut data, &q);
        model.inverse_dynamics(&mut data, &q, &rest, &rest, &mut force);
        inertial(model, &data, &sensors[i])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use config::Robot;

    fn lola() -> (Robot, Model, [Frame; 2]) {
        let robot = Robot::load(&config::root(None).join("robots/lola")).unwrap();
        let model = robot.model().unwrap();
        let sensors = [0, 1].map(|i| model.frame(&robot.feet[i].sensor_link, robot.feet[i].sensor).unwrap());
        (robot, model, sensors)
    }

    /// Foot and toe hang on the sensor, whatever the pose of the leg; their masses are those of appendix B.
    #[test]
    fn a_hanging_sensor_carries_foot_and_toe() {
        let (robot, model, sensors) = lola();
        let stand = hanging(&model, &sensors, &robot.poses["stand"]);
        let crouch = hanging(&model, &sensors, &robot.poses["crouch"]);
        for (i, mass) in [(0, 1.648 + 0.797), (1, 1.643 + 0.797)] {
            let [x, y, z] = stand[i].force;
            assert!(x.abs() < 1e-12 && y.abs() < 1e-12 && (z - mass * 9.81).abs() < 1e-12, "{:?}", stand[i]);
            assert!(stand[i].moment[2].abs() < 1e-12);
            // T_y = -x F_z: the toe brings the centre of gravity in front of the sensor by some centimetres.
            let lever = -stand[i].moment[1] / z;
            assert!(lever > 0.0 && lever < 0.1, "{lever} m");
            let same_toes = (0..3).all(|k| (stand[i].moment[k] - crouch[i].moment[k]).abs() < 1e-12);
            assert!(same_toes, "{:?} {:?}", stand[i], crouch[i]);
        }
    }

    /// Against the balance of forces: at rest, in any attitude, the carried force is the weight in sensor axes, and an
    /// acceleration of the base adds m a.
    #[test]
    fn is_mass_times_acceleration_less_gravity() {
        let (robot, model, sensors) = lola();
        let (mut data, mut q) = (Data::new(&model), model.neutral());
        q[7..].copy_from_slice(&robot.poses["stand"]);
        let tilt = UnitQuaternion::from_euler_angles(0.3, -0.2, 1.0);
        q[3..7].copy_from_slice(tilt.coords.as_slice());
        let (v, mut force) = (vec![0.0; model.nv()], vec![0.0; model.nv()]);
        let mut acceleration = v.clone();
        acceleration[..3].copy_from_slice(&[2.0, -1.0, 3.0]);
        model.forward_kinematics(&mut data, &q);
        model.inverse_dynamics(&mut data, &q, &v, &acceleration, &mut force);
        for (i, mass) in [(0, 1.648 + 0.797), (1, 1.643 + 0.797)] {
            let w = inertial(&model, &data, &sensors[i]);
            let a = tilt * nalgebra::Vector3::new(2.0, -1.0, 3.0) - multibody::GRAVITY;
            let expected = mass * model.frame_pose(&data, &sensors[i]).rotation.inverse_transform_vector(&a);
            assert!((nalgebra::Vector3::from(w.force) - expected).norm() < 1e-9, "{:?} {expected}", w.force);
        }
    }
}
