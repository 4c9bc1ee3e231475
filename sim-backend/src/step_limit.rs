//! Linearisation of equations of motion, and the steps that explicit and semi-implicit methods may take on them.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | s | eigenvalue of the derivative of the rates by the state | 1/s |
//! | R | factor by which a step multiplies an eigenvector, as a polynomial of hs | 1 |
//! | r, T | damping of a mode by the contact layer over its mass; time B/K of the layer | 1/s, s |

use std::error::Error;

use config::method::Integrator;
use config::scene::FRICTION_RAMP;
use config::{Components, Robot, Scene};
use environment::Environment;
use faer::{Mat, Par, set_global_parallelism};
use nalgebra::Complex;

use crate::body::with_plant_mismatch;
use crate::drive::JointCubic;
use crate::feet::RECOVERY;
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
    let Some(of) = explicit(integrator) else { return Ok(None) };
    let mut plant = Plant::new(robot, Environment::flat(), components.into().on_points(), pose)?;
    plant.set_friction_ramp(ramp);
    explicit_limit(&mut plant, of, pose).map(Some)
}

/// Largest stable step of a scene: its robot as heavy and on such soles as `[plant_mismatch]` says. Semi-implicit steps have one,
/// too. None: the method chooses its steps itself.
///
/// # Errors
/// As of [`step_limit`].
pub fn step_limit_of_scene(robot: &Robot, scene: &Scene) -> Result<Option<StepLimit>> {
    let (real, pose) = (with_plant_mismatch(robot, scene), &robot.poses[&scene.start_pose]);
    let plant = |components: Components| -> Result<Plant> {
        let mut plant = Plant::new(&real, Environment::flat(), components.on_points(), pose)?;
        plant.weigh(&scene.plant_mismatch)?;
        plant.set_friction_ramp(scene.friction_ramp);
        Ok(plant)
    };
    if let Some(of) = explicit(scene.integrator) {
        return explicit_limit(&mut plant(scene.components())?, of, pose).map(Some);
    }
    if scene.integrator != Integrator::SemiImplicit {
        return Ok(None);
    }
    // Dry friction holds shafts and never frees one: without it the soles meet the least mass.
    let mut free = plant(Components { friction: false, ..scene.components() })?;
    semi_implicit_limit(&mut free, real.contact.damping_time, pose).map(Some)
}

/// Largest stable step of a method \[s\] by eigenvalues \[1/s\].
type LimitOf = fn(&[Complex<f64>]) -> f64;

/// That of an explicit method.
fn explicit(integrator: Integrator) -> Option<LimitOf> {
    match integrator {
        Integrator::Euler => Some(euler_limit),
        Integrator::RungeKutta4 => Some(runge_kutta_limit),
        Integrator::SemiImplicit | Integrator::Bdf => None,
    }
}

/// Smallest of the steps `of` the eigenvalues in each regime.
fn explicit_limit(plant: &mut Plant, of: LimitOf, pose: &[f64]) -> Result<StepLimit> {
    let drives = resting(pose);
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
    // Slow modes are the robot's fall, which no step makes stable.
    let mut least = StepLimit { step: f64::INFINITY, regime: "" };
    for (regime, x) in regimes {
        let mut values = eigenvalues(&x, |x, dx| plant.rate(0.0, x, &drives, &PlantInputs::POWERED, dx))?;
        values.retain(|s| s.norm() > SLOW);
        let step = of(&values).max(0.0);
        if step < least.step {
            least = StepLimit { step, regime };
        }
    }
    Ok(least)
}

/// Largest stable semi-implicit step: drives and gears are those of its end and limit nothing; contact forces are those of its
/// begin, so that against the soles it is Euler's. Nodes in the air only take stiffness away.
fn semi_implicit_limit(plant: &mut Plant, damping_time: f64, pose: &[f64]) -> Result<StepLimit> {
    let drives = resting(pose);
    let mut x = plant.standing(pose);
    let speed = plant.layout().speed();
    let (at_rest, mut rates) = (x[speed.clone()].to_vec(), vec![0.0; x.len()]);
    // Without power nothing but the layers under the soles answers to a speed: - M^-1 B.
    let mut values = eigenvalues(&at_rest, |v, dv| {
        x[speed.clone()].copy_from_slice(v);
        plant.rate(0.0, &x, &drives, &PlantInputs::default(), &mut rates);
        dv.copy_from_slice(&rates[speed.clone()]);
    })?;
    values.retain(|s| s.re < -SLOW);
    // Stiffness is damping over T in every direction, so each mode is a mass on one layer: s^2 + r s + r/T = 0.
    let of_mode = |value: &Complex<f64>| {
        let r = -value.re;
        let root = Complex::new(r * r - 4.0 * r / damping_time, 0.0).sqrt();
        [1.0, -1.0].map(|sign| (root * sign - r) / 2.0)
    };
    let modes: Vec<Complex<f64>> = values.iter().flat_map(of_mode).collect();
    let (soles, recovery) = (euler_limit(&modes), 1.0 / RECOVERY);
    Ok(if soles < recovery {
        StepLimit { step: soles, regime: "contact forces of the begin of a step" }
    } else {
        StepLimit { step: recovery, regime: "nodes that have sunk in are thrown up" }
    })
}

/// Drives that hold a pose.
fn resting(pose: &[f64]) -> Vec<JointCubic> {
    pose.iter().map(|&q| JointCubic::resting(q)).collect()
}

/// Limit that the step of a scene is beyond, unless the scene forces it.
///
/// # Errors
/// As of [`step_limit`].
pub fn exceeded(robot: &Robot, scene: &Scene) -> Result<Option<StepLimit>> {
    let step = scene.cycle / f64::from(scene.substeps);
    let limit = if scene.force_step { None } else { step_limit_of_scene(robot, scene)? };
    Ok(limit.filter(|limit| step > limit.step))
}

/// Refuses a step of a scene that is longer than the stable one.
///
/// # Errors
/// It is, and the scene does not force it; or as of [`step_limit`].
pub(crate) fn check(robot: &Robot, scene: &Scene) -> Result<()> {
    let Some(limit) = exceeded(robot, scene)? else { return Ok(()) };
    let name = Integrator::WORDS[scene.integrator as usize];
    let enough = (scene.cycle / limit.step).ceil();
    let advice = if enough <= 1000.0 { format!("substeps = {enough} or more, or ") } else { String::new() };
    let implicit = scene.integrator == Integrator::SemiImplicit;
    let other = if implicit { "" } else { "integrator = \"semi_implicit\", or " };
    let factor = scene.plant_mismatch.contact_stiffness;
    let soles = if factor == 1.0 { String::new() } else { format!(", contact_stiffness = {factor}") };
    Err(format!(
        "scene `{}`: integrator = \"{name}\" with substeps = {}: a step of {} ms is longer than {}, the largest stable one \
         ({}{soles}); take {advice}{other}force_step = true to see what happens",
        scene.name,
        scene.substeps,
        1e3 * scene.cycle / f64::from(scene.substeps),
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
