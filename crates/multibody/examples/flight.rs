//! Lets a robot fly without forces but its weight: classical Runge-Kutta from a state of tests/peers/mujoco/states, and
//! prints where it ends; `tests/peers/mujoco_flight.sh` asks.
//!
//! usage: flight URDF BASE_LINK STATE.txt STEP SECONDS

use std::error::Error;

use multibody::{Data, Model};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [urdf, base, state, step, seconds] = &arguments[..] else {
        return Err("usage: flight URDF BASE_LINK STATE.txt STEP SECONDS".into());
    };
    let state = std::fs::read_to_string(state)?;
    let row = |key: &str| {
        let line = state.lines().find_map(|line| line.strip_prefix(key)).unwrap_or_default();
        line.split_whitespace().collect::<Vec<_>>()
    };
    let numbers = |key| row(key).iter().map(|n| n.parse::<f64>()).collect::<Result<Vec<_>, _>>();
    let model = Model::from_urdf(&std::fs::read_to_string(urdf)?, base, &row("joints "))?;
    let (h, seconds): (f64, f64) = (step.parse()?, seconds.parse()?);
    let mut x = [numbers("q ")?, numbers("v ")?].concat();
    let mut flight = Flight::new(&model, x.len())?;
    for _ in 0..(seconds / h).round() as u64 {
        flight.step(h, &mut x);
    }
    println!("{}", serde_json::to_string(&x)?);
    Ok(())
}

struct Flight<'a> {
    model: &'a Model,
    data: Data,
    none: Vec<f64>,
    k: [Vec<f64>; 4],
    at: Vec<f64>,
}

impl<'a> Flight<'a> {
    fn new(model: &'a Model, states: usize) -> Result<Self, Box<dyn Error>> {
        if states != model.nq() + model.nv() {
            return Err(
                format!("{states} numbers in the state, {} in the model", model.nq() + model.nv()).into()
            );
        }
        let zero = || vec![0.0; states];
        Ok(Self {
            data: Data::new(model),
            none: vec![0.0; model.nv()],
            k: [zero(), zero(), zero(), zero()],
            at: zero(),
            model,
        })
    }

    fn step(&mut self, h: f64, x: &mut [f64]) {
        for stage in 0..4 {
            self.at.copy_from_slice(x);
            if stage > 0 {
                let share = if stage == 3 { h } else { 0.5 * h };
                for (at, k) in self.at.iter_mut().zip(&self.k[stage - 1]) {
                    *at += share * k;
                }
            }
            let (q, v) = self.at.split_at_mut(self.model.nq());
            normalize(&mut q[3..7]);
            let (rate, acceleration) = self.k[stage].split_at_mut(self.model.nq());
            self.model.configuration_rate(q, v, rate);
            self.model.forward_dynamics(&mut self.data, q, v, &self.none, acceleration);
        }
        let [k1, k2, k3, k4] = &self.k;
        for (i, x) in x.iter_mut().enumerate() {
            *x += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
        normalize(&mut x[3..7]);
    }
}

fn normalize(quaternion: &mut [f64]) {
    let length = quaternion.iter().map(|x| x * x).sum::<f64>().sqrt();
    quaternion.iter_mut().for_each(|x| *x /= length);
}
