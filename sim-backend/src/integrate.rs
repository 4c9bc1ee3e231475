//! Time steps: explicit Euler and classical Runge-Kutta on a flat state vector.

use config::scene::Integrator;

/// Scratch for one step of a state of fixed length.
pub struct Stepper {
    k: [Vec<f64>; 4],
    x: Vec<f64>,
}

impl Stepper {
    /// For states of `n` numbers.
    pub fn new(n: usize) -> Self {
        Self { k: std::array::from_fn(|_| vec![0.0; n]), x: vec![0.0; n] }
    }

    /// Advances `state` from `t` by `h` \[s\]; `rate(t, x, dx)` writes the derivative.
    pub fn step(
        &mut self,
        integrator: Integrator,
        t: f64,
        h: f64,
        state: &mut [f64],
        mut rate: impl FnMut(f64, &[f64], &mut [f64]),
    ) {
        let [k1, k2, k3, k4] = &mut self.k;
        rate(t, state, k1);
        if integrator == Integrator::Euler {
            return add(state, h, k1);
        }
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
    fn error(integrator: Integrator, n: usize) -> f64 {
        let (mut stepper, mut x) = (Stepper::new(1), [1.0]);
        let h = 2.0 / n as f64;
        for i in 0..n {
            stepper.step(integrator, i as f64 * h, h, &mut x, |t, x, dx| dx[0] = t.cos() * x[0]);
        }
        (x[0] - 2f64.sin().exp()).abs()
    }

    #[test]
    fn orders_of_convergence_are_one_and_four() {
        for (integrator, order) in [(Integrator::Euler, 1.0), (Integrator::RungeKutta4, 4.0)] {
            let measured = (error(integrator, 100) / error(integrator, 200)).log2();
            assert!((measured - order).abs() < 0.1, "{integrator:?}: {measured}");
        }
    }
}
