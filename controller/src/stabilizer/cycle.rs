//! One control cycle as its stages see it: constants of the robot, the plan at both ends of the cycle, measured state.

use config::Robot;
use config::gait::StabilizerGains;
use nalgebra::{Matrix3, Rotation3, Vector2, Vector3};

use crate::estimate::TaskEstimate;
use crate::plan_follower::Desired;
use crate::task_space::TaskSpace;
use crate::torso;

/// Cycles that may be missed and are caught up on, one after the other; the joint loop carries on meanwhile.
const MISSED_CYCLES: u64 = 20;

/// Time base of the controller.
#[derive(Clone)]
pub(super) struct CycleClock {
    /// \[s\] Length of a cycle.
    pub(super) dt: f64,
    /// Tick of the last cycle; none before the first one.
    last: Option<u64>,
}

impl CycleClock {
    pub(super) fn new(dt: f64) -> Self {
        Self { dt, last: None }
    }

    /// Begins the cycle `tick`: the number of cycles that were missed before it, none for the first one.
    pub(super) fn begin(&mut self, tick: u64) -> Option<u64> {
        let last = self.last.replace(tick);
        last.map(|last| tick.saturating_sub(last + 1).min(MISSED_CYCLES))
    }

    /// The last cycle that began.
    pub(super) fn tick(&self) -> u64 {
        self.last.unwrap_or(0)
    }
}

/// Inputs that all stages of a cycle share.
#[derive(Clone, Copy)]
pub(super) struct ControlCycle<'a> {
    pub(super) robot: &'a Robot,
    pub(super) control: &'a StabilizerGains,
    /// \[s\]
    pub(super) dt: f64,
    /// The plan now and at the end of the cycle.
    pub(super) now: &'a Desired,
    pub(super) end: &'a Desired,
    pub(super) estimate: &'a TaskEstimate,
    /// Planning frame from torso, as planned for the end of the cycle.
    pub(super) torso: Matrix3<f64>,
    /// Kinematics of the joint targets (feedback path 1) or of the measured joints (path 2).
    pub(super) kinematics: &'a TaskSpace,
    /// \[1\] @I Rise of the ground per metre.
    pub(super) slope: Vector2<f64>,
}

impl ControlCycle<'_> {
    /// Axes of the planned foot (heading x, y, normal of the sole) in torso axes.
    pub(super) fn foot_axes(&self, foot: usize) -> Matrix3<f64> {
        let at = self.end;
        let heading = Rotation3::from_axis_angle(&Vector3::z_axis(), at.feet[foot].position[3]);
        self.torso.transpose() * (heading * pitched(at.pitch[foot].position[0])).matrix()
    }

    /// Force sensor seen from the sole frame \[m\].
    pub(super) fn sensor_from_sole(&self, foot: usize) -> Vector3<f64> {
        let (sole, sensor) = (self.kinematics.sole(foot), self.kinematics.sensor(foot));
        sole.rotation.transpose() * (sensor.position - sole.position)
    }
}

/// Planning frame from torso where the plan wants the upper body.
pub(super) fn planned_torso(at: &Desired) -> Matrix3<f64> {
    torso::rotation(&Vector3::from(at.torso.position)).unwrap_or_else(Matrix3::identity)
}

/// Rotation of a sole about its own y axis \[rad\].
pub(super) fn pitched(angle: f64) -> Rotation3<f64> {
    Rotation3::from_axis_angle(&Vector3::y_axis(), angle)
}
