//! Centre of gravity and momentum of the whole robot.

use nalgebra::{Const, Dyn, Matrix, RawStorageMut, Vector3};

use crate::body::JointKernel;
use crate::data::Data;
use crate::model::Model;
use crate::space::{V3, ZERO};

/// Momentum of the robot about its centre of gravity, world axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Momentum {
    /// \[N s\]
    pub linear: Vector3<f64>,
    /// \[N m s\]
    pub angular: Vector3<f64>,
}

impl Model {
    /// \[m\] Centre of gravity in the world. Leaves in `data` what [`Model::cog_jacobian`] needs. Needs
    /// [`Model::forward_kinematics`].
    pub fn cog(&self, data: &mut Data) -> Vector3<f64> {
        let Data { places, moments, .. } = data;
        for ((to, p), b) in moments.iter_mut().zip(places.iter()).zip(&self.bodies) {
            *to = p.r * b.m + p.a * b.mc;
        }
        for k in (1..self.bodies.len()).rev() {
            let carried = moments[k];
            moments[self.bodies[k].parent] += carried;
        }
        (moments[0] * (1.0 / self.mass())).into()
    }

    /// \[m\] Centre of gravity of all that a joint carries, in the world, and its derivative to the joint's coordinate.
    /// Needs [`Model::cog`].
    pub fn carried_cog(&self, data: &Data, joint: usize) -> (Vector3<f64>, Vector3<f64>) {
        let k = joint + 1;
        let (p, com) = (&data.places[k], data.moments[k] * (1.0 / self.carried[k]));
        let rate = match self.bodies[k].kind {
            JointKernel::Along(_) => p.e,
            _ => p.e.cross(com - p.r),
        };
        (com.into(), rate.into())
    }

    /// \[m/s\], \[m/s^2\] Velocity of the centre of gravity, and its acceleration when v' = 0 (J' v). Needs
    /// [`Model::forward_motion`].
    pub fn cog_motion(&self, data: &Data) -> (Vector3<f64>, Vector3<f64>) {
        let (mut v, mut dv) = (ZERO, ZERO);
        for ((m, p), b) in data.motions.iter().zip(&data.places).zip(&self.bodies) {
            let mc = p.a * b.mc;
            v += m.v * b.m + m.w.cross(mc);
            dv += m.dv * b.m + m.dw.cross(mc) + m.w.cross(m.w.cross(mc));
        }
        let per_mass = 1.0 / self.mass();
        ((v * per_mass).into(), (dv * per_mass).into())
    }

    /// Jacobian of the centre of gravity, 3 x n_v, world axes. Needs [`Model::cog`].
    pub fn cog_jacobian<S>(&self, data: &Data, jacobian: &mut Matrix<f64, Const<3>, Dyn, S>)
    where
        S: RawStorageMut<f64, Const<3>, Dyn>,
    {
        assert_eq!(jacobian.ncols(), self.nv(), "columns of the Jacobian");
        let base = &data.places[0];
        let d = data.moments[0] * (1.0 / self.mass()) - base.r;
        for (k, e) in [base.a.x, base.a.y, base.a.z].into_iter().enumerate() {
            set(jacobian, k, e);
            set(jacobian, k + 3, e.cross(d));
        }
        self.cog_columns(data, 6, jacobian);
    }

    /// Only the joints' columns of [`Model::cog_jacobian`], 3 x n: the motion against the base, in world axes.
    pub fn cog_jacobian_of_joints<S>(&self, data: &Data, jacobian: &mut Matrix<f64, Const<3>, Dyn, S>)
    where
        S: RawStorageMut<f64, Const<3>, Dyn>,
    {
        assert_eq!(jacobian.ncols(), self.n(), "columns of the Jacobian");
        self.cog_columns(data, 0, jacobian);
    }

    fn cog_columns<S>(&self, data: &Data, first: usize, jacobian: &mut Matrix<f64, Const<3>, Dyn, S>)
    where
        S: RawStorageMut<f64, Const<3>, Dyn>,
    {
        let per_mass = 1.0 / self.mass();
        for (k, body) in self.bodies.iter().enumerate().skip(1) {
            let (p, m) = (&data.places[k], self.carried[k]);
            let column = match body.kind {
                JointKernel::Along(_) => p.e * m,
                _ => p.e.cross(data.moments[k] - p.r * m),
            };
            set(jacobian, first + k - 1, column * per_mass);
        }
    }

    /// Momentum and angular momentum about the centre of gravity, (3.4) with the term `m rho x v_o` that the print
    /// lacks (errata, F13), rotors included. Needs [`Model::forward_motion`].
    pub fn momentum(&self, data: &Data) -> Momentum {
        let (mut p, mut l, mut mc) = (ZERO, ZERO, ZERO);
        for ((m, place), b) in data.motions.iter().zip(&data.places).zip(&self.bodies) {
            let rho = place.a * b.mc;
            let impulse = m.v * b.m + m.w.cross(rho);
            p += impulse;
            mc += place.r * b.m + rho;
            l += place.r.cross(impulse) + rho.cross(m.v) + place.a * (b.i * place.a.t_mul(m.w)); // (3.4)
        }
        let w = |k: usize| data.places[k].a.t_mul(data.motions[k].w);
        for (k, spin, _) in self.rotor_terms(&data.spins, w) {
            l += data.places[k].a * spin;
        }
        let c = mc * (1.0 / self.mass());
        Momentum { linear: p.into(), angular: (l - c.cross(p)).into() }
    }

    /// \[J\] Kinetic and potential energy (zero at world height zero), rotors included. Needs [`Model::forward_motion`].
    pub fn energy(&self, data: &Data) -> (f64, f64) {
        let (mut kinetic, mut height) = (0.0, 0.0);
        for ((m, p), b) in data.motions.iter().zip(&data.places).zip(&self.bodies) {
            let (rho, w) = (p.a * b.mc, p.a.t_mul(m.w));
            kinetic += 0.5 * (b.m * m.v.dot(m.v) + w.dot(b.i * w)) + m.v.dot(m.w.cross(rho));
            height += b.m * p.r.z + rho.z;
        }
        let w = |k: usize| data.places[k].a.t_mul(data.motions[k].w);
        kinetic += self.rotor_terms(&data.spins, w).map(|(_, _, energy)| energy).sum::<f64>();
        (kinetic, -crate::model::G.z * height)
    }
}

#[inline(always)]
fn set<S>(jacobian: &mut Matrix<f64, Const<3>, Dyn, S>, column: usize, v: V3)
where
    S: RawStorageMut<f64, Const<3>, Dyn>,
{
    let mut to = jacobian.column_mut(column);
    (to[0], to[1], to[2]) = (v.x, v.y, v.z);
}
