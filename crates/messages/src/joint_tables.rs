//! `joint_tables`: points that the drives play by themselves, for all joints, when a plan is made.

use crate::{Header, Joints, MAX_JOINTS, record};

/// Room for points of a joint.
pub const MAX_POINTS: usize = 1024;

record! {
    /// Tables of motor positions at equal times. Written by controller. Point 0 is where the joints are when cycle
    /// `start_tick` begins; the drives play a cubic from each point to the next one.
    record JointTables {
        /// Tick in which the tables were completed; it lies ahead of `start_tick`.
        header: Header,
        /// \[1\] Number of the plan that they are of, ascending; 0 is none.
        plan: u64,
        /// \[1\] The cycle with whose SYNC the drives begin.
        start_tick: u64,
        /// \[1\] @range 1..256 Samples of the drives' position controllers from point to point: m.
        spacing: u64,
        /// \[1\] @range 2..1024 Number of points.
        points: u64,
        /// \[1\] 1: the last point is followed by the first one.
        cyclic: u64,
        /// \[1\] Number of joints.
        joints: u64,
        /// \[rad\] Angle of one count of each joint's motor: those of the robot that the tables were made for.
        unit: Joints,
        /// \[count\] Positions of the motors, by joint.
        counts: [[i32; MAX_POINTS]; MAX_JOINTS],
    }
}

impl JointTables {
    /// Positions of joint `j` \[count\]; empty if there are more points than room.
    pub fn of(&self, j: usize) -> &[i32] {
        self.counts[j].get(..self.points as usize).unwrap_or_default()
    }
}
