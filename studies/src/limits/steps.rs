//! Explicit steps: how long they may be against contact layers, servos and circuits (F1-F4).
//!
//! Predicted from eigenvalues of the linearised equations, measured by bisection: does a change of 1e-7 grow?

use ::contact::point::{self, ContactLaw};
use chain::ending::is_doubt;
use config::method::Integrator;
use config::scene::Scene;
use messages::EventCode;
use nalgebra::Complex;
use sim_backend::drive::JointCubic;
use sim_backend::integrate::Stepper;
use sim_backend::plant::{Plant, PlantInputs};
use sim_backend::step_limit::{eigenvalues, euler_limit, runge_kutta_limit};

use super::LimitRule::{AtMost, Within};
use super::held::HeldRobot;
use super::{Bench, Findings, Result, largest_stable, row, stepper};

/// Where the stability region of the classical Runge-Kutta method ends on the real axis.
const REAL_AXIS: f64 = 2.785_293_563_405_282;

/// The contact points of the robot; penetration is not taken back, so that the layer stands alone.
fn law(bench: &Bench) -> ContactLaw {
    let c = &bench.setup.robot.contact;
    let stiffness = [c.tangential_stiffness, c.tangential_stiffness, c.normal_stiffness];
    ContactLaw {
        stiffness,
        damping: stiffness.map(|k| k * c.damping_time),
        friction: c.friction,
        recovery: 0.0,
    }
}

/// F1, F4: a node in the air relaxes with B/K.
pub(super) fn free_layer(bench: &Bench) -> Findings {
    let law = law(bench);
    let time = law.damping[2] / law.stiffness[2];
    let grows = |runge_kutta: bool, h: f64| {
        let (mut method, mut d) = (stepper(1), [1e-3]);
        let rate = |_: f64, d: &[f64], dd: &mut [f64]| {
            dd[0] = point::solve(&law, [0.0, 0.0, d[0]], [0.0; 3], 1.0).rate[2];
        };
        for _ in 0..20_000 {
            if runge_kutta {
                method.runge_kutta_4(0.0, h, &mut d, rate);
            } else {
                method.euler(0.0, h, &mut d, rate);
            }
        }
        !(d[0].abs() <= 1e-3)
    };
    let limit = |runge_kutta: bool| largest_stable(0.0, 10.0 * time, |h| !grows(runge_kutta, h));
    let numbers = [[2.0 * time, limit(false)?], [REAL_AXIS * time, limit(true)?]];
    Ok(vec![
        row("F1", "s", Within(1e-3)).of("explicit Euler, free layer: largest step 2 B/K", numbers[0]),
        row("F4", "s", Within(1e-3)).of("Runge-Kutta 4, free layer: largest step 2.785 B/K", numbers[1]),
    ])
}

/// F2: a mass, and a toe, on one layer: m s^2 + B s + K = 0.
pub(super) fn mass_on_layer(_: &Bench) -> Findings {
    let law = ContactLaw { stiffness: [2e5; 3], damping: [2e3; 3], friction: 0.6, recovery: 0.0 };
    let finding = |(name, m): (&str, f64)| {
        let (k, b) = (law.stiffness[2], law.damping[2]);
        let root = Complex::new(b * b - 4.0 * m * k, 0.0).sqrt();
        let values = [1.0, -1.0].map(|sign| (root * sign - b) / (2.0 * m));
        // Stable: a small speed at rest on the layer does not grow.
        let at_rest = [0.0, 0.0, multibody::GRAVITY_ACCELERATION * m / k];
        let stable = |h: f64| {
            let (mut method, mut x) = (stepper(3), at_rest);
            (x[0], x[1]) = (-at_rest[2], 1e-7);
            for _ in 0..20_000 {
                method.euler(0.0, h, &mut x, |_, x, dx| {
                    let a = point::solve(&law, [0.0, 0.0, x[2]], [0.0, 0.0, x[1]], x[0] + x[2]);
                    *dx.first_chunk_mut().expect("three states") =
                        [x[1], a.force[2] / m + multibody::GRAVITY.z, a.rate[2]];
                });
            }
            x[1].abs() < 1e-6
        };
        let numbers = [euler_limit(&values), largest_stable(0.0, 0.05, stable)?];
        let regime = format!("explicit Euler, {name} of {m} kg on a layer: -2 Re s/|s|^2");
        Ok(row("F2", "s", Within(1e-3)).of(regime, numbers))
    };
    [("mass", 60.0), ("toe", 0.797)].into_iter().map(finding).collect()
}

/// A plant at rest on its feet, and how it takes steps.
struct Standing {
    plant: Plant,
    state: Vec<f64>,
    drives: Vec<JointCubic>,
}

const POWERED: PlantInputs = PlantInputs::POWERED;

impl Standing {
    /// Comes to rest in steps of `h` \[s\].
    fn new(bench: &Bench, depth: u8, h: f64, seconds: f64) -> Result<Self> {
        let mut plant = bench.plant(depth)?;
        let state = plant.standing(bench.pose());
        let drives = bench.pose().iter().map(|&q| JointCubic::resting(q)).collect();
        let mut standing = Self { plant, state, drives };
        let mut state = standing.state.clone();
        standing.advance(Integrator::Euler, h, (seconds / h) as usize, &mut state);
        standing.state = state;
        Ok(standing)
    }

    fn advance(&mut self, integrator: Integrator, h: f64, steps: usize, state: &mut [f64]) {
        let mut stepper = Stepper::new(integrator, state.len());
        for _ in 0..steps {
            stepper.step(&mut self.plant, 0.0, h, state, &self.drives, &POWERED);
        }
    }

    fn eigenvalues(&mut self) -> Result<Vec<Complex<f64>>> {
        let Self { plant, state, drives } = self;
        eigenvalues(state, |x, dx| plant.rate(0.0, x, drives, &POWERED, dx))
    }

    /// Largest step from `low` to `high` in which a small change of the speeds does not grow, and, where there are no servos
    /// that still settle, the robot stays at rest: swings that have grown to their end look alike, changed or not.
    fn largest(&mut self, integrator: Integrator, low: f64, high: f64) -> Result<f64> {
        let most = if self.plant.layout().joints == 0 { 1e-3 } else { f64::INFINITY };
        let speed = self.plant.layout().speed();
        let rest = self.state.clone();
        largest_stable(low, high, |h| {
            let mut x = rest.clone();
            for (i, v) in x[speed.clone()].iter_mut().enumerate() {
                *v += 1e-7 * (1.0 + i as f64).sin();
            }
            self.advance(integrator, h, 1500, &mut x);
            let mut unchanged = rest.clone();
            self.advance(integrator, h, 1500, &mut unchanged);
            let alike = |a: &[f64], b: &[f64], most: f64| {
                a[speed.clone()].iter().zip(&b[speed.clone()]).all(|(a, b)| (a - b).abs() < most)
            };
            alike(&x, &unchanged, 1e-4) && alike(&unchanged, &rest, most)
        })
    }
}

/// From which multiple of the largest stable step on the simulated robot tells that it is lost, and how; and whether a scene
/// with such a step is refused unless it is forced. Below of that multiple it chatters within the bounds that feet which lift
/// off, limits of voltages and ramps of friction set.
fn told(bench: &Bench, depth: u8, integrator: Integrator, limit: f64) -> Result<(String, bool)> {
    let scene = |times: f64, force_step: bool| Scene {
        depth,
        integrator,
        cycle: times * limit,
        substeps: 1,
        force_step,
        ..bench.setup.scene.clone()
    };
    let refused = HeldRobot::new(bench, &scene(1.05, false)).is_err();
    for times in [1.05, 1.2, 1.5, 2.0, 3.0, 5.0, 8.0] {
        let scene = scene(times, true);
        let event = HeldRobot::new(bench, &scene)?.first_event((3.0 / scene.cycle) as usize);
        if let Some(code) = event.filter(|code| is_doubt(*code) || *code == EventCode::Fallen) {
            return Ok((format!("refused at load; if forced {code:?} from {times} times on"), refused));
        }
    }
    Ok(("refused at load; if forced nothing up to 8 times".into(), false))
}

/// F2, F4: all of type 1, standing.
pub(super) fn whole_robot(bench: &Bench) -> Findings {
    let mut standing = Standing::new(bench, 1, 1e-3, 3.0)?;
    let values = standing.eigenvalues()?;
    let finding = |(id, name, integrator, predicted): (_, &str, _, f64)| {
        let measured = standing.largest(integrator, 0.2 * predicted, 3.0 * predicted)?;
        let (said, told) = told(bench, 1, integrator, predicted)?;
        let regime = format!("{name}, standing robot of type 1");
        Ok(row(id, "s", Within(0.008)).of(regime, [predicted, measured]).says(&said, told))
    };
    [
        ("F2", "explicit Euler", Integrator::Euler, euler_limit(&values)),
        ("F4", "Runge-Kutta 4", Integrator::RungeKutta4, runge_kutta_limit(&values)),
    ]
    .map(finding)
    .into_iter()
    .collect()
}

/// F3, F4: type 2, standing on its servos.
pub(super) fn servo(bench: &Bench) -> Findings {
    let mut standing = Standing::new(bench, 2, 2e-5, 0.4)?;
    let values = standing.eigenvalues()?;
    let finding = |(id, name, integrator, predicted): (_, &str, _, f64)| {
        let measured = standing.largest(integrator, 0.2 * predicted, 3.0 * predicted)?;
        let (said, told) = told(bench, 2, integrator, predicted)?;
        let regime = format!("{name}, standing robot of type 2 with its servos");
        Ok(row(id, "s", Within(0.008)).of(regime, [predicted, measured]).says(&said, told))
    };
    [
        ("F3", "explicit Euler", Integrator::Euler, euler_limit(&values)),
        ("F4", "Runge-Kutta 4", Integrator::RungeKutta4, runge_kutta_limit(&values)),
    ]
    .map(finding)
    .into_iter()
    .collect()
}

/// F3: the circuit of a motor under its current loop of bandwidth w_c, rotor held: 2 L/(R + L w_c).
pub(super) fn circuit(bench: &Bench) -> Findings {
    let motor = bench.setup.robot.drives[0].motor;
    let bandwidth = 3000.0;
    let stable = |h: f64| {
        let (mut method, mut current) = (stepper(1), [1.0]);
        for _ in 0..20_000 {
            method.euler(0.0, h, &mut current, |_, i, di| {
                di[0] = motor.current_rate(i[0], -motor.inductance * bandwidth * i[0], 0.0);
            });
        }
        current[0].abs() <= 1.0
    };
    let predicted = 2.0 * motor.inductance / (motor.resistance + motor.inductance * bandwidth);
    let numbers = [predicted, largest_stable(0.0, 1e-2, stable)?];
    let exact = motor.current_after(1.0, 0.0, 0.0, 1000.0 * predicted);
    Ok(vec![
        row("F3", "s", Within(1e-3)).of("explicit Euler, current loop of a motor: 2 L/(R + L w_c)", numbers),
        row("F3", "A", AtMost)
            .of("exact step of the circuit, 1000 times as long: current left of 1 A", [0.0, exact.abs()]),
    ])
}
