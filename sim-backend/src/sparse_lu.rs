//! Linear equations of the stiff method: Gaussian elimination that skips zeros.
//!
//! I - c J of a robot is mostly zeros: a contact node answers to its own displacement, a current to its own motor, an angle to
//! its own speed. These states are eliminated one by one on the diagonal, the cheapest first (Markowitz); what is left, the
//! accelerations, which all answer to each other, goes to a dense factorization with pivots. The order is kept as long as
//! no new place becomes occupied, the factors as long as the matrix is the same.
//!
//! | symbol | name |
//! |---|---|
//! | A | matrix, n rows |
//! | p | state that is eliminated |

use std::cell::RefCell;
use std::rc::Rc;

use diffsol::{LaLinearOp, Matrix, MatrixCommon, NalgebraContext, NalgebraMat, NalgebraVec, Vector};
use diffsol_la::error::LaError;
use nalgebra::{DMatrix, DVector, Dyn, LU};

/// Share of the places left that a pivot may touch before the rest counts as dense.
const DENSE: f64 = 0.5;
/// \[1\] Smaller pivots end the elimination.
const LEAST_PIVOT: f64 = 1e-12;

/// Factors of one matrix, and the order of elimination for others like it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Factors {
    n: usize,
    /// Occupied places of A, by rows.
    occupied: Vec<bool>,
    pivots: Vec<Pivot>,
    /// States that are left to the dense factorization.
    rest: Vec<usize>,
    /// The matrix that was factored, by columns, and its factors, by rows.
    matrix: Vec<f64>,
    factors: Vec<f64>,
    dense: Option<LU<f64, Dyn, Dyn>>,
}

/// One state of the elimination: rows and columns that it touches.
#[derive(Clone, Debug)]
struct Pivot {
    state: usize,
    rows: Vec<usize>,
    columns: Vec<usize>,
}

impl Factors {
    /// Factors A, given by columns.
    fn factor(&mut self, matrix: &[f64], n: usize) {
        if self.n == n && self.dense.is_some() && self.matrix == matrix {
            return;
        }
        if self.n != n {
            *self = Self { n, occupied: vec![false; n * n], factors: vec![0.0; n * n], ..Self::default() };
        }
        self.matrix.clear();
        self.matrix.extend_from_slice(matrix);
        let mut grown = self.pivots.is_empty() && self.rest.is_empty();
        for j in 0..n {
            for i in 0..n {
                let a = matrix[n * j + i];
                self.factors[n * i + j] = a;
                if a != 0.0 && !self.occupied[n * i + j] {
                    (self.occupied[n * i + j], grown) = (true, true);
                }
            }
        }
        if grown {
            self.order();
        }
        self.eliminate();
    }

    /// Chooses the order: each time the state on the diagonal that touches the fewest places.
    fn order(&mut self) {
        let n = self.n;
        let mut at = self.occupied.clone();
        let count = |of: &dyn Fn(usize, usize) -> bool| -> Vec<usize> {
            (0..n).map(|i| (0..n).filter(|&j| of(i, j)).count()).collect()
        };
        let mut in_row = count(&|i, j| at[n * i + j]);
        let mut in_column = count(&|j, i| at[n * i + j]);
        let mut left: Vec<usize> = (0..n).collect();
        self.pivots.clear();
        while let Some((k, &p)) = left.iter().enumerate().min_by_key(|(_, p)| in_row[**p] * in_column[**p]) {
            if (in_row[p] * in_column[p]) as f64 > DENSE * (left.len() * left.len()) as f64 {
                break;
            }
            left.remove(k);
            let rows: Vec<usize> = left.iter().copied().filter(|&i| at[n * i + p]).collect();
            let columns: Vec<usize> = left.iter().copied().filter(|&j| at[n * p + j]).collect();
            rows.iter().for_each(|&i| in_row[i] -= 1);
            columns.iter().for_each(|&j| in_column[j] -= 1);
            // Where rows and columns of the pivot meet, something appears.
            for &i in &rows {
                for &j in columns.iter().filter(|&&j| !at[n * i + j]).collect::<Vec<_>>() {
                    at[n * i + j] = true;
                    in_row[i] += 1;
                    in_column[j] += 1;
                }
            }
            self.pivots.push(Pivot { state: p, rows, columns });
        }
        self.rest = left;
    }

    fn eliminate(&mut self) {
        let Self { n, pivots, rest, factors: a, .. } = self;
        let n = *n;
        self.dense = None;
        let mut of_pivot = Vec::with_capacity(n);
        for Pivot { state: p, rows, columns } in pivots.iter() {
            let pivot = a[n * p + p];
            if pivot.abs() < LEAST_PIVOT {
                return;
            }
            of_pivot.clear();
            of_pivot.extend(columns.iter().map(|j| a[n * p + j]));
            for i in rows {
                let row = &mut a[n * i..n * (i + 1)];
                row[*p] /= pivot;
                let factor = row[*p];
                if factor != 0.0 {
                    columns.iter().zip(&of_pivot).for_each(|(j, of_pivot)| row[*j] -= factor * of_pivot);
                }
            }
        }
        self.dense = Some(DMatrix::from_fn(rest.len(), rest.len(), |i, j| a[n * rest[i] + rest[j]]).lu());
    }

    /// A^-1 b in place; false if A has no factors.
    fn solve(&self, b: &mut [f64]) -> bool {
        let Self { n, pivots, rest, factors: a, .. } = self;
        let Some(dense) = &self.dense else { return false };
        for Pivot { state: p, rows, .. } in pivots {
            for i in rows {
                b[*i] -= a[n * i + p] * b[*p];
            }
        }
        let mut x = DVector::from_fn(rest.len(), |i, _| b[rest[i]]);
        if !dense.solve_mut(&mut x) {
            return false;
        }
        rest.iter().zip(&x).for_each(|(i, x)| b[*i] = *x);
        for Pivot { state: p, columns, .. } in pivots.iter().rev() {
            let known: f64 = columns.iter().map(|j| a[n * p + j] * b[*j]).sum();
            b[*p] = (b[*p] - known) / a[n * p + p];
        }
        true
    }
}

/// The elimination as the library calls it; its factors outlive a solver.
#[derive(Clone, Default)]
pub(crate) struct SparseLu {
    factors: Rc<RefCell<Factors>>,
    matrix: Option<NalgebraMat<f64>>,
}

impl SparseLu {
    /// Begins with these.
    pub(crate) fn new(factors: Factors) -> Self {
        Self { factors: Rc::new(RefCell::new(factors)), matrix: None }
    }

    /// Factors, once their solver is gone.
    pub(crate) fn into_factors(self) -> Factors {
        self.factors.take()
    }
}

impl diffsol_la::LinearSolver<NalgebraMat<f64>> for SparseLu {
    fn set_linearisation<
        C: LaLinearOp<V = NalgebraVec<f64>, T = f64, M = NalgebraMat<f64>, C = NalgebraContext>,
    >(
        &mut self,
        op: &C,
    ) {
        let Some(matrix) = &mut self.matrix else { return };
        op.matrix_inplace(matrix);
        self.factors.borrow_mut().factor(matrix.inner().as_slice(), op.nrows());
    }

    fn set_sparsity<
        C: LaLinearOp<V = NalgebraVec<f64>, T = f64, M = NalgebraMat<f64>, C = NalgebraContext>,
    >(
        &mut self,
        op: &C,
    ) {
        self.matrix = Some(NalgebraMat::zeros(op.nrows(), op.ncols(), *op.context()));
    }

    fn solve_in_place(&self, x: &mut NalgebraVec<f64>) -> Result<(), LaError> {
        let solved = self.factors.borrow().solve(x.inner_mut().as_mut_slice());
        if solved { Ok(()) } else { Err(LaError::Other("no factors".into())) }
    }

    fn solve_transpose_in_place(&self, _: &mut NalgebraVec<f64>) -> Result<(), LaError> {
        Err(LaError::Other("no transposed equations in a step".into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix of the shape of a robot's: chains, an arrow, and a dense block; by columns.
    fn matrix(n: usize, dense: usize, seed: f64) -> Vec<f64> {
        let value = |i: usize, j: usize| (seed + (7 * i + 13 * j) as f64).sin();
        let at = |i: usize, j: usize| match (i < dense, j < dense) {
            (true, _) => value(i, j) + if i == j { 3.0 } else { 0.0 },
            (false, true) => {
                if (i + j).is_multiple_of(5) {
                    value(i, j)
                } else {
                    0.0
                }
            }
            (false, false) => {
                if i == j {
                    4.0
                } else if i.abs_diff(j) == 1 {
                    value(i, j)
                } else {
                    0.0
                }
            }
        };
        (0..n * n).map(|k| at(k % n, k / n)).collect()
    }

    #[test]
    fn solutions_are_those_of_a_dense_factorization() {
        let (n, dense) = (60, 12);
        let mut factors = Factors::default();
        for seed in [0.3, 1.7, 0.3] {
            let a = matrix(n, dense, seed);
            let b: Vec<f64> = (0..n).map(|i| (i as f64).cos()).collect();
            factors.factor(&a, n);
            let mut x = b.clone();
            assert!(factors.solve(&mut x));
            let left = DMatrix::from_vec(n, n, a) * DVector::from_vec(x) - DVector::from_vec(b);
            assert!(left.amax() < 1e-12, "{}", left.amax());
        }
        assert!(factors.rest.len() < 2 * dense, "{} of {n} states are left", factors.rest.len());
    }

    #[test]
    fn a_singular_matrix_has_no_factors() {
        let mut factors = Factors::default();
        factors.factor(&[0.0; 9], 3);
        assert!(!factors.solve(&mut [1.0; 3]));
    }
}
