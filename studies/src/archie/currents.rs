//! Torques and currents of a stride of his walk, and how long its motors bear it.

use std::path::Path;

use config::Setup;
use serde::Serialize;

use super::statics::Statics;
use super::trial::{BEGIN, STEPS, open_loop, walk_with};
use crate::Error;
use crate::sheet::{Column, fixed, plain};

/// Instants of the stride in the prediction.
const INSTANTS: usize = 480;
/// \[s\] Of a single support, until torques are those of standing.
const SETTLES: f64 = 0.5;
/// \[s\] Over which currents are averaged for their largest torque.
const RUSTLES: f64 = 0.1;
/// \[s\] For so long the strides are repeated, to see whether a winding gets too hot.
const LONG: f64 = 600.0;

pub(super) const COLUMNS: &[Column] = &[
    plain("/joint", "joint, right leg"),
    fixed("/predicted_nm", "largest torque predicted [N m]", 1),
    fixed("/measured_nm", "on one foot, without friction [N m]", 1),
    fixed("/peak_a", "its current [A]", 2),
    fixed("/stride_peak_a", "in the whole stride [A]", 2),
    fixed("/predicted_rms_a", "rms predicted [A]", 2),
    fixed("/rms_a", "rms without friction [A]", 2),
    fixed("/friction_rms_a", "rms with friction [A]", 2),
    fixed("/continuous_a", "for ever [A]", 2),
    fixed("/predicted_s", "at its limit after, predicted [s]", 1),
    fixed("/limit_s", "without friction [s]", 1),
    fixed("/friction_limit_s", "with friction [s]", 1),
];

/// A joint over a stride.
#[derive(Clone, Debug, Serialize)]
pub struct JointLoad {
    /// Its name.
    pub joint: String,
    /// \[N m\] Largest torque by statics, and by the current of the motor without friction.
    pub predicted_nm: f64,
    /// \[N m\]
    pub measured_nm: f64,
    /// \[A\] Largest current without friction, on one foot and in the whole stride, where both feet push one another.
    pub peak_a: f64,
    /// \[A\]
    pub stride_peak_a: f64,
    /// \[A\] Root of its mean square over the stride: by statics, without friction, with it.
    pub predicted_rms_a: f64,
    /// \[A\]
    pub rms_a: f64,
    /// \[A\]
    pub friction_rms_a: f64,
    /// \[A\] May flow for ever.
    pub continuous_a: f64,
    /// \[s\] After which the winding is at its limit, of strides that repeat: the same three; none: never.
    pub predicted_s: Option<f64>,
    /// \[s\]
    pub limit_s: Option<f64>,
    /// \[s\]
    pub friction_limit_s: Option<f64>,
}

/// Currents \[A\] of the drives at an instant.
type Currents = Vec<f64>;

/// The right leg's joints.
///
/// # Errors
/// The scene is wrong, or its robot has no thermal data.
pub(super) fn loads(config: &Path) -> Result<Vec<JointLoad>, Error> {
    let mut setup = open_loop(config, STEPS, |_| ())?;
    let with = stride(&setup)?;
    setup.scene.components.friction = Some(false);
    let without = stride(&setup)?;
    let predicted = torques(&setup)?;
    let protection = setup.robot.protection.clone().ok_or("robot archie has no [protection]")?;
    let pattern = setup.gait.pattern.ok_or("gait archie_static has no [pattern]")?;
    let (step, double_support) = (pattern.step_time, pattern.double_support);
    let leg = setup.robot.drives.iter().enumerate().filter(|(_, drive)| drive.name.starts_with("right"));
    let load = |(d, drive): (usize, &config::drive::Drive)| {
        let joint = drive.joints[0];
        let ratio = drive.transmission.at([0.0; 3], [0.0; 3])?.ratio[0].abs();
        let torque_constant = drive.motor.torque_constant;
        let course = |of: &[Currents]| of.iter().map(|at| at[d]).collect::<Vec<_>>();
        let (with, without) = (course(&with), course(&without));
        // Single supports are the end of either step; what the change of feet leaves swinging has settled.
        let half = without.len() / 2;
        let settled = (half as f64 * (double_support + SETTLES) / step) as usize;
        // Encoders of 360 counts make the current rustle: means over a tenth of a second.
        let rustles = (RUSTLES / setup.scene.cycle) as usize;
        let mean = |some: &[f64]| some.iter().sum::<f64>() / some.len() as f64;
        let steps = without.chunks(half).filter_map(|step| step.get(settled..));
        let on_one_foot: Vec<f64> = steps.flat_map(|step| step.chunks(rustles).map(mean)).collect();
        let statics: Vec<f64> = predicted.iter().map(|at| at[joint] / (ratio * torque_constant)).collect();
        let winding = &protection.windings[d];
        let [continuous, constant] = [winding.continuous_current, winding.time_constant];
        let period = 2.0 * step;
        // What the drives' own protection would see.
        let simulated = |course: &[f64]| {
            let (mut temperature, dt) = (winding.surroundings, period / course.len() as f64);
            let hot = course.iter().cycle().take((LONG / dt) as usize).position(|current| {
                temperature = winding.after(temperature, *current, dt);
                temperature > winding.highest
            });
            hot.map(|k| k as f64 * dt)
        };
        Ok(JointLoad {
            joint: setup.robot.joints[joint].name.replace("right_", "").replace('_', " "),
            predicted_nm: largest(&statics) * ratio * torque_constant,
            measured_nm: largest(&on_one_foot) * ratio * torque_constant,
            peak_a: largest(&on_one_foot),
            stride_peak_a: largest(&without),
            predicted_rms_a: rms(&statics),
            rms_a: rms(&without),
            friction_rms_a: rms(&with),
            continuous_a: continuous,
            predicted_s: heated(&statics, period, continuous, constant),
            limit_s: simulated(&without),
            friction_limit_s: simulated(&with),
        })
    };
    leg.map(load).collect()
}

fn largest(course: &[f64]) -> f64 {
    course.iter().fold(0.0, |most, x| most.max(x.abs()))
}

fn rms(course: &[f64]) -> f64 {
    (course.iter().map(|x| x * x).sum::<f64>() / course.len() as f64).sqrt()
}

/// Prediction of the instant at which a winding that was cold is at its limit: share of the limit s, tau s' = (I/I_c)^2 - s.
fn heated(course: &[f64], period: f64, continuous: f64, tau: f64) -> Option<f64> {
    let (mut share, dt) = (0.0, period / course.len() as f64);
    (0..(LONG / dt) as usize).find_map(|k| {
        let loss = (course[k % course.len()] / continuous).powi(2);
        share = loss + (share - loss) * (-dt / tau).exp();
        (share > 1.0).then_some(k as f64 * dt)
    })
}

/// Currents of the drives over the periodic stride, its first instant that of its first double support.
fn stride(setup: &Setup) -> Result<Vec<Currents>, Error> {
    let step = setup.gait.pattern.map_or(0.0, |p| p.step_time);
    let drives = setup.robot.drives.len();
    let mut all = Vec::new();
    let walked = walk_with(setup, &mut |_| (), &mut |cycle| {
        let t = cycle.sim_state.time - BEGIN;
        if (step..3.0 * step).contains(&t) {
            all.push(cycle.sensors.motor_current[..drives].to_vec());
        }
    });
    if walked.ended == "done" { Ok(all) } else { Err(walked.ended.into()) }
}

/// Torques of the joints over the stride \[N m\], by statics: the feet carry as planned, and do not push one another.
fn torques(setup: &Setup) -> Result<Vec<Vec<f64>>, Error> {
    let mut statics = Statics::new(&setup.robot, &setup.gait).ok_or("gait archie_static cannot be laid")?;
    let step = setup.gait.pattern.map_or(0.0, |p| p.step_time);
    let at = |k: usize| step + 2.0 * step * k as f64 / INSTANTS as f64;
    let mut torque = |t: f64| {
        let left = statics.load_left(t);
        let of = |statics: &mut Statics<'_>, j| {
            let [right, other] = [0, 1].map(|stance| statics.torque(t, j, stance));
            Some((1.0 - left) * right? + left * other?)
        };
        (0..setup.robot.joints.len()).map(|j| of(&mut statics, j)).collect::<Option<Vec<f64>>>()
    };
    (0..INSTANTS)
        .map(|k| torque(at(k)))
        .collect::<Option<_>>()
        .ok_or_else(|| "a leg cannot take its pose".into())
}
