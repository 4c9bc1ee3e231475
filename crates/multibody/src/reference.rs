//! Reference algorithm, which only tests and benchmarks call: forward dynamics in O(n) by articulated bodies, to be compared
//! with [`Model::forward_dynamics`].
//!
//! A body with everything it carries, joints free to move, answers to an acceleration (dw, a) of its origin with
//!
//! ```text
//! n = i   dw + h a + n0        (moment)
//! f = h^T dw + m a + f0        (force)
//! ```
//!
//! i, m symmetric, h any 3 x 3 matrix. Eliminating the joint's own acceleration gives what the parent feels. As in
//! [`crate::inverse`], a is less gravity and only angular velocities are needed. Body axes throughout.

use nalgebra::{Matrix6, Vector6};

use crate::body::Body;
use crate::data::{Articulated, Data, Local, with_turn};
use crate::model::{G, Model};
use crate::space::{Mat3, Sym3, V3, ZERO, v3};
use crate::turn::Turn;

impl Model {
    /// Acceleration v' that the generalized force gives at `q`, `v`; n_v each. The same as
    /// [`Model::forward_dynamics`] by another route, with cost linear in n. For models without rotors.
    pub fn forward_dynamics_articulated(
        &self,
        data: &mut Data,
        q: &[f64],
        v: &[f64],
        force: &[f64],
        acceleration: &mut [f64],
    ) {
        assert!(
            v.len() == self.nv() && force.len() == self.nv(),
            "lengths of v and of the generalized force"
        );
        assert_eq!(acceleration.len(), self.nv(), "length of the acceleration");
        assert!(self.gyros.is_empty(), "articulated bodies have no rotors here; use forward_dynamics");
        self.set_position(data, q);
        let Data { joints, oblique, locals, articulated, base, .. } = data;

        // Outwards: velocities, and what they alone accelerate.
        let w = V3::from_slice(&v[3..]);
        locals[0].w = w;
        articulated[0] = own(&self.bodies[0], w, ZERO, ZERO);
        for (k, body) in self.bodies.iter().enumerate().skip(1) {
            let (p, j, qd) = (locals[body.parent].w, &joints[k], v[k + 5] * body.sign);
            with_turn!(body, j, &oblique[k], t => {
                let (w, cw, ca) = velocities(t, p, j.r, qd);
                locals[k].w = w;
                articulated[k] = own(body, w, cw, ca);
            });
        }
        // Inwards: articulated inertia, with each joint eliminated.
        for (k, body) in self.bodies.iter().enumerate().skip(1).rev() {
            let (before, from) = articulated.split_at_mut(k);
            let j = &joints[k];
            with_turn!(body, j, &oblique[k], t => {
                eliminate(t, &mut from[0], force[k + 5] * body.sign, j.r, &mut before[body.parent]);
            });
        }
        // Outwards again from the base, which nothing holds: accelerations.
        let (dw, a) = free(&articulated[0], V3::from_slice(force), V3::from_slice(&force[3..]));
        locals[0] = Local { w, dw, a, ..Local::default() };
        for (k, body) in self.bodies.iter().enumerate().skip(1) {
            let (p, j) = (&locals[body.parent], &joints[k]);
            let (p_dw, p_a) = (p.dw, p.a);
            with_turn!(body, j, &oblique[k], t => {
                let (qdd, dw, a) = follow(t, &articulated[k], p_dw, p_a, j.r);
                acceleration[k + 5] = qdd * body.sign;
                (locals[k].dw, locals[k].a) = (dw, a);
            });
        }
        let linear = a + base.t_mul(G) - w.cross(V3::from_slice(v));
        acceleration[..3].copy_from_slice(&linear.array());
        acceleration[3..6].copy_from_slice(&dw.array());
    }
}

/// Angular velocity of a body and the accelerations that come from velocities alone.
#[inline(always)]
fn velocities<T: Turn>(t: T, p: V3, r: V3, qd: f64) -> (V3, V3, V3) {
    let w = t.down(p);
    let ca = t.down(p.cross(p.cross(r)));
    if T::SLIDES { (w, ZERO, ca + t.across(w, 2.0 * qd)) } else { (t.plus(w, qd), t.across(w, qd), ca) }
}

/// A body by itself.
#[inline(always)]
fn own(b: &Body, w: V3, cw: V3, ca: V3) -> Articulated {
    let c = b.mc;
    Articulated {
        i: b.i,
        // mc x a
        h: Mat3 { x: v3(0.0, c.z, -c.y), y: v3(-c.z, 0.0, c.x), z: v3(c.y, -c.x, 0.0) },
        m: Sym3 { xx: b.m, yy: b.m, zz: b.m, xy: 0.0, xz: 0.0, yz: 0.0 },
        n: w.cross(b.i * w),
        f: w.cross(w.cross(c)),
        cw,
        ca,
        ..Articulated::NONE
    }
}

/// Eliminates the joint's acceleration and adds the rest to the parent, whose origin is -r away.
#[inline(always)]
fn eliminate<T: Turn>(t: T, b: &mut Articulated, force: f64, r: V3, p: &mut Articulated) {
    // Force of the joint for a unit of each acceleration, and its own resistance.
    let (un, uf, felt) = if T::SLIDES {
        (t.column_of(&b.h), t.column(b.m), t.part(b.f))
    } else {
        (t.column(b.i), t.row_of(&b.h), t.part(b.n))
    };
    let d = 1.0 / if T::SLIDES { t.part(uf) } else { t.part(un) };
    (b.un, b.uf, b.d, b.u) = (un, uf, d, force - felt);

    let (vn, vf) = (un * d, uf * d);
    let i = b.i + outer(un, vn) * -1.0;
    let m = b.m + outer(uf, vf) * -1.0;
    let h = Mat3 { x: b.h.x - vn * uf.x, y: b.h.y - vn * uf.y, z: b.h.z - vn * uf.z };
    let s = b.u;
    let n = b.n + i * b.cw + h * b.ca + vn * s;
    let f = b.f + h.t_mul(b.cw) + m * b.ca + vf * s;

    // To the parent's axes, then to its origin: a_child = a + dw x r, n += r x f.
    let (i, h, m, n, f) = (t.up_sym(i), t.up_mat(h), t.up_sym(m), t.up(n), t.up(f));
    let rm = Mat3 {
        x: r.cross(m * v3(1.0, 0.0, 0.0)),
        y: r.cross(m * v3(0.0, 1.0, 0.0)),
        z: r.cross(m * v3(0.0, 0.0, 1.0)),
    };
    let h_new = Mat3 { x: h.x + rm.x, y: h.y + rm.y, z: h.z + rm.z };
    p.m += m;
    p.h = Mat3 { x: p.h.x + h_new.x, y: p.h.y + h_new.y, z: p.h.z + h_new.z };
    // i' = i - h r~ + (r~ h^T) - r~ m r~  =  i - h_new r~ - (h r~)^T
    p.i += i + shift(&h_new, &h, r) * -1.0;
    p.f += f;
    p.n += n + r.cross(f);
}

/// a b^T for parallel a, b.
#[inline(always)]
fn outer(a: V3, b: V3) -> Sym3 {
    Sym3 { xx: a.x * b.x, yy: a.y * b.y, zz: a.z * b.z, xy: a.x * b.y, xz: a.x * b.z, yz: a.y * b.z }
}

/// g r~ + (h r~)^T, which is symmetric when g = h + r~ m.
#[inline(always)]
fn shift(g: &Mat3, h: &Mat3, r: V3) -> Sym3 {
    // Columns of g r~: r~ = [[0, -z, y], [z, 0, -x], [-y, x, 0]].
    let gx = g.y * r.z - g.z * r.y;
    let gy = g.z * r.x - g.x * r.z;
    let gz = g.x * r.y - g.y * r.x;
    let hx = h.y * r.z - h.z * r.y;
    let hy = h.z * r.x - h.x * r.z;
    let hz = h.x * r.y - h.y * r.x;
    Sym3 {
        xx: gx.x + hx.x,
        yy: gy.y + hy.y,
        zz: gz.z + hz.z,
        xy: gy.x + hx.y,
        xz: gz.x + hx.z,
        yz: gz.y + hy.z,
    }
}

/// Acceleration of the free base under a force and a moment.
fn free(b: &Articulated, force: V3, moment: V3) -> (V3, V3) {
    let mut m = Matrix6::zeros();
    m.fixed_view_mut::<3, 3>(0, 0).copy_from(&b.m.matrix());
    m.fixed_view_mut::<3, 3>(3, 3).copy_from(&b.i.matrix());
    for (k, c) in [b.h.x, b.h.y, b.h.z].into_iter().enumerate() {
        for (l, x) in c.array().into_iter().enumerate() {
            m[(3 + l, k)] = x;
            m[(k, 3 + l)] = x;
        }
    }
    let (f, n) = (force - b.f, moment - b.n);
    let right = Vector6::new(f.x, f.y, f.z, n.x, n.y, n.z);
    // A checked model's matrix is positive definite; NaN in the state stays NaN in the answer.
    let x = m.cholesky().map_or(Vector6::repeat(f64::NAN), |c| c.solve(&right));
    (v3(x[3], x[4], x[5]), v3(x[0], x[1], x[2]))
}

/// Acceleration of a joint and its body from the parent's.
#[inline(always)]
fn follow<T: Turn>(t: T, b: &Articulated, p_dw: V3, p_a: V3, r: V3) -> (f64, V3, V3) {
    let dw = t.down(p_dw) + b.cw;
    let a = t.down(p_a + p_dw.cross(r)) + b.ca;
    let qdd = b.d * (b.u - b.un.dot(dw) - b.uf.dot(a));
    if T::SLIDES { (qdd, dw, t.plus(a, qdd)) } else { (qdd, t.plus(dw, qdd), a) }
}
