//! How a robot walks (planner) and how it is stabilized (controller).

/// `gaits/NAME.toml`.
#[derive(Clone, Debug)]
pub struct Gait {
    /// Steps.
    pub step: Step,
    /// Model the centre-of-gravity trajectory is planned with.
    pub model: Model,
    /// What may be commanded.
    pub limits: Limits,
    /// Stabilizing control.
    pub control: Control,
}

/// Steps and feet.
#[derive(Clone, Debug)]
pub struct Step {
    /// \[m\] Lateral distance of the sole frames W_step.
    pub width: f64,
    /// \[m\] Least lateral distance of the sole frames W_step,min, feet parallel.
    pub width_min: f64,
    /// \[m\] Height of the swing foot z_swing.
    pub swing_height: f64,
    /// \[1\] Share of a step that is double support.
    pub double_support: f64,
    /// \[s\] Double support of the first step out of standing, and after the last one until rest.
    pub start_time: f64,
    /// \[s\] The swing foot moves horizontally only this long after lift-off ...
    pub swing_lag: f64,
    /// \[s\] ... and until this long before landing.
    pub swing_lead: f64,
    /// \[m\] Longest first and last step.
    pub first_length: f64,
    /// \[m, m, rad\] Largest change of (length, side, turn) from one step to the next.
    pub change: [f64; 3],
    /// \[s\] Largest change of the duration from one step to the next.
    pub change_duration: f64,
    /// Step lengths and durations of forward walking by speed, ascending in speed: \[m/s, m, s\].
    pub by_speed: Vec<[f64; 3]>,
}

/// The three-mass model (4.38).
#[derive(Clone, Copy, Debug)]
pub struct Model {
    /// \[m\] Height of the centre of gravity while walking.
    pub com_height: f64,
    /// \[m\] Where the centre of gravity stands in x, in front of the middle of the sole frames.
    pub com_forward: f64,
    /// \[1\] Mass of one leg point over the robot's mass.
    pub leg_mass: f64,
    /// \[m\] Height of a leg's mass point above its sole frame.
    pub leg_height: f64,
    /// \[m\] Distance the planned zero-moment point keeps from the edges of the support polygon.
    pub zmp_margin: f64,
    /// \[s\] Largest spacing of collocation points.
    pub spacing: f64,
    /// \[s\] Time for raising or lowering the body while standing.
    pub stand_time: f64,
}

/// Ranges of walking commands (thesis 4.6.1); outside of them a command is refused.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// \[m\] Step length.
    pub length: [f64; 2],
    /// \[m\] Step to the side.
    pub side: [f64; 2],
    /// \[rad\] Turn per step.
    pub turn: [f64; 2],
    /// \[s\] Step duration.
    pub duration: [f64; 2],
}

/// Gains of the stabilizer (thesis chapter 5).
#[derive(Clone, Copy, Debug)]
pub struct Control {
    /// \[N m/rad\] K_P of the inclinations phi_x, phi_y (5.2), (5.3).
    pub inclination_p: [f64; 2],
    /// \[N m s/rad\] K_D of the same.
    pub inclination_d: [f64; 2],
    /// \[N/m\] K_P of the height of the centre of gravity (5.4).
    pub height_p: f64,
    /// \[N s/m\] K_D of the same.
    pub height_d: f64,
    /// \[1\] F_z,max over the robot's weight (5.12).
    pub force_max: f64,
    /// \[1/s\] K_lambda of normal force, moment about x, moment about y (5.26).
    pub force_gain: [f64; 3],
    /// \[1\] K_lambda,FF (5.31).
    pub force_feed_forward: f64,
    /// \[N\] Contact forces between which a foot is blended from position to force control.
    pub force_blend: [f64; 2],
    /// \[1/s\] K_lambda_x: how fast a modification returns to zero under position control (5.32).
    pub position_gain: f64,
    /// \[m, rad, rad\] Limits of a modification (z, s1, s0).
    pub modification_limit: [f64; 3],
    /// \[m/s, rad/s, rad/s\] Limits of its rate.
    pub modification_rate: [f64; 3],
    /// \[1/s\] K_x: drift compensation of the inverse kinematics (feedback path 1).
    pub drift_gain: f64,
    /// \[1/s\] alpha_N: weight of the null-space cost H (5.38).
    pub null_space_gain: f64,
    /// \[s\] Time constant of the force sensor filter.
    pub force_filter: f64,
}
