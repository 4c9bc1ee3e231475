//! Friction parameters from efficiencies (2.62): the model of Rossmann (2.60) and the thesis's own (2.61).
//!
//! Variables   p = (T_0, μ, b, γ) of (2.61), or (T_0, μ, b, g) of (2.60)
//! Objective   Σ (η_model - η)² → min,   1/η_model = 1 + p · x
//! Constraints T_0, μ, b, γ ≥ 0; g is free, as it was when (2.60) was used
//!
//! | model | x |
//! |---|---|
//! | (2.61) | 1/T_l, 1, ω/T_l, ω |
//! | (2.60) | 1/T_l, 1, ω/T_l, ω³/T_l |
//!
//! with ω, T_l > 0. γ ≥ 0 is missing in (2.62): without it efficiencies above 1 come out at speed (errata 1, (2.62)).
//! Method: Levenberg and Marquardt's; the bounded linear problem of each step is solved exactly, by trying all sets of
//! parameters that are 0.

use std::fmt;

use nalgebra::{Matrix4, Vector4};

use crate::HarmonicFriction;

/// One measured efficiency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Efficiency {
    /// \[rad/s\] ω of the motor, positive.
    pub speed: f64,
    /// \[N m\] T_l: torque at the output over N, positive.
    pub load: f64,
    /// \[1\] η = T_l/T_mot, between 0 and 1.
    pub efficiency: f64,
}

/// Friction (2.60), with which gears were modelled before; on the motor's side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CubicFriction {
    /// \[N m\] T_0.
    pub starting: f64,
    /// \[1\] μ
    pub load: f64,
    /// \[N m s/rad\] b
    pub viscous: f64,
    /// \[N m s³/rad³\] g; negative ones make a gear that gives energy at high speed.
    pub cubic: f64,
}

/// A model with fitted parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit<T> {
    /// The parameters.
    pub friction: T,
    /// \[1\] Largest |η_model - η|.
    pub largest: f64,
    /// \[1\] Root of the mean square of η_model - η.
    pub rms: f64,
    /// \[1\] How far the optimality conditions are from holding, relative to the rows of the problem.
    pub optimality: f64,
}

/// Data that no parameters can be fitted to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FitError {
    /// A point outside of what the models describe.
    Point {
        /// Its row, from 0.
        row: usize,
        /// Which of its entries.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// The allowed range.
        allowed: &'static str,
    },
    /// The points do not tell the parameters apart.
    TooAlike {
        /// Number of points.
        points: usize,
    },
}

/// Steps; a fit takes about ten.
const STEPS: usize = 200;
/// Least eigenvalue of the normal equations over their largest.
const LEAST_SPREAD: f64 = 1e-10;

/// Fits (2.61).
pub fn coupled(data: &[Efficiency]) -> Result<Fit<HarmonicFriction>, FitError> {
    let fit = FitProblem::new(data, |point| point.speed, true)?.solve();
    let [starting, load, viscous, coupled] = fit.friction;
    Ok(fit.with(HarmonicFriction { starting, load, viscous, coupled }))
}

/// Fits (2.60).
pub fn cubic(data: &[Efficiency]) -> Result<Fit<CubicFriction>, FitError> {
    let fit = FitProblem::new(data, |point| point.speed.powi(3) / point.load, false)?.solve();
    let [starting, load, viscous, cubic] = fit.friction;
    Ok(fit.with(CubicFriction { starting, load, viscous, cubic }))
}

impl HarmonicFriction {
    /// \[1\] η while the motor drives a load T_l > 0 at ω > 0.
    pub fn efficiency(&self, speed: f64, load: f64) -> f64 {
        load / (load - self.torque(speed, load, 0.0))
    }
}

impl CubicFriction {
    /// \[N m\] T_f at a load torque that is known.
    pub fn torque(&self, speed: f64, load: f64) -> f64 {
        let dry = if speed == 0.0 { 0.0 } else { speed.signum() * (self.starting + self.load * load.abs()) };
        -dry - self.viscous * speed - self.cubic * speed.powi(3) // (2.60)
    }

    /// \[1\] η while the motor drives a load T_l > 0 at ω > 0.
    pub fn efficiency(&self, speed: f64, load: f64) -> f64 {
        load / (load - self.torque(speed, load))
    }
}

impl<T> Fit<T> {
    fn with<U>(&self, friction: U) -> Fit<U> {
        Fit { friction, largest: self.largest, rms: self.rms, optimality: self.optimality }
    }
}

/// The least-squares problem with columns of equal size.
struct FitProblem {
    /// x of every point, scaled, and η.
    rows: Vec<(Vector4<f64>, f64)>,
    /// Parameter over scaled parameter.
    scale: Vector4<f64>,
    /// Which parameters must not be negative.
    bounded: [bool; 4],
}

impl FitProblem {
    fn new(data: &[Efficiency], last: impl Fn(&Efficiency) -> f64, bounded: bool) -> Result<Self, FitError> {
        data.iter().enumerate().try_for_each(|(row, point)| check(row, point))?;
        let x = |p: &Efficiency| Vector4::new(1.0 / p.load, 1.0, p.speed / p.load, last(p));
        let largest = data.iter().map(x).fold(Vector4::zeros(), |m: Vector4<f64>, x| m.sup(&x));
        let rows: Vec<_> = data.iter().map(|p| (x(p).component_div(&largest), p.efficiency)).collect();
        let normal: Matrix4<f64> = rows.iter().map(|(x, _)| x * x.transpose()).sum();
        let spread = normal.symmetric_eigenvalues();
        if data.len() < 4 || !(spread.min() > LEAST_SPREAD * spread.max()) {
            return Err(FitError::TooAlike { points: data.len() });
        }
        Ok(Self { rows, scale: largest.map(|x| 1.0 / x), bounded: [true, true, true, bounded] })
    }

    /// η_model - η of a point.
    fn error(&self, p: &Vector4<f64>, (x, eta): &(Vector4<f64>, f64)) -> f64 {
        1.0 / (1.0 + p.dot(x)) - eta
    }

    /// Sum of squares; infinite where the model has no efficiency.
    fn cost(&self, p: &Vector4<f64>) -> f64 {
        if self.rows.iter().any(|(x, _)| 1.0 + p.dot(x) <= 0.0) {
            return f64::INFINITY;
        }
        self.rows.iter().map(|row| self.error(p, row).powi(2)).sum()
    }

    /// Normal matrix JᵀJ and gradient Jᵀr, J = -η² x.
    fn linear(&self, p: &Vector4<f64>) -> (Matrix4<f64>, Vector4<f64>) {
        let (mut normal, mut gradient) = (Matrix4::zeros(), Vector4::zeros());
        for row in &self.rows {
            let j = row.0 * -(1.0 + p.dot(&row.0)).powi(-2);
            normal += j * j.transpose();
            gradient += j * self.error(p, row);
        }
        (normal, gradient)
    }

    fn solve(&self) -> Fit<[f64; 4]> {
        let mut p = self.start();
        let (mut cost, mut damping) = (self.cost(&p), 1e-3);
        for _ in 0..STEPS {
            let (normal, gradient) = self.linear(&p);
            let damped = normal + Matrix4::from_diagonal(&normal.diagonal()) * damping;
            let next = bounded_minimum(&damped, &(gradient - damped * p), self.bounded);
            let (next_cost, step) = (self.cost(&next), (next - p).norm());
            if next_cost <= cost {
                (p, cost, damping) = (next, next_cost, (damping * 0.1_f64).max(1e-12));
            } else {
                damping *= 10.0;
            }
            if step <= 1e-14 * (1.0 + p.norm()) {
                break;
            }
        }
        self.result(&p)
    }

    /// Fits 1/η - 1, which is linear in p.
    fn start(&self) -> Vector4<f64> {
        let normal: Matrix4<f64> = self.rows.iter().map(|(x, _)| x * x.transpose()).sum();
        let right: Vector4<f64> = self.rows.iter().map(|(x, eta)| x * (1.0 / eta - 1.0)).sum();
        bounded_minimum(&normal, &-right, [true; 4])
    }

    fn result(&self, p: &Vector4<f64>) -> Fit<[f64; 4]> {
        let errors = self.rows.iter().map(|row| self.error(p, row).abs());
        let gradient = self.linear(p).1;
        let wrong = (0..4).map(|i| {
            let at_bound = self.bounded[i] && p[i] <= 0.0;
            if at_bound { (-gradient[i]).max(0.0) } else { gradient[i].abs() }
        });
        Fit {
            friction: p.component_mul(&self.scale).map(|p| p + 0.0).into(), // no -0
            largest: errors.fold(0.0, f64::max),
            rms: (self.cost(p) / self.rows.len() as f64).sqrt(),
            optimality: wrong.fold(0.0, f64::max) / self.rows.len() as f64,
        }
    }
}

/// Minimum of ½ pᵀ A p + bᵀ p with the bounded entries of p not negative: the best of all sets of entries that are 0.
fn bounded_minimum(a: &Matrix4<f64>, b: &Vector4<f64>, bounded: [bool; 4]) -> Vector4<f64> {
    let value = |p: &Vector4<f64>| 0.5 * p.dot(&(a * p)) + b.dot(p);
    let sets = (0..16_u8).filter(|set| (0..4).all(|i| set & (1 << i) == 0 || bounded[i]));
    let solutions = sets.filter_map(|set| minimum_without(a, b, set));
    let allowed = solutions.filter(|p| (0..4).all(|i| !bounded[i] || p[i] >= 0.0));
    allowed.min_by(|p, q| value(p).total_cmp(&value(q))).unwrap_or_else(Vector4::zeros)
}

/// The minimum with the entries of `zero` held at 0.
fn minimum_without(a: &Matrix4<f64>, b: &Vector4<f64>, zero: u8) -> Option<Vector4<f64>> {
    let (mut a, mut b) = (*a, *b);
    for i in (0..4).filter(|i| zero & (1 << i) != 0) {
        a.fill_row(i, 0.0);
        a.fill_column(i, 0.0);
        a[(i, i)] = 1.0;
        b[i] = 0.0;
    }
    Some(a.cholesky()?.solve(&-b))
}

fn check(row: usize, point: &Efficiency) -> Result<(), FitError> {
    let entries = [
        ("speed", point.speed, "above 0 rad/s", point.speed > 0.0),
        ("load", point.load, "above 0 N m", point.load > 0.0),
        (
            "efficiency",
            point.efficiency,
            "above 0, up to 1",
            point.efficiency > 0.0 && point.efficiency <= 1.0,
        ),
    ];
    for (quantity, value, allowed, right) in entries {
        if !(right && value.is_finite()) {
            return Err(FitError::Point { row, quantity, value, allowed });
        }
    }
    Ok(())
}

impl fmt::Display for FitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Point { row, quantity, value, allowed } => {
                write!(f, "row {row}: {quantity} = {value} is not allowed; it must be {allowed}")
            }
            Self::TooAlike { points } => write!(
                f,
                "{points} points do not determine four parameters: give at least 3 different speeds and 2 loads"
            ),
        }
    }
}

impl std::error::Error for FitError {}
