//! Joint speeds (figure 5.8): of task velocities (5.34)-(5.39), and the joints without a task: toes, camera
//! head, arms, and those that go to their comfortable angles.

use config::Robot;
use curves::Sample;
use messages::Plan;
use multibody::ModelError;
use nalgebra::Matrix6;

use super::cycle::ControlCycle;
use super::joints::{JointState, Onset};
use super::task;
use crate::approach::Approach;
use crate::arms::ArmSwing;
use crate::gaze::{Gaze, TorsoMotion};
use crate::inverse_kinematics::{Factorised, InverseKinematics, JointVector, TaskJacobian, TaskVector};
use crate::task_space::TaskSpace;

/// Return of joints without a task to their comfortable angles.
const SETTLE: Approach = Approach { rate: 2.0, speed: 0.5, acceleration: 5.0 };

/// \[rad\] Toes are not held against the ground further than this from where they are.
const YIELD: f64 = 0.05;

/// \[1/s\] alpha_N: weight of the null-space cost H (5.38).
const NULL_SPACE_GAIN: f64 = 1.0;

/// Inverse kinematics and the limbs that move beside the feet's task.
#[derive(Clone)]
pub(super) struct JointSpeeds {
    ik: InverseKinematics,
    /// Joints that the task may use.
    free: Vec<bool>,
    jacobian: TaskJacobian,
    pub(super) gaze: Option<Gaze>,
    arms: Option<ArmSwing>,
}

impl JointSpeeds {
    /// Of `robot`; allocates everything.
    pub(super) fn new(
        robot: &Robot,
        kinematics: &TaskSpace,
        arm_swing: Option<f64>,
    ) -> Result<Self, ModelError> {
        let free = kinematics.leg_joints(robot);
        Ok(Self {
            ik: InverseKinematics::new(&robot.joints, &free, NULL_SPACE_GAIN),
            free,
            jacobian: TaskJacobian::zeros(),
            gaze: Gaze::new(robot)?,
            arms: ArmSwing::new(robot, arm_swing)?,
        })
    }

    /// Head and arms are at rest, wherever they are.
    pub(super) fn reset(&mut self) {
        if let Some(gaze) = &mut self.gaze {
            gaze.halt();
        }
        if let Some(arms) = &mut self.arms {
            arms.halt();
        }
    }

    /// The task of the feet at the present angles.
    pub(super) fn linearise(&mut self, kinematics: &mut TaskSpace) -> Factorised {
        kinematics.task_jacobian(&mut self.jacobian);
        self.ik.factorise(&self.jacobian)
    }

    /// N of the modification, through the inverse kinematics (5.30).
    pub(super) fn sole_motion(&self, cycle: &ControlCycle<'_>, task: &Factorised) -> Matrix6<f64> {
        let speeds = self.ik.columns(task, &task::unit_modifications(cycle));
        task::sole_motion(cycle, &speeds, &self.free)
    }

    /// Wanted speeds of all joints at the end of the cycle; `torso` is how the camera head is carried, `lag` \[rad\] by how
    /// much the joints lag behind their targets.
    pub(super) fn solve(
        &mut self,
        cycle: &ControlCycle<'_>,
        (task, velocity): (&Factorised, &TaskVector),
        joints: &JointState,
        onset: Onset,
        torso: &TorsoMotion,
        lag: &[f64],
    ) -> JointVector {
        let mut given = self.given_speeds(cycle, joints, onset, lag);
        if let Some(gaze) = &mut self.gaze {
            gaze.drive(torso, cycle.dt, &joints.angle, &joints.speed, &mut given);
        }
        if let Some(arms) = &mut self.arms {
            let setting_in = (onset.drift, onset.share);
            arms.drive(cycle.kinematics, &joints.angle, cycle.dt, setting_in, &mut given);
        }
        self.ik.speeds(task, velocity, &given, &joints.angle, onset.share)
    }

    /// Speeds of the joints that no foot needs: toes as planned, the others to their comfortable angles.
    fn given_speeds(
        &self,
        cycle: &ControlCycle<'_>,
        joints: &JointState,
        onset: Onset,
        lag: &[f64],
    ) -> JointVector {
        let mut speeds = JointVector::zeros();
        let settle = SETTLE.eased(onset.share);
        for (j, joint) in cycle.robot.joints.iter().enumerate().filter(|(j, _)| !self.free[*j]) {
            speeds[j] = settle.next(joint.comfort - joints.angle[j], joints.speed[j], cycle.dt);
        }
        for (foot, toe) in cycle.robot.feet.iter().enumerate().filter_map(|(i, f)| Some((i, f.toe?))) {
            speeds[toe] = toe_speed(&cycle.end.toes[foot], joints.angle[toe], lag[toe], onset.drift);
        }
        speeds
    }
}

/// As planned; a toe that is to lie flat and is bent by more than [`YIELD`], as on the edge of a board, gives way.
/// One that moves as planned lags behind as far, and must not; one that is ahead of that does not lag. `angle` \[rad\] is its
/// target, `bent` \[rad\] how far that is from where it is.
fn toe_speed(plan: &Sample<1>, angle: f64, bent: f64, drift: f64) -> f64 {
    let over = bent - bent.clamp(-YIELD, YIELD);
    let back = (plan.position[0] - angle) * drift;
    let moving = plan.velocity[0] != 0.0 || plan.acceleration[0] != 0.0;
    let ahead = over * plan.velocity[0] < 0.0;
    if over == 0.0 || moving && !ahead {
        plan.velocity[0] + back.clamp(-SETTLE.speed, SETTLE.speed)
    } else {
        -over * drift
    }
}

/// Motion of the torso as the camera head takes it, in the planning frame of `plan`.
pub(super) fn torso_motion(cycle: &ControlCycle<'_>, plan: &Plan, omega: [f64; 3]) -> TorsoMotion {
    let estimate = cycle.estimate;
    TorsoMotion {
        origin: plan.origin,
        height: plan.height,
        turn: estimate.turn,
        rotation: estimate.rotation,
        position: estimate.torso,
        velocity: estimate.torso_velocity,
        omega: omega.into(),
    }
}
