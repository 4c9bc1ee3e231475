//! Plausibility of readings: the next one of a joint, a foot or the upper body is not far from the last.
//!
//! A checksum lets some flipped bits pass, and a counter does not see them. What they do to a number is seen only if it is
//! more than the robot can do in the time since the last reading.

use codec::layout::Carries;
use config::Robot;
use config::system::BusLimits;
use messages::{MAX_JOINTS, Sensors};

/// \[m\] Lever of the largest believable force at a foot's sensor.
const LEVER: f64 = 0.3;
/// \[1\] A landing changes a force by more than a bent bit may, this many times at most, but not one component alone: the
/// second changes by at least this share. On hard soles at 5 km/h: 3.6 weights, and a share of 0.09.
const LANDING: f64 = 6.0;
const TOGETHER: f64 = 0.05;
/// \[rad/s\] Fastest the upper body turns.
const TURN: f64 = 5.0;
/// \[rad/s\] Most this changes in one cycle; while Lola walks up to 5 km/h it changes by 0.3.
const JERK: f64 = 2.0;
/// \[1\] Play of a component of the upper body's quaternion.
const PLAY: f64 = 0.005;
/// \[m/s^2\] Most the specific force changes in one cycle: a foot stamps. In a walk it changes by 65.
const SHOCK: f64 = 200.0;

/// Readings of a node.
#[derive(Clone, Debug, Default)]
pub(crate) struct Readings {
    pub(crate) joints: Vec<usize>,
    pub(crate) feet: Vec<usize>,
    pub(crate) imu: bool,
}

/// The bounds of a robot.
#[derive(Clone, Debug)]
pub(crate) struct ReadingBounds {
    dt: f64,
    limits: BusLimits,
    speed: [f64; MAX_JOINTS],
    range: [[f64; 2]; MAX_JOINTS],
    /// \[N\]
    force: f64,
}

/// Copies the readings of a joint.
pub(crate) fn copy_joint(j: usize, from: &Sensors, to: &mut Sensors) {
    to.joint_angle[j] = from.joint_angle[j];
    to.joint_speed[j] = from.joint_speed[j];
    to.motor_angle[j] = from.motor_angle[j];
    to.motor_speed[j] = from.motor_speed[j];
}

impl Readings {
    /// Readings of each node of the robot's bus.
    pub(crate) fn of(robot: &Robot) -> Vec<Self> {
        let mut all = vec![Self::default(); robot.layout.nodes.len()];
        for message in robot.layout.sent(false) {
            let reads = &mut all[message.node];
            for signal in &message.signals {
                match signal.carries {
                    Carries::Angle(j) => reads.joints.push(j),
                    Carries::Force(foot, 0) => reads.feet.push(foot),
                    Carries::Orientation(0) => reads.imu = true,
                    _ => {}
                }
            }
        }
        all
    }

    /// Copies the readings of the node.
    pub(crate) fn copy(&self, from: &Sensors, to: &mut Sensors) {
        for &j in &self.joints {
            copy_joint(j, from, to);
        }
        for &foot in &self.feet {
            to.foot_wrench[foot] = from.foot_wrench[foot];
        }
        if self.imu {
            to.imu = from.imu;
        }
    }
}

impl ReadingBounds {
    pub(crate) fn new(robot: &Robot, limits: BusLimits, dt: f64) -> Self {
        let (mut speed, mut range) = ([0.0; MAX_JOINTS], [[0.0; 2]; MAX_JOINTS]);
        for (j, joint) in robot.joints.iter().enumerate() {
            (speed[j], range[j]) = (joint.speed_limit, joint.range);
        }
        Self { dt, limits, speed, range, force: limits.jump_force * robot.weight() }
    }

    /// Moves what a node reads on by one cycle, or holds it there: what is believed while nothing better comes.
    ///
    /// An angle leaves neither its range nor, if it is outside, the place where it is.
    pub(crate) fn carry_on(&self, reads: &Readings, moves: bool, s: &mut Sensors) {
        for &j in &reads.joints {
            if !moves {
                (s.joint_speed[j], s.motor_speed[j]) = (0.0, 0.0);
                continue;
            }
            let reach = self.speed[j] * self.dt;
            let [low, high] = self.range[j];
            for (angle, speed) in
                [(&mut s.joint_angle[j], s.joint_speed[j]), (&mut s.motor_angle[j], s.motor_speed[j])]
            {
                let moved = *angle + (speed * self.dt).clamp(-reach, reach);
                *angle = moved.clamp(low.min(*angle), high.max(*angle));
            }
        }
    }

    /// True if what a node reads can be, `cycles` after what was believed `before`; the angle of a joint that has just
    /// `found` out where it is can be any.
    pub(crate) fn believes(
        &self,
        reads: &Readings,
        before: &Sensors,
        now: &Sensors,
        cycles: u32,
        found: &[bool; MAX_JOINTS],
    ) -> bool {
        let cycles = f64::from(cycles);
        let near = |a: f64, b: f64, most: f64| (a - b).abs() <= most;
        // A joint moves no faster than its limit, and an encoder plays a little.
        let joint = |&j: &usize| {
            let angle = self.limits.jump + self.limits.jump_speed * self.speed[j] * self.dt * cycles;
            let speed = self.speed[j] * cycles;
            near(now.joint_angle[j], before.joint_angle[j], angle)
                && near(now.motor_angle[j], before.motor_angle[j], angle)
                && near(now.joint_speed[j], before.joint_speed[j], speed)
                && near(now.motor_speed[j], before.motor_speed[j], speed)
        };
        let foot = |&i: &usize| {
            let (a, b, alone) = (&now.foot_wrench[i], &before.foot_wrench[i], self.force * cycles);
            let mut change: [f64; 6] = std::array::from_fn(|k| match k {
                0..3 => (a.force[k] - b.force[k]).abs(),
                _ => (a.moment[k - 3] - b.moment[k - 3]).abs() / LEVER,
            });
            change.sort_unstable_by(f64::total_cmp); // NaN last: it is never believed
            let [.., second, first] = change;
            first <= alone || first <= LANDING * alone && second >= TOGETHER * first
        };
        // The torso turns and is shaken within bounds.
        let (a, b) = (&now.imu, &before.imu);
        let imu = || {
            let turned = PLAY + 0.5 * TURN * self.dt * cycles;
            (0..4).all(|k| near(a.orientation[k], b.orientation[k], turned))
                && (0..3).all(|k| near(a.angular_velocity[k], b.angular_velocity[k], JERK * cycles))
                && (0..3).all(|k| near(a.acceleration[k], b.acceleration[k], SHOCK * cycles))
        };
        reads.joints.iter().all(|j| found[*j] || joint(j))
            && reads.feet.iter().all(foot)
            && (!reads.imu || imu())
    }
}
