//! Archie's legs by two routes along his gaits: in closed form, as the open loop has them, and by the differential inverse
//! kinematics of the stabilizer, from the URDF.

use config::pattern::Pattern;
use config::{Gait, Robot};
use controller::inverse_kinematics::{InverseKinematics, JointVector, TaskJacobian, TaskVector};
use controller::task_space::TaskSpace;
use messages::{MAX_JOINTS, Plan};
use nalgebra::{Matrix3, Rotation3, Vector3};
use planner::pattern_check::walk_of;

/// \[rad\]
const APART: f64 = 1e-8;
/// Steps of the differential route from point to point.
const ROUNDS: usize = 30;

/// Parameters of thesis 6.2 and 4.3.
fn gaits() -> [Pattern; 2] {
    let gait = Gait::load(&config::root(None).join("gaits/archie_static.toml")).unwrap();
    let walked = gait.pattern.unwrap();
    let example = Pattern {
        step_time: 2.0,
        double_support: 0.4,
        over_time: 1.2,
        low_time: 0.08,
        high_time: 1.2,
        pitch_times: [0.08, 1.9, 2.28],
        length: 0.2,
        over_length: 0.2,
        leave: 0.2,
        land: 0.3,
        end_ahead: 0.07,
        start_behind: 0.07,
        start_height: 0.542,
        ..walked
    };
    [walked, example]
}

/// Planned pose of a sole against the upright torso.
fn planned(robot: &Robot, plan: &Plan, foot: usize, t: f64) -> (Vector3<f64>, Matrix3<f64>) {
    let [rear, front, ..] = robot.feet[foot].support;
    let (sole, pitch) = plan.sole(foot, t, [rear, front]);
    let [x, y, z, _] = sole.position;
    let turned = Rotation3::from_axis_angle(&Vector3::y_axis(), pitch.position[0]);
    (Vector3::new(x, y, z) - Vector3::from(plan.body.sample(t).position), *turned.matrix())
}

#[test]
fn closed_form_and_differential_inverse_kinematics_agree_along_both_gaits() {
    let robot = Robot::load(&config::root(None).join("robots/archie")).unwrap();
    let mut space = TaskSpace::new(&robot).unwrap();
    let differential = InverseKinematics::new(&robot.joints, &space.leg_joints(&robot), 0.0);
    for pattern in gaits() {
        let (mut worst, mut points) = (0.0_f64, 0);
        let mut q: Option<[f64; MAX_JOINTS]> = None;
        for walked in walk_of(&Gait::from(pattern), &robot).unwrap() {
            for k in 0..300 {
                let t = walked.end * f64::from(k) / 300.0;
                let mut closed = [0.0; MAX_JOINTS];
                robot.angles_of_plan(&walked.plan, t, &mut closed).unwrap();
                // From the point before; at first from a little beside.
                let mut angles = q.unwrap_or_else(|| closed.map(|angle| 0.98 * angle));
                let mut jacobian = TaskJacobian::zeros();
                for _ in 0..ROUNDS {
                    space.update(&angles);
                    space.task_jacobian(&mut jacobian);
                    let mut way = TaskVector::zeros();
                    for foot in 0..2 {
                        let (at, turned) = planned(&robot, &walked.plan, foot, t);
                        let is = space.sole(foot);
                        let off = turned * is.rotation.transpose();
                        // Axis times sine: the angle by its cosine ends at 1e-8.
                        let axis = |a: usize, b: usize| 0.5 * (off[(b, a)] - off[(a, b)]);
                        way.fixed_rows_mut::<3>(6 * foot).copy_from(&(at - is.position));
                        way.fixed_rows_mut::<3>(6 * foot + 3).copy_from(&Vector3::new(
                            axis(1, 2),
                            axis(2, 0),
                            axis(0, 1),
                        ));
                        // The soles against the torso: where the centre of gravity is does not matter.
                        let sole = space.sole_jacobian(foot);
                        for j in 0..robot.joints.len() {
                            for row in 0..6 {
                                jacobian[(6 * foot + row, j)] = sole[(row, j)];
                            }
                        }
                    }
                    let turn = differential.speeds(
                        &differential.factorise(&jacobian),
                        &way,
                        &JointVector::zeros(),
                        &angles[..robot.joints.len()],
                        0.0,
                    );
                    (0..robot.joints.len()).for_each(|j| angles[j] += turn[j]);
                    if turn.amax() < 1e-13 {
                        break;
                    }
                }
                let apart = angles.iter().zip(closed).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                (worst, points) = (worst.max(apart), points + 1);
                q = Some(angles);
            }
        }
        println!("T_c = {} s: {worst:.1e} rad over {points} points", pattern.step_time);
        assert!(worst < APART && points == 1500, "T_c = {} s: {worst} rad", pattern.step_time);
    }
}
