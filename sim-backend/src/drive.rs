//! References of the joints: cubics from target to target (2.74), which a type 1 model follows exactly.
//!
//! Joints of type 1 have no torque, so they cannot be limp: with the supply off they come to rest at their own rate of
//! braking, and stay.
//! That stands for friction in gears; for a robot without brakes whose motors have no torque see types 2 to 5.

use config::robot::Joint;

/// Motion of one joint during one bus cycle, as a cubic in the time since the cycle began; or as two, one after the other,
/// where a drive passes a point of its own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointCubic {
    /// Coefficients of the angle \[rad, rad/s, ...\], constant term first.
    c: [f64; 4],
    /// Time of the second one \[s\], and its coefficients in the time since then.
    second: Option<(f64, [f64; 4])>,
}

/// Angle, speed and acceleration of a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointMotion {
    /// \[rad\]
    pub angle: f64,
    /// \[rad/s\]
    pub speed: f64,
    /// \[rad/s^2\]
    pub acceleration: f64,
}

impl JointCubic {
    /// At rest at `angle` \[rad\].
    pub fn resting(angle: f64) -> Self {
        Self::of([angle, 0.0, 0.0, 0.0])
    }

    /// With these coefficients of the angle \[rad, rad/s, ...\], constant term first.
    pub(crate) fn of(c: [f64; 4]) -> Self {
        Self { c, second: None }
    }

    /// The same until `time` \[s\], then another one in the time since then.
    pub(crate) fn then(self, time: f64, c: [f64; 4]) -> Self {
        Self { second: Some((time, c)), ..self }
    }

    /// Begins a cycle of `dt` \[s\] from `from` that ends in `angle`, `speed`: the cubic Hermite through both.
    pub fn follow(from: JointMotion, angle: f64, speed: f64, dt: f64) -> Self {
        let (dp, v0, v1) = (angle - from.angle, from.speed, speed);
        Self::of([
            from.angle,
            v0,
            (3.0 * dp / dt - 2.0 * v0 - v1) / dt,
            (v0 + v1 - 2.0 * dp / dt) / (dt * dt),
        ])
    }

    /// Begins a cycle of `dt` \[s\] in which the joint is brought to rest.
    pub fn brake(joint: &Joint, from: JointMotion, dt: f64) -> Self {
        let less = joint.braking * dt;
        let speed = if from.speed.abs() <= less { 0.0 } else { from.speed - less * from.speed.signum() };
        Self::follow(from, from.angle + 0.5 * (from.speed + speed) * dt, speed, dt)
    }

    /// Motion `tau` \[s\] after the beginning of the cycle.
    pub fn at(&self, tau: f64) -> JointMotion {
        let (c, tau) = match &self.second {
            Some((begin, c)) if tau > *begin => (c, tau - begin),
            _ => (&self.c, tau),
        };
        JointMotion {
            angle: c[0] + tau * (c[1] + tau * (c[2] + tau * c[3])),
            speed: c[1] + tau * (2.0 * c[2] + tau * 3.0 * c[3]),
            acceleration: 2.0 * c[2] + tau * 6.0 * c[3],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn follows_to_the_target_and_starts_where_it_was() {
        let from = JointMotion { angle: 0.3, speed: -1.0, acceleration: 0.0 };
        let drive = JointCubic::follow(from, 0.2995, 0.4, 1e-3);
        let (a, b) = (drive.at(0.0), drive.at(1e-3));
        assert!((a.angle - 0.3).abs() < 1e-15 && (a.speed + 1.0).abs() < 1e-15);
        assert!((b.angle - 0.2995).abs() < 1e-15 && (b.speed - 0.4).abs() < 1e-12);
    }

    /// A target that integrates its own speed by the trapezoidal rule costs no more than its own acceleration.
    #[test]
    fn consistent_targets_make_a_constant_acceleration() {
        let from = JointMotion { angle: 0.0, speed: 0.2, acceleration: 0.0 };
        let drive = JointCubic::follow(from, 0.5 * (0.2 + 0.3) * 1e-3, 0.3, 1e-3);
        for tau in [0.0, 0.4e-3, 1e-3] {
            assert!((drive.at(tau).acceleration - 100.0).abs() < 1e-9);
        }
    }
}
