//! Linearisation of equations of motion, and the steps that explicit methods may take on them.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | s | eigenvalue of the derivative of the rates by the state | 1/s |
//! | R | factor by which a step multiplies an eigenvector, as a polynomial of hs | 1 |

use std::error::Error;

use config::method::Integrator;
use config::scene::FRICTION_RAMP;
use config::{Components, Robot, Scene};
use environment::Environment;
use faer::{Mat, Par, set_global_parallelism};
use nalgebra::Complex;

use crate::drive::JointCubic;
use crate::plant::{Plant, PlantInputs};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// \[1\] By how much a state is changed to see what its rate does: contact nodes stay on the ground, rotors within the ramp
/// of their dry friction.
const CHANGE: f64 = 1e-7;
/// \[1/s\] Eigenvalues below are zeros with rounding errors: a robot may stand anywhere, a stuck node stay anywhere.
const ZERO: f64 = 1.0;
/// \[1/s\] Slower modes are the robot's own: one that topples grows with any step.
const SLOW: f64 = 20.0;
/// \[rad/s\] Speeds of joints and rotors outside of the ramp of dry friction, which damps nothing there.
const MOVING: [f64; 2] = [0.3, 30.0];
/// \[m\] Height of the soles of a robot in the air.
const IN_THE_AIR: f64 = 1.0;

/// Eigenvalues \[1/s\] of the linearised rates at a state, zeros left out.
///
/// # Errors
/// The iteration for them does not end.
pub fn eigenvalues(x: &[f64], mut rate: impl FnMut(&[f64], &mut [f64])) -> Result<Vec<Complex<f64>>> {
    let n = x.len();
    let (mut at, mut ahead, mut behind) = (x.to_vec(), vec![0.0; n], vec![0.0; n]);
    let mut jacobian = Mat::zeros(n, n);
    for j in 0..n {
        at[j] = x[j] + CHANGE;
        rate(&at, &mut ahead);
        at[j] = x[j] - CHANGE;
        rate(&at, &mut behind);
        at[j] = x[j];
        for i in 0..n {
            jacobian[(i, j)] = (ahead[i] - behind[i]) / (2.0 * CHANGE);
        }
    }
    // On this thread alone: no process of the chain gets others for it.
    set_global_parallelism(Par::Seq);
    let found = jacobian.eigenvalues().map_err(|e| format!("eigenvalues of the linearised rates: {e:?}"))?;
    Ok(found.iter().map(|s| Complex::new(s.re, s.im)).filter(|s| s.norm() > ZERO).collect())
}

/// \[s\] Largest step with which explicit Euler is stable: -2 Re s/|s|^2.
pub fn euler_limit(values: &[Complex<f64>]) -> f64 {
    values.iter().map(|s| -2.0 * s.re / s.norm_sqr()).fold(f64::INFINITY, f64::min)
}

/// \[s\] The same for the classical Runge-Kutta method: |R| = 1.
pub fn runge_kutta_limit(values: &[Complex<f64>]) -> f64 {
    let factor = |z: Complex<f64>| {
        let terms = [1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0];
        terms.iter().fold(Complex::new(0.0, 0.0), |r, c| r * z + c).norm()
    };
    let limit = |s: &Complex<f64>| {
        // Its region reaches no further than 3.5 from the origin.
        let (far, steps) = (3.5 / s.norm(), 4000);
        let first = (1..=steps).map(|k| far * f64::from(k) / f64::from(steps)).find(|h| factor(s * *h) > 1.0);
        first.unwrap_or(far)
    };
    values.iter().map(limit).fold(f64::INFINITY, f64::min)
}

/// Largest step with which an explicit method is stable, of what limits it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepLimit {
    /// \[s\] 0 if no step is.
    pub step: f64,
    /// Motion of the robot in which it is the smallest.
    pub regime: &'static str,
}

/// Largest stable step of an explicit method on a robot of these components: the smallest of a robot that stands, one whose rotors
/// turn faster than dry friction damps them, and one in the air. Pads count as points: both relax with K/B. None: the method
/// is not explicit.
///
/// # Errors
/// The robot's data do not allow them.
pub fn step_limit(
    robot: &Robot,
    components: impl Into<Components>,
    pose: &[f64],
    integrator: Integrator,
) -> Result<Option<StepLimit>> {
    step_limit_of_ramp(robot, components, pose, integrator, FRICTION_RAMP)
}

/// The same with dry friction that changes its sign over `ramp` \[rad/s\] of a rotor: the narrower, the stiffer.
///
/// # Errors
/// As of [`step_limit`].
pub fn step_limit_of_ramp(
    robot: &Robot,
    components: impl Into<Components>,
    pose: &[f64],
    integrator: Integrator,
    ramp: f64,
) -> Result<Option<StepLimit>> {
    let of: fn(&[Complex<f64>]) -> f64 = match integrator {
        Integrator::Euler => euler_limit,
        Integrator::RungeKutta4 => runge_kutta_limit,
        Integrator::SemiImplicit | Integrator::Bdf => return Ok(None),
    };
    let mut plant = Plant::new(robot, Environment::flat(), components.into().on_points(), pose)?;
    plant.set_friction_ramp(ramp);
    let drives: Vec<JointCubic> = pose.iter().map(|&q| JointCubic::resting(q)).collect();
    let (standing, hanging) = (plant.standing(pose), plant.hanging(pose, IN_THE_AIR));
    let l = *plant.layout();
    let moving = |mut x: Vec<f64>| {
        x[l.speed()][6..].fill(MOVING[0]);
        x[l.rotor_speed()].fill(MOVING[1]);
        x
    };
    let regimes = [
        ("standing", standing.clone()),
        ("standing, joints in motion", moving(standing)),
        ("in the air, joints in motion", moving(hanging)),
    ];
    let mut least = StepLimit { step: f64::INFINITY, regime: "" };
    for (regime, x) in regimes {
        let mut values = eigenvalues(&x, |x, dx| plant.rate(0.0, x, &drives, &PlantInputs::POWERED, dx))?;
        values.retain(|s| s.norm() > SLOW);
        let step = of(&values).max(0.0);
        if step < least.step {
            least = StepLimit { step, regime };
        }
    }
    Ok(Some(least))
}

/// Refuses an explicit step of a scene that is longer than the stable one.
///
/// # Errors
/// It is, and the scene does not force it; or as of [`step_limit`].
pub(crate) fn check(robot: &Robot, scene: &Scene) -> Result<()> {
    let pose = &robot.poses[&scene.start_pose];
    let found = step_limit_of_ramp(robot, scene.components(), pose, scene.integrator, scene.friction_ramp)?;
    let Some(limit) = found else { return Ok(()) };
    let step = scene.cycle / f64::from(scene.substeps);
    if step <= limit.step || scene.force_step {
        return Ok(());
    }
    let name = Integrator::WORDS[scene.integrator as usize];
    let enough = (scene.cycle / limit.step).ceil();
    let advice = if enough <= 1000.0 { format!("substeps = {enough} or more, or ") } else { String::new() };
    Err(format!(
        "scene `{}`: integrator = \"{name}\" with substeps = {}: a step of {} ms is longer than {}, the largest stable one \
         ({}); take {advice}integrator = \"semi_implicit\", or force_step = true to see what happens",
        scene.name,
        scene.substeps,
        1e3 * step,
        in_ms(limit.step),
        limit.regime
    )
    .into())
}

/// A step \[s\], rounded down to what is still stable.
fn in_ms(step: f64) -> String {
    let ms = 1e3 * step;
    if ms >= 0.01 { format!("{} ms", (1e3 * ms).floor() / 1e3) } else { format!("{:.1e} ms", 0.95 * ms) }
}
