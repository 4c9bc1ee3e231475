//! Lola for the benchmark: as she is, with rotors as bodies, with rotors as gyrostats.

use std::error::Error;

use multibody::{Frame, Model, Rotor};
use nalgebra::Vector3;
use urdf_rs::JointType;

/// A robot that both sides can read.
pub(crate) struct Robot {
    pub urdf: urdf_rs::Robot,
    pub joints: Vec<String>,
    pub model: Model,
    /// Frames of the joints that move the feet.
    pub feet: [Frame; 2],
    /// Feet and toes.
    pub soles: [Frame; 4],
}

/// \[kg m^2\], \[kg\] A rotor about its axis and across it, and its mass; sizes of a hip's.
const ROTOR: (f64, f64, f64) = (3e-5, 2e-5, 0.1);

impl Robot {
    /// Joints that move the feet.
    pub(crate) const FEET: [&str; 2] = ["right_ankle_flexion", "left_ankle_flexion"];

    pub(crate) fn lola() -> Result<Robot, Box<dyn Error>> {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/robots/lola/lola.urdf");
        // Pinocchio has its fast kernels for +x, +y, +z only; with Lola's axes turned positive both can use theirs.
        let urdf = std::fs::read_to_string(path)?
            .replace("<axis xyz=\"-1 0 0", "<axis xyz=\"1 0 0")
            .replace("<axis xyz=\"0 -1 0", "<axis xyz=\"0 1 0");
        Robot::read(urdf_rs::read_from_string(&urdf)?)
    }

    fn read(urdf: urdf_rs::Robot) -> Result<Robot, Box<dyn Error>> {
        let movable = urdf.joints.iter().filter(|j| j.joint_type != JointType::Fixed);
        let joints: Vec<String> = movable.map(|j| j.name.clone()).collect();
        let order: Vec<&str> = joints.iter().map(String::as_str).collect();
        let model = Model::from_urdf(&urdf_rs::write_to_string(&urdf)?, "torso", &order)?;
        let frame = |link| model.frame(link, [0.0; 3]);
        let feet = [frame("right_foot")?, frame("left_foot")?];
        let soles = [feet[0], feet[1], frame("right_toe")?, frame("left_toe")?];
        Ok(Robot { urdf, joints, model, feet, soles })
    }

    /// A body before each of the first joints, turning about the same axis.
    pub(crate) fn with_rotor_bodies(&self, rotors: usize) -> Result<Robot, Box<dyn Error>> {
        Robot::read(self.rotors_added(rotors, JointType::Revolute)?)
    }

    /// The same rotors in the links that carry the joints.
    pub(crate) fn with_gyrostats(&self, rotors: usize) -> Result<Model, Box<dyn Error>> {
        let locked = Robot::read(self.rotors_added(rotors, JointType::Fixed)?)?;
        let rotor = |k: usize| {
            let joint = &self.urdf.joints[k];
            let (name, link) = (joint.name.clone(), joint.parent.link.clone());
            Rotor { name, link, axis: Vector3::from(joint.axis.xyz.0), inertia: ROTOR.0, joints: Vec::new() }
        };
        let rotors: Vec<Rotor> = (0..rotors).map(rotor).collect();
        Ok(locked.model.with_rotors(&rotors)?)
    }

    fn rotors_added(&self, rotors: usize, kind: JointType) -> Result<urdf_rs::Robot, Box<dyn Error>> {
        let mut urdf = self.urdf.clone();
        for k in 0..rotors {
            let mut joint = self.urdf.joints[k].clone();
            let of = urdf.links.iter().find(|l| l.name == joint.child.link);
            let mut link = of.ok_or("a joint names no link")?.clone();
            let name = format!("{}_rotor", joint.name);
            (link.name, joint.child.link, joint.name) = (name.clone(), name.clone(), name);
            joint.joint_type = kind.clone();
            let i = &mut link.inertial;
            (i.mass.value, i.origin) = (ROTOR.2, urdf_rs::Pose::default());
            let about = |k: usize| if joint.axis.xyz[k] == 0.0 { ROTOR.1 } else { ROTOR.0 };
            (i.inertia.ixx, i.inertia.iyy, i.inertia.izz) = (about(0), about(1), about(2));
            (i.inertia.ixy, i.inertia.ixz, i.inertia.iyz) = (0.0, 0.0, 0.0);
            (link.visual, link.collision) = (Vec::new(), Vec::new());
            urdf.links.push(link);
            // Pinocchio numbers subtrees in one piece.
            urdf.joints.insert(2 * k, joint);
        }
        Ok(urdf)
    }
}
