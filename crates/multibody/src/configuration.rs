//! Steps in the configuration, which is no vector space: the base turns.

use nalgebra::{Quaternion, Vector3};

use crate::model::Model;
use crate::space::{Mat3, V3, v3};

impl Model {
    /// The configuration with the base at the origin, upright, all joints at zero.
    pub fn neutral(&self) -> Vec<f64> {
        let mut q = vec![0.0; self.nq()];
        q[6] = 1.0;
        q
    }

    /// `next` = the configuration after moving from `q` with constant v for `dt` \[s\]: the base along the screw of its
    /// twist (exponential map), joints straight. The quaternion stays of unit length.
    pub fn integrate(&self, q: &[f64], v: &[f64], dt: f64, next: &mut [f64]) {
        assert!(
            q.len() == self.nq() && v.len() == self.nv() && next.len() == self.nq(),
            "lengths of q, v, next"
        );
        let (u, w) = (V3::from_slice(v) * dt, V3::from_slice(&v[3..]) * dt);
        let q0 = [q[3], q[4], q[5], q[6]];
        let (turn, shift) = exponential(u, w);
        let r = V3::from_slice(q) + Mat3::from_quaternion(q0) * shift;
        next[..3].copy_from_slice(&r.array());
        next[3..7].copy_from_slice(&product(q0, turn));
        for k in 0..self.n() {
            next[7 + k] = q[7 + k] + v[6 + k] * dt;
        }
    }

    /// `rate` = dq/dt of the numbers in q, for integrators that treat q as a vector and normalize afterwards.
    pub fn configuration_rate(&self, q: &[f64], v: &[f64], rate: &mut [f64]) {
        assert!(
            q.len() == self.nq() && v.len() == self.nv() && rate.len() == self.nq(),
            "lengths of q, v, rate"
        );
        let q0 = Quaternion::new(q[6], q[3], q[4], q[5]);
        let half = Quaternion::from_imag(Vector3::new(v[3], v[4], v[5]) * 0.5);
        let r = Mat3::from_quaternion([q[3], q[4], q[5], q[6]]) * V3::from_slice(v);
        rate[..3].copy_from_slice(&r.array());
        rate[3..7].copy_from_slice((q0 * half).coords.as_slice());
        rate[7..].copy_from_slice(&v[6..]);
    }
}

/// Quaternion of the rotation vector w, and the way of the origin when it moves with u in the turning axes.
fn exponential(u: V3, w: V3) -> ([f64; 4], V3) {
    let a2 = w.dot(w);
    let a = a2.sqrt();
    let (sin_half, cos_half) = (0.5 * a).sin_cos();
    // half = sin(a/2)/a, b = (1 - cos a)/a^2, c = (a - sin a)/a^3, by series where they cancel.
    let half = if a > 1e-4 { sin_half / a } else { 0.5 - a2 / 48.0 };
    let b = 2.0 * half * half;
    let c = if a > 0.05 {
        (a - a.sin()) / (a * a2)
    } else {
        1.0 / 6.0 - a2 / 120.0 * (1.0 - a2 / 42.0 * (1.0 - a2 / 72.0))
    };
    let wu = w.cross(u);
    ([w.x * half, w.y * half, w.z * half, cos_half], u + wu * b + w.cross(wu) * c)
}

/// Product of two unit quaternions, of unit length again.
fn product(p: [f64; 4], q: [f64; 4]) -> [f64; 4] {
    let (pv, qv) = (v3(p[0], p[1], p[2]), v3(q[0], q[1], q[2]));
    let v = qv * p[3] + pv * q[3] + pv.cross(qv);
    let w = p[3] * q[3] - pv.dot(qv);
    let scale = 1.0 / (v.dot(v) + w * w).sqrt();
    [v.x * scale, v.y * scale, v.z * scale, w * scale]
}
