//! Contact flags of the feet, and what ends in a controlled stop: sensor data that are not finite, a fall, being
//! lifted.

use messages::{EventCode, Sensors};

use crate::estimate::{LOADED, TaskEstimate};
use crate::plan_follower::Desired;

/// \[1\] Normal force from which a foot counts as being in contact, in weights of the robot, above what a swinging foot's
/// inertia reads; contact ends below [`LOADED`].
const FIRM: f64 = 0.1;
/// Inclination error \[rad\] from which the robot counts as falling: joints are brought to rest.
pub(crate) const FALLING: f64 = 0.5;
/// Cycles without load on either foot, while the plan wants load, after which the robot counts as lifted.
const LIFTED_CYCLES: u32 = 200;
/// Cycles in a row that are bridged with the last good sensor data if a value is not finite.
const BAD_CYCLES: u32 = 20;

/// Admits sensor data and decides when to stop.
#[derive(Clone)]
pub(crate) struct SafetyWatch {
    /// \[N\] Weight of the robot.
    weight: f64,
    /// Neither inclination nor load is known: nobody can tell a fall or being lifted.
    blind: bool,
    /// The last sensor data without a NaN, and how many with one came since.
    good: Sensors,
    bad: u32,
    unloaded: u32,
    /// Reason for the joints to come to rest, if there is one.
    why: Option<EventCode>,
    contact: [bool; 2],
}

impl SafetyWatch {
    /// Of a robot of `weight` \[N\], which has encoders only if `blind`.
    pub(crate) fn new(weight: f64, blind: bool) -> Self {
        Self { weight, blind, good: Sensors::default(), bad: 0, unloaded: 0, why: None, contact: [false; 2] }
    }

    /// The sensor data if they are finite, otherwise the last ones that were; true where that begins.
    pub(crate) fn admit(&mut self, sensors: &Sensors, joints: usize) -> (Sensors, bool) {
        let (imu, wrench) = (&sensors.imu, &sensors.foot_wrench);
        let finite =
            sensors.joint_angle[..joints].iter().chain(&sensors.joint_speed[..joints]).all(|x| x.is_finite())
                && imu.orientation.iter().chain(&imu.angular_velocity).all(|x| x.is_finite())
                && wrench.iter().all(|w| w.force.iter().chain(&w.moment).all(|x| x.is_finite()));
        if finite {
            self.good = *sensors;
            self.bad = 0;
            for (contact, w) in self.contact.iter_mut().zip(wrench) {
                *contact = w.force[2] > self.weight * if *contact { LOADED } else { FIRM };
            }
        } else {
            self.bad = self.bad.saturating_add(1);
            self.good.header = sensors.header;
        }
        (self.good, self.bad == 1)
    }

    /// Contact of each foot with the ground.
    pub(crate) fn contact(&self) -> [bool; 2] {
        self.contact
    }

    /// Begins anew, as with a supply that was switched on.
    pub(crate) fn reset(&mut self) {
        self.why = None;
        self.unloaded = 0;
    }

    /// Reason for the joints to come to rest, until the supply was off; none: they need not.
    pub(crate) fn stopped(&self) -> Option<EventCode> {
        self.why
    }

    /// Stops for good if something is wrong; the reason in that cycle.
    pub(crate) fn check(
        &mut self,
        sensors: &Sensors,
        now: &Desired,
        estimate: &TaskEstimate,
    ) -> Option<EventCode> {
        let tilt = (0..2).map(|i| (now.torso.position[i] - estimate.angles[i]).abs()).fold(0.0, f64::max);
        let load = sensors.foot_wrench[0].force[2].max(sensors.foot_wrench[1].force[2]);
        self.unloaded = if load < LOADED * self.weight && !self.blind { self.unloaded + 1 } else { 0 };
        let why = if self.bad > BAD_CYCLES {
            Some(EventCode::SensorNotFinite)
        } else if !(tilt < FALLING) {
            Some(EventCode::Fallen)
        } else if self.unloaded > LIFTED_CYCLES {
            Some(EventCode::Lifted)
        } else {
            None
        };
        let why = why.filter(|_| self.why.is_none());
        self.why = self.why.or(why);
        why
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Contact is the same share of every robot's weight: a foot that carries an eighth of it stands on the
    /// ground, one that reads a twelfth has not met it yet, and one that keeps a fortieth has left it.
    #[test]
    fn contact_is_a_share_of_the_weight() {
        for name in ["lola", "johnnie", "archie"] {
            let robot = config::Robot::load(&config::root(None).join("robots").join(name)).unwrap();
            let mut watch = SafetyWatch::new(robot.weight(), false);
            let mut contact = |share: f64| {
                let mut sensors = Sensors::default();
                sensors.foot_wrench[0].force[2] = share * robot.weight();
                watch.admit(&sensors, robot.joints.len());
                watch.contact()[0]
            };
            let seen =
                [1.0 / 12.0, 1.0 / 8.0, 1.0 / 12.0, 1.0 / 20.0, 1.0 / 40.0, 1.0 / 12.0].map(&mut contact);
            assert_eq!(seen, [false, true, true, true, false, false], "{name}");
        }
    }
}
