//! Lola thrown into the air without drives: energy and momentum stay, and the error falls with the integrator's order.

use crate::tree;
use multibody::{Data, Model};

const LOLA: &str = include_str!("../../../config/robots/lola/lola.urdf");

fn lola() -> Model {
    let robot = urdf_rs::read_from_string(LOLA).expect("Lola's URDF");
    let movable = robot.joints.iter().filter(|j| j.joint_type != urdf_rs::JointType::Fixed);
    let joints: Vec<&str> = movable.map(|j| j.name.as_str()).collect();
    Model::from_urdf(LOLA, "torso", &joints).expect("Lola's URDF, parents first")
}

/// One classical Runge-Kutta step on (q, v) with the base's pose advanced through the derivative of q's numbers.
fn step(model: &Model, data: &mut Data, q: &mut [f64], v: &mut [f64], dt: f64, articulated: bool) {
    let zero = vec![0.0; model.nv()];
    let (mut dq, mut dv) = (vec![vec![0.0; q.len()]; 4], vec![vec![0.0; v.len()]; 4]);
    for s in 0..4 {
        let c = [0.0, 0.5, 0.5, 1.0][s] * dt;
        let ahead = |x: &[f64], d: &[Vec<f64>]| -> Vec<f64> {
            (0..x.len()).map(|k| x[k] + if s == 0 { 0.0 } else { c * d[s - 1][k] }).collect()
        };
        let (mut qs, vs) = (ahead(q, &dq), ahead(v, &dv));
        normalize(&mut qs);
        model.configuration_rate(&qs, &vs, &mut dq[s]);
        if articulated {
            model.forward_dynamics_articulated(data, &qs, &vs, &zero, &mut dv[s]);
        } else {
            model.forward_dynamics(data, &qs, &vs, &zero, &mut dv[s]);
        }
    }
    let sum = |d: &[Vec<f64>], k: usize| dt / 6.0 * (d[0][k] + 2.0 * d[1][k] + 2.0 * d[2][k] + d[3][k]);
    (0..q.len()).for_each(|k| q[k] += sum(&dq, k));
    (0..v.len()).for_each(|k| v[k] += sum(&dv, k));
    normalize(q);
}

fn normalize(q: &mut [f64]) {
    let norm = q[3..7].iter().map(|x| x * x).sum::<f64>().sqrt();
    q[3..7].iter_mut().for_each(|x| *x /= norm);
}

/// Drift over 0.2 s of energy (relative to the kinetic energy), momentum less gravity's, and angular momentum.
fn drift(dt: f64, articulated: bool) -> [f64; 3] {
    let model = lola();
    let mut data = Data::new(&model);
    let mut dice = tree::Dice(3);
    let mut q = tree::configuration(&mut dice, &model);
    q[7..].iter_mut().for_each(|x| *x *= 0.2);
    let mut v = dice.list(model.nv(), 1.5);
    let mut observe = |q: &[f64], v: &[f64]| {
        model.forward_motion(&mut data, q, v);
        (model.energy(&data), model.momentum(&data))
    };
    let ((kinetic, potential), before) = observe(&q, &v);
    let mut scratch = Data::new(&model);
    let steps = (0.2 / dt).round() as usize;
    for _ in 0..steps {
        step(&model, &mut scratch, &mut q, &mut v, dt, articulated);
    }
    let ((k1, p1), after) = observe(&q, &v);
    let pulled = before.linear + multibody::GRAVITY * (model.mass() * dt * steps as f64);
    [
        ((k1 + p1) - (kinetic + potential)).abs() / kinetic,
        (after.linear - pulled).norm() / before.linear.norm(),
        (after.angular - before.angular).norm() / before.angular.norm(),
    ]
}

#[test]
fn energy_and_momentum_are_kept() {
    for articulated in [false, true] {
        let fine = drift(2.5e-4, articulated);
        assert!(fine.iter().all(|&e| e < 1e-9), "articulated {articulated}: {fine:?}");
    }
}

#[test]
fn drift_falls_with_the_fourth_power_of_the_step() {
    let (coarse, fine) = (drift(4e-3, false), drift(2e-3, false));
    for k in [0, 2] {
        let order = (coarse[k] / fine[k]).log2();
        assert!(order > 3.6, "quantity {k}: {} then {}: order {order}", coarse[k], fine[k]);
    }
}
