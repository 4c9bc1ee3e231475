//! Reading a URDF into a [`Model`].

use std::collections::{HashMap, HashSet};

use nalgebra::{IsometryMatrix3, Matrix3, Rotation3, Vector3};
use urdf_rs::{Joint, JointType, Pose, Robot};

use crate::builder::{JointKind, ModelBuilder, rotation_from_rpy};
use crate::error::ModelError;
use crate::inertia::Inertia;
use crate::model::Model;

impl Model {
    /// Reads a floating-base tree.
    ///
    /// `base_link` is the link that floats, the root of the URDF. `joint_order` names every movable joint (revolute,
    /// continuous, prismatic) once, parents before children: this is the order of the coordinates. Links behind fixed
    /// joints become part of the body that carries them and stay addressable by [`Model::frame`]. Limits, geometry,
    /// transmissions and `<mimic>` are not read; a joint that mimics another is a coordinate of its own.
    pub fn from_urdf(urdf: &str, base_link: &str, joint_order: &[&str]) -> Result<Model, ModelError> {
        Self::from_urdf_locked(urdf, base_link, joint_order, &[])
    }

    /// Root link of a URDF, and its movable joints: parents before their children, otherwise in the order of the file.
    ///
    /// # Errors
    /// It cannot be read, or has no link that hangs on none.
    pub fn urdf_order(urdf: &str) -> Result<(String, Vec<String>), ModelError> {
        let robot = urdf_rs::read_from_string(urdf).map_err(|e| ModelError::Unreadable(e.to_string()))?;
        let children: HashSet<&str> = robot.joints.iter().map(|j| j.child.link.as_str()).collect();
        let root = robot.links.iter().map(|l| l.name.as_str()).find(|name| !children.contains(name));
        let root = root.ok_or_else(|| ModelError::Unreadable("no link is the root of a tree".into()))?;
        let mut below: HashMap<&str, Vec<&Joint>> = HashMap::new();
        robot.joints.iter().for_each(|j| below.entry(&j.parent.link).or_default().push(j));
        // What is reached twice is a loop, which whoever builds the model refuses.
        let (mut order, mut open, mut reached) = (Vec::new(), vec![root], HashSet::from([root]));
        while let Some(link) = open.pop() {
            for joint in below.get(link).into_iter().flatten() {
                if reached.insert(&joint.child.link) {
                    open.push(&joint.child.link);
                    order.extend((joint.joint_type != JointType::Fixed).then(|| joint.name.clone()));
                }
            }
        }
        Ok((root.to_owned(), order))
    }

    /// Sum of the masses of a URDF's links \[kg\].
    ///
    /// # Errors
    /// It cannot be read.
    pub fn urdf_mass(urdf: &str) -> Result<f64, ModelError> {
        let robot = urdf_rs::read_from_string(urdf).map_err(|e| ModelError::Unreadable(e.to_string()))?;
        Ok(robot.links.iter().map(|link| link.inertial.mass.value).sum())
    }

    /// [`Model::from_urdf`] with some joints held at these coordinates \[rad, m\], as if they were fixed: they are none of `joint_order`.
    pub fn from_urdf_locked(
        urdf: &str,
        base_link: &str,
        joint_order: &[&str],
        locked: &[(&str, f64)],
    ) -> Result<Model, ModelError> {
        let mut robot = urdf_rs::read_from_string(urdf).map_err(|e| ModelError::Unreadable(e.to_string()))?;
        for &(name, at) in locked {
            let joint = robot.joints.iter_mut().find(|j| j.name == name);
            lock(joint.ok_or_else(|| ModelError::UnknownJoint(name.into()))?, at);
        }
        let tree = Tree::new(&robot, base_link)?;
        tree.check_order(joint_order)?;
        let mut builder = ModelBuilder::new(base_link, tree.inertia(base_link)?);
        tree.add_fixed(&mut builder, base_link)?;
        for name in joint_order {
            let joint = tree.joint(name)?;
            tree.add(&mut builder, joint)?;
            tree.add_fixed(&mut builder, &joint.child.link)?;
        }
        builder.build()
    }
}

/// The URDF with its links and joints by name, known to be a tree that hangs on the base.
struct Tree<'a> {
    links: HashMap<&'a str, &'a urdf_rs::Link>,
    joints: &'a [Joint],
    /// Joint that carries a link.
    above: HashMap<&'a str, &'a Joint>,
}

impl<'a> Tree<'a> {
    fn new(robot: &'a Robot, base: &str) -> Result<Self, ModelError> {
        let mut tree = Tree { links: HashMap::new(), joints: &robot.joints, above: HashMap::new() };
        for link in &robot.links {
            if tree.links.insert(&link.name, link).is_some() {
                return Err(ModelError::Duplicate(link.name.clone()));
            }
        }
        // Joints: names that are unique, links that exist, one joint above each.
        for (k, joint) in robot.joints.iter().enumerate() {
            if robot.joints[..k].iter().any(|j| j.name == joint.name) {
                return Err(ModelError::Duplicate(joint.name.clone()));
            }
            for link in [&joint.parent.link, &joint.child.link] {
                if !tree.links.contains_key(link.as_str()) {
                    return Err(ModelError::UnknownLink(link.clone()));
                }
            }
            if let Some(other) = tree.above.insert(&joint.child.link, joint) {
                return Err(ModelError::Loop(
                    joint.child.link.clone(),
                    other.name.clone(),
                    joint.name.clone(),
                ));
            }
        }
        if !tree.links.contains_key(base) {
            return Err(ModelError::UnknownLink(base.into()));
        }
        // One tree: a second one, or a loop, would be left out without a word.
        for link in &robot.links {
            if !tree.hangs_on(base, &link.name) {
                return Err(ModelError::Unreachable(link.name.clone()));
            }
        }
        Ok(tree)
    }

    fn hangs_on(&self, base: &str, link: &str) -> bool {
        let mut at = link;
        for _ in 0..=self.joints.len() {
            match self.above.get(at) {
                None => return at == base,
                Some(joint) => at = &joint.parent.link,
            }
        }
        false
    }

    fn joint(&self, name: &str) -> Result<&'a Joint, ModelError> {
        let movable = |j: &&Joint| j.name == name && j.joint_type != JointType::Fixed;
        self.joints.iter().find(movable).ok_or_else(|| ModelError::UnknownJoint(name.into()))
    }

    fn check_order(&self, order: &[&str]) -> Result<(), ModelError> {
        for (k, name) in order.iter().enumerate() {
            let joint = self.joint(name)?;
            if order[..k].contains(name) {
                return Err(ModelError::Duplicate((*name).into()));
            }
            if let Some(carrier) = self.carrier(joint)
                && order[k..].contains(&carrier.name.as_str())
            {
                return Err(ModelError::Order((*name).into(), carrier.name.clone()));
            }
        }
        match self
            .joints
            .iter()
            .find(|j| j.joint_type != JointType::Fixed && !order.contains(&j.name.as_str()))
        {
            Some(joint) => Err(ModelError::MissingJoint(joint.name.clone())),
            None => Ok(()),
        }
    }

    /// Nearest movable joint towards the base.
    fn carrier(&self, joint: &Joint) -> Option<&'a Joint> {
        let mut at = *self.above.get(joint.parent.link.as_str())?;
        while at.joint_type == JointType::Fixed {
            at = self.above.get(at.parent.link.as_str())?;
        }
        Some(at)
    }

    fn inertia(&self, link: &str) -> Result<Inertia, ModelError> {
        let i = &self.links[link].inertial;
        let m = &i.inertia;
        let pose = placement(&i.origin);
        let moments = Matrix3::new(m.ixx, m.ixy, m.ixz, m.ixy, m.iyy, m.iyz, m.ixz, m.iyz, m.izz);
        let own = Inertia { mass: i.mass.value, center: Vector3::zeros(), moments };
        match own.fault() {
            Some(fault) => Err(ModelError::Inertia(link.into(), fault)),
            None => Ok(own.seen_from(&pose)),
        }
    }

    fn add(&self, builder: &mut ModelBuilder, joint: &Joint) -> Result<(), ModelError> {
        let axis = Vector3::from(joint.axis.xyz.0);
        let kind = match joint.joint_type {
            JointType::Fixed => JointKind::Fixed,
            JointType::Revolute | JointType::Continuous => JointKind::Revolute(axis),
            JointType::Prismatic => JointKind::Prismatic(axis),
            ref other => {
                return Err(ModelError::JointType(joint.name.clone(), format!("{other:?}").to_lowercase()));
            }
        };
        let child = &joint.child.link;
        let placement = placement(&joint.origin);
        if placement
            .translation
            .vector
            .iter()
            .chain(placement.rotation.matrix().iter())
            .any(|x| !x.is_finite())
        {
            return Err(ModelError::Geometry(joint.name.clone()));
        }
        builder.joint(&joint.name, &joint.parent.link, child, &placement, kind, &self.inertia(child)?)?;
        Ok(())
    }

    /// Adds everything that hangs rigidly on a link.
    fn add_fixed(&self, builder: &mut ModelBuilder, link: &str) -> Result<(), ModelError> {
        for joint in self.joints.iter().filter(|j| j.parent.link == link && j.joint_type == JointType::Fixed)
        {
            self.add(builder, joint)?;
            self.add_fixed(builder, &joint.child.link)?;
        }
        Ok(())
    }
}

/// Makes a joint fixed where it is `at` \[rad, m\].
fn lock(joint: &mut Joint, at: f64) {
    let axis = Vector3::from(joint.axis.xyz.0);
    let moved = match joint.joint_type {
        JointType::Revolute | JointType::Continuous => {
            let turn = Rotation3::new(axis.normalize() * at);
            IsometryMatrix3::from_parts(Vector3::zeros().into(), turn)
        }
        JointType::Prismatic => {
            IsometryMatrix3::from_parts((axis.normalize() * at).into(), Rotation3::identity())
        }
        _ => return,
    };
    let pose = placement(&joint.origin) * moved;
    let (roll, pitch, yaw) = pose.rotation.euler_angles();
    joint.origin.xyz.0 = pose.translation.vector.into();
    joint.origin.rpy.0 = [roll, pitch, yaw];
    joint.joint_type = JointType::Fixed;
}

fn placement(p: &Pose) -> IsometryMatrix3<f64> {
    IsometryMatrix3::from_parts(Vector3::from(p.xyz.0).into(), rotation_from_rpy(p.rpy.0))
}
