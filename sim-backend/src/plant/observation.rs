//! Observation of a plant: what sensors and logs want to know of a state.

use messages::Wrench;
use multibody::Frame;
use nalgebra::Vector3;

use crate::drive::JointCubic;
use crate::layout::orientation;
use crate::sensors::carried;

use super::{Joints, Plant, Scratch};

/// Places and forces in a state, as sensors and logs need them.
#[derive(Clone, Copy, Debug)]
pub struct Snapshot {
    /// \[N, N m\] @world Ground on each foot, moment about the sole frame.
    pub foot_wrench: [Wrench; 2],
    /// \[m, rad\] @world Sole frames: x, y, z, heading.
    pub feet: [[f64; 4]; 2],
    /// \[m\] @world
    pub com: Vector3<f64>,
}

impl Plant {
    /// Kinematics of the feet and forces of the ground in a state, `tau` \[s\] into the cycle. The next step from there
    /// has them already.
    pub fn look(&mut self, tau: f64, x: &[f64], drives: &[JointCubic]) {
        self.load(tau, x, drives);
        self.touch_ground(&x[self.layout.layer()]);
        let Scratch { joint_acceleration, acceleration, .. } = &mut self.scratch;
        if let Joints::Following(_) = self.joints {
            acceleration[6..].copy_from_slice(joint_acceleration);
        }
    }

    /// Places and forces in a state.
    pub fn snapshot(&mut self, tau: f64, x: &[f64], drives: &[JointCubic]) -> Snapshot {
        self.look(tau, x, drives);
        // With the kinematics of all bodies: an evaluation needs only those of the limbs.
        self.model.forward_kinematics_here(&mut self.data);
        let com = self.model.cog(&mut self.data);
        let foot_wrench = std::array::from_fn(|foot| {
            let (_, force, moment) = self.sole_load(foot);
            Wrench { force: force.into(), moment: moment.into() }
        });
        let Self { model, data, ground, .. } = &*self;
        let sole_places = std::array::from_fn(|i| {
            let pose = model.frame_pose(data, &ground.soles[i]);
            let (r, p) = (pose.rotation.matrix(), pose.translation.vector);
            [p.x, p.y, p.z, r[(1, 0)].atan2(r[(0, 0)])]
        });
        Snapshot { foot_wrench, feet: sole_places, com }
    }

    /// Contact points that carry, after [`Plant::look`].
    pub fn carrying(&self) -> &[messages::ContactPoint] {
        self.ground.feet.carrying()
    }

    /// Takes the mean acceleration of a step of `h` \[s\] between two states for that at its end: it is what the step's
    /// forces did, impacts and dry friction included.
    pub fn note_step(&mut self, h: f64, before: &[f64], x: &[f64]) {
        let l = &self.layout;
        let velocity = |x: &[f64]| orientation(x) * Vector3::from_column_slice(&x[l.speed()][..3]);
        let (speed_before, speed) = (&before[l.speed()], &x[l.speed()]);
        let acceleration = &mut self.scratch.acceleration;
        for ((a, before), after) in acceleration.iter_mut().zip(speed_before).zip(speed) {
            *a = (after - before) / h;
        }
        // Velocities of the torso's origin are in its own axes, which turn.
        let linear = orientation(x).inverse() * ((velocity(x) - velocity(before)) / h)
            - angular_velocity(speed).cross(&Vector3::from_column_slice(&speed[..3]));
        acceleration[..3].copy_from_slice(linear.as_slice());
    }

    /// Nothing accelerates.
    pub(crate) fn note_rest(&mut self) {
        self.scratch.acceleration.fill(0.0);
    }

    /// \[m/s^2, rad/s^2\] @torso Acceleration of the torso's origin less gravity, and angular acceleration, of the step that
    /// led to a state.
    pub(crate) fn torso_acceleration(&self, x: &[f64]) -> (Vector3<f64>, Vector3<f64>) {
        let (speed, change) = (&x[self.layout.speed()], &self.scratch.acceleration);
        let turning = angular_velocity(speed).cross(&Vector3::from_column_slice(&speed[..3]));
        let linear = Vector3::from_column_slice(&change[..3]) + turning;
        let specific = linear - orientation(x).inverse() * multibody::GRAVITY;
        (specific, Vector3::from_column_slice(&change[3..6]))
    }

    /// \[m, N, N m\] @world Origin of a sole frame, force of the ground on its foot and moment about that origin, after
    /// [`Plant::look`].
    pub(crate) fn sole_load(&self, foot: usize) -> (Vector3<f64>, Vector3<f64>, Vector3<f64>) {
        let at = self.model.frame_position(&self.data, &self.ground.soles[foot]);
        let (force, moment) = self.ground.feet.total(&self.model, &self.data, &at, Some(foot));
        (at, force, moment)
    }

    /// \[N m\] Torques of the joints' drives by inverse dynamics, (2.75) solved for them, rotors included, gear friction not:
    /// in the state that was last looked at, with the acceleration of [`Plant::note_step`]. It is all that is known of drives
    /// whose joints follow their targets. Locked joints have none.
    pub fn joint_torques(&mut self, torque: &mut [f64]) {
        let Self { model, data, ground, scratch, .. } = self;
        let Scratch { v, acceleration, force, bias, .. } = scratch;
        model.inverse_dynamics_here(data, v, acceleration, bias);
        force.fill(0.0);
        ground.feet.add_to(model, data, force);
        torque.fill(0.0);
        for (i, (needed, ground)) in bias[6..].iter().zip(&force[6..]).enumerate() {
            torque[self.moving.as_ref().map_or(i, |moving| moving.outside[i])] = needed - ground;
        }
    }

    /// Wrenches that carry and move the bodies below each force sensor in the state that was last looked at, with the
    /// acceleration of [`Plant::note_step`].
    pub fn carried(&mut self, sensors: &[Frame; 2]) -> [Wrench; 2] {
        let Self { model, data, scratch, .. } = self;
        model.forward_kinematics_here(data);
        model.inverse_dynamics_here(data, &scratch.v, &scratch.acceleration, &mut scratch.bias);
        sensors.map(|frame| carried::inertial(model, data, &frame))
    }

    /// Motors in a state: angles and speeds in joint units, which hold the joints' on entry, and currents.
    pub fn motors(&self, x: &[f64], angle: &mut [f64], speed: &mut [f64], current: &mut [f64]) {
        let l = &self.layout;
        let Joints::Driven(train) = &self.joints else { return };
        for (joint, e) in train.rotors() {
            let j = self.outside(joint);
            (angle[j], speed[j]) = (x[l.rotor_angle()][e], x[l.rotor_speed()][e]);
        }
        if let Some(moving) = &self.moving {
            current[..moving.reference.len()].fill(0.0); // drives of locked joints have nothing to do
        }
        for (i, steady) in train.steady_currents().enumerate() {
            current[self.outside(i)] = x[l.current()].get(i).copied().unwrap_or(steady);
        }
    }

    /// Pose of a frame of the limbs that touch the ground, after [`Plant::look`].
    pub fn frame_pose(&self, frame: &Frame) -> nalgebra::IsometryMatrix3<f64> {
        self.model.frame_pose(&self.data, frame)
    }

    /// \[rad, rad/s\] Angle and speed of joint `j` of the robot in the state that was last looked at; of a locked one those
    /// of its reference.
    pub fn joint(&self, j: usize) -> (f64, f64) {
        let inside = match &self.moving {
            None => Ok(j),
            Some(moving) => moving.outside.binary_search(&j),
        };
        match (inside, &self.moving) {
            (Err(_), Some(moving)) => (moving.reference[j].angle, moving.reference[j].speed),
            (Ok(i) | Err(i), _) => (self.scratch.q[7 + i], self.scratch.v[6 + i]),
        }
    }
}

fn angular_velocity(speed: &[f64]) -> Vector3<f64> {
    Vector3::from_column_slice(&speed[3..6])
}
