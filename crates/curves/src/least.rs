//! Piecewise quintics of least acceleration (thesis (4.30)).
//!
//! ```text
//! Variables    p_k, v_k, a_k   value and derivatives at the knots
//! Objective    1/2 integral of p''^2
//! Constraints  some of the variables are given
//! ```
//! The Hessian of one piece is that of errata 2.5; in the free variables it is positive definite once two values are
//! given, and the solution is that of a linear system.

use crate::Sample;

/// Hessian of 1/2 int p''^2 over a piece of length `h` \[s\] in (p0, v0, a0, p1, v1, a1), errata 2.5.
pub fn hessian(h: f64) -> [[f64; 6]; 6] {
    let (h2, h3) = (h * h, h * h * h);
    let (p, pv, pa) = (120.0 / (7.0 * h3), 60.0 / (7.0 * h2), 3.0 / (7.0 * h));
    let (v, va) = (192.0 / (35.0 * h), 11.0 / 35.0);
    let (vw, vb) = (108.0 / (35.0 * h), 4.0 / 35.0);
    let (a, ab) = (3.0 * h / 35.0, h / 70.0);
    [
        [p, pv, pa, -p, pv, -pa],
        [pv, v, va, -pv, vw, -vb],
        [pa, va, a, -pa, vb, ab],
        [-p, -pv, -pa, p, -pv, pa],
        [pv, vw, vb, -pv, v, -va],
        [-pa, -vb, ab, pa, -va, a],
    ]
}

/// Values at `times` \[s\] that make the integral of p''^2 least; `given` holds (value, first, second derivative) where
/// they are prescribed. None if the times do not ascend or too little is given.
pub fn least_acceleration<const K: usize>(
    times: &[f64; K],
    given: &[[Option<f64>; 3]; K],
) -> Option<[Sample<1>; K]> {
    let mut matrix = [[[[0.0; 3]; 3]; K]; K];
    for k in 1..K {
        let h = times[k] - times[k - 1];
        if !(h > 0.0) {
            return None;
        }
        let piece = hessian(h);
        for (i, row) in piece.iter().enumerate() {
            for (j, x) in row.iter().enumerate() {
                matrix[k - 1 + i / 3][k - 1 + j / 3][i % 3][j % 3] += x;
            }
        }
    }
    let x = solve(&matrix, given)?;
    Some(x.map(|[p, v, a]| Sample { position: [p], velocity: [v], acceleration: [a] }))
}

type Blocks<const K: usize> = [[[[f64; 3]; 3]; K]; K];

/// Gaussian elimination over the free variables; the matrix is positive definite there, so no pivoting is needed.
fn solve<const K: usize>(matrix: &Blocks<K>, given: &[[Option<f64>; 3]; K]) -> Option<[[f64; 3]; K]> {
    let n = 3 * K;
    let known = |i: usize| given[i / 3][i % 3];
    let mut m = *matrix;
    let mut x = [[0.0; 3]; K];
    // Known derivatives go to the right-hand side.
    for i in (0..n).filter(|&i| known(i).is_none()) {
        let sum = |j: usize| known(j).map_or(0.0, |g| g * matrix[i / 3][j / 3][i % 3][j % 3]);
        x[i / 3][i % 3] = -(0..n).map(sum).sum::<f64>();
    }
    // Elimination without pivoting: the matrix is symmetric and positive definite, or the problem has no answer.
    for i in (0..n).filter(|&i| known(i).is_none()) {
        let pivot = m[i / 3][i / 3][i % 3][i % 3];
        if !(pivot > 1e-9 * matrix[i / 3][i / 3][i % 3][i % 3]) {
            return None;
        }
        for r in (i + 1..n).filter(|&r| known(r).is_none()) {
            let factor = m[r / 3][i / 3][r % 3][i % 3] / pivot;
            for c in i..n {
                m[r / 3][c / 3][r % 3][c % 3] -= factor * m[i / 3][c / 3][i % 3][c % 3];
            }
            x[r / 3][r % 3] -= factor * x[i / 3][i % 3];
        }
    }
    // Back substitution.
    for i in (0..n).rev() {
        x[i / 3][i % 3] = match known(i) {
            Some(value) => value,
            None => {
                let later = (i + 1..n).filter(|&j| known(j).is_none());
                let sum: f64 = later.map(|j| m[i / 3][j / 3][i % 3][j % 3] * x[j / 3][j % 3]).sum();
                (x[i / 3][i % 3] - sum) / m[i / 3][i / 3][i % 3][i % 3]
            }
        };
    }
    Some(x)
}
