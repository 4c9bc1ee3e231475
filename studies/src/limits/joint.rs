//! Control of one joint with an elastic gear: which gains are stable (J1-J3).
//!
//! Predicted by the conditions of Hurwitz, poles and spectral radii of [`ElasticJoint`]; measured with the drives, gears,
//! friction and controllers that move the robot, on a robot of one joint in free fall: does a swing of it calm down?
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | K, J_J, J_M | stiffness of the gear, inertia of link and rotor on the link's side | N m/rad, kg m^2 |
//! | K_p, K_d, d | gains, viscous friction of the rotor, on the link's side | N m/rad, N m s/rad |
//! | T, V | cycle of a sampled law, amplitude of the rotor's speed | s, rad/s |

use std::f64::consts::PI;

use ::drives::elastic_joint::{ElasticJoint, Gains};
use ::drives::{
    Cascade, ControlLaw, Elasticity, Feedback, Friction, HarmonicFriction, JointControl, Motor, Resolution,
    Sampled, Sampling, ScrewFriction, Transmission,
};
use config::Robot;
use config::method::Integrator;
use config::robot::Drive as Description;
use environment::Environment;
use sim_backend::drive::JointCubic;
use sim_backend::integrate::Stepper;
use sim_backend::plant::{Plant, PlantInputs};

use crate::joint_bench::one_joint;
use crate::search::{Width, middle, windows};

use super::LimitRule::{AtLeast, AtMost, Within};
use super::drives::gear;
use super::{Bench, Findings, LimitRow, Result, row};

/// A leg joint standing, and the same in the air (errata 2.14): HFUC-25-100 with a large motor.
pub(super) const STANCE: ElasticJoint =
    ElasticJoint { stiffness: 3.1e4, link: 10.0, rotor: 1.2, friction: 0.0 };
pub(super) const AIR: ElasticJoint = ElasticJoint { link: 0.5, ..STANCE };
/// Speeds and angles as they are, torques at once; with a cycle of delay; with speeds by differences.
pub(super) const EXACT: Sampled = Sampled { delay: false, difference: false };
pub(super) const DELAYED: Sampled = Sampled { delay: true, difference: false };
const DIFFERENCE: Sampled = Sampled { delay: false, difference: true };

/// Ratio of the gear, as that of all harmonic drives negative.
const RATIO: f64 = -100.0;
/// \[N m/A\]
const CONSTANT: f64 = 0.1;
/// \[s\] Longest steps of the simulation, with sampled laws and continuous ones; a step h damps a swing w by w^2 h/2.
const STEPS: [f64; 2] = [1e-5, 5e-6];
/// \[rad/s\] Speed with which the rotor begins where the loop is linear.
const KICK: f64 = 1e-3;
/// \[rad/s\] Least and largest speed with which it begins where friction is dry.
const SWINGS: [f64; 2] = [1e-3, 20.0];
const FRICTIONLESS: HarmonicFriction =
    HarmonicFriction { starting: 0.0, load: 0.0, viscous: 0.0, coupled: 0.0 };

/// One loop on the bench.
#[derive(Clone, Copy)]
struct Loop {
    joint: ElasticJoint,
    feedback: Feedback,
    gains: Gains,
    /// T \[s\], and how it is sampled.
    sampled: Option<(f64, Sampled)>,
    friction: Friction,
    /// \[s\] How long it is watched.
    seconds: f64,
}

impl Loop {
    fn new(joint: ElasticJoint, feedback: Feedback, [kp, kd]: [f64; 2]) -> Self {
        let gains = Gains { position: kp * joint.stiffness, speed: kd };
        let n = RATIO * RATIO;
        let viscous = HarmonicFriction { viscous: joint.friction / n, ..FRICTIONLESS };
        let friction = if joint.friction > 0.0 { Friction::Harmonic(viscous) } else { Friction::Free };
        Self { joint, feedback, gains, sampled: None, friction, seconds: 1.0 }
    }

    fn every(self, period: f64, sampled: Sampled) -> Self {
        Self { sampled: Some((period, sampled)), ..self }
    }

    fn with(self, friction: Friction) -> Self {
        Self { friction, ..self }
    }

    /// Whether the linear loop is stable by theory.
    fn predicted(&self) -> bool {
        let Self { joint, feedback, gains, .. } = *self;
        match self.sampled {
            None => joint.is_stable(feedback, gains),
            Some((period, sampled)) => joint.held(period).is_stable(feedback, gains, sampled),
        }
    }

    /// \[1/s\] How fast the swing of the simulated rotor grows, that begins with these speeds \[rad/s\] of link and rotor;
    /// from the second quarter of the time to the last.
    fn measured(&self, lola: &Robot, [link, rotor]: [f64; 2]) -> Result<f64> {
        let mut plant = Plant::new(&self.robot(lola), Environment::flat(), 3, &[0.0])?;
        if let Some(train) = plant.train_mut() {
            train.set_speed_gains([self.gains.speed / (RATIO * RATIO * CONSTANT)]);
        }
        let (l, mut x) = (*plant.layout(), plant.standing(&[0.0]));
        x[2] += 1e3;
        x[l.layer()].fill(0.0);
        (x[l.speed()][6], x[l.rotor_speed()][0]) = (link, rotor);
        let (drives, inputs) = ([JointCubic::resting(0.0)], PlantInputs::POWERED);
        let cycle = self.sampled.map_or(1e-3, |(period, _)| period);
        let longest = STEPS[usize::from(self.sampled.is_none())];
        let (cycles, steps) = ((self.seconds / cycle) as usize, (cycle / longest).ceil() as usize);
        let mut stepper = Stepper::new(Integrator::SemiImplicit, x.len());
        let mut most = [0.0_f64; 4];
        for i in 0..cycles {
            plant.sample(cycle, &x, &drives, &inputs);
            for k in 0..steps {
                let h = cycle / steps as f64;
                stepper.step(&mut plant, k as f64 * h, h, &mut x, &drives, &inputs);
                let speed = x[l.rotor_speed()][0].abs();
                most[4 * i / cycles] = most[4 * i / cycles].max(speed);
            }
            if !(x[l.rotor_speed()][0].abs() < 1e6) {
                return Ok(f64::INFINITY);
            }
        }
        Ok((most[3] / most[1]).ln() / (0.5 * self.seconds))
    }

    fn is_calm(&self, bench: &Bench) -> Result<bool> {
        Ok(self.measured(&bench.setup.robot, [0.0, KICK])? < 0.0)
    }

    /// The joint on the bench, with motors that do what they are told.
    fn robot(&self, lola: &Robot) -> Robot {
        one_joint(lola, self.drive(), self.joint.link)
    }

    fn drive(&self) -> Description {
        let cascade = Cascade {
            feedback: self.feedback,
            position_gain: self.gains.position / self.gains.speed,
            speed_bandwidth: 1.0, // the bench sets the gain itself
            current_bandwidth: 1e8,
        };
        Description {
            name: "bench".into(),
            gear: String::new(),
            transmission: Transmission::Harmonic { ratio: RATIO },
            joints: vec![0],
            stator: "base".into(),
            axis: [0.0, 0.0, 1.0],
            rotor_inertia: self.joint.rotor / (RATIO * RATIO),
            motor: Motor { inductance: 1e-3, resistance: 1e-3, torque_constant: CONSTANT },
            voltage_limit: 1e15,
            current_limit: 1e9,
            friction: self.friction,
            elasticity: Some(Elasticity::linear(self.joint.stiffness)),
            brake: None,
            winding: None,
            encoder_counts: None,
            control: JointControl {
                law: ControlLaw::Cascade(cascade),
                sampling: self.sampled.map_or(Sampling::Continuous, |(_, sampled)| Sampling::Cycle(sampled)),
                resolution: Resolution::default(),
            },
        }
    }
}

/// Gains at which a loop is tried.
#[derive(Clone, Copy)]
struct Tried {
    /// \[1\] Unit of the gain: the gear's stiffness for K_p, 1 N m s/rad for K_d.
    unit: f64,
    /// Least and largest gain, in that unit.
    range: [f64; 2],
    /// Number of gains that are simulated; theory tries [`FINER`] times as many.
    count: usize,
}

/// Gains that theory tries over those that are simulated.
const FINER: usize = 100;
/// K_p of a leg that stands, and of one in the air.
const POSITION_GAINS: Tried = Tried { unit: STANCE.stiffness, range: [0.01, 2.5], count: 25 };
const POSITION_GAINS_AIR: Tried = Tried { unit: AIR.stiffness, range: [0.01, 0.81], count: 41 };
/// K_d; smaller ones than these damp so little that a second does not tell growth from decay.
const SPEED_GAINS: Tried = Tried { unit: 1.0, range: [100.0, 4000.0], count: 25 };

impl Tried {
    fn grid(&self, count: usize) -> Vec<f64> {
        let [low, high] = self.range;
        let step = (high - low) / (count - 1) as f64;
        (0..count).map(|k| self.unit * (low + step * k as f64)).collect()
    }
}

/// Windows of stable gains of a family of loops, by theory and by simulation, each on a grid of its own: one finding for each
/// border.
fn stable_gains(
    bench: &Bench,
    (row, regime, gain): (LimitRow, &str, &str),
    tried: Tried,
    family: impl Fn(f64) -> Loop + Sync,
) -> Findings {
    // By theory.
    let fine = tried.grid(FINER * tried.count);
    let predicts = |x: f64| family(x).predicted();
    let on_grid: Vec<bool> = fine.iter().map(|x| predicts(*x)).collect();
    let predicted = windows(&fine, Width::Share(1e-6), &on_grid, |x| Result::Ok(predicts(x)))?;
    // By simulation, on all cores.
    let coarse = tried.grid(tried.count);
    let calm =
        chain::parallel::map(coarse.len(), |k| family(coarse[k]).is_calm(bench).map_err(|e| e.to_string()));
    let calm = calm.into_iter().collect::<std::result::Result<Vec<_>, _>>()?;
    let measured = windows(&coarse, Width::Share(3e-3), &calm, |x| family(x).is_calm(bench))?;
    if predicted.len() != measured.len() {
        let text = format!("{regime}: windows of {gain} {predicted:?} by theory, {measured:?} by simulation");
        return Err(text.into());
    }
    // The windows in the order of their gains, each with its borders.
    let mut findings = Vec::new();
    for (theory, simulation) in predicted.iter().zip(&measured) {
        for (border, which) in ["smallest", "largest"].into_iter().enumerate() {
            match [theory[border], simulation[border]] {
                [None, None] => {}
                [Some(a), Some(b)] => {
                    let numbers = [a, b].map(|x| x / tried.unit);
                    // What the steps of the simulation damp makes windows wider: a lower border may lie too low.
                    let rule = if border == 0 { AtMost } else { row.rule };
                    findings.push(LimitRow { rule, ..row }.of(format!("{regime}: {which} {gain}"), numbers));
                }
                ends => {
                    return Err(format!("{regime}: {which} {gain} {ends:?}: only one of them ends").into());
                }
            }
        }
    }
    Ok(findings)
}

/// J1: continuous loops. (5.44) grows with any gains, (5.46) with none, (5.50) from K_p = K on.
pub(super) fn continuous(bench: &Bench) -> Findings {
    let mut findings = Vec::new();
    for (name, joint) in [("J_J = 10", STANCE), ("J_J = 0.5", AIR)] {
        let link = Loop { seconds: 0.5, ..Loop::new(joint, Feedback::Link, [0.1, 100.0]) };
        let numbers =
            [joint.growth(link.feedback, link.gains), link.measured(&bench.setup.robot, [0.0, KICK])?];
        let regime = format!("link-side PD (5.43), {name}, no friction: rate of growth");
        findings.push(row("J1", "1/s", Within(0.05)).of(regime, numbers));
    }
    let motor = Loop::new(STANCE, Feedback::Motor, [20.0, 1000.0]);
    let regime = "motor-side PD (5.45), K_p = 20 K: rate of growth";
    let growth = motor.measured(&bench.setup.robot, [0.0, KICK])?;
    findings.push(row("J1", "1/s", AtMost).of(regime, [0.0, growth]));
    for (name, joint, kd) in [("J_J = 10", STANCE, 500.0), ("J_J = 0.5", AIR, 100.0)] {
        let k = joint.stiffness;
        let mixed = |kp: f64| Loop::new(joint, Feedback::LinkMotor, [kp / k, kd]);
        let regime = format!("link angle, motor speed (5.49), {name}");
        findings.extend(stable_gains(
            bench,
            (row("J1", "", Within(0.01)), &regime, "K_p/K"),
            POSITION_GAINS,
            mixed,
        )?);
    }
    Ok(findings)
}

/// J2: sampled loops, against spectral radii.
pub(super) fn sampled(bench: &Bench) -> Findings {
    let mut findings = Vec::new();
    let speed_gains = [
        ("motor-side, 1 ms", Feedback::Motor, 1e-3, EXACT),
        ("motor-side, 1 ms, differences", Feedback::Motor, 1e-3, DIFFERENCE),
        ("motor-side, 1 ms + 1 cycle", Feedback::Motor, 1e-3, DELAYED),
        ("motor-side, 3.5 ms", Feedback::Motor, 3.5e-3, EXACT),
        ("link and motor, 3.5 ms + 1 cycle", Feedback::LinkMotor, 3.5e-3, DELAYED),
    ];
    for (name, feedback, period, sampled) in speed_gains {
        let family = |kd| Loop::new(STANCE, feedback, [0.1, kd]).every(period, sampled);
        let regime = format!("{name}, J_J = 10, K_p = 0.1 K");
        let row = row("J2", "N m s/rad", Within(0.02));
        findings.extend(stable_gains(bench, (row, &regime, "K_d"), SPEED_GAINS, family)?);
    }
    let position_gains = [
        ("motor-side, 3.5 ms + 1 cycle", STANCE, Feedback::Motor, DELAYED, 144.0),
        ("motor-side, 3.5 ms, differences", STANCE, Feedback::Motor, DIFFERENCE, 247.0),
        ("link and motor, 3.5 ms", STANCE, Feedback::LinkMotor, EXACT, 300.0),
        ("link and motor, 3.5 ms + 1 cycle", STANCE, Feedback::LinkMotor, DELAYED, 200.0),
        ("link and motor, 3.5 ms + 1 cycle", AIR, Feedback::LinkMotor, DELAYED, 120.0),
        ("link and motor, 3.5 ms + 1 cycle", AIR, Feedback::LinkMotor, DELAYED, 221.0),
    ];
    for (name, joint, feedback, sampled, kd) in position_gains {
        let tried = if joint.link == AIR.link { POSITION_GAINS_AIR } else { POSITION_GAINS };
        let family = |kp: f64| Loop::new(joint, feedback, [kp / joint.stiffness, kd]).every(3.5e-3, sampled);
        let regime = format!("{name}, J_J = {}, K_d = {kd}", joint.link);
        let row = row("J2", "", Within(0.02));
        findings.extend(stable_gains(bench, (row, &regime, "K_p/K"), tried, family)?);
    }
    // Where the motor-side loop has no stable gains at all (errata 2.14), the mixed one has.
    let growth = |feedback: Feedback| {
        let tried = Loop::new(AIR, feedback, [0.1, 120.0]).every(3.5e-3, DELAYED);
        let radius = AIR.held(3.5e-3).spectral_radius(feedback, tried.gains, DELAYED);
        let measured = Loop { seconds: 0.5, ..tried }.measured(&bench.setup.robot, [0.0, KICK]);
        measured.map(|measured| [radius.ln() / 3.5e-3, measured])
    };
    let regime = "motor-side, 3.5 ms + 1 cycle, J_J = 0.5, K_d = 120: rate of growth";
    let [predicted, measured] = growth(Feedback::Motor)?;
    let told = "grows, as predicted";
    findings.push(row("J2", "1/s", AtLeast).of(regime, [0.0, measured]).says(told, predicted > 0.0));
    let regime = "link and motor, 3.5 ms + 1 cycle, J_J = 0.5, K_d = 120: rate of growth";
    let [predicted, measured] = growth(Feedback::LinkMotor)?;
    let calm = "decays, as predicted";
    findings.push(row("J2", "1/s", AtMost).of(regime, [0.0, measured]).says(calm, predicted < 0.0));
    Ok(findings)
}

/// \[N m s/rad\] Viscous friction of the rotor from which on the loop is stable.
fn enough_friction(loop_: &Loop) -> Result<f64> {
    let stable = |d: f64| ElasticJoint { friction: d, ..loop_.joint }.is_stable(loop_.feedback, loop_.gains);
    middle([0.0, 1e4], Width::Share(1e-6), |d| Ok(!stable(d)))
}

/// J3: friction of the rotor makes link-side PD stable: viscous friction up to gains, dry friction up to swings. A swing
/// of V feels dry friction T_0 like viscous friction 4 T_0/(pi V).
pub(super) fn friction(bench: &Bench) -> Findings {
    let mut findings = Vec::new();
    for (joint, u) in [(STANCE, 2.0), (AIR, 0.2)] {
        let (k, d) = (joint.stiffness, 200.0);
        let joint = ElasticJoint { friction: d, ..joint };
        let family = |kp: f64| Loop::new(joint, Feedback::Link, [kp / k, u * d]);
        let regime = format!("link-side, J_J = {}, d = 200, K_d = {}", joint.link, u * d);
        let row = row("J3", "", Within(0.02));
        findings.extend(stable_gains(bench, (row, &regime, "K_p/K"), POSITION_GAINS, family)?);
    }
    for joint in [STANCE, AIR] {
        let dry = HarmonicFriction { starting: gear(bench, "hfuc_25_100")?.starting, ..FRICTIONLESS };
        let held = Loop::new(joint, Feedback::Link, [0.1, 100.0]).with(Friction::Harmonic(dry));
        let enough = enough_friction(&held)?;
        let about = 4.0 * dry.starting * RATIO.abs() / (PI * enough);
        // The swing at the limit: link and rotor against each other, v_J/v_M = -d/K_d.
        let calm = |v: f64| {
            let grows = held.measured(&bench.setup.robot, [-v * enough / held.gains.speed, v])?;
            Result::Ok(!(grows > 0.0))
        };
        let regime =
            format!("link-side, dry friction of HFUC-25-100, J_J = {}: largest calm swing", joint.link);
        let numbers = [about, middle(SWINGS, Width::Share(5e-3), calm)?];
        findings.push(row("J3", "rad/s", Within(0.15)).of(regime, numbers));
    }
    let screw = Friction::Screw(ScrewFriction { direct: 0.860, indirect: 0.858 });
    let knee = Loop::new(STANCE, Feedback::Link, [0.1, 100.0]).with(screw);
    let growth = knee.measured(&bench.setup.robot, [0.0, KICK])?;
    let regime = "link-side, friction of a roller screw, J_J = 10: rate of growth";
    findings.push(row("J3", "1/s", AtLeast).of(regime, [0.0, growth]));
    Ok(findings)
}
