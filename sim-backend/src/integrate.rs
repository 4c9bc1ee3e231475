//! Time steps: explicit Euler and classical Runge-Kutta on a flat state vector, semi-implicit Euler by the plant itself,
//! and the adaptive method of [`crate::stiff`].

use config::method::Integrator;

use crate::drive::JointCubic;
use crate::inputs::PlantInputs;
use crate::plant::Plant;
use crate::stiff::{GaveUp, Stiff, StiffLimits};

/// Tolerance of the adaptive method, unless it is given another one.
const TOLERANCE: f64 = 1e-6;

/// A method, and room for one step of a state of fixed length.
#[derive(Clone)]
pub struct Stepper {
    integrator: Integrator,
    k: [Vec<f64>; 4],
    x: Vec<f64>,
    stiff: Stiff,
    gave_up: Option<GaveUp>,
}

impl Stepper {
    /// For states of `n` numbers.
    pub fn new(integrator: Integrator, n: usize) -> Self {
        Self {
            integrator,
            k: std::array::from_fn(|_| vec![0.0; n]),
            x: vec![0.0; n],
            stiff: Stiff::new(StiffLimits::of_tolerance(TOLERANCE)),
            gave_up: None,
        }
    }

    /// The same with a tolerance of the adaptive method.
    pub fn with_tolerance(self, tolerance: f64) -> Self {
        Self { stiff: Stiff::new(StiffLimits::of_tolerance(tolerance)), ..self }
    }

    /// The last time the adaptive method gave up since the last call; a semi-implicit step went on from there.
    pub fn take_gave_up(&mut self) -> Option<GaveUp> {
        self.gave_up.take()
    }

    /// Advances the state of a plant from `t` \[s\] into the cycle by `h` \[s\].
    pub fn step(
        &mut self,
        plant: &mut Plant,
        t: f64,
        h: f64,
        state: &mut [f64],
        drives: &[JointCubic],
        inputs: &PlantInputs,
    ) {
        let mut rate = |t: f64, x: &[f64], dx: &mut [f64]| plant.rate(t, x, drives, inputs, dx);
        match self.integrator {
            Integrator::Euler => self.euler(t, h, state, rate),
            Integrator::RungeKutta4 => self.runge_kutta_4(t, h, state, rate),
            Integrator::SemiImplicit => plant.implicit_step(t, h, state, drives, inputs),
            Integrator::Bdf => {
                if let Err(gave_up) = self.stiff.advance(t, h, state, &mut rate) {
                    let at = gave_up.time;
                    self.gave_up = Some(gave_up);
                    plant.implicit_step(at, t + h - at, state, drives, inputs);
                } else {
                    // States that were tried, and references beyond their cycle, are no faults: where it came to counts.
                    plant.take_fault();
                    plant.rate(t + h, state, drives, inputs, &mut self.x);
                }
            }
        }
    }

    /// x + h x'(t, x); `rate(t, x, dx)` writes the derivative.
    pub fn euler(
        &mut self,
        t: f64,
        h: f64,
        state: &mut [f64],
        mut rate: impl FnMut(f64, &[f64], &mut [f64]),
    ) {
        rate(t, state, &mut self.k[0]);
        add(state, h, &self.k[0]);
    }

    /// The classical method of fourth order; `rate(t, x, dx)` writes the derivative.
    pub fn runge_kutta_4(
        &mut self,
        t: f64,
        h: f64,
        state: &mut [f64],
        mut rate: impl FnMut(f64, &[f64], &mut [f64]),
    ) {
        let [k1, k2, k3, k4] = &mut self.k;
        rate(t, state, k1);
        set(&mut self.x, state, h / 2.0, k1);
        rate(t + h / 2.0, &self.x, k2);
        set(&mut self.x, state, h / 2.0, k2);
        rate(t + h / 2.0, &self.x, k3);
        set(&mut self.x, state, h, k3);
        rate(t + h, &self.x, k4);
        for i in 0..state.len() {
            state[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
    }
}

fn add(x: &mut [f64], h: f64, k: &[f64]) {
    for (x, k) in x.iter_mut().zip(k) {
        *x += h * k;
    }
}

fn set(y: &mut [f64], x: &[f64], h: f64, k: &[f64]) {
    for i in 0..y.len() {
        y[i] = x[i] + h * k[i];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Error of x' = cos(t) x, x(0) = 1 at t = 2 with n steps; exact: exp(sin 2).
    fn error(fourth: bool, n: usize) -> f64 {
        let (mut stepper, mut x) = (Stepper::new(Integrator::Euler, 1), [1.0]);
        let h = 2.0 / n as f64;
        let rate = |t: f64, x: &[f64], dx: &mut [f64]| dx[0] = t.cos() * x[0];
        for i in 0..n {
            let t = i as f64 * h;
            if fourth { stepper.runge_kutta_4(t, h, &mut x, rate) } else { stepper.euler(t, h, &mut x, rate) }
        }
        (x[0] - 2f64.sin().exp()).abs()
    }

    #[test]
    fn orders_of_convergence_are_one_and_four() {
        for (fourth, order) in [(false, 1.0), (true, 4.0)] {
            let measured = (error(fourth, 100) / error(fourth, 200)).log2();
            assert!((measured - order).abs() < 0.1, "{order}: {measured}");
        }
    }
}
