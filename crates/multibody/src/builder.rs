//! A tree of links put together in code; the URDF reader ends here too.

use nalgebra::{IsometryMatrix3, Rotation3, Unit, Vector3};

use crate::body::{Body, JointKernel, NamedLink};
use crate::error::ModelError;
use crate::inertia::Inertia;
use crate::model::Model;
use crate::space::{Sym3, V3};

/// Motion of a child link against its parent. The axis is given in the child's frame, of any length above zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointKind {
    /// Not at all: the child becomes part of its parent's body.
    Fixed,
    /// Turns about the axis \[rad\].
    Revolute(Vector3<f64>),
    /// Slides along the axis \[m\].
    Prismatic(Vector3<f64>),
}

/// Makes a [`Model`]. Joints are added parents first; the order of the movable ones is that of the coordinates.
#[derive(Clone, Debug)]
pub struct ModelBuilder {
    links: Vec<NamedLink>,
    inertias: Vec<Inertia>,
    joints: Vec<NewJoint>,
}

#[derive(Clone, Debug)]
struct NewJoint {
    name: String,
    /// Body that carries the joint.
    parent: usize,
    /// First link of the moved body.
    link: usize,
    /// Position of the joint in the parent body.
    origin: Vector3<f64>,
    /// Axis in the axes of the base at zero coordinates.
    axis: Unit<Vector3<f64>>,
    slides: bool,
}

impl ModelBuilder {
    /// Starts with the floating base.
    pub fn new(base_link: &str, inertia: Inertia) -> ModelBuilder {
        let base = NamedLink { name: base_link.into(), body: 0, pose: IsometryMatrix3::identity() };
        ModelBuilder { links: vec![base], inertias: vec![inertia], joints: Vec::new() }
    }

    /// Adds link `child` with its inertia in its own frame; `placement` is parent_from_child at coordinate zero.
    pub fn joint(
        &mut self,
        name: &str,
        parent: &str,
        child: &str,
        placement: &IsometryMatrix3<f64>,
        kind: JointKind,
        inertia: &Inertia,
    ) -> Result<&mut ModelBuilder, ModelError> {
        if self.links.iter().any(|l| l.name == child) {
            return Err(ModelError::Duplicate(child.into()));
        }
        let found = self.links.iter().find(|l| l.name == parent);
        let parent = found.ok_or_else(|| ModelError::UnknownLink(parent.into()))?;
        if let Some(fault) = inertia.fault() {
            return Err(ModelError::Inertia(child.into(), fault));
        }
        // A fixed link is part of the body that carries its parent.
        let in_parent = parent.pose * placement;
        let carrier = parent.body;
        let (axis, slides) = match kind {
            JointKind::Fixed => {
                self.inertias[carrier] = self.inertias[carrier].with(&inertia.seen_from(&in_parent));
                self.links.push(NamedLink { name: child.into(), body: carrier, pose: in_parent });
                return Ok(self);
            }
            JointKind::Revolute(axis) => (axis, false),
            JointKind::Prismatic(axis) => (axis, true),
        };
        if self.joints.iter().any(|j| j.name == name) {
            return Err(ModelError::Duplicate(name.into()));
        }
        let axis = Unit::try_new(in_parent.rotation * axis, 1e-9)
            .ok_or_else(|| ModelError::Geometry(name.into()))?;
        // Frames of the bodies are parallel to the base at zero coordinates, whatever the links' axes are.
        let pose = IsometryMatrix3::from_parts(Vector3::zeros().into(), in_parent.rotation);
        let body = self.inertias.len();
        self.joints.push(NewJoint {
            name: name.into(),
            parent: carrier,
            link: self.links.len(),
            origin: in_parent.translation.vector,
            axis,
            slides,
        });
        self.inertias.push(inertia.seen_from(&pose));
        self.links.push(NamedLink { name: child.into(), body, pose });
        Ok(self)
    }

    /// Checks every moving body and finishes the model.
    pub fn build(&self) -> Result<Model, ModelError> {
        for (k, inertia) in self.inertias.iter().enumerate() {
            let first = if k == 0 { &self.links[0] } else { &self.links[self.joints[k - 1].link] };
            if let Some(fault) = inertia.fault().or_else(|| inertia.fault_of_moving_body()) {
                return Err(ModelError::Inertia(first.name.clone(), fault));
            }
        }
        let bodies: Vec<Body> = (0..self.inertias.len()).map(|k| self.body(k)).collect();
        if let Some(j) = self.joints.iter().zip(&bodies[1..]).find(|(_, b)| !b.is_finite()) {
            return Err(ModelError::Geometry(j.0.name.clone()));
        }
        Ok(Model::new(bodies, self.links.clone(), self.joints.iter().map(|j| j.name.clone()).collect()))
    }

    fn body(&self, k: usize) -> Body {
        let inertia = &self.inertias[k];
        let i = Sym3::from_matrix(&inertia.moments_about_origin());
        let (parent, origin, (kind, sign)) = match k {
            0 => (0, Vector3::zeros(), (JointKernel::Base, 1.0)),
            _ => {
                let j = &self.joints[k - 1];
                (j.parent, j.origin, classify(j.axis.into_inner(), j.slides))
            }
        };
        Body {
            parent,
            kind,
            sign,
            r: origin.into(),
            m: inertia.mass,
            mc: (inertia.center * inertia.mass).into(),
            i,
            s: Body::second_moments(i),
        }
    }
}

/// Finds the fast form of a joint. An axis within rounding of a coordinate axis is taken as that axis.
fn classify(e: Vector3<f64>, slides: bool) -> (JointKernel, f64) {
    const ROUNDING: f64 = 1e-14;
    if slides {
        return (JointKernel::Along(e.into()), 1.0);
    }
    for (k, kind) in [JointKernel::X, JointKernel::Y, JointKernel::Z].into_iter().enumerate() {
        let across = e[(k + 1) % 3].hypot(e[(k + 2) % 3]);
        if across < ROUNDING {
            return (kind, e[k].signum());
        }
    }
    (JointKernel::About(V3::from(e)), 1.0)
}

/// Rotation of a URDF's `rpy` \[rad\], with quarter turns that were written with all digits made exact.
pub(crate) fn rotation_from_rpy(rpy: [f64; 3]) -> Rotation3<f64> {
    let exact = |a: f64| if a.abs() < 4e-16 { 0.0 } else { a };
    let m = *Rotation3::from_euler_angles(rpy[0], rpy[1], rpy[2]).matrix();
    Rotation3::from_matrix_unchecked(m.map(exact))
}
