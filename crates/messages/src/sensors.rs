//! `sensors`: everything measured on the robot, once per bus cycle.

use crate::{Header, Joints, MAX_JOINTS, Wrench, record};

record! {
    /// Orientation and motion of the upper body.
    part Imu {
        /// \[1\] Unit quaternion (x, y, z, w), world_from_torso; zero heading is the heading at switch-on.
        orientation: [f64; 4],
        /// \[rad/s\] @torso
        angular_velocity: [f64; 3],
        /// \[m/s^2\] @torso Specific force: (0, 0, +9.81) at rest.
        acceleration: [f64; 3],
    }
}

record! {
    /// All sensor data of one bus cycle. Written by lowlevel.
    record Sensors {
        /// Tick and stamp of the bus cycle.
        header: Header,
        /// \[rad\] Link side (absolute encoders).
        joint_angle: Joints,
        /// \[rad/s\] Link side.
        joint_speed: Joints,
        /// \[rad\] Motor side, divided by the gear ratio.
        motor_angle: Joints,
        /// \[rad/s\] Motor side, divided by the gear ratio.
        motor_speed: Joints,
        /// \[A\] @invalid NaN where the drive has no current sensor
        motor_current: Joints,
        /// \[1\] Statuswords of the drives (CiA 402); 0 where none is sent.
        drive_status: [u32; MAX_JOINTS],
        /// \[1\] Error codes of the drives (CiA 402); 0: none.
        drive_error: [u32; MAX_JOINTS],
        /// \[deg C\] Windings of the motors.
        temperature: Joints,
        /// \[N, N m\] @sensor frame of each foot: force and moment of the ground on the foot; right, left.
        foot_wrench: [Wrench; 2],
        /// Upper body.
        imu: Imu,
        /// \[1\] 1 while the motor supply is on.
        power: u64,
        /// \[1\] A [`StartUp`](crate::StartUp), as the joint loop left it in the cycle before.
        start_up: u64,
        /// \[1\] Bus frames missed since start.
        frames_missed: u64,
        /// \[1\] Targets refused or limited since start.
        targets_limited: u64,
    }
}
