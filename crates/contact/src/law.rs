//! The contact law as a residual, and the numbers that steer its solution: shared by all methods for coupled nodes.

use nalgebra::{Matrix3, Vector2, Vector3};

/// Search for the forces of coupled nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CouplingMethod {
    /// Algorithm 1 as the thesis has it, with the r-factors of the errata: all nodes at once.
    Jacobi,
    /// The same, each node with the newest forces of the others.
    GaussSeidel,
    /// Each node's law solved exactly with its neighbours' velocities held.
    Velocity,
    /// [`CouplingMethod::Velocity`] when a good part of the sole touches and most of that sticks, else [`CouplingMethod::GaussSeidel`];
    /// that, too, if the former does not converge.
    Fastest,
}

/// Ground and solver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// \[1\] mu
    pub friction: f64,
    /// \[1/s\] Rate at which penetration left over from a finite step is taken back (errata 1, drift stabilization).
    pub recovery: f64,
    /// Method.
    pub method: CouplingMethod,
    /// \[1\] gamma of the r-factors (2.48), (2.49); 0 < gamma < 2, for Jacobi often less.
    pub gamma: f64,
    /// \[1\] Largest residual, as a multiple of 0.1 N and of 1 mm/s.
    pub tolerance: f64,
    /// Sweeps after which the solver gives up and says so.
    pub sweeps: u32,
}

impl Settings {
    /// For rubber on a floor with friction mu.
    pub fn of_friction(friction: f64) -> Self {
        Self {
            friction,
            recovery: 200.0,
            method: CouplingMethod::Fastest,
            gamma: 1.0,
            tolerance: 1e-3,
            sweeps: 200,
        }
    }
}

/// End of the solver.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolverReport {
    /// Sweeps over the nodes.
    pub sweeps: u32,
    /// \[1\] Residual of the law, as a multiple of 0.1 N and of 1 mm/s, the larger of the two.
    pub residual: f64,
    /// True if the residual is within the tolerance; if not, forces are finite and within the friction cone all the same.
    pub converged: bool,
    /// True if the law of each touching node alone has one solution only (errata 1, F7). With large friction on
    /// slanting ground it need not have.
    pub unique: bool,
}

/// Residual 1: force \[N\] and velocity \[m/s\].
pub(crate) const SCALE: (f64, f64) = (0.1, 1e-3);

/// \[m\] Height below which a node may carry force: a node at rest is at the ground only up to rounding.
pub const TOUCHING: f64 = 1e-6;

/// r-factors \[N s/m\] of a node, tangential and normal (2.49), (2.48) with the block of the inverse (errata 1).
pub(crate) fn factors(e: &Matrix3<f64>, mobility: &Matrix3<f64>) -> (f64, f64) {
    let g = e.transpose() * mobility * e;
    let (a, b, c) = (g[(0, 0)], g[(1, 1)], g[(0, 1)]);
    let largest = 0.5 * (a + b) + (0.5 * (a - b)).hypot(c);
    (1.0 / largest, 1.0 / g[(2, 2)])
}

/// lambda after one step of the fixed point (2.44), (2.45).
pub(crate) fn prox(lambda: &Vector3<f64>, u: &Vector3<f64>, r: (f64, f64), mu: f64) -> Vector3<f64> {
    let n = (lambda.z - r.1 * u.z).max(0.0); // (2.44), (2.46)
    let t: Vector2<f64> = lambda.xy() - r.0 * u.xy();
    let (size, most) = (t.norm(), mu * n);
    let t = if size <= most { t } else { t * (most / size) }; // (2.45), (2.47)
    Vector3::new(t.x, t.y, n)
}

/// Residual of a change of force of a node with these r-factors.
pub(crate) fn residual(change: &Vector3<f64>, r: (f64, f64)) -> f64 {
    let (t, n) = (change.xy().norm(), change.z.abs());
    let velocity = (t / r.0).max(n / r.1);
    (t.max(n) / SCALE.0).max(velocity / SCALE.1)
}
