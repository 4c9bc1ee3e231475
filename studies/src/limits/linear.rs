//! Linearisation of equations of motion, and the steps that explicit methods may take on them.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | s | eigenvalue of the derivative of the rates by the state | 1/s |
//! | R | factor by which a step multiplies an eigenvector, as a polynomial of hs | 1 |

use nalgebra::linalg::{Schur, balancing};
use nalgebra::{Complex, DMatrix};

use super::Result;

/// \[1\] By how much a state is changed to see what its rate does: contact nodes stay on the ground, rotors within the ramp
/// of their dry friction.
const CHANGE: f64 = 1e-7;
/// \[1/s\] Eigenvalues below are zeros with rounding errors: a robot may stand anywhere, a stuck node stay anywhere.
const ZERO: f64 = 1.0;
/// \[1/s\] By how much all eigenvalues are moved while they are computed.
const SHIFT: f64 = 1000.0;

/// Eigenvalues \[1/s\] of the linearised rates at a state, zeros left out.
///
/// # Errors
/// The iteration for them does not end.
pub(super) fn eigenvalues(x: &[f64], mut rate: impl FnMut(&[f64], &mut [f64])) -> Result<Vec<Complex<f64>>> {
    let n = x.len();
    let (mut at, mut ahead, mut behind) = (x.to_vec(), vec![0.0; n], vec![0.0; n]);
    let mut jacobian = DMatrix::zeros(n, n);
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
    // Scaled, and moved away from zero, where many eigenvalues coincide and the iteration would not end.
    balancing::balance_parlett_reinsch(&mut jacobian);
    for i in 0..n {
        jacobian[(i, i)] -= SHIFT;
    }
    let found =
        Schur::try_new(jacobian, 1e-13, 200 * n).ok_or("no eigenvalues of the linearised rates found")?;
    Ok(found.complex_eigenvalues().iter().map(|s| s + SHIFT).filter(|s| s.norm() > ZERO).collect())
}

/// \[s\] Largest step with which explicit Euler is stable: -2 Re s/|s|^2.
pub(super) fn euler_limit(values: &[Complex<f64>]) -> f64 {
    values.iter().map(|s| -2.0 * s.re / s.norm_sqr()).fold(f64::INFINITY, f64::min)
}

/// \[s\] The same for the classical Runge-Kutta method: |R| = 1.
pub(super) fn runge_kutta_limit(values: &[Complex<f64>]) -> f64 {
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
