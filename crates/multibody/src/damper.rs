//! Damping taken at the end of a step: what an implicit method adds to the mass matrix.
//!
//! A torque `t - b w+` along a transmission w = c q', with w+ = w + h (c q''), gives (M + h b c^T c) q'' = ... : the
//! entries of the joints of one limb, which the rows of the mass matrix have already.

use crate::data::Data;
use crate::error::ModelError;
use crate::forward::{factor, solve};
use crate::model::Model;
use crate::rotor::Rotor;

/// Inertia-like term along a transmission of up to three joints of one limb, see [`Model::solve_damped`].
#[derive(Clone, Debug)]
pub struct Damper {
    entries: Vec<[usize; 3]>,
    ratio: [f64; Rotor::JOINTS],
    inertia: f64,
}

impl Damper {
    /// Ratios c of the joints, in the order of [`Model::damper`], and h b \[kg m^2\].
    pub fn set(&mut self, ratio: [f64; Rotor::JOINTS], inertia: f64) {
        (self.ratio, self.inertia) = (ratio, inertia);
    }
}

impl Model {
    /// A damper along a transmission to joints of one limb.
    pub fn damper(&self, joints: &[usize]) -> Result<Damper, ModelError> {
        let entries = self.pairs(joints).map_err(|why| ModelError::Rotor("damper".into(), why))?;
        Ok(Damper { entries, ratio: [0.0; Rotor::JOINTS], inertia: 0.0 })
    }

    /// Mass matrix, kept in `data`, and nonlinear terms `h` at the configuration that `data` has.
    pub fn dynamics_here(&self, data: &mut Data, v: &[f64], h: &mut [f64]) {
        self.rows(data);
        self.nonlinear_terms_here(data, v, h);
    }

    /// Solves (M + dampers) x = b in place, after [`Model::dynamics_here`], as often as wanted.
    pub fn solve_damped(&self, data: &mut Data, dampers: &[Damper], x: &mut [f64]) {
        assert_eq!(x.len(), self.nv(), "length of the right-hand side");
        let Data { m, l, .. } = data;
        l.copy_from_slice(m);
        for d in dampers.iter().filter(|d| d.inertia != 0.0) {
            for &[a, b, at] in &d.entries {
                l[at] += d.inertia * d.ratio[a] * d.ratio[b];
            }
        }
        factor(&self.paths, l);
        solve(&self.paths, l, x);
    }

    /// Takes an acceleration found by [`Model::solve_damped`] to the bodies, for [`Model::rotor_acceleration`].
    pub fn accelerate(&self, data: &mut Data, v: &[f64], acceleration: &[f64]) {
        self.turn_bodies(data, v, acceleration);
    }
}
