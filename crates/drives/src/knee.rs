//! Knee: a roller screw between a pivot on the thigh and one on the shank; its motor turns with the screw.
//!
//! | symbol | name | unit | frame |
//! |---|---|---|---|
//! | t_r_B | `pivot`: where the screw hangs on the thigh | m | thigh |
//! | t_r_pc | `joint`: origin of the shank frame | m | thigh |
//! | s_r_a | `attachment`: where the nut hangs on the shank | m | shank |
//! | a | `axis` of the joint | 1 | thigh and shank |
//! | P | `lead` of the screw, negative for a left-hand thread | m/rev | |
//! | r, l | vector and distance between the pivots | m | thigh |
//!
//! Source: (2.14)-(2.21) as in errata 1, F4: the vector to the knee axis begins at the pivot, the rate of the screw is
//! that of its length, and a second derivative that the thesis leaves out. Frames are parallel at joint angle 0.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use crate::turn::Rotation;
use crate::{Gear, OutOfDomain};

/// \[1\] Lever, and length of the screw, over the size of the linkage that count as none.
const LEAST_LEVER: f64 = 1e-6;

/// Places of a knee's parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KneeGeometry {
    /// \[1\] Unit vector of the joint's axis.
    pub axis: [f64; 3],
    /// \[m\] Origin of the joint, in the upper link.
    pub joint: [f64; 3],
    /// \[m\] Pivot of the screw, in the upper link.
    pub pivot: [f64; 3],
    /// \[m\] Pivot of the nut, in the lower link.
    pub attachment: [f64; 3],
    /// \[m\] Lead of the screw in one revolution; negative for a left-hand thread.
    pub lead: f64,
}

/// Transmission of a knee.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knee {
    geometry: KneeGeometry,
    /// a
    axis: Vector3<f64>,
    /// t_r_pc - t_r_B \[m\]
    base: Vector3<f64>,
    /// s_r_a \[m\]
    attachment: Vector3<f64>,
    /// 2π/P \[rad/m\]
    turns: f64,
    /// l at angle 0 \[m\]
    rest: f64,
    /// Sign of l' at angle 0: the side of the joint on which the screw stays.
    side: f64,
    /// Least lever and length \[m\].
    least: f64,
}

impl Knee {
    /// The linkage; an error if the screw points at the joint where the joint angle is 0.
    pub fn new(geometry: &KneeGeometry) -> Result<Self, OutOfDomain> {
        let base = Vector3::from(geometry.joint) - Vector3::from(geometry.pivot);
        let (axis, attachment) =
            (Vector3::from(geometry.axis).normalize(), Vector3::from(geometry.attachment));
        let r = base + attachment;
        let side = axis.cross(&attachment).dot(&r).signum();
        let least = LEAST_LEVER * (base.norm() + attachment.norm());
        let geometry = *geometry;
        let knee = Self {
            geometry,
            axis,
            base,
            attachment,
            turns: TAU / geometry.lead,
            rest: r.norm(),
            side,
            least,
        };
        knee.at(0.0, 0.0).map(|_| knee)
    }

    /// Geometry that it was made of.
    pub fn geometry(&self) -> &KneeGeometry {
        &self.geometry
    }

    /// Angle, ratio and bias of the motor at joint angle `q` \[rad\] and speed `qd` \[rad/s\].
    pub(crate) fn at(&self, q: f64, qd: f64) -> Result<Gear, OutOfDomain> {
        let s = Rotation::new(self.axis, q).of(&self.attachment);
        let r = self.base + s; // (2.15)
        let rp = self.axis.cross(&s);
        let rpp = self.axis.cross(&rp);
        let l = r.norm(); // (2.16)
        let lever = rp.dot(&r) / l; // l' (2.17)
        if !(lever * self.side > self.least && l > self.least) {
            return Err(if lever.is_finite() {
                OutOfDomain::Lever { margin: lever * self.side }
            } else {
                OutOfDomain::NotFinite
            });
        }
        let bend = (rpp.dot(&r) + rp.norm_squared() - lever * lever) / l; // l'' (F4)
        Ok(Gear {
            angle: self.turns * (l - self.rest),   // (2.18)
            ratio: [self.turns * lever, 0.0, 0.0], // (2.21)
            bias: self.turns * bend * qd * qd,     // (F4)
        })
    }

    /// Joint angle \[rad\] of a motor angle \[rad\], in closed form: l² = const + 2 (A cos q + B sin q).
    pub fn joint_angle(&self, angle: f64) -> Result<f64, OutOfDomain> {
        let along = self.axis * self.axis.dot(&self.attachment);
        let (a, b) =
            (self.base.dot(&(self.attachment - along)), self.base.dot(&self.axis.cross(&self.attachment)));
        let l = self.rest + angle / self.turns;
        let fixed = self.base.norm_squared() + self.attachment.norm_squared() + 2.0 * self.base.dot(&along);
        let cosine = (l * l - fixed) / (2.0 * a.hypot(b));
        if !(l > 0.0 && cosine.abs() < 1.0) {
            let nearest = (fixed + 2.0 * a.hypot(b) * cosine.signum()).max(0.0).sqrt();
            let residual = ((nearest - l) * self.turns).abs();
            return Err(if residual.is_finite() {
                OutOfDomain::NoAngle { residual }
            } else {
                OutOfDomain::NotFinite
            });
        }
        let q = b.atan2(a) - self.side * cosine.acos();
        Ok(q.sin().atan2(q.cos()))
    }
}
