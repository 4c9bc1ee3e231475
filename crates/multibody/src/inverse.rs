//! Inverse dynamics: M v' + h of (2.34)-(2.36), by one sweep out and one sweep back.
//!
//! | symbol | name | unit | axes |
//! |---|---|---|---|
//! | w, dw | angular velocity and acceleration of a body | rad/s | body |
//! | k | `dw~ + w~ w~`: a point r of the body has the acceleration a + k r | 1/s^2 | body |
//! | a | acceleration of its origin, less gravity | m/s^2 | body |
//! | f, n | force, and moment about its origin, for the body and all it carries | N, N m | body |
//! | m, mc, s | mass, first moment, second moments about the origin (integral of r r^T) | | body |
//!
//! The sweep needs no linear velocities. Gravity enters as the base's acceleration -g with g = (0, 0, -9.81); the
//! print of (2.36) has the opposite sign (errata).

use nalgebra::Vector3;

use crate::body::Body;
use crate::data::{Data, Local, with_turn};
use crate::model::{Frame, G, Model};
use crate::space::{Mat3, V3, ZERO, v3};
use crate::turn::Turn;

impl Model {
    /// Generalized force that gives `acceleration` (v') at `q`, `v`: M v' + h, length n_v each.
    pub fn inverse_dynamics(
        &self,
        data: &mut Data,
        q: &[f64],
        v: &[f64],
        acceleration: &[f64],
        force: &mut [f64],
    ) {
        self.set_position(data, q);
        self.inverse_dynamics_here(data, v, acceleration, force);
    }

    /// [`Model::inverse_dynamics`] at the configuration that `data` has.
    pub fn inverse_dynamics_here(&self, data: &mut Data, v: &[f64], acceleration: &[f64], force: &mut [f64]) {
        assert_eq!(acceleration.len(), self.nv(), "length of the acceleration");
        assert_eq!(force.len(), self.nv(), "length of the generalized force");
        let base = (V3::from_slice(acceleration), V3::from_slice(&acceleration[3..]));
        self.sweeps(data, v, base, |k| acceleration[k + 5], |k, x| force[k + 5] = x);
        collect(data, force);
        self.load_joints(data, force);
    }

    /// Nonlinear terms h at `q`, `v`: Coriolis, centrifugal and weight; M v' + h = generalized force.
    pub fn nonlinear_terms(&self, data: &mut Data, q: &[f64], v: &[f64], h: &mut [f64]) {
        self.set_position(data, q);
        self.nonlinear_terms_here(data, v, h);
    }

    /// [`Model::nonlinear_terms`] at the configuration that `data` has.
    pub fn nonlinear_terms_here(&self, data: &mut Data, v: &[f64], h: &mut [f64]) {
        assert_eq!(h.len(), self.nv(), "length of the generalized force");
        self.sweeps(data, v, (ZERO, ZERO), |_| 0.0, |k, x| h[k + 5] = x);
        collect(data, h);
        self.load_joints(data, h);
    }

    /// Force \[N\], and moment \[N m\] about the frame's origin, world axes, that the frame's body and all it carries need
    /// for the motion and against the weight that [`Model::inverse_dynamics`] was last asked about. What a sensor between
    /// the body and its parent measures is this less what acts on these bodies from outside. Needs the pose of the
    /// frame's body at the same configuration.
    pub fn carried_wrench(&self, data: &Data, frame: &Frame) -> (Vector3<f64>, Vector3<f64>) {
        let (place, local) = (&data.places[frame.body], &data.locals[frame.body]);
        let n = local.n - frame.r.cross(local.f);
        ((place.a * local.f).into(), (place.a * n).into())
    }

    /// Both sweeps, with the base's acceleration; leaves force and moment of every body in `data` and hands the force of
    /// the joint of body k to `joint`.
    #[inline(always)]
    pub(crate) fn sweeps(
        &self,
        data: &mut Data,
        v: &[f64],
        base: (V3, V3),
        qdd: impl Fn(usize) -> f64,
        mut joint: impl FnMut(usize, f64),
    ) {
        assert_eq!(v.len(), self.nv(), "length of v");
        let Data { joints, oblique, locals, base: attitude, spins, .. } = data;
        // Outwards: motion of each body, and the force that it takes by itself. Gravity is an acceleration of the base.
        let w = V3::from_slice(&v[3..]);
        let a = base.0 + w.cross(V3::from_slice(v)) - attitude.t_mul(G);
        locals[0] = load(&self.bodies[0], w, base.1, a);
        for (k, body) in self.bodies.iter().enumerate().skip(1) {
            let (p, j) = (&locals[body.parent], &joints[k]);
            let (qd, qdd) = (v[k + 5] * body.sign, qdd(k) * body.sign);
            with_turn!(body, j, &oblique[k], t => locals[k] = out(t, p, j.offset(), qd, qdd, body));
        }
        // Rotors between the sweeps: they need their stators' motion, and load them before the loads are summed.
        self.load_stators(locals, spins, v, &qdd);
        // Inwards: each joint bears its body and all that hangs on it.
        for (k, body) in self.bodies.iter().enumerate().skip(1).rev() {
            let (own, j) = (locals[k], &joints[k]);
            let p = &mut locals[body.parent];
            with_turn!(body, j, &oblique[k], t => {
                joint(k, t.part(choose(t, own.n, own.f)) * body.sign);
                let f = t.up(own.f);
                p.f += f;
                p.n += t.up(own.n);
                if let Some(r) = j.offset() {
                    p.n += r.cross(f);
                }
            });
        }
    }
}

/// The base's part of the generalized force.
fn collect(data: &Data, force: &mut [f64]) {
    let base = &data.locals[0];
    force[..3].copy_from_slice(&base.f.array());
    force[3..6].copy_from_slice(&base.n.array());
}

/// Load of a joint: the moment if it turns, the force if it slides.
#[inline(always)]
pub(crate) fn choose<T: Turn>(_: T, turning: V3, sliding: V3) -> V3 {
    if T::SLIDES { sliding } else { turning }
}

/// Motion of a body from its parent's, and the load of its own inertia.
#[inline(always)]
fn out<T: Turn>(t: T, p: &Local, r: Option<V3>, qd: f64, qdd: f64, body: &Body) -> Local {
    let w = t.down(p.w);
    let dw = t.down(p.dw);
    let a = t.down(r.map_or(p.a, |r| p.a + p.k * r));
    if T::SLIDES {
        load(body, w, dw, t.plus(a + t.across(w, 2.0 * qd), qdd))
    } else {
        load(body, t.plus(w, qd), t.plus(dw + t.across(w, qd), qdd), a)
    }
}

/// Force and moment about the origin that a body's own inertia asks for (2.36), as integrals over its mass of a + k r
/// and r x (a + k r).
#[inline(always)]
fn load(b: &Body, w: V3, dw: V3, a: V3) -> Local {
    let (xy, xz, yz) = (w.x * w.y, w.x * w.z, w.y * w.z);
    let (xx, yy, zz) = (w.x * w.x, w.y * w.y, w.z * w.z);
    let k = Mat3 {
        x: v3(-yy - zz, xy + dw.z, xz - dw.y),
        y: v3(xy - dw.z, -xx - zz, yz + dw.x),
        z: v3(xz + dw.y, yz - dw.x, -xx - yy),
    };
    let (f, s) = (a * b.m + k * b.mc, &b.s);
    // Components of the integral of r x k r: (k s)_zy - (k s)_yz and so on.
    let n = v3(
        k.x.z * s.xy - k.x.y * s.xz + k.y.z * s.yy - k.z.y * s.zz + (zz - yy) * s.yz,
        k.y.x * s.yz - k.y.z * s.xy + k.z.x * s.zz - k.x.z * s.xx + (xx - zz) * s.xz,
        k.z.y * s.xz - k.z.x * s.yz + k.x.y * s.xx - k.y.x * s.yy + (yy - xx) * s.xy,
    );
    Local { w, dw, k, a, f, n: n + b.mc.cross(a) }
}
