//! Poses of a pattern: both legs in closed form.

use super::{Pose, Stride};
use config::{Gait, Robot};
use messages::{LEFT, RIGHT};
use nalgebra::{Matrix3, Rotation3, Vector3};
use planner::Planner;
use planner::pattern_check::{PatternFault, WalkedPlan, walk_of};

/// Joints in the thesis's order, from the foot on.
const JOINTS: [&str; 6] =
    ["ankle adduction", "ankle flexion", "knee", "hip flexion", "hip adduction", "hip rotation"];

/// The last stride of the walk that is checked, and the first rule that it breaks.
pub(super) fn stride<'a>(
    gait: &Gait,
    robot: &'a Robot,
) -> Result<(Stride<'a>, Option<String>), PatternFault> {
    let mut plans = walk_of(gait, robot)?;
    let fault = Planner::of(gait, robot).err().map(|fault| fault.to_string());
    let pattern = gait.pattern.ok_or(PatternFault::NoPattern)?;
    let (step, double) = (pattern.step_time, pattern.double_support);
    let plans = plans.split_off(plans.len() - 2);
    let named = |(k, name): (usize, &str)| format!("theta {}: {name}", k + 1);
    let stride = Stride {
        steps: [[0.0, double, step], [step, step + double, 2.0 * step]],
        joints: JOINTS.into_iter().enumerate().map(named).collect(),
        pose: Box::new(move |t| pose(robot, &plans, step, t)),
    };
    Ok((stride, fault))
}

/// At `t` \[s\], 0 to two steps of `step` \[s\], with a plan for each of them.
fn pose(robot: &Robot, plans: &[WalkedPlan], step: f64, t: f64) -> Pose {
    let (walked, t) = if t < step { (&plans[0], t) } else { (&plans[1], t - step) };
    let plan = &walked.plan;
    // The stride begins where the swing foot of its first plan stands.
    let first = &plans[0].plan;
    let begin = first.feet[RIGHT].sample(0.0).position;
    let shift = Vector3::new(
        plan.origin[0] - first.origin[0] - begin[0],
        plan.origin[1] - first.origin[1] - begin[1],
        0.0,
    );
    let body = Vector3::from(plan.body.sample(t).position);
    let upright = Matrix3::identity();
    let mut pose = Pose {
        ankles: [Vector3::zeros(); 2],
        pitch: [0.0; 2],
        torso: body + shift,
        chains: [Vec::new(), Vec::new()],
        angles: [vec![f64::NAN; 6], vec![f64::NAN; 6]],
    };
    for foot in [RIGHT, LEFT] {
        let [rear, front, ..] = robot.feet[foot].support;
        let ankle = -robot.feet[foot].sole[2];
        let (sole, pitch) = plan.sole(foot, t, [rear, front]);
        let [x, y, z, _] = sole.position;
        let turned = Rotation3::from_axis_angle(&Vector3::y_axis(), pitch.position[0]);
        let (at, of) = (Vector3::new(x, y, z), |p: Vector3<f64>| turned * p);
        pose.ankles[foot] = at + of(Vector3::new(0.0, 0.0, ankle)) + shift;
        pose.pitch[foot] = pitch.position[0];
        let mut chain =
            vec![at + of(Vector3::new(rear, 0.0, 0.0)), at + of(Vector3::new(front, 0.0, 0.0)), at];
        if let Some(leg) = robot.legs.as_ref().map(|legs| &legs[foot]) {
            match leg.angles((turned.matrix(), &at), (&upright, &body)) {
                Ok(q) => {
                    pose.angles[foot] = leg.theta(&q).to_vec();
                    chain.extend(leg.chain_in_sole(&q).map(|p| at + of(p)));
                }
                Err(_) => chain.extend([Vector3::repeat(f64::NAN); 7]),
            }
        }
        pose.chains[foot] = chain.into_iter().map(|p| p + shift).collect();
    }
    pose
}
