//! Setpoints of the joints: last word on every target before it goes to the drives.

use std::hash::{Hash, Hasher};

use config::Robot;
use messages::{JointTargets, MAX_JOINTS, Sensors};

use crate::braking::brake;
use crate::limits::{Setpoint, admit};
use crate::rejoin::Rejoin;

/// Setpoints of all joints.
#[derive(Clone)]
pub(crate) struct Setpoints {
    /// Those that the drives were given last.
    last: [Setpoint; MAX_JOINTS],
    /// Targets were followed in the cycle before.
    tracked: bool,
    /// Offsets from targets that came again after a pause.
    rejoin: [Rejoin; MAX_JOINTS],
}

impl Setpoints {
    /// Of joints that nobody has read yet.
    pub(crate) fn new() -> Self {
        Self {
            last: [Setpoint { angle: 0.0, speed: 0.0 }; MAX_JOINTS],
            tracked: false,
            rejoin: [Rejoin::default(); MAX_JOINTS],
        }
    }

    /// Hashes what decides what comes next for so many joints.
    pub(crate) fn hash_state(&self, joints: usize, h: &mut impl Hasher) {
        self.tracked.hash(h);
        for (last, rejoin) in self.last.iter().zip(&self.rejoin).take(joints) {
            let offset = rejoin.offset().map(|o| (o.angle.to_bits(), o.speed.to_bits()));
            (last.angle.to_bits(), last.speed.to_bits(), offset).hash(h);
        }
    }

    /// Setpoint of joint `j`.
    pub(crate) fn of(&self, j: usize) -> Setpoint {
        self.last[j]
    }

    /// Joint `j` is where it is measured: what comes next begins there.
    pub(crate) fn follow_measured(&mut self, j: usize, sensors: &Sensors) {
        self.last[j] = Setpoint { angle: sensors.joint_angle[j], speed: 0.0 };
    }

    /// One cycle of braking for all joints.
    pub(crate) fn brake_all(&mut self, robot: &Robot, dt: f64) {
        for (last, joint) in self.last.iter_mut().zip(&robot.joints) {
            *last = brake(joint, *last, dt);
        }
    }

    /// Ends a cycle in which targets were followed, or not; then the next ones are joined gently.
    pub(crate) fn end_cycle(&mut self, tracked: bool) {
        self.tracked = tracked;
        if !tracked {
            self.rejoin.iter_mut().for_each(Rejoin::forget);
        }
    }

    /// One cycle of `dt` \[s\] after finite targets, or without fresh ones; `resumed` if none were fresh in the cycle
    /// before. Only the joints that targets may lead move. Returns those that were held back, one bit each.
    ///
    /// Without targets the last ones are carried on at their speed. At first and after a pause the joints come to them
    /// gently.
    pub(crate) fn track(
        &mut self,
        robot: &Robot,
        sensors: &Sensors,
        fresh: Option<&JointTargets>,
        resumed: bool,
        leads: impl Fn(usize) -> bool,
        dt: f64,
    ) -> u64 {
        let mut held = 0u64;
        for (j, joint) in robot.joints.iter().enumerate() {
            if !leads(j) {
                self.rejoin[j].forget();
                continue; // it has no torque
            }
            let last = self.last[j];
            // Neither what is carried on nor what is left of an offset leads out of the joint's range.
            let inside = |m: Setpoint| Setpoint {
                angle: m.angle.clamp(joint.range[0].min(last.angle), joint.range[1].max(last.angle)),
                ..m
            };
            let carried = inside(Setpoint { angle: last.angle + last.speed * dt, speed: last.speed });
            let wanted = match fresh {
                Some(t) => {
                    let target = Setpoint { angle: t.angle[j], speed: t.speed[j] };
                    if resumed || !self.tracked {
                        self.rejoin[j].begin(carried, target);
                        carried
                    } else if self.rejoin[j].is_over() {
                        target
                    } else {
                        inside(self.rejoin[j].step(target, dt))
                    }
                }
                None => carried,
            };
            // Whatever it comes from, it passes the limits last.
            let possible = || robot.acceleration(j, &sensors.joint_angle);
            if let Ok((setpoint, limited)) = admit(joint, possible, last, wanted, dt) {
                self.last[j] = setpoint;
                held |= u64::from(limited) << j;
            }
        }
        held
    }
}
