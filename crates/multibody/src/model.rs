//! The tree: what never changes.

use nalgebra::Vector3;

use crate::body::{Body, Composite, JointKernel, NamedLink, kernel_rotation};
use crate::error::ModelError;
use crate::gyro::Gyro;
use crate::space::{Mat3, V3};
use crate::sparsity::{Paths, Subtrees};

/// \[m/s^2\] Gravity of all models, downwards.
pub const GRAVITY_ACCELERATION: f64 = 9.81;
/// \[m/s^2\] The same in the world frame.
pub const GRAVITY: Vector3<f64> = Vector3::new(0.0, 0.0, -GRAVITY_ACCELERATION);

pub(crate) const G: V3 = V3 { x: 0.0, y: 0.0, z: -GRAVITY_ACCELERATION };

/// A floating-base tree of rigid bodies.
///
/// | symbol | content | shape |
/// |---|---|---|
/// | q | base position in the world \[m\], base quaternion (x, y, z, w), joint coordinates | 7 + n |
/// | v | base velocity \[m/s\] and angular velocity \[rad/s\], both in the base frame, joint speeds | 6 + n |
///
/// v's first six are a velocity, not the derivative of q's first seven; [`Model::integrate`] connects them. A
/// generalized force has the shape of v: force and moment about the base's origin in the base frame, joint torques.
/// Velocities, accelerations and Jacobians of frames have world axes.
#[derive(Clone, Debug)]
pub struct Model {
    pub(crate) bodies: Vec<Body>,
    /// First moments and moments of inertia of the bodies by themselves, as the composite sweeps begin.
    pub(crate) own: Vec<Composite>,
    pub(crate) links: Vec<NamedLink>,
    pub(crate) joint_names: Vec<String>,
    /// \[kg\] Mass of the body and everything it carries.
    pub(crate) carried: Vec<f64>,
    pub(crate) paths: Paths,
    pub(crate) subtrees: Subtrees,
    pub(crate) rotor_names: Vec<String>,
    /// By the bodies that carry them.
    pub(crate) gyros: Vec<Gyro>,
}

/// A frame fixed to a body; cheap to copy.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    pub(crate) body: usize,
    /// body_from_frame
    pub(crate) rotation: Mat3,
    pub(crate) r: V3,
}

impl Frame {
    /// The same axes at another origin, `offset` \[m\] away in this frame's axes.
    pub fn shifted(&self, offset: [f64; 3]) -> Frame {
        Frame { r: self.r + self.rotation * V3::from_slice(&offset), ..*self }
    }

    /// Joint that moves the frame's body, none if it belongs to the base.
    pub fn joint(&self) -> Option<usize> {
        self.body.checked_sub(1)
    }
}

impl Model {
    pub(crate) fn new(bodies: Vec<Body>, links: Vec<NamedLink>, joint_names: Vec<String>) -> Model {
        let own = bodies.iter().map(Body::own).collect();
        let paths = Paths::new(&bodies);
        let subtrees = Subtrees::new(&bodies, &paths);
        let (carried, rotor_names, gyros) = (Vec::new(), Vec::new(), Vec::new());
        let mut model =
            Model { bodies, own, links, joint_names, carried, paths, subtrees, rotor_names, gyros };
        model.weigh();
        model
    }

    /// Sums up what each body carries.
    pub(crate) fn weigh(&mut self) {
        self.carried = self.bodies.iter().map(|b| b.m).collect();
        for k in (1..self.bodies.len()).rev() {
            self.carried[self.bodies[k].parent] += self.carried[k];
        }
    }

    /// Number of joints n.
    pub fn n(&self) -> usize {
        self.joint_names.len()
    }

    /// Length of q: 7 + n.
    pub fn nq(&self) -> usize {
        7 + self.n()
    }

    /// Length of v: 6 + n.
    pub fn nv(&self) -> usize {
        6 + self.n()
    }

    /// \[m\] Centre of gravity of the base body alone, in the base frame.
    pub fn base_cog(&self) -> Vector3<f64> {
        (self.bodies[0].mc * (1.0 / self.bodies[0].m)).into()
    }

    /// \[kg\] Mass of the whole robot.
    pub fn mass(&self) -> f64 {
        self.carried[0]
    }

    /// Names of the joints by their indices.
    pub fn joint_names(&self) -> &[String] {
        &self.joint_names
    }

    /// Index of a joint (0..n); its coordinate is q\[7 + i\], its speed v\[6 + i\].
    pub fn joint_index(&self, name: &str) -> Option<usize> {
        self.joint_names.iter().position(|j| j == name)
    }

    /// Joint that carries a joint's parent body; none if that is the base.
    pub fn parent_joint(&self, joint: usize) -> Option<usize> {
        self.bodies[joint + 1].parent.checked_sub(1)
    }

    /// Is a joint (0..n) prismatic?
    pub fn slides(&self, joint: usize) -> bool {
        matches!(self.bodies[joint + 1].kind, JointKernel::Along(_))
    }

    /// Names of all links, in the order in which they were added.
    pub fn link_names(&self) -> impl Iterator<Item = &str> {
        self.links.iter().map(|l| l.name.as_str())
    }

    /// A frame with the axes of `link`, its origin at `offset` \[m\] in the link.
    pub fn frame(&self, link: &str, offset: [f64; 3]) -> Result<Frame, ModelError> {
        let found = self.links.iter().find(|l| l.name == link);
        let link = found.ok_or_else(|| ModelError::UnknownLink(link.into()))?;
        let rotation = kernel_rotation(&link.pose);
        Ok(Frame { body: link.body, rotation, r: link.pose.translation.vector.into() }.shifted(offset))
    }
}
