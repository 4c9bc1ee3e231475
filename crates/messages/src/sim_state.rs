//! `sim_state`: the truth about the simulated robot, which no controller reads.

use crate::{Header, Joints, Wrench, record};

/// Contact points of a record: the 16 of Lola's soles, or the corners of her eight pads.
pub const MAX_CONTACTS: usize = 32;

/// Objects of a scene that may move.
pub const MAX_MOVING: usize = 8;

record! {
    /// A place where the ground carries the robot.
    part ContactPoint {
        /// \[m\] @world The node, on its deformed sole.
        place: [f64; 3],
        /// \[1\] @world Normal of the ground there, out of it.
        normal: [f64; 3],
    }
}

record! {
    /// Pose, motion and contact of the simulated robot. Written by sim-backend, read by logger and figures only.
    record SimState {
        /// Tick of the bus cycle.
        header: Header,
        /// \[s\] Simulated time.
        time: f64,
        /// \[m\] @world Origin of the torso frame.
        position: [f64; 3],
        /// \[1\] Unit quaternion (x, y, z, w), world_from_torso.
        orientation: [f64; 4],
        /// \[m/s\] @torso Velocity of the torso frame's origin.
        velocity: [f64; 3],
        /// \[rad/s\] @torso
        angular_velocity: [f64; 3],
        /// \[rad\] Joint angles.
        joint_angle: Joints,
        /// \[rad\] Rotors behind elastic gears, divided by the gear ratio; elsewhere the joint angles.
        motor_angle: Joints,
        /// \[m\] @world Centre of gravity.
        com: [f64; 3],
        /// \[N, N m\] @world Ground on each foot: force, and moment about the foot's sole frame; right, left.
        foot_wrench: [Wrench; 2],
        /// \[m, rad\] @world Sole frame of each foot: x, y, z, heading.
        feet: [[f64; 4]; 2],
        /// \[1\] Contact points that carry: the first of `contact`.
        contacts: u64,
        /// Nodes of both soles that are pressed on the ground, of a pad at most the four outermost ones; zeros behind them.
        contact: [ContactPoint; MAX_CONTACTS],
        /// \[N\] @world External push on the torso.
        push: [f64; 3],
        /// \[N\] Rope of the crane, 0 without one.
        rope: f64,
        /// \[1\] 1 while the motor supply is on.
        power: u64,
        /// \[1\] 1 once the robot has fallen: torso tilted by more than 45 degrees or below half its height.
        fallen: u64,
        /// \[s\] By how much the scene's objects that move are late, in its order: they wait while a robot is in their way.
        object_delay: [f64; MAX_MOVING],
    }
}

impl SimState {
    /// Contact points that carry.
    pub fn carrying(&self) -> &[ContactPoint] {
        &self.contact[..(self.contacts as usize).min(MAX_CONTACTS)]
    }
}
