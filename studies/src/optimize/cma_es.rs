//! CMA-ES, (mu/mu_w, lambda) with positive weights (Hansen, The CMA Evolution Strategy: A Tutorial, arXiv:1604.00772).
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | m | mean of the search distribution | of the box |
//! | sigma | its step size | of the box |
//! | C | its covariance matrix | 1 |
//! | p_sigma, p_c | evolution paths of step size and covariance | 1 |
//!
//! Numbers in brackets are the tutorial's equations. A point outside of the box is drawn anew.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::{Ending, Evaluations, into_box, order};
use crate::random::Random;

/// \[of the box\] First step size, and the largest standard deviation at which the search has converged.
const FIRST: f64 = 0.3;
const SMALL: f64 = 1e-3;
/// Times that a point outside of the box is drawn anew before it is moved to the nearest one inside.
const ANEW: usize = 100;

/// Searches until the distribution is small.
pub(super) fn search(
    start: &DVector<f64>,
    random: &mut Random,
    on: &mut Evaluations<'_>,
) -> Result<(), Ending> {
    let n = start.len();
    let dimensions = n as f64;
    let lambda = 4 + (3.0 * dimensions.ln()) as usize; // (48)
    let weights = weights(lambda);
    let mu_eff = 1.0 / weights.iter().map(|w| w * w).sum::<f64>();

    // Learning rates and damping (55) to (58).
    let c_sigma = (mu_eff + 2.0) / (dimensions + mu_eff + 5.0);
    let damping = 1.0 + 2.0 * (((mu_eff - 1.0) / (dimensions + 1.0)).sqrt() - 1.0).max(0.0) + c_sigma;
    let c_c = (4.0 + mu_eff / dimensions) / (dimensions + 4.0 + 2.0 * mu_eff / dimensions);
    let c_1 = 2.0 / ((dimensions + 1.3).powi(2) + mu_eff);
    let c_mu = (1.0 - c_1).min(2.0 * (mu_eff - 2.0 + 1.0 / mu_eff) / ((dimensions + 2.0).powi(2) + mu_eff));
    // Length of a vector of n standard normal numbers.
    let chi = dimensions.sqrt() * (1.0 - 1.0 / (4.0 * dimensions) + 1.0 / (21.0 * dimensions * dimensions));

    let (mut m, mut sigma, mut c) = (start.clone(), FIRST, DMatrix::<f64>::identity(n, n));
    let (mut p_sigma, mut p_c) = (DVector::<f64>::zeros(n), DVector::<f64>::zeros(n));
    on.of(std::slice::from_ref(start))?;
    for generation in 1.. {
        // Points of this generation (38) to (40).
        let eigen = SymmetricEigen::new(c.clone());
        let deviations = eigen.eigenvalues.map(|d| d.max(0.0).sqrt());
        if sigma * deviations.max() < SMALL {
            break;
        }
        let spread = &eigen.eigenvectors * DMatrix::from_diagonal(&deviations);
        let points: Vec<DVector<f64>> = (0..lambda).map(|_| inside(&m, &(&spread * sigma), random)).collect();
        let costs = on.of(&points)?;

        // The better half, weighted (41), (42).
        let mut ranks: Vec<usize> = (0..lambda).collect();
        ranks.sort_by(|&a, &b| order(costs[a]).total_cmp(&order(costs[b])));
        let steps: Vec<DVector<f64>> = ranks.iter().map(|&k| (&points[k] - &m) / sigma).collect();
        let mean =
            weights.iter().zip(&steps).fold(DVector::zeros(n), |sum: DVector<f64>, (w, y)| sum + y * *w);
        m += &mean * sigma;

        // Paths (43), (45): of the step size without the shape of the distribution.
        let whitened = eigen.eigenvectors.transpose() * &mean;
        let whitened =
            &eigen.eigenvectors * whitened.zip_map(&deviations, |y, d| if d > 0.0 { y / d } else { 0.0 });
        p_sigma = p_sigma * (1.0 - c_sigma) + whitened * (c_sigma * (2.0 - c_sigma) * mu_eff).sqrt();
        let grown = 1.0 - (1.0 - c_sigma).powi(2 * generation);
        let short = p_sigma.norm() / grown.sqrt() < (1.4 + 2.0 / (dimensions + 1.0)) * chi;
        let h = if short { 1.0 } else { 0.0 };
        p_c = p_c * (1.0 - c_c) + &mean * (h * (c_c * (2.0 - c_c) * mu_eff).sqrt());

        // Covariance (47) and step size (44).
        let rank_one = &p_c * p_c.transpose() * c_1;
        let rank_mu = weights
            .iter()
            .zip(&steps)
            .fold(DMatrix::zeros(n, n), |sum: DMatrix<f64>, (w, y)| sum + y * y.transpose() * (c_mu * w));
        let kept = 1.0 - c_1 - c_mu + (1.0 - h) * c_1 * c_c * (2.0 - c_c);
        c = c * kept + rank_one + rank_mu;
        sigma *= ((c_sigma / damping) * (p_sigma.norm() / chi - 1.0)).exp();
    }
    Ok(())
}

/// Weights of the better half of `lambda` points (49), (53): they sum up to 1.
fn weights(lambda: usize) -> Vec<f64> {
    let raw: Vec<f64> =
        (1..=lambda / 2).map(|i| f64::midpoint(lambda as f64, 1.0).ln() - (i as f64).ln()).collect();
    let sum: f64 = raw.iter().sum();
    raw.into_iter().map(|w| w / sum).collect()
}

/// A point of the distribution within the box.
fn inside(m: &DVector<f64>, spread: &DMatrix<f64>, random: &mut Random) -> DVector<f64> {
    let mut point = m.clone();
    for _ in 0..ANEW {
        point = m + spread * m.map(|_| normal(random));
        if point.iter().all(|x| (0.0..=1.0).contains(x)) {
            return point;
        }
    }
    into_box(point)
}

/// A standard normal number (Box and Muller).
fn normal(random: &mut Random) -> f64 {
    let (radius, angle) = (1.0 - random.unit(), random.unit());
    (-2.0 * radius.ln()).sqrt() * (TAU * angle).cos()
}
