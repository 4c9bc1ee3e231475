//! Integration of joint speeds to joint targets, within what each joint can do.

use config::gait::StabilizerGains;
use config::{Robot, WITH_LOAD};
use messages::{MAX_JOINTS, Sensors};

use crate::approach::PLANNED;
use crate::inverse_kinematics::JointVector;

/// \[s\] Time in which drift compensation, null-space motion and returns set in when the joints begin to move: they may rest
/// far from comfort, and where they rest is not quite where a plan begins.
const RAMP: f64 = 0.5;
/// \[1\] Times what the drives can accelerate, asked of them: a little less than what the joint loop passes, which knows the
/// measured angles, and these lag.
const ASKED: f64 = 0.97 * WITH_LOAD;
/// \[rad\] and \[rad/s\] Targets smaller than this are zero: what decays for seconds would become subnormal otherwise, first in
/// the products of the kinematics, and stay so.
const GONE: f64 = 1e-30;

/// Joint targets: q_d, q_d' at the end of the last cycle.
#[derive(Clone)]
pub(super) struct JointState {
    /// \[rad\]
    pub(super) angle: [f64; MAX_JOINTS],
    /// \[rad/s\]
    pub(super) speed: JointVector,
    /// \[s\] Since the joints were at rest.
    moving: f64,
}

/// Share of drift compensation, null-space motion and returns that is wanted, and K_x (5.35) with that share.
#[derive(Clone, Copy)]
pub(super) struct Onset {
    pub(super) share: f64,
    /// \[1/s\]
    pub(super) drift: f64,
}

impl JointState {
    pub(super) fn new() -> Self {
        Self { angle: [0.0; MAX_JOINTS], speed: JointVector::zeros(), moving: 0.0 }
    }

    /// Stands still at the measured angles.
    pub(super) fn reset(&mut self, measured: &[f64; MAX_JOINTS]) {
        self.angle = *measured;
        self.speed.fill(0.0);
    }

    /// Stands still where the targets are.
    pub(super) fn rest(&mut self) {
        self.speed.fill(0.0);
        self.moving = 0.0;
    }

    /// \[rad\] q_d - q of the first `n` joints.
    pub(super) fn lag(&self, sensors: &Sensors, n: usize) -> [f64; MAX_JOINTS] {
        let mut lag = [0.0; MAX_JOINTS];
        for j in 0..n {
            lag[j] = self.angle[j] - sensors.joint_angle[j];
        }
        lag
    }

    /// Onset of drift compensation, null-space motion and returns: all of it a while after the joints began to move. A leg
    /// that is nearly straight has no length to spare for any of them before the plan has lowered the body.
    pub(super) fn onset(&self, control: &StabilizerGains) -> Onset {
        let x = (self.moving / RAMP).min(1.0);
        let share = x * x * (3.0 - 2.0 * x);
        Onset { share, drift: control.drift_gain * share }
    }

    /// q_d of the end of the cycle, trapezoidal, so that angle and speed agree; within range, speed and what the drives can
    /// accelerate with a landing's load, which asks for more. Returns the number of joints that one of these held.
    pub(super) fn integrate(&mut self, robot: &Robot, wanted: &JointVector, dt: f64) -> u64 {
        self.moving += dt;
        let mut limited = 0;
        for (j, joint) in robot.joints.iter().enumerate() {
            if !wanted[j].is_finite() {
                limited += 1;
                continue;
            }
            // Towards the end of its range no faster than it can brake in what will be left of it: s^2 <= 2 b r at the end of
            // the cycle. Without a limit of acceleration this is NaN, which min and max pass over.
            let [low, high] = joint.range;
            let braking = PLANNED * joint.acceleration;
            let braked = |room: f64, speed: f64| {
                let half = 0.5 * braking * dt;
                let left = (room - 0.5 * dt * speed).max(0.0);
                (half * half + 2.0 * braking * left).sqrt() - half
            };
            let speed = wanted[j].min(braked(high - self.angle[j], self.speed[j]));
            let speed = speed.max(-braked(self.angle[j] - low, -self.speed[j]));
            let mut speed = speed.clamp(-joint.speed_limit, joint.speed_limit);
            // The least over all poses first: the one of this pose must go through the linkages.
            if (speed - self.speed[j]).abs() > ASKED * joint.acceleration * dt {
                let most = ASKED * robot.acceleration(j, &self.angle) * dt;
                speed = speed.clamp(self.speed[j] - most, self.speed[j] + most);
            }
            let angle = self.angle[j] + 0.5 * dt * (self.speed[j] + speed);
            let held = angle.clamp(low.min(self.angle[j]), high.max(self.angle[j]));
            limited += u64::from(speed != wanted[j] || held != angle);
            if held.is_finite() {
                let kept = |x: f64| if x.abs() < GONE { 0.0f64.copysign(x) } else { x };
                self.speed[j] = if held == angle { kept(speed) } else { 0.0 };
                self.angle[j] = kept(held);
            }
        }
        limited
    }
}
