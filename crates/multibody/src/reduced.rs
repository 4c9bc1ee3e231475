//! Base dynamics of the reduced model: joints follow prescribed motions, the base is free (2.74)-(2.81).

use nalgebra::{Matrix6, Vector6};

use crate::data::Data;
use crate::model::Model;
use crate::space::{V3, ZERO};

impl Model {
    /// (M_TT, h_T + M_TJ q''_J) at `q`, `v` for prescribed joint accelerations (n) \[rad/s^2\].
    ///
    /// The base's acceleration in base axes (v' of its six) is M_TT^-1 (J_T^T f - bias) (2.80), where J_T^T f is force
    /// and moment about the base's origin in base axes of all that acts from outside. One composite sweep and one
    /// inverse dynamics with the base held.
    pub fn base_dynamics(
        &self,
        data: &mut Data,
        q: &[f64],
        v: &[f64],
        joint_acceleration: &[f64],
    ) -> (Matrix6<f64>, Vector6<f64>) {
        self.set_position(data, q);
        self.base_dynamics_here(data, v, joint_acceleration)
    }

    /// [`Model::base_dynamics`] at the configuration that `data` has.
    pub fn base_dynamics_here(
        &self,
        data: &mut Data,
        v: &[f64],
        joint_acceleration: &[f64],
    ) -> (Matrix6<f64>, Vector6<f64>) {
        assert_eq!(joint_acceleration.len(), self.n(), "length of the joint acceleration");
        self.composites(data);
        self.sweeps(data, v, (ZERO, ZERO), |k| joint_acceleration[k - 1], |_, _| ());
        let (c, l, m) = (&data.composites[0], &data.locals[0], self.mass());
        let (x, i) = (c.mc, c.i);
        #[rustfmt::skip]
        let m_tt = Matrix6::new(
            m,    0.0,  0.0,  0.0,  x.z,  -x.y,
            0.0,  m,    0.0,  -x.z, 0.0,  x.x,
            0.0,  0.0,  m,    x.y,  -x.x, 0.0,
            0.0,  -x.z, x.y,  i.xx, i.xy, i.xz,
            x.z,  0.0,  -x.x, i.xy, i.yy, i.yz,
            -x.y, x.x,  0.0,  i.xz, i.yz, i.zz,
        );
        let V3 { x, y, z } = l.f;
        (m_tt, Vector6::new(x, y, z, l.n.x, l.n.y, l.n.z))
    }
}
