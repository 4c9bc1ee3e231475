//! Stabilizing control: plan and sensors to joint targets (thesis chapter 5).
//!
//! Stages and their files: ARCHITECTURE.md, figure 5.8.

mod approach;
pub mod arms;
pub mod contact;
pub mod contact_force;
pub mod daemon;
pub mod estimate;
pub mod force_control;
pub mod gaze;
mod ground_slope;
mod inclination_trim;
pub mod inverse_kinematics;
mod open_loop;
pub mod plan_follower;
mod plan_tables;
mod pose_switch;
pub mod saccade;
mod stabilizer;
pub mod table_builder;
pub mod task_space;
pub mod torso;
mod watch;

pub use stabilizer::{Controller, verdict};

#[cfg(test)]
pub(crate) fn test_gains() -> config::gait::StabilizerGains {
    config::gait::StabilizerGains {
        inclination_p: [1350.0; 2],
        inclination_d: [250.0; 2],
        height_p: 2000.0,
        height_d: 400.0,
        force_shift: 1.0,
        force_gain: [20.0; 3],
        force_feed_forward: 1.0,
        force_blend: [5.0, 50.0],
        position_gain: 10.0,
        modification_limit: [0.03, 0.15, 0.15],
        modification_rate: [0.5, 2.0, 2.0],
        drift_gain: 50.0,
        inclination_compensation: 1.0,
        planned_deformation: 0.0,
        feedback: 1,
        force_filter: 0.005,
    }
}
