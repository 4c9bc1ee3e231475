//! Support for a search of all states: short times, and a hash that tells two states apart. Only tests call it.

use std::hash::{Hash, Hasher};

use super::{JointLoop, LoopState};
use crate::start_up::StartUpTiming;

impl JointLoop {
    /// The same with other lengths of what the start-up counts: short ones make a world that can be explored whole.
    pub fn with_timing(mut self, timing: StartUpTiming) -> Self {
        self.start_up.set_timing(timing);
        self
    }

    /// Hashes everything that decides what the joint loop does after [`JointLoop::send`], numbers as far as they matter:
    /// equal states act alike, but for what they report.
    pub fn hash_state(&self, h: &mut impl Hasher) {
        let stop = match self.state {
            LoopState::Stop(why) => Some(why as u64),
            _ => None,
        };
        (std::mem::discriminant(&self.state), stop, self.output.reset.trip).hash(h);
        self.age.hash_state(self.sensors.header.tick, h);
        self.setpoints.hash_state(self.robot.joints.len(), h);
        self.guard.hash_state(h);
        self.start_up.hash_state(h);
        let s = &self.sensors;
        s.power.hash(h);
        for j in 0..self.robot.joints.len() {
            (s.drive_status[j], s.drive_error[j]).hash(h);
            for x in [s.joint_angle[j], s.joint_speed[j], s.motor_angle[j], s.motor_speed[j]] {
                x.to_bits().hash(h);
            }
        }
        for wrench in &s.foot_wrench {
            wrench.force.iter().chain(&wrench.moment).for_each(|x| x.to_bits().hash(h));
        }
        let imu = &s.imu;
        let all = imu.orientation.iter().chain(&imu.angular_velocity).chain(&imu.acceleration);
        all.for_each(|x| x.to_bits().hash(h));
    }
}
