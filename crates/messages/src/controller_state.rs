//! `controller_state`: what the stabilizer makes of plan and sensors.

use crate::{Header, Joints, Wrench, record};

record! {
    /// Desired and measured task space, errors and modified forces. Written by controller.
    ///
    /// "Measured" task-space values are direct kinematics of the measured joint angles and the IMU, in the planning
    /// frame of the active plan, anchored at the foot that is planned to carry more. Arrays of feet: right, left.
    record ControllerState {
        /// Tick of the sensor data used.
        header: Header,
        /// \[1\] Id of the plan being executed; 0 before the first one.
        plan_id: u64,
        /// \[s\] Time since the start of that plan.
        plan_time: f64,
        /// \[1\] A [`GaitState`](crate::GaitState).
        gait: u64,
        /// \[1\] A [`Phase`](crate::Phase) of each foot.
        phase: [u64; 2],
        /// \[1\] Whether a foot presses on the ground, by its force sensor.
        contact: [u64; 2],
        /// \[1\] 1 while the robot does not stand on its feet yet: no walking command is taken.
        not_standing: u64,
        /// \[m, m, rad\] @I_0 Planning frame of the active plan.
        origin: [f64; 3],
        /// \[m\] Desired centre of gravity.
        com_desired: [f64; 3],
        /// \[m\] Measured centre of gravity.
        com: [f64; 3],
        /// \[m/s\] Its velocity, the foot it is anchored at being at rest where it presses.
        com_velocity: [f64; 3],
        /// \[m\] Measured divergent component of its motion: `c + c'/w`, `w` that of a linear pendulum of its height. @invalid NaN
        /// where it is not above the feet
        dcm: [f64; 2],
        /// \[m\] Desired minus measured one. @invalid NaN without a plan for the centre of gravity
        dcm_error: [f64; 2],
        /// \[m\] Measured origin of the torso.
        torso: [f64; 3],
        /// \[m, rad\] Measured sole frames: x, y, z, heading.
        feet: [[f64; 4]; 2],
        /// \[m, rad\] Desired sole frames: x, y, z, heading.
        feet_desired: [[f64; 4]; 2],
        /// \[rad\] Inclination error Delta phi_x, Delta phi_y: desired minus measured (5.2), (5.3).
        inclination_error: [f64; 2],
        /// \[rad/s\] Its rate.
        inclination_rate_error: [f64; 2],
        /// \[rad\] Roll and pitch that the IMU is taken to read too much: measured inclinations are without them.
        inclination_trim: [f64; 2],
        /// \[1\] @I_0 Rise of the ground per metre along x and y, as the last two stance soles lay on it; 0 on level ground, and
        /// of a gait without `[reaction]`.
        ground_slope: [f64; 2],
        /// \[m, m, rad\] @I_0 Place and heading of the torso as the camera head reckons them, with the heading of the gyroscopes,
        /// less those that footholds say; zeros of a robot without a camera head.
        head_offset: [f64; 3],
        /// \[m\] Planned zero-moment point.
        zmp_desired: [f64; 2],
        /// \[m\] Zero-moment point of the measured foot wrenches. @invalid NaN while no foot carries load
        zmp: [f64; 2],
        /// \[m\] Pressure point of each foot on the ground. @invalid NaN while it carries no load
        pressure_point: [[f64; 2]; 2],
        /// \[m\] Distance of the measured zero-moment point to the edge of the support polygon of the loaded feet;
        /// negative outside. @invalid NaN while no foot carries load
        zmp_margin: f64,
        /// \[1\] Load factor of the left foot, planned.
        load_left: f64,
        /// \[N, N m\] @sensor frames Desired contact forces after modification lambda_d1 (5.22).
        wrench_desired: [Wrench; 2],
        /// \[m, rad, rad\] Trajectory modification Delta x_lambda of each foot: z, s1, s0 (5.33).
        modification: [[f64; 3]; 2],
        /// \[rad\] Joint targets of the last cycle minus measured joint angles.
        tracking_error: Joints,
        /// \[1\] Times a limit held back the inverse kinematics or a modification.
        limited: u64,
    }
}
