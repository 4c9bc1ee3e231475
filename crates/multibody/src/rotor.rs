//! Motor rotors as gyrostats.
//!
//! The thesis gives every motor a body of its own. A rotor is symmetric about its axis, so that neither mass nor
//! moments of inertia of stator and rotor together change when it turns: it is enough to keep both as one body, rotor
//! locked, and to add what the turning brings. Nothing is lost by that, and a rotor costs a few products in place of a
//! body.
//!
//! | symbol | name | unit | frame |
//! |---|---|---|---|
//! | j | moment of inertia about the rotor's axis | kg m^2 | |
//! | e | axis | 1 | stator's body |
//! | s | speed of the rotor against the stator, `phi'` | rad/s | |
//! | ds | its rate, `phi''` | rad/s^2 | |
//! | c | transmission `phi' = sum c_i q_i'`, also with c_i that depend on q | 1 | |
//! | w, dw | angular velocity and acceleration of the stator | rad/s | stator's body |
//!
//! Locked, the rotor would have the moment of momentum `j e (e.w)`; turning adds `j s e`. So to the kinetic energy comes
//! `j s (e.w) + j s^2 / 2`, to the moment on the stator `j ds e + w x (j s e)`, and the rotor's own equation is
//! `j (ds + e.dw) = torque about its axis`. A geared rotor hands this torque to its joints, c_i times; a free one takes
//! it from the caller.

use nalgebra::Vector3;

use crate::body::Body;
use crate::data::{Data, Local};
use crate::error::ModelError;
use crate::gyro::{Gyro, MOST_JOINTS, Spin};
use crate::inertia::{Inertia, least};
use crate::model::Model;
use crate::space::V3;

/// A rotor that [`Model::with_rotors`] puts into a link.
#[derive(Clone, Debug, PartialEq)]
pub struct Rotor {
    /// Unique among the rotors.
    pub name: String,
    /// Link that carries the stator. Its mass and inertia contain the rotor's, as if locked.
    pub link: String,
    /// Axis in the link's axes, of any length above zero; the rotor counts positive about it.
    pub axis: Vector3<f64>,
    /// \[kg m^2\] Moment of inertia about the axis.
    pub inertia: f64,
    /// Joints that the rotor is geared to, at most [`Rotor::JOINTS`], all carried by `link` and one by the other; none for
    /// a rotor that turns by itself, as behind an elastic gear.
    pub joints: Vec<usize>,
}

impl Rotor {
    /// Most joints one rotor can be geared to.
    pub const JOINTS: usize = MOST_JOINTS;
}

impl Model {
    /// The same robot with rotors, numbered as listed. Until [`Data::set_gear`] gives its transmission a geared rotor is
    /// locked. Free rotors are no part of v, the mass matrix and the generalized force.
    ///
    /// [`Model::forward_dynamics_articulated`] knows no rotors.
    pub fn with_rotors(mut self, rotors: &[Rotor]) -> Result<Model, ModelError> {
        for rotor in rotors {
            let fault = |why: String| ModelError::Rotor(rotor.name.clone(), why);
            if self.rotor_names.contains(&rotor.name) {
                return Err(ModelError::Duplicate(rotor.name.clone()));
            }
            let gyro = self.gyro(rotor).map_err(fault)?;
            // A free rotor does not turn along about its axis: the stator's inertia loses that part.
            if gyro.geared.is_empty() {
                let stator = &mut self.bodies[gyro.body];
                stator.i += gyro.inertia() * -1.0;
                stator.s = Body::second_moments(stator.i);
                self.own[gyro.body] = stator.own();
            }
            self.rotor_names.push(rotor.name.clone());
            self.gyros.push(gyro);
            let body = self.gyros[self.gyros.len() - 1].body;
            let left = self.least_moment_without_rotors(body);
            if !(left > 0.0) {
                return Err(fault(format!(
                    "link `{}` must contain the inertia of its rotors, but without them its smallest principal moment is {left:.6e} kg m^2; correct the rotor's inertia or the link's",
                    rotor.link
                )));
            }
        }
        self.gyros.sort_by_key(|g| g.body);
        Ok(self)
    }

    /// Names of the rotors in the order of their indices.
    pub fn rotor_names(&self) -> &[String] {
        &self.rotor_names
    }

    fn gyro(&self, rotor: &Rotor) -> Result<Gyro, String> {
        let link = self.links.iter().find(|l| l.name == rotor.link);
        let link = link.ok_or_else(|| format!("link `{}` does not exist; correct the name", rotor.link))?;
        if !(rotor.inertia > 0.0 && rotor.inertia.is_finite()) {
            return Err(format!("inertia is {} kg m^2, must be above zero", rotor.inertia));
        }
        let e = (link.pose.rotation * rotor.axis)
            .try_normalize(1e-9)
            .filter(|e| e.iter().all(|x| x.is_finite()))
            .ok_or("the axis must be finite and longer than zero; correct it")?;
        if rotor.joints.len() > Rotor::JOINTS {
            return Err(format!(
                "geared to {} joints, at most {} are possible",
                rotor.joints.len(),
                Rotor::JOINTS
            ));
        }
        if let Some(j) = rotor.joints.iter().find(|&&j| j >= self.n()) {
            return Err(format!("joint {j} does not exist; name one below {}", self.n()));
        }
        // Its joints hang on the stator: a rotor turns what lies beyond it.
        let geared: Vec<usize> = rotor.joints.iter().map(|j| j + 1).collect();
        if let Some(&k) = geared.iter().find(|&&k| k == link.body || !self.carries(link.body, k)) {
            return Err(format!(
                "joint `{}` is not carried by link `{}`; name a link between it and the base",
                self.joint_names[k - 1],
                rotor.link
            ));
        }
        let entries = self.pairs(&rotor.joints)?;
        let index = self.gyros.len();
        Ok(Gyro { index, body: link.body, j: rotor.inertia, e: e.into(), geared, entries })
    }

    /// For every pair a, b <= a of joints of one limb the place of its entry in the rows of the mass matrix.
    pub(crate) fn pairs(&self, joints: &[usize]) -> Result<Vec<[usize; 3]>, String> {
        let mut entries = Vec::new();
        for (a, &k) in joints.iter().enumerate() {
            for (b, &l) in joints.iter().enumerate().take(a + 1) {
                if (a == b) != (k == l) {
                    return Err(format!("joint `{}` is listed twice", self.joint_names[k]));
                }
                let (row, column) = (k.max(l) + 6, k.min(l) + 6);
                let columns = &self.paths.column[self.paths.row(row)];
                let at = columns.iter().position(|&c| c == column).ok_or_else(|| {
                    format!(
                        "joints `{}` and `{}` are on different limbs; split the rotor",
                        self.joint_names[l], self.joint_names[k]
                    )
                })?;
                entries.push([a, b, self.paths.start[row] + at]);
            }
        }
        Ok(entries)
    }

    /// True if the body k is `carrier` or hangs on it.
    fn carries(&self, carrier: usize, mut k: usize) -> bool {
        while k > carrier {
            k = self.bodies[k].parent;
        }
        k == carrier
    }

    /// \[kg m^2\] Smallest principal moment of a body about its centre of gravity, its rotors free about their axes.
    fn least_moment_without_rotors(&self, body: usize) -> f64 {
        let b = &self.bodies[body];
        let geared = self.gyros.iter().filter(|g| g.body == body && !g.geared.is_empty());
        let i = geared.fold(b.i, |i, g| i + g.inertia() * -1.0);
        least(&Inertia::about_origin(b.m, (b.mc * (1.0 / b.m)).into(), i.matrix()).moments)
    }

    /// \[rad/s^2\] Acceleration `phi''` of a free rotor against its stator under the torque of
    /// [`Data::set_free_rotor`], after [`Model::forward_dynamics`] or [`Model::inverse_dynamics`]; after
    /// [`Model::nonlinear_terms`] that at v' = 0.
    pub fn rotor_acceleration(&self, data: &Data, rotor: usize) -> f64 {
        let own = |g: &&Gyro| g.index == rotor;
        self.gyros
            .iter()
            .find(own)
            .map_or(f64::NAN, |g| data.spins[rotor].torque / g.j - g.e.dot(data.locals[g.body].dw))
    }

    /// Speeds of the geared rotors.
    pub(crate) fn rotor_speeds(&self, spins: &mut [Spin], v: &[f64]) {
        for g in &self.gyros {
            if !g.geared.is_empty() {
                spins[g.index].s = g.through(&spins[g.index], |k| v[k + 5]);
            }
        }
    }

    /// Adds the rotors' demands on their stators, between the sweeps of the inverse dynamics.
    #[inline(always)]
    pub(crate) fn load_stators(
        &self,
        locals: &mut [Local],
        spins: &mut [Spin],
        v: &[f64],
        qdd: impl Fn(usize) -> f64,
    ) {
        self.rotor_speeds(spins, v);
        for g in &self.gyros {
            let (spin, stator) = (&mut spins[g.index], &mut locals[g.body]);
            let rate = if g.geared.is_empty() {
                spin.torque
            } else {
                spin.ds = g.through(spin, &qdd) + spin.bias;
                g.j * spin.ds
            };
            stator.n += g.e * rate + stator.w.cross(g.momentum(spin, stator.w));
        }
    }

    /// Adds the rotors' own torques to the joints they are geared to.
    pub(crate) fn load_joints(&self, data: &Data, force: &mut [f64]) {
        for g in &self.gyros {
            let spin = &data.spins[g.index];
            let torque = g.j * (g.e.dot(data.locals[g.body].dw) + spin.ds);
            for (&k, c) in g.geared.iter().zip(spin.ratio) {
                force[k + 5] += c * torque;
            }
        }
    }

    /// Moment of momentum and kinetic energy of the rotors beyond what the bodies' own inertia holds: (stator's body,
    /// moment of momentum in its axes, energy), each for the stator's angular velocity given by body.
    pub(crate) fn rotor_terms<'a>(
        &'a self,
        spins: &'a [Spin],
        w: impl Fn(usize) -> V3 + 'a,
    ) -> impl Iterator<Item = (usize, V3, f64)> + 'a {
        self.gyros.iter().map(move |g| {
            let (spin, w) = (&spins[g.index], w(g.body));
            let along = g.e.dot(w);
            let energy = if g.geared.is_empty() {
                0.5 * g.j * (along + spin.s) * (along + spin.s)
            } else {
                g.j * spin.s * (along + 0.5 * spin.s)
            };
            (g.body, g.momentum(spin, w), energy)
        })
    }
}

impl Data {
    /// Transmission of a geared rotor: `phi' = sum ratio_i q_i'` over its joints in the order of [`Rotor::joints`], and
    /// `bias` \[rad/s^2\] = `sum ratio_i' q_i'`, so that `phi'' = sum ratio_i q_i'' + bias`.
    pub fn set_gear(&mut self, rotor: usize, ratio: [f64; Rotor::JOINTS], bias: f64) {
        let spin = &mut self.spins[rotor];
        (spin.ratio, spin.bias) = (ratio, bias);
    }

    /// Speed `phi'` \[rad/s\] of a free rotor against its stator, and the torque \[N m\] on it about its axis; the stator
    /// feels the opposite one.
    pub fn set_free_rotor(&mut self, rotor: usize, speed: f64, torque: f64) {
        let spin = &mut self.spins[rotor];
        (spin.s, spin.torque) = (speed, torque);
    }

    /// \[rad/s\] Speed of a rotor against its stator, as last given or found.
    pub fn rotor_speed(&self, rotor: usize) -> f64 {
        self.spins[rotor].s
    }
}
