//! Arm swing (thesis 4.9): the arms move opposite to the legs, so that less of a vertical moment is left to the soles.
//!
//! | symbol | name | unit | frame |
//! |---|---|---|---|
//! | x_l | centre of gravity of a leg, forward | m | torso |
//! | x_a | centre of gravity of an arm, forward | m | torso |
//! | k | arm swing of the gait | 1 | |
//! | l | forward motion of x_a per turn of the shoulder | m/rad | |
//!
//! "The reference values are calculated from the position of the CoG of the opposite leg", scaled down. Of both legs only
//! what differs counts, half of x_l,left - x_l,right: what they have in common moves the whole robot, and both arms with
//! it would pitch it. So with x_0 where the arm hangs in its comfortable pose
//!
//!   right arm: x_a = x_0 + k (x_l,left - x_l,right) / 2        left arm: the same with minus.
//!
//! One row per arm, resolved by the one joint that swings it; all other joints of the arms keep to their comfort.

use config::Robot;
use messages::{LEFT, MAX_JOINTS, RIGHT};
use multibody::ModelError;

use crate::approach::Approach;
use crate::inverse_kinematics::JointVector;
use crate::task_space::TaskSpace;

/// \[m/rad\] Damping of the division by l: an arm that is stretched out forward cannot move that way.
const DAMPING: f64 = 0.02;
/// Return of an arm that is not where it should be, as after standing up from a crouch.
const RETURN: Approach = Approach { rate: f64::INFINITY, speed: 0.5, acceleration: 5.0 };
/// Share of its lever at rest that an arm has at least while it hangs.
const HANGS: f64 = 0.3;
/// Share of its length that an arm is swung out at most.
const REACH: f64 = 0.8;

/// The arms of one robot.
#[derive(Clone)]
pub struct ArmSwing {
    joints: [usize; 2],
    /// First joint of each leg that the other leg does not need.
    hips: [usize; 2],
    gain: f64,
    /// x_0 of each arm, and how far it may be from there \[m\]; l there \[m/rad\], and the shoulder's angle \[rad\].
    rest: [f64; 2],
    reach: [f64; 2],
    lever: [f64; 2],
    comfort: [f64; 2],
    /// References of the last cycle, for their rates; none after a pause.
    last: Option<[f64; 2]>,
    /// \[rad/s\] Speeds with which the shoulders returned to their references in the last cycle.
    returning: [f64; 2],
}

impl ArmSwing {
    /// Arms that swing `gain` as far as the legs; none if the robot has none or nobody wants it.
    pub fn new(robot: &Robot, gain: Option<f64>) -> Result<Option<Self>, ModelError> {
        let (Some(arms), Some(gain)) = (robot.arms, gain) else { return Ok(None) };
        let mut kinematics = TaskSpace::new(robot)?;
        let mut q = [0.0; MAX_JOINTS];
        for (j, joint) in robot.joints.iter().enumerate() {
            q[j] = joint.comfort;
        }
        kinematics.update(&q);
        let place = |i: usize| kinematics.limb(arms.joints[i]);
        Ok(Some(Self {
            joints: arms.joints,
            hips: kinematics.hips(),
            gain,
            rest: [0, 1].map(|i| place(i).0.x),
            reach: [0, 1].map(|i| REACH * place(i).1.norm()),
            lever: [0, 1].map(|i| place(i).1.x),
            comfort: arms.joints.map(|j| q[j]),
            last: None,
            returning: [0.0; 2],
        }))
    }

    /// Begins anew after a pause.
    pub fn halt(&mut self) {
        self.last = None;
        self.returning = [0.0; 2];
    }

    /// Speeds of the shoulders, `desired` being the kinematics of the `angles` \[rad\] commanded last; small
    /// errors vanish with `drift` \[1/s\], large ones within bounds of speed and acceleration, of which there is a `share`
    /// while the motion sets in.
    pub fn drive(
        &mut self,
        desired: &TaskSpace,
        angles: &[f64],
        dt: f64,
        (drift, share): (f64, f64),
        given: &mut JointVector,
    ) {
        let leg = |foot: usize| desired.limb(self.hips[foot]).0.x;
        let half = 0.5 * self.gain * (leg(LEFT) - leg(RIGHT));
        let wanted = [self.rest[RIGHT] + half, self.rest[LEFT] - half];
        let last = self.last.replace(wanted).unwrap_or(wanted);
        for i in [RIGHT, LEFT] {
            let (com, swing) = desired.limb(self.joints[i]);
            let bounded = wanted[i].clamp(self.rest[i] - self.reach[i], self.rest[i] + self.reach[i]);
            let rate = if bounded == wanted[i] { (wanted[i] - last[i]) / dt } else { 0.0 };
            // Joint angles from ways of the arm's centre of gravity.
            let turn = swing.x / (swing.x * swing.x + DAMPING * DAMPING);
            // An arm that does not hang would be led over the top: it comes down first.
            let hangs = swing.x / self.lever[i] > HANGS;
            let error =
                if hangs { turn * (bounded - com.x) } else { self.comfort[i] - angles[self.joints[i]] };
            let back = Approach { rate: drift, ..RETURN.eased(share) };
            self.returning[i] = back.next(error, self.returning[i], dt);
            given[self.joints[i]] = turn * rate + self.returning[i];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use config::root;

    const DT: f64 = 1e-3;

    struct Rig {
        robot: Robot,
        arms: ArmSwing,
        desired: TaskSpace,
        q: Vec<f64>,
    }

    impl Rig {
        fn new(name: &str, gain: f64) -> Self {
            let robot = Robot::load(&root(None).join("robots").join(name)).unwrap();
            let q = robot.joints.iter().map(|j| j.comfort).collect();
            let arms = ArmSwing::new(&robot, Some(gain)).unwrap().unwrap();
            Self { arms, desired: TaskSpace::new(&robot).unwrap(), q, robot }
        }

        /// Hips swing to and fro, opposite to one another, `amplitude` \[rad\]; largest error of the arms after the first
        /// second \[m\], from the definition in the head of this file.
        fn walk(&mut self, amplitude: f64) -> f64 {
            let named = |part| ["right", "left"].map(|s| self.robot.joint(&format!("{s}_{part}")).unwrap());
            let (hip, shoulder) = (named("hip_flexion"), named("shoulder_flexion"));
            let still = hip.map(|j| self.q[j]);
            let mut worst = 0.0f64;
            for k in 0..3000 {
                let swing = amplitude * (4.5 * f64::from(k) * DT).sin();
                // The axes of the left leg are mirrored: the same change of the angle moves the legs apart.
                (self.q[hip[0]], self.q[hip[1]]) = (still[0] + swing, still[1] + swing);
                self.desired.update(&self.q);
                let legs = self.arms.hips.map(|j| self.desired.limb(j).0.x);
                let at = shoulder.map(|j| self.desired.limb(j).0.x);
                let half = 0.5 * self.arms.gain * (legs[LEFT] - legs[RIGHT]);
                if k > 1000 {
                    worst = worst.max((at[RIGHT] - self.arms.rest[RIGHT] - half).abs());
                    worst = worst.max((at[LEFT] - self.arms.rest[LEFT] + half).abs());
                }
                let mut given = JointVector::zeros();
                self.arms.drive(&self.desired, &self.q, DT, (100.0, 1.0), &mut given);
                for j in self.arms.joints {
                    self.q[j] += DT * given[j];
                }
            }
            worst
        }
    }

    #[test]
    fn each_arm_goes_with_the_opposite_leg() {
        for name in ["lola", "johnnie"] {
            let error = Rig::new(name, 0.8).walk(0.25);
            assert!(error < 2e-3, "{name}: {error} m");
        }
        // What is measured is there: without a motion of the arms the error is that of the legs.
        let mut still = Rig::new("lola", 0.8);
        still.arms.joints.reverse();
        assert!(still.walk(0.25) > 0.05, "arms that go with the leg of their own side are noticed");
    }

    /// Legs further apart than arms are long: the arms stay short of the horizontal, and nothing breaks.
    #[test]
    fn arms_swing_no_further_than_they_reach() {
        let mut rig = Rig::new("lola", 3.0);
        rig.walk(0.8);
        let shoulders = rig.arms.joints.map(|j| rig.q[j].abs());
        assert!(shoulders.iter().all(|q| *q < 1.4), "{shoulders:?}");
    }

    #[test]
    fn hips_are_where_the_legs_part() {
        let rig = Rig::new("lola", 1.0);
        let names = rig.arms.hips.map(|j| rig.robot.joints[j].name.as_str());
        assert_eq!(names, ["right_hip_rotation", "left_hip_rotation"], "the pelvis moves both");
    }

    #[test]
    fn nobody_swings_who_has_no_arms_or_is_not_asked_to() {
        let mut robot = Robot::load(&root(None).join("robots/lola")).unwrap();
        assert!(ArmSwing::new(&robot, None).unwrap().is_none());
        robot.arms = None;
        assert!(ArmSwing::new(&robot, Some(1.0)).unwrap().is_none());
    }
}
