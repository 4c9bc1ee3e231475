//! Sampled cascade with an integral and a clock of its own: how fast its speed loop may be (J4).
//!
//! Predicted by the largest eigenvalue of what a period of the position loop does to the linear joint: plant between two
//! samples by the matrix exponential, law, estimator and filter at each. Measured on the bench: does a kick of the rotor calm
//! down?
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | m, w, q, v | angle and speed of rotor and link, in units of the motor | rad, rad/s |
//! | I, U | current, voltage | A, V |
//! | d, y, z, r | last angle seen, filtered speed, integral, speed asked for | rad, rad/s, A, rad/s |

use ::drives::{
    CascadeOutput, CascadePi, ControlLaw, Elasticity, Friction, JointControl, Motor, Resolution,
    SamplePeriods, Sampling, Transmission,
};
use config::robot::Drive;
use nalgebra::{DMatrix, DVector};

use crate::joint_bench::{Course, ServoBench};
use crate::search::{Width, middle};

use super::LimitRule::{AtLeast, Within};
use super::{Bench, Findings, Result, row};

/// A small brushless motor with its wave generator, and its gear: Archie's knee.
const MOTOR: Motor = Motor { inductance: 3.6e-4, resistance: 0.98, torque_constant: 0.03355 };
const ROTOR: f64 = 3.28e-5;
const RATIO: f64 = -160.0;
/// \[N m/rad\]
const STIFFNESS: f64 = 1.6e4;
/// \[s\] Of the speed loop; twice that of the position loop.
const PERIOD: f64 = 160e-6;
/// \[s\] Longest step of the simulation, and how long it watches \[s\].
const STEP: f64 = 5e-6;
const SECONDS: f64 = 0.4;
/// \[rad/s\]
const KICK: f64 = 1e-3;
/// \[rad/s\] Bandwidths between which the limit is looked for.
const BANDWIDTHS: [f64; 2] = [390.0, 4e4];

/// Gains of position and integral that leave the slow modes their damping, so that one mode alone has the limit.
const LAW: CascadePi = CascadePi {
    position_gain: 20.0,
    speed_bandwidth: 390.0,
    speed_integral: 20.0,
    speed_filter: 0.0,
    feed_forward: [1.0, 0.0],
    output: CascadeOutput::Current(3000.0),
};

/// Joint of a link \[kg m^2\].
struct SampledJoint {
    link: f64,
    law: CascadePi,
}

impl SampledJoint {
    /// Largest eigenvalue of a period of the position loop, of the joint's motion relative to where it is led.
    fn radius(&self) -> f64 {
        let CascadePi { position_gain, speed_bandwidth, speed_integral, speed_filter, output, .. } = self.law;
        let n2 = RATIO * RATIO;
        let (link, spring) = (self.link / n2, STIFFNESS / n2);
        let gain = speed_bandwidth * (ROTOR + link) / MOTOR.torque_constant;
        // Plant between two samples: m, w, q, v, I and what is put out.
        let Motor { inductance, resistance, torque_constant } = MOTOR;
        let mut rates = DMatrix::<f64>::zeros(6, 6);
        (rates[(0, 1)], rates[(2, 3)]) = (1.0, 1.0);
        (rates[(1, 0)], rates[(1, 2)], rates[(1, 4)]) =
            (-spring / ROTOR, spring / ROTOR, torque_constant / ROTOR);
        (rates[(3, 0)], rates[(3, 2)]) = (spring / link, -spring / link);
        match output {
            CascadeOutput::Current(bandwidth) => {
                let fast = bandwidth + resistance / inductance;
                (rates[(4, 4)], rates[(4, 5)]) = (-fast, fast);
            }
            CascadeOutput::Voltage => {
                rates[(4, 1)] = -torque_constant / inductance;
                (rates[(4, 4)], rates[(4, 5)]) = (-resistance / inductance, resistance / inductance);
            }
        }
        let propagate = (rates * PERIOD).exp();
        let share = if speed_filter > 0.0 { 1.0 - (-PERIOD / speed_filter).exp() } else { 1.0 };
        // One period of the position loop: two of the speed loop. State: m, w, q, v, I, d, y, z.
        let period = |mut x: DVector<f64>| {
            let asked = -position_gain * x[0];
            for _ in 0..2 {
                x[6] += share * ((x[0] - x[5]) / PERIOD - x[6]);
                x[5] = x[0];
                let lag = asked - x[6];
                x[7] += gain * speed_integral * PERIOD * lag;
                let out = gain * lag + x[7];
                let plant = &propagate * DVector::from_vec(vec![x[0], x[1], x[2], x[3], x[4], out]);
                x.rows_mut(0, 5).copy_from(&plant.rows(0, 5));
            }
            x
        };
        let unit = |i: usize| DVector::from_fn(8, |k, _| if k == i { 1.0 } else { 0.0 });
        let columns: Vec<DVector<f64>> = (0..8).map(|i| period(unit(i))).collect();
        let map = DMatrix::from_columns(&columns);
        map.complex_eigenvalues().iter().map(|s| s.norm()).fold(0.0, f64::max)
    }

    /// \[1/s\] How fast a kick of the simulated rotor grows, from the second quarter of the time to the last.
    fn growth(&self, bench: &Bench) -> Result<f64> {
        let joint = ServoBench::new(&bench.setup.robot, self.drive(), self.link)?;
        let states = joint.run(Course { kick: KICK, seconds: SECONDS, ..Course::default() }, STEP)?;
        let most = |quarter: f64| {
            let within = |t: f64| (quarter..quarter + 0.25).contains(&(t / SECONDS));
            let inside = states.iter().filter(|s| within(s.time));
            inside.map(|s| s.speed.abs()).fold(0.0, f64::max)
        };
        if states.last().is_none_or(|s| s.time < 0.99 * SECONDS) {
            return Ok(f64::INFINITY);
        }
        Ok((most(0.75) / most(0.25)).ln() / (0.5 * SECONDS))
    }

    fn drive(&self) -> Drive {
        Drive {
            name: "bench".into(),
            gear: String::new(),
            transmission: Transmission::Harmonic { ratio: RATIO },
            joints: vec![0],
            stator: "base".into(),
            axis: [0.0, 0.0, 1.0],
            rotor_inertia: ROTOR,
            motor: MOTOR,
            voltage_limit: 1e15,
            current_limit: 1e15,
            friction: Friction::Free,
            elasticity: Some(Elasticity::linear(STIFFNESS)),
            brake: None,
            winding: None,
            encoder_counts: None,
            control: JointControl {
                law: ControlLaw::CascadePi(self.law),
                sampling: Sampling::Period(SamplePeriods { speed: PERIOD, position_every: 2 }),
                resolution: Resolution::default(),
            },
        }
    }
}

/// J4: largest bandwidth of the speed loop, and the gains that the thesis prints (errata 3, 2.9).
pub(super) fn cascade(bench: &Bench) -> Findings {
    let mut findings = Vec::new();
    let cases = [
        ("J_J = 1, current", 1.0, LAW),
        ("J_J = 0.3, current", 0.3, LAW),
        ("J_J = 1, current, filter of 1 ms", 1.0, CascadePi { speed_filter: 1e-3, ..LAW }),
        ("J_J = 1, voltage", 1.0, CascadePi { output: CascadeOutput::Voltage, ..LAW }),
    ];
    let mut largest = 0.0;
    for (name, link, law) in cases {
        let joint = |speed_bandwidth: f64| SampledJoint { link, law: CascadePi { speed_bandwidth, ..law } };
        let predicted = middle(BANDWIDTHS, Width::Share(1e-6), |w| Result::Ok(joint(w).radius() < 1.0))?;
        largest = predicted;
        let calm = |w: f64| Result::Ok(joint(w).growth(bench)? < 0.0);
        let measured = middle([0.5 * predicted, 2.0 * predicted], Width::Share(2e-3), calm)?;
        let regime = format!("cascade_pi, 160 us, {name}: largest bandwidth of the speed loop");
        findings.push(row("J4", "rad/s", Within(0.05)).of(regime, [predicted, measured]));
    }
    // 45 V s/rad and 6800 V/rad, taken at the motor as they are printed.
    let (link, inertia) = (1.0, ROTOR + 1.0 / (RATIO * RATIO));
    let speed_bandwidth = 45.0 / MOTOR.resistance * MOTOR.torque_constant / inertia;
    let law =
        CascadePi { speed_bandwidth, speed_integral: 6800.0 / 45.0, output: CascadeOutput::Voltage, ..LAW };
    let printed = SampledJoint { link, law };
    let grows = printed.radius() > 1.0 && printed.growth(bench)? > 0.0;
    let regime = "cascade_pi, 160 us, J_J = 1, voltage: bandwidth of the gains printed for the motor, over the largest";
    let found = row("J4", "rad/s", AtLeast).of(regime, [largest, speed_bandwidth]);
    findings.push(found.says("grows, as predicted", grows));
    Ok(findings)
}
