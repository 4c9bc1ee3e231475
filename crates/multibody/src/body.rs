//! Bodies and links of the tree, with their joints: constants of the kernels.

use nalgebra::IsometryMatrix3;

use crate::space::{Mat3, Sym3, V3};

/// One rigid body with the joint that moves it, in a frame parallel to the base at zero coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Body {
    pub parent: usize,
    pub kind: JointKernel,
    /// +1 or -1: the coordinate counts along or against the axis of `kind`.
    pub sign: f64,
    /// Origin in the parent's frame at zero coordinate.
    pub r: V3,
    pub m: f64,
    /// First moment of mass m c.
    pub mc: V3,
    /// Moments of inertia about the origin, geared rotors locked, free ones free about their axes.
    pub i: Sym3,
    /// Second moments of mass about the origin, the integral of r r^T, as `i` says them.
    pub s: Sym3,
}

impl Body {
    /// Second moments of mass of the moments of inertia `i`: tr(i)/2 E - i.
    pub(crate) fn second_moments(i: Sym3) -> Sym3 {
        let half = 0.5 * (i.xx + i.yy + i.zz);
        Sym3 { xx: half - i.xx, yy: half - i.yy, zz: half - i.zz, xy: -i.xy, xz: -i.xz, yz: -i.yz }
    }

    pub(crate) fn own(&self) -> Composite {
        Composite { mc: self.mc, i: self.i }
    }

    pub(crate) fn is_finite(&self) -> bool {
        (self.r.dot(self.r) + self.mc.dot(self.mc)).is_finite()
    }
}

/// Joint of a body by its fastest kernel.
#[derive(Clone, Copy, Debug)]
pub(crate) enum JointKernel {
    Base,
    X,
    Y,
    Z,
    About(V3),
    Along(V3),
}

/// A link by name: its body and body_from_link.
#[derive(Clone, Debug)]
pub(crate) struct NamedLink {
    pub name: String,
    pub body: usize,
    pub pose: IsometryMatrix3<f64>,
}

/// First moment and moments of inertia about the body's origin of the body and all it carries.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Composite {
    pub mc: V3,
    pub i: Sym3,
}

/// Internal rotation of a frame as the kernels want it.
pub(crate) fn kernel_rotation(pose: &IsometryMatrix3<f64>) -> Mat3 {
    pose.rotation.into()
}
