//! Mass matrix (2.35) by composite bodies.
//!
//! The body k and all it carries, taken as rigid, have mass, first moment mc and moments i about k's origin. A unit
//! speed of joint k gives that composite the momentum f and moment of momentum n; carried towards the base, their
//! parts along each joint on the way are the entries of row k. Entries between different branches are zero and are
//! never touched.

use std::ops::Range;

use nalgebra::DMatrix;

use crate::body::Composite;
use crate::data::{Data, with_turn};
use crate::inverse::choose;
use crate::model::Model;
use crate::space::{Twin, V3};
use crate::turn::Turn;

impl Model {
    /// Mass matrix at `q`, n_v x n_v, symmetric, both triangles.
    pub fn mass_matrix<'d>(&self, data: &'d mut Data, q: &[f64]) -> &'d DMatrix<f64> {
        self.set_position(data, q);
        self.mass_matrix_here(data)
    }

    /// [`Model::mass_matrix`] at the configuration that `data` has.
    pub fn mass_matrix_here<'d>(&self, data: &'d mut Data) -> &'d DMatrix<f64> {
        self.rows(data);
        let Data { m, mass_matrix, .. } = data;
        let (nv, full) = (self.nv(), mass_matrix.as_mut_slice());
        let mut put = |entries: Range<usize>| {
            for (&x, &[at, mirror]) in m[entries.clone()].iter().zip(&self.paths.full[entries]) {
                full[at as usize] = x;
                full[mirror as usize] = x;
            }
        };
        put(0..self.paths.start[6]);
        (6..nv).for_each(|k| put(self.paths.joints(k)));
        for k in 6..nv {
            let six = &m[self.paths.start[k]..][..6];
            full[nv * k..][..6].copy_from_slice(six);
            (0..6).for_each(|c| full[k + nv * c] = six[c]);
        }
        &data.mass_matrix
    }

    /// Composite bodies, from the tips to the base.
    pub(crate) fn composites(&self, data: &mut Data) {
        let Data { joints, oblique, composites, .. } = data;
        composites.copy_from_slice(&self.own);
        for (k, body) in self.bodies.iter().enumerate().skip(1).rev() {
            let (own, j) = (composites[k], &joints[k]);
            let p = &mut composites[body.parent];
            with_turn!(body, j, &oblique[k], t => carry(t, &own, self.carried[k], j.offset(), p));
        }
    }

    /// Composite bodies, and the rows of the mass matrix along the paths.
    ///
    /// A joint's kernel is chosen once for its composite and for all momenta that pass it on their way to the base.
    pub(crate) fn rows(&self, data: &mut Data) {
        let Data { joints, oblique, composites, momenta, spins, m, .. } = data;
        // From the tips: gyrostats of a body, its own momentum, then those that pass through it, then its inertia.
        let mut gyros = &self.gyros[..];
        composites.copy_from_slice(&self.own);
        for (k, body) in self.bodies.iter().enumerate().skip(1).rev() {
            while let Some((g, before)) = gyros.split_last()
                && g.body == k
            {
                g.add_momenta(&spins[g.index], momenta);
                gyros = before;
            }
            let (own, j) = (composites[k], &joints[k]);
            let (p, members, mass) = (&mut composites[body.parent], self.subtrees.of(k), self.carried[k]);
            with_turn!(body, j, &oblique[k], t => {
                momenta[k] = momentum(t, &own, mass, body.sign);
                pass(t, j.offset(), body.sign, members, momenta, m);
                carry(t, &own, mass, j.offset(), p);
            });
        }
        // The base last: what has arrived there are the first six columns of each row.
        base_rows(self.mass(), &composites[0], m);
        for g in gyros {
            g.add_momenta(&spins[g.index], momenta);
        }
        for (k, t) in momenta.iter().enumerate().skip(1) {
            let at = self.paths.start[k + 5];
            let six = [t.x[0], t.y[0], t.z[0], t.x[1], t.y[1], t.z[1]];
            m[at..at + 6].copy_from_slice(&six);
        }
        for g in &self.gyros {
            g.add_entries(&spins[g.index], m);
        }
    }
}

/// Takes the entries of a joint out of the momenta that pass it, and carries these to the parent's origin and axes.
#[inline(always)]
fn pass<T: Turn>(t: T, r: Option<V3>, sign: f64, members: &[[u32; 2]], momenta: &mut [Twin], m: &mut [f64]) {
    for &[d, at] in members {
        let Some(momentum) = momenta.get_mut(d as usize) else { continue };
        m[at as usize] = t.part(choose(t, momentum.second(), momentum.first())) * sign;
        let mut up = t.up_twin(*momentum);
        if let Some(r) = r {
            up.add_second(r.cross(up.first()));
        }
        *momentum = up;
    }
}

/// Adds a composite of mass `m` whose origin is at `r` in the parent's frame.
#[inline(always)]
fn carry<T: Turn>(t: T, own: &Composite, m: f64, r: Option<V3>, p: &mut Composite) {
    let mc = t.up(own.mc);
    p.mc += mc;
    p.i += t.up_sym(own.i);
    let Some(r) = r else { return };
    // Moments about a point r away: I + m (r.r E - r r^T) + (2 r.mc E - r mc^T - mc r^T), with u = mc + m r/2.
    p.mc += r * m;
    let u = mc + r * (0.5 * m);
    let (xx, yy, zz) = (r.x * u.x, r.y * u.y, r.z * u.z);
    p.i.xx += 2.0 * (yy + zz);
    p.i.yy += 2.0 * (xx + zz);
    p.i.zz += 2.0 * (xx + yy);
    p.i.xy -= r.x * u.y + r.y * u.x;
    p.i.xz -= r.x * u.z + r.z * u.x;
    p.i.yz -= r.y * u.z + r.z * u.y;
}

/// Momentum and moment of momentum about the body's origin for unit speed of its joint's coordinate.
#[inline(always)]
fn momentum<T: Turn>(t: T, c: &Composite, m: f64, sign: f64) -> Twin {
    if T::SLIDES {
        Twin::new(t.plus(V3::default(), m * sign), t.across(c.mc, sign))
    } else {
        Twin::new(t.across(c.mc, -sign), t.column(c.i) * sign)
    }
}

/// The six rows of the base: m E, m c~, I.
fn base_rows(mass: f64, c: &Composite, m: &mut [f64]) {
    let (mc, i) = (c.mc, c.i);
    let rows: [&[f64]; 6] = [
        &[mass],
        &[0.0, mass],
        &[0.0, 0.0, mass],
        &[0.0, -mc.z, mc.y, i.xx],
        &[mc.z, 0.0, -mc.x, i.xy, i.yy],
        &[-mc.y, mc.x, 0.0, i.xz, i.yz, i.zz],
    ];
    let mut at = 0;
    for row in rows {
        m[at..at + row.len()].copy_from_slice(row);
        at += row.len();
    }
}
