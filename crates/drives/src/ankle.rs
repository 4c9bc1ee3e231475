//! Ankle: one of two parallel slider-cranks. A nut travels on a screw along the shank and pulls the foot by a coupler;
//! a belt and a bevel gear on the knee's axis bring the rotation from a motor on the thigh.
//!
//! | symbol | name | unit | frame |
//! |---|---|---|---|
//! | s^a_r_pc | `ankle`: origin of the ankle | m | shank |
//! | a^f_r_pc | `foot`: origin of the foot | m | ankle |
//! | s_r_top | `screw_top`: where l_screw = 0 | m | shank |
//! | e | `screw_axis`: from the top towards the foot | 1 | shank |
//! | f_r_bot | `attachment` of the coupler | m | foot |
//! | L | `coupler`: its length | m | |
//! | P | `lead`, negative for a left-hand thread | m/rev | |
//! | i_bev, i_belt | `bevel`, `belt` ratios | 1 | |
//! | ± | `knee_share`: +1, -1, or 0 for a motor on the shank | 1 | |
//! | r0, r_c | vectors to the coupler's lower end: from the top, from the nut | m | shank |
//!
//! Source: (2.22)-(2.33) as in errata 1, F5: nut, not coupler, in (2.25), (2.26); belt and bevel; second derivative; domain
//! D > 0. Frames are parallel at joint angle 0; joints are knee, adduction (shank to ankle), flexion (ankle to foot).

use std::f64::consts::TAU;

use nalgebra::Vector3;

use crate::turn::Rotation;
use crate::{Gear, OutOfDomain};

/// \[1\] Cosine between coupler and screw at which the coupler counts as standing across it.
const LEAST_COSINE: f64 = 1e-6;

/// Places of an ankle drive's parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnkleGeometry {
    /// \[1\] Unit vector of the adduction axis, in the shank and in the ankle.
    pub adduction_axis: [f64; 3],
    /// \[1\] Unit vector of the flexion axis, in the ankle and in the foot.
    pub flexion_axis: [f64; 3],
    /// \[m\] Origin of the ankle in the shank.
    pub ankle: [f64; 3],
    /// \[m\] Origin of the foot in the ankle.
    pub foot: [f64; 3],
    /// \[m\] Upper end of the screw in the shank.
    pub screw_top: [f64; 3],
    /// \[1\] Direction of the screw in the shank, from its top towards the foot.
    pub screw_axis: [f64; 3],
    /// \[m\] Where the coupler hangs on the foot, in the foot.
    pub attachment: [f64; 3],
    /// \[m\] Length of the coupler.
    pub coupler: f64,
    /// \[m\] Lead of the screw in one revolution; negative for a left-hand thread.
    pub lead: f64,
    /// \[1\] Rotation of the bevel gear on the knee's axis over that of the screw.
    pub bevel: f64,
    /// \[1\] Rotation of the motor over that of the bevel gear.
    pub belt: f64,
    /// \[1\] Share of the knee angle in the rotation of the bevel gear: +1, -1 or 0.
    pub knee_share: f64,
}

/// Transmission of one of the two motors of an ankle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ankle {
    geometry: AnkleGeometry,
    adduction: Vector3<f64>,
    flexion: Vector3<f64>,
    /// s^a_r_pc - s_r_top \[m\]
    base: Vector3<f64>,
    foot: Vector3<f64>,
    attachment: Vector3<f64>,
    /// e
    screw: Vector3<f64>,
    /// L \[m\]
    coupler: f64,
    /// i_belt i_bev 2π/P \[rad/m\]
    turns: f64,
    /// ± i_belt
    knee: f64,
    /// l at angles 0 \[m\]
    rest: f64,
}

/// Position of the nut with derivatives by the ankle's two joints.
pub(crate) struct Nut {
    /// \[m\]
    pub(crate) l: f64,
    /// \[m/rad\]
    pub(crate) dl: [f64; 2],
    /// \[m/s^2\] l'' at q'' = 0.
    pub(crate) bias: f64,
}

impl Ankle {
    /// The linkage; an error if the coupler does not reach where the joint angles are 0.
    pub fn new(geometry: &AnkleGeometry) -> Result<Self, OutOfDomain> {
        let unit = |v: [f64; 3]| Vector3::from(v).normalize();
        let mut ankle = Self {
            geometry: *geometry,
            adduction: unit(geometry.adduction_axis),
            flexion: unit(geometry.flexion_axis),
            base: Vector3::from(geometry.ankle) - Vector3::from(geometry.screw_top),
            foot: Vector3::from(geometry.foot),
            attachment: Vector3::from(geometry.attachment),
            screw: unit(geometry.screw_axis),
            coupler: geometry.coupler,
            turns: geometry.belt * geometry.bevel * TAU / geometry.lead,
            knee: geometry.belt * geometry.knee_share,
            rest: 0.0,
        };
        ankle.rest = ankle.nut([0.0; 2], [0.0; 2])?.l;
        Ok(ankle)
    }

    /// Geometry that it was made of.
    pub fn geometry(&self) -> &AnkleGeometry {
        &self.geometry
    }

    /// Angle, ratio and bias of the motor at joint angles `q` \[rad\] and speeds `qd` \[rad/s\].
    pub(crate) fn at(&self, q: [f64; 3], qd: [f64; 3]) -> Result<Gear, OutOfDomain> {
        let nut = self.nut([q[1], q[2]], [qd[1], qd[2]])?;
        Ok(Gear {
            angle: self.turns * (nut.l - self.rest) + self.knee * q[0], // (2.25), (2.31)
            ratio: [self.knee, self.turns * nut.dl[0], self.turns * nut.dl[1]], // (2.33)
            bias: self.turns * nut.bias,                                // (F5)
        })
    }

    /// The nut at adduction and flexion `q` \[rad\], speeds `qd` \[rad/s\].
    pub(crate) fn nut(&self, q: [f64; 2], qd: [f64; 2]) -> Result<Nut, OutOfDomain> {
        let (e, a, f) = (&self.screw, &self.adduction, &self.flexion);
        let (turn_a, turn_f) = (Rotation::new(*a, q[0]), Rotation::new(*f, q[1]));
        let s = turn_f.of(&self.attachment);
        let x = turn_a.of(&(self.foot + s));
        let r0 = self.base + x; // (2.22)
        let along = r0.dot(e);
        let margin = self.coupler * self.coupler - r0.norm_squared() + along * along; // D (F5)
        if !(margin > (LEAST_COSINE * self.coupler).powi(2)) {
            return Err(if margin.is_finite() {
                OutOfDomain::Coupler { margin }
            } else {
                OutOfDomain::NotFinite
            });
        }
        let root = margin.sqrt(); // r_c . e
        let l = along - root; // (2.24)
        let rc = r0 - e * l;
        let bent = f.cross(&s);
        let d0 = [a.cross(&x), turn_a.of(&bent)]; // dr0/dq
        let dl = [rc.dot(&d0[0]) / root, rc.dot(&d0[1]) / root]; // (2.30)
        let twice = a.cross(&d0[0]) * (qd[0] * qd[0])
            + a.cross(&d0[1]) * (2.0 * qd[0] * qd[1])
            + turn_a.of(&f.cross(&bent)) * (qd[1] * qd[1]); // b0
        let rate = d0[0] * qd[0] + d0[1] * qd[1] - e * (dl[0] * qd[0] + dl[1] * qd[1]); // r_c'
        Ok(Nut { l, dl, bias: (rc.dot(&twice) + rate.norm_squared()) / root })
    }
}
