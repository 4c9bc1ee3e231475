//! Mass matrix (2.35) by composite bodies.
//!
//! The body k and all it carries, taken as rigid, have mass, first moment mc and moments i about k's origin. A unit
//! speed of joint k gives that composite the momentum f and moment of momentum n; carried towards the base, their
//! parts along each joint on the way are the entries of row k. Entries between different branches are zero and are
//! never touched.

use nalgebra::DMatrix;

use crate::data::{Composite, Data, with_turn};
use crate::inverse::choose;
use crate::model::Model;
use crate::space::{Sym3, V3};
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
        let full = mass_matrix.as_mut_slice();
        for (&x, &[at, mirror]) in m.iter().zip(&self.paths.full) {
            full[at as usize] = x;
            full[mirror as usize] = x;
        }
        &data.mass_matrix
    }

    /// Composite bodies, from the tips to the base.
    pub(crate) fn composites(&self, data: &mut Data) {
        let Data { joints, oblique, composites, .. } = data;
        for (c, b) in composites.iter_mut().zip(&self.bodies) {
            *c = Composite { mc: b.mc, i: b.i };
        }
        for (k, body) in self.bodies.iter().enumerate().skip(1).rev() {
            let (own, j) = (composites[k], &joints[k]);
            let p = &mut composites[body.parent];
            with_turn!(body, j, &oblique[k], t => carry(t, &own, self.carried[k], j.r, p));
        }
    }

    /// Composite bodies, and the rows of the mass matrix along the paths.
    ///
    /// A joint's kernel is chosen once for its composite and for all momenta that pass it on their way to the base.
    pub(crate) fn rows(&self, data: &mut Data) {
        let Data { joints, oblique, composites, momenta, spins, m, .. } = data;
        let mut gyros = &self.gyros[..];
        for (c, b) in composites.iter_mut().zip(&self.bodies) {
            *c = Composite { mc: b.mc, i: b.i };
        }
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
                momenta[k] = momentum(t, &own, mass).map(|x| x * body.sign);
                pass(t, j.r, body.sign, members, momenta, m);
                carry(t, &own, mass, j.r, p);
            });
        }
        base_rows(self.mass(), &composites[0], m);
        for g in gyros {
            g.add_momenta(&spins[g.index], momenta);
        }
        for (k, [f, n]) in momenta.iter().enumerate().skip(1) {
            let at = self.paths.start[k + 5];
            m[at..at + 3].copy_from_slice(&f.array());
            m[at + 3..at + 6].copy_from_slice(&n.array());
        }
        for g in &self.gyros {
            g.add_entries(&spins[g.index], m);
        }
    }
}

/// Takes the entries of a joint out of the momenta that pass it, and carries these to the parent's origin and axes.
#[inline(always)]
fn pass<T: Turn>(t: T, r: V3, sign: f64, members: &[[u32; 2]], momenta: &mut [[V3; 2]], m: &mut [f64]) {
    for &[d, at] in members {
        let [f, n] = momenta[d as usize];
        m[at as usize] = t.part(choose(t, n, f)) * sign;
        let f = t.up(f);
        momenta[d as usize] = [f, t.up(n) + r.cross(f)];
    }
}

/// Adds a composite of mass `m` whose origin is at `r` in the parent's frame.
#[inline(always)]
fn carry<T: Turn>(t: T, own: &Composite, m: f64, r: V3, p: &mut Composite) {
    let mc = t.up(own.mc);
    // Moments about a point r away: I + m (r.r E - r r^T) + (2 r.mc E - r mc^T - mc r^T), with u = mc + m r/2.
    let u = mc + r * (0.5 * m);
    let d = 2.0 * r.dot(u);
    let (ru, s) =
        (Sym3 { xx: r.x * u.x, yy: r.y * u.y, zz: r.z * u.z, xy: 0.0, xz: 0.0, yz: 0.0 }, t.up_sym(own.i));
    p.mc += mc + r * m;
    p.i.xx += s.xx + d - 2.0 * ru.xx;
    p.i.yy += s.yy + d - 2.0 * ru.yy;
    p.i.zz += s.zz + d - 2.0 * ru.zz;
    p.i.xy += s.xy - (r.x * u.y + r.y * u.x);
    p.i.xz += s.xz - (r.x * u.z + r.z * u.x);
    p.i.yz += s.yz - (r.y * u.z + r.z * u.y);
}

/// Momentum and moment of momentum about the body's origin for unit speed of its joint.
#[inline(always)]
fn momentum<T: Turn>(t: T, c: &Composite, m: f64) -> [V3; 2] {
    if T::SLIDES {
        [t.plus(V3::default(), m), t.across(c.mc, 1.0)]
    } else {
        [t.across(c.mc, -1.0), t.column(c.i)]
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
