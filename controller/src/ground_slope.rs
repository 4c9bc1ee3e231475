//! Slope of the ground, learned from soles that lie flat on it.
//!
//! | symbol | name | unit | frame |
//! |---|---|---|---|
//! | g | rise of the ground per metre along x and y | 1 | I_0 |
//! | T | time constant | s | - |
//!
//! A stance sole that presses well inside of itself lies on the ground: its inclination, by joints and inertial measurement unit,
//! is that of the ground there. One sole may lie on a board; g is what this one and the one before it have in common.

use messages::Sensors;
use nalgebra::{Matrix3, Rotation2, Vector2, Vector3};

use crate::estimate::TaskEstimate;
use crate::plan_follower::Desired;

/// \[s\] T.
const TIME_CONSTANT: f64 = 0.1;
/// \[m\] Distance of the zero-moment point from the edge of the sole at least.
const INSIDE: f64 = 0.01;
/// \[1\] Load that the foot is planned to carry, and share of the weight that it carries, at least.
const ALONE: f64 = 0.99;
const CARRIED: f64 = 0.7;
/// \[1\] Slope up to which the ground is level: so much may be an error of measurement.
const LEVEL: f64 = 0.02;
/// \[1\] Largest slope that is believed.
const LARGEST: f64 = 0.105;

/// One cycle of walking, which the slope is learned from.
pub(crate) struct WalkedCycle<'a> {
    pub(crate) sensors: &'a Sensors,
    /// \[N\] Weight of the robot.
    pub(crate) weight: f64,
    /// torso_from_sole
    pub(crate) soles: [Matrix3<f64>; 2],
    pub(crate) now: &'a Desired,
    pub(crate) estimate: &'a TaskEstimate,
    /// \[rad\] Heading of the planning frame in I_0.
    pub(crate) heading: f64,
    /// \[s\]
    pub(crate) dt: f64,
}

/// Slope of the ground.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct GroundSlope {
    /// Foot that stands on its own.
    foot: Option<usize>,
    /// \[1\] @I_0 Slopes under its sole, and under that of the foot before it.
    soles: [Vector2<f64>; 2],
}

impl GroundSlope {
    /// g, zero on ground that is level.
    pub(crate) fn slope(&self) -> Vector2<f64> {
        let [now, before] = &self.soles;
        let common = |a: f64, b: f64| if a * b > 0.0 { a.signum() * a.abs().min(b.abs()) } else { 0.0 };
        let both = now.zip_map(before, common);
        let size = both.norm();
        if size > LEVEL { both * ((size - LEVEL).min(LARGEST) / size) } else { Vector2::zeros() }
    }

    /// Learns from a cycle of walking.
    pub(crate) fn learn(&mut self, cycle: &WalkedCycle<'_>) {
        let &WalkedCycle { sensors, weight, soles, now, estimate, heading, dt } = cycle;
        let foot = usize::from(now.load[1] > now.load[0]);
        if self.foot != Some(foot) {
            *self = Self { foot: Some(foot), soles: [Vector2::zeros(), self.soles[0]] };
        }
        let flat = now.pitch[foot].position[0] == 0.0;
        let carries = now.load[foot] > ALONE && sensors.foot_wrench[foot].force[2] > CARRIED * weight;
        if flat && carries && estimate.zmp_margin > INSIDE {
            let up: Vector3<f64> = (estimate.rotation * soles[foot]).column(2).into();
            let under = Rotation2::new(heading) * (-up.xy() / up.z);
            self.soles[0] += (under - self.soles[0]) * (dt / TIME_CONSTANT);
        }
    }
}

#[cfg(test)]
mod tests {
    use config::Robot;
    use nalgebra::UnitQuaternion;

    use super::*;
    use crate::plan_follower::PlanFollower;
    use crate::task_space::TaskSpace;

    const DT: f64 = 1e-3;
    /// \[rad\] Heading of the planning frame.
    const HEADING: f64 = 0.7;

    /// A robot whose soles stand in turn on ground that rises by these slopes @I along x and y: what it has learned @I_0.
    fn learned(slopes: &[[f64; 2]], at: f64) -> Vector2<f64> {
        let robot = Robot::load(&config::root(None).join("robots/lola")).unwrap();
        let mut measured = TaskSpace::new(&robot).unwrap();
        let joints = vec![0.0; robot.joints.len()];
        measured.update_motion(&joints, &joints, &[0.0; 3]);
        let mut desired = PlanFollower::new([[0.0, 0.0]; 2]).sample(0.0);
        let mut slope = GroundSlope::default();
        for (k, [x, y]) in slopes.iter().enumerate() {
            // The whole robot is turned with the ground: its vertical becomes the normal.
            let normal = Vector3::new(-x, -y, 1.0);
            let turn = UnitQuaternion::rotation_between(&Vector3::z(), &normal).unwrap();
            let foot = k % 2;
            desired.load = [0.0; 2];
            desired.load[foot] = 1.0;
            let mut sensors = Sensors::default();
            sensors.imu.orientation = turn.coords.into();
            let (sole, sensor) = (measured.sole(foot), measured.sensor(foot));
            let force = turn.inverse() * Vector3::new(0.0, 0.0, robot.weight());
            let from = sole.position + Vector3::new(at, 0.0, 0.0) - sensor.position;
            sensors.foot_wrench[foot].force = (sensor.rotation.transpose() * force).into();
            sensors.foot_wrench[foot].moment = (sensor.rotation.transpose() * from.cross(&force)).into();
            let estimate = TaskEstimate::new(&robot, &sensors, &measured, &desired);
            let soles = [0, 1].map(|i| measured.sole(i).rotation);
            let cycle = WalkedCycle {
                sensors: &sensors,
                weight: robot.weight(),
                soles,
                now: &desired,
                estimate: &estimate,
                heading: HEADING,
                dt: DT,
            };
            (0..1000).for_each(|_| slope.learn(&cycle));
        }
        slope.slope()
    }

    #[test]
    fn two_soles_make_a_slope_and_one_does_not() {
        let ground = [0.06, -0.03];
        let [s, c] = [HEADING.sin(), HEADING.cos()];
        let turned = Vector2::new(c * ground[0] - s * ground[1], s * ground[0] + c * ground[1]);
        let expected = turned * (1.0 - LEVEL / turned.norm());
        let two = learned(&[ground, ground], 0.0);
        assert!((two - expected).norm() < 2e-3, "{two} instead of {expected}");
        for one in [&[ground][..], &[[0.0; 2], ground], &[ground, [0.0; 2]], &[ground, [-0.06, 0.03]]] {
            assert_eq!(learned(one, 0.0), Vector2::zeros(), "{one:?}");
        }
    }

    #[test]
    fn the_smaller_one_counts_up_to_the_largest() {
        let both = learned(&[[0.04, 0.0], [0.08, 0.0]], 0.0);
        assert!((both.norm() - (0.04 - LEVEL)).abs() < 2e-3, "{both}");
        assert!((learned(&[[0.3, 0.0], [0.3, 0.0]], 0.0).norm() - LARGEST).abs() < 1e-12);
        assert_eq!(learned(&[[0.018, 0.0], [0.018, 0.0]], 0.0), Vector2::zeros());
    }

    /// A sole that presses on its edge may have turned about it.
    #[test]
    fn a_sole_on_its_edge_tells_nothing() {
        let robot = Robot::load(&config::root(None).join("robots/lola")).unwrap();
        let [_, front, ..] = robot.feet[0].support;
        let ground = [[0.06, 0.0]; 2];
        assert_eq!(learned(&ground, front - 0.5 * INSIDE), Vector2::zeros());
        assert!(learned(&ground, front - 2.0 * INSIDE).norm() > 0.03);
    }
}
