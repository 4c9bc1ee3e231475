//! Forward dynamics by the mass matrix: M v' = force - h, with the sparsity of the tree.
//!
//! M = L^T D L with L unit lower triangular, eliminated from the tips to the base, has no fill-in: row k of L has its
//! entries where row k of M has, on the path from the base to k.

use crate::data::Data;
use crate::model::{Model, Paths};

impl Model {
    /// Acceleration v' that the generalized force gives at `q`, `v`; n_v each.
    pub fn forward_dynamics(
        &self,
        data: &mut Data,
        q: &[f64],
        v: &[f64],
        force: &[f64],
        acceleration: &mut [f64],
    ) {
        assert_eq!(force.len(), self.nv(), "length of the generalized force");
        data.set_position(self, q);
        self.composites(data);
        self.rows(data);
        self.bias(data, v, acceleration);
        for (a, f) in acceleration.iter_mut().zip(force) {
            *a = f - *a;
        }
        data.l.copy_from_slice(&data.m);
        factor(&self.paths, &mut data.l);
        solve(&self.paths, &data.l, acceleration);
    }

    /// Solves M x = b in place with the mass matrix that [`Model::mass_matrix`] or [`Model::forward_dynamics`] left.
    pub fn solve_mass_matrix(&self, data: &mut Data, x: &mut [f64]) {
        assert_eq!(x.len(), self.nv(), "length of the right-hand side");
        data.l.copy_from_slice(&data.m);
        factor(&self.paths, &mut data.l);
        solve(&self.paths, &data.l, x);
    }
}

/// L^T D L in place; the diagonal holds 1/D.
fn factor(paths: &Paths, l: &mut [f64]) {
    for k in (0..paths.start.len() - 1).rev() {
        let range = paths.row(k);
        let columns = &paths.column[range.clone()];
        let (before, row) = l.split_at_mut(range.start);
        let row = &mut row[..columns.len()];
        let (last, off) = row.split_last_mut().expect("a row holds its diagonal");
        let d = 1.0 / *last;
        *last = d;
        for t in (0..off.len()).rev() {
            let a = off[t] * d;
            let at = paths.start[columns[t]];
            for (x, y) in before[at..=at + t].iter_mut().zip(&off[..=t]) {
                *x -= a * y;
            }
            off[t] = a;
        }
    }
}

/// x <- L^-1 D^-1 L^-T x
fn solve(paths: &Paths, l: &[f64], x: &mut [f64]) {
    let nv = paths.start.len() - 1;
    for k in (0..nv).rev() {
        let range = paths.row(k);
        let xk = x[k];
        for (&a, &c) in l[range.clone()].iter().zip(&paths.column[range]).rev().skip(1) {
            x[c] -= a * xk;
        }
    }
    for k in 0..nv {
        let range = paths.row(k);
        let (&d, off) = l[range.clone()].split_last().expect("a row holds its diagonal");
        let mut s = x[k] * d;
        for (&a, &c) in off.iter().zip(&paths.column[range]) {
            s -= a * x[c];
        }
        x[k] = s;
    }
}
