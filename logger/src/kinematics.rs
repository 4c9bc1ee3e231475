//! Poses of all links from the state of the simulated robot.

use config::Robot;
use messages::SimState;
use multibody::{Data, Frame, Model, ModelError};
use nalgebra::UnitQuaternion;
use recording::{Link, LinkPoses, Pose};

/// The robot's tree of links.
pub struct Kinematics {
    model: Model,
    data: Data,
    frames: Vec<Frame>,
    links: Vec<Link>,
    q: Vec<f64>,
}

impl Kinematics {
    /// From the URDF of the robot.
    pub fn new(robot: &Robot) -> Result<Self, ModelError> {
        let joints: Vec<&str> = robot.joints.iter().map(|j| j.name.as_str()).collect();
        let model = Model::from_urdf(&robot.urdf, &robot.torso, &joints)?;
        let names: Vec<String> = model.link_names().map(String::from).collect();
        let frames = names.iter().map(|name| model.frame(name, [0.0; 3])).collect::<Result<Vec<_>, _>>()?;
        // The first link of a body is the one its joint moves; the others are fixed to it.
        let carrier = |joint: Option<usize>| frames.iter().position(|f| f.joint() == joint);
        let links = names
            .into_iter()
            .enumerate()
            .map(|(k, name)| {
                let joint = frames[k].joint();
                let first = carrier(joint).filter(|first| *first != k);
                Link { name, parent: first.or_else(|| joint.and_then(|j| carrier(model.parent_joint(j)))) }
            })
            .collect();
        let (data, q) = (Data::new(&model), model.neutral());
        Ok(Self { model, data, frames, links, q })
    }
}

impl LinkPoses for Kinematics {
    fn links(&self) -> &[Link] {
        &self.links
    }

    fn poses(&mut self, state: &SimState, out: &mut [Pose]) {
        self.q[..3].copy_from_slice(&state.position);
        self.q[3..7].copy_from_slice(&state.orientation);
        let joints = self.q.len() - 7;
        self.q[7..].copy_from_slice(&state.joint_angle[..joints]);
        self.model.forward_kinematics(&mut self.data, &self.q);
        for (frame, pose) in self.frames.iter().zip(out) {
            let world = self.model.frame_pose(&self.data, frame);
            let turn = UnitQuaternion::from_rotation_matrix(&world.rotation);
            *pose = Pose {
                position: world.translation.vector.into(),
                orientation: [turn.i, turn.j, turn.k, turn.w],
            };
        }
    }
}
