//! Forward dynamics by the mass matrix: M v' = force - h, with the sparsity of the tree.
//!
//! M = L^T D L with L unit lower triangular, eliminated from the tips to the base, has no fill-in: row k of L has its
//! entries where row k of M has, on the path from the base to k.

use crate::data::{Data, with_turn};
use crate::model::Model;
use crate::space::V3;
use crate::sparsity::Paths;
use crate::turn::Turn;

impl Model {
    /// Acceleration v' that the generalized force gives at `q`, `v`; n_v each. Leaves in `data` what
    /// [`Model::rotor_acceleration`] needs.
    pub fn forward_dynamics(
        &self,
        data: &mut Data,
        q: &[f64],
        v: &[f64],
        force: &[f64],
        acceleration: &mut [f64],
    ) {
        self.set_position(data, q);
        self.forward_dynamics_here(data, v, force, acceleration);
    }

    /// [`Model::forward_dynamics`] at the configuration that `data` has.
    pub fn forward_dynamics_here(&self, data: &mut Data, v: &[f64], force: &[f64], acceleration: &mut [f64]) {
        assert_eq!(force.len(), self.nv(), "length of the generalized force");
        self.rows(data);
        self.nonlinear_terms_here(data, v, acceleration);
        for (a, f) in acceleration.iter_mut().zip(force) {
            *a = f - *a;
        }
        data.l.copy_from_slice(&data.m);
        factor(&self.paths, &mut data.l);
        solve(&self.paths, &data.l, acceleration);
        if self.gyros.iter().any(|g| g.geared.is_empty()) {
            self.turn_bodies(data, v, acceleration);
        }
    }

    /// Angular accelerations of all bodies, their angular velocities being known.
    pub(crate) fn turn_bodies(&self, data: &mut Data, v: &[f64], acceleration: &[f64]) {
        let Data { joints, oblique, locals, .. } = data;
        locals[0].dw = V3::from_slice(&acceleration[3..]);
        for (k, body) in self.bodies.iter().enumerate().skip(1) {
            let (dw, w, j) = (locals[body.parent].dw, locals[k].w, &joints[k]);
            let (qd, qdd) = (v[k + 5] * body.sign, acceleration[k + 5] * body.sign);
            with_turn!(body, j, &oblique[k], t => locals[k].dw = turning(t, dw, w, qd, qdd));
        }
    }

    /// Solves M x = b in place with the mass matrix that [`Model::mass_matrix`] or [`Model::forward_dynamics`] left.
    pub fn solve_mass_matrix(&self, data: &mut Data, x: &mut [f64]) {
        assert_eq!(x.len(), self.nv(), "length of the right-hand side");
        data.l.copy_from_slice(&data.m);
        factor(&self.paths, &mut data.l);
        solve(&self.paths, &data.l, x);
    }
}

/// Angular acceleration of a body from its parent's and its own angular velocity.
#[inline(always)]
fn turning<T: Turn>(t: T, p_dw: V3, w: V3, qd: f64, qdd: f64) -> V3 {
    let dw = t.down(p_dw);
    if T::SLIDES { dw } else { t.plus(dw + t.across(w, qd), qdd) }
}

/// L^T D L in place; the diagonal holds 1/D.
///
/// Every row begins with the six columns of the base, which are updated at their fixed length.
pub(crate) fn factor(paths: &Paths, l: &mut [f64]) {
    let nv = paths.start.len() - 1;
    // Joints from the tips: each takes its share from the rows of its ancestors.
    let mut base = [[0.0; 6]; 6];
    for k in (6..nv).rev() {
        let range = paths.row(k);
        let columns = &paths.column[range.clone()];
        let (before, row) = l.split_at_mut(range.start);
        let Some((last, off)) = row[..columns.len()].split_last_mut() else { continue };
        let Some((six, joints)) = off.split_first_chunk_mut::<6>() else { continue };
        let d = 1.0 / *last;
        *last = d;
        for t in (0..joints.len()).rev() {
            let a = joints[t] * d;
            let at = paths.start[columns[6 + t]];
            let Some((to_six, to_joints)) = before[at..].split_first_chunk_mut::<6>() else { continue };
            subtract(to_six, six, a);
            for (x, y) in to_joints.iter_mut().zip(&joints[..=t]) {
                *x -= a * y;
            }
            joints[t] = a;
        }
        // The base gets its share in a block of its own, so that the rows above stay independent of each other.
        let scaled = six.map(|x| x * d);
        for (to, a) in base.iter_mut().zip(scaled) {
            subtract(to, six, a);
        }
        *six = scaled;
    }
    // Then the base, a dense triangle of six.
    for k in 0..6 {
        for (x, y) in l[paths.row(k)].iter_mut().zip(&base[k]) {
            *x += y;
        }
    }
    for k in (0..6).rev() {
        let at = k * (k + 1) / 2;
        let d = 1.0 / l[at + k];
        l[at + k] = d;
        for t in (0..k).rev() {
            let (a, to) = (l[at + t] * d, t * (t + 1) / 2);
            for s in 0..=t {
                l[to + s] -= a * l[at + s];
            }
            l[at + t] = a;
        }
    }
}

/// x <- x - a y
#[inline(always)]
fn subtract(x: &mut [f64; 6], y: &[f64; 6], a: f64) {
    for k in 0..6 {
        x[k] -= a * y[k];
    }
}

/// x <- L^-1 D^-1 L^-T x
pub(crate) fn solve(paths: &Paths, l: &[f64], x: &mut [f64]) {
    let nv = paths.start.len() - 1;
    let Some((base, joints)) = x.split_first_chunk_mut::<6>() else { return };
    for k in (6..nv).rev() {
        let (six, off, _, columns) = row_of(paths, l, k);
        let xk = joints[k - 6];
        subtract(base, six, xk);
        for (&a, &c) in off.iter().zip(columns) {
            joints[c - 6] -= a * xk;
        }
    }
    solve_base(l, base);
    for k in 6..nv {
        let (six, off, d, columns) = row_of(paths, l, k);
        let mut s = joints[k - 6] * d;
        for (a, b) in six.iter().zip(base.iter()) {
            s -= a * b;
        }
        for (&a, &c) in off.iter().zip(columns) {
            s -= a * joints[c - 6];
        }
        joints[k - 6] = s;
    }
}

/// Row of a joint: the base's columns, the joints' entries before the diagonal, 1/D, the joints' columns.
#[inline(always)]
fn row_of<'a>(paths: &'a Paths, l: &'a [f64], k: usize) -> (&'a [f64; 6], &'a [f64], f64, &'a [usize]) {
    const NONE: (&[f64; 6], &[f64], f64, &[usize]) = (&[0.0; 6], &[], 0.0, &[]);
    let range = paths.row(k);
    let Some((six, rest)) = l[range.clone()].split_first_chunk::<6>() else { return NONE };
    let Some((&d, off)) = rest.split_last() else { return NONE };
    (six, off, d, &paths.column[range.start + 6..range.end])
}

fn solve_base(l: &[f64], x: &mut [f64; 6]) {
    for k in (0..6).rev() {
        for t in 0..k {
            x[t] -= l[k * (k + 1) / 2 + t] * x[k];
        }
    }
    for k in 0..6 {
        let at = k * (k + 1) / 2;
        x[k] *= l[at + k];
        for t in 0..k {
            x[k] -= l[at + t] * x[t];
        }
    }
}
