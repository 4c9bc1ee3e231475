//! Free flight of Lola and fall of a chain of three links: smooth motion, where order counts most (chart 1).
//!
//! The states and the chain are those of tests/peers/mujoco, so that MuJoCo's points are of the same motion.

use std::error::Error;

use config::Setup;
use multibody::{Data, Model};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use serde_json::Value;

use super::system::{SteppingMethod, System, Times};
use super::{AccuracyInput, ErrorChart, Part};

pub(super) const PART: Part = charts;

const END: Times = Times { every: 1.0, count: 1 };
const STEPS: [f64; 10] = [2e-2, 1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5];
const TOLERANCES: [f64; 5] = [1e-4, 1e-6, 1e-8, 1e-10, 1e-12];

fn charts(given: &AccuracyInput<'_>) -> Result<Vec<ErrorChart>, Box<dyn Error>> {
    let lola = Setup::load(given.config, "stand")?.robot;
    let chain = include_str!("../../../tests/peers/mujoco/chain.urdf");
    let mut all = motion(
        given,
        ["flight", "Free flight of Lola, 1 s", "flight"],
        FallingBodies::new(lola.model()?, include_str!("../../../tests/peers/mujoco/states/flight.txt"))?,
    );
    all.extend(motion(
        given,
        ["chain", "Fall of a chain of three links, 1 s", "chain"],
        FallingBodies::new(
            Model::from_urdf(chain, "torso", &["hip", "knee", "ankle"])?,
            include_str!("../../../tests/peers/mujoco/states/chain.txt"),
        )?,
    ));
    Ok(all)
}

/// Three charts of one body: position, energy, momentum.
fn motion(
    given: &AccuracyInput<'_>,
    [name, title, initial]: [&str; 3],
    mut body: FallingBodies,
) -> Vec<ErrorChart> {
    let about =
        "No contact, no drives. Reference: RK4 with steps of 0.02 ms; energy and momentum by their laws.";
    let measures = [
        ("position", "largest error of a coordinate at 1 s [m, rad]"),
        ("energy", "drift of the energy in 1 s [J]"),
        ("momentum", "drift of the angular momentum in 1 s [N m s]"),
    ];
    let mut charts =
        measures.map(|(what, m)| ErrorChart::new(&format!("{name}.{what}"), title, m).about(about));
    // Reference, and what the laws conserve.
    let start = body.start.clone();
    let reference = SteppingMethod::RungeKutta4(2e-5).run(&mut body, &start, END).seen.remove(0);
    let (energy, turn) = body.conserved(&start);
    let mut methods: Vec<SteppingMethod> = Vec::new();
    methods.extend(STEPS[2..].iter().map(|h| SteppingMethod::Euler(*h)));
    methods.extend(STEPS.iter().map(|h| SteppingMethod::Own("semi-implicit", *h)));
    methods.extend(STEPS[..8].iter().map(|h| SteppingMethod::RungeKutta4(*h)));
    methods.extend(TOLERANCES.iter().map(|tolerance| SteppingMethod::Bdf(*tolerance)));
    // Each method's error against both.
    for method in methods {
        let (motion, mut point) = method.measure(&mut body, &start, END);
        (point.scene, point.model) = (name.into(), "bodies".into());
        let end = &motion.seen[0];
        let now = body.conserved(end);
        let errors = [body.distance(end, &reference), (now.0 - energy).abs(), (now.1 - turn).norm()];
        for (chart, error) in charts.iter_mut().zip(errors) {
            chart.add(super::Point { error, ..point.clone() });
        }
    }
    // The same of other programs.
    for found in given.peers.of(&[("scene", "flight"), ("initial", initial)]) {
        let number = |key: &str| found[key].as_f64().unwrap_or(f64::NAN);
        let turned = found["angular_momentum"].as_array().map(Vec::as_slice).unwrap_or_default();
        let turned =
            Vector3::from_iterator((0..3).map(|k| turned.get(k).and_then(Value::as_f64).unwrap_or(f64::NAN)));
        let change = (number("energy_j") - number("energy_start_j")).abs();
        let position = given.peers.point(found, |state| body.distance(state, &reference));
        let errors = [position.error, change, (turned - turn).norm()];
        for (chart, error) in charts.iter_mut().zip(errors) {
            chart.add(super::Point { error, scene: name.into(), ..position.clone() });
        }
    }
    let [position, ..] = &mut charts;
    position.expect_order("Euler", 1.0, 1e-5..=2e-4);
    position.expect_order("semi-implicit", 1.0, 1e-5..=2e-4);
    position.expect_order("RK4", 4.0, 1.9e-3..=2.1e-2);
    charts.into()
}

/// Bodies in free fall; x = (q, v).
struct FallingBodies {
    model: Model,
    data: Data,
    none: Vec<f64>,
    acceleration: Vec<f64>,
    start: Vec<f64>,
}

impl FallingBodies {
    fn new(model: Model, state: &str) -> Result<Self, String> {
        let row = |key: &str| {
            let line = state.lines().find_map(|line| line.strip_prefix(key)).unwrap_or_default();
            line.split_whitespace()
                .map(str::parse)
                .collect::<Result<Vec<f64>, _>>()
                .map_err(|e| format!("{key}: {e}"))
        };
        let start = [row("q ")?, row("v ")?].concat();
        let zero = vec![0.0; model.nv()];
        if start.len() != model.nq() + model.nv() {
            return Err(format!("state has {} numbers, the model {}", start.len(), model.nq() + model.nv()));
        }
        Ok(Self { data: Data::new(&model), none: zero.clone(), acceleration: zero, model, start })
    }

    /// Accelerations at x, its quaternion made of unit length.
    fn accelerate(&mut self, x: &[f64]) {
        let (q, v) = x.split_at(self.model.nq());
        let mut q = q.to_vec();
        q[3..7].copy_from_slice(orientation(x).coords.as_slice());
        self.model.set_position(&mut self.data, &q);
        self.model.forward_dynamics_here(&mut self.data, v, &self.none, &mut self.acceleration);
    }

    /// Energy \[J\] and angular momentum \[N m s\].
    fn conserved(&mut self, x: &[f64]) -> (f64, Vector3<f64>) {
        let (q, v) = x.split_at(self.model.nq());
        let mut q = q.to_vec();
        q[3..7].copy_from_slice(orientation(x).coords.as_slice());
        self.model.forward_motion(&mut self.data, &q, v);
        let (kinetic, potential) = self.model.energy(&self.data);
        (kinetic + potential, self.model.momentum(&self.data).angular)
    }

    /// Largest difference of a coordinate; of the orientation its angle.
    fn distance(&self, a: &[f64], b: &[f64]) -> f64 {
        let coordinate = |k: usize| (a[k] - b[k]).abs();
        let straight = (0..3).chain(7..self.model.nq()).map(coordinate).fold(0.0, f64::max);
        let turned = orientation(a).rotation_to(&orientation(b)).imag().norm() * 2.0; // small angles to all digits
        if a.iter().all(|a| a.is_finite()) { straight.max(turned) } else { f64::NAN }
    }
}

impl System for FallingBodies {
    fn rate(&mut self, _: f64, x: &[f64], dx: &mut [f64]) {
        self.accelerate(x);
        let n = self.model.nq();
        let (v, w) = (Vector3::from_column_slice(&x[n..n + 3]), Vector3::from_column_slice(&x[n + 3..n + 6]));
        dx[..3].copy_from_slice((orientation(x) * v).as_slice());
        let o = Quaternion::new(x[6], x[3], x[4], x[5]);
        dx[3..7].copy_from_slice((o * Quaternion::from_imag(w) * 0.5).coords.as_slice());
        dx[7..n].copy_from_slice(&x[n + 6..]);
        dx[n..].copy_from_slice(&self.acceleration);
    }

    fn own_step(&mut self, _: f64, h: f64, x: &mut [f64]) {
        self.accelerate(x);
        let (q, v) = x.split_at_mut(self.model.nq());
        for (v, a) in v.iter_mut().zip(&self.acceleration) {
            *v += h * a;
        }
        let from = q.to_vec();
        self.model.integrate(&from, v, h, q);
    }
}

fn orientation(x: &[f64]) -> UnitQuaternion<f64> {
    UnitQuaternion::from_quaternion(Quaternion::new(x[6], x[3], x[4], x[5]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use multibody::GRAVITY;

    /// Methods that know nothing of each other agree, and conserve what must be conserved.
    #[test]
    fn the_chain_falls_the_same_way_by_two_methods() {
        let chain = include_str!("../../../tests/peers/mujoco/chain.urdf");
        let model = Model::from_urdf(chain, "torso", &["hip", "knee", "ankle"]).unwrap();
        let mut body =
            FallingBodies::new(model, include_str!("../../../tests/peers/mujoco/states/chain.txt")).unwrap();
        let start = body.start.clone();
        let times = Times { every: 0.3, count: 1 };
        let a = SteppingMethod::RungeKutta4(5e-4).run(&mut body, &start, times).seen.remove(0);
        let b = SteppingMethod::Bdf(1e-11).run(&mut body, &start, times).seen.remove(0);
        assert!(body.distance(&a, &b) < 1e-8, "{:e}", body.distance(&a, &b));
        let (before, after) = (body.conserved(&start), body.conserved(&a));
        assert!((before.0 - after.0).abs() < 1e-8 && (before.1 - after.1).norm() < 1e-9);
        let fallen = 0.5 * GRAVITY.z * 0.3 * 0.3;
        assert!(fallen < -0.4 && body.distance(&a, &start) > 0.3);
    }
}
