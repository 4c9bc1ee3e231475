//! Poses of all links from joint angles, and joint torques from motor currents.

use config::Robot;
use config::robot::Drive;
use messages::{Joints, Sensors};
use multibody::{Data, Frame, Model, ModelError};
use recording::{LinkFrame, LinkPoses, RecordedPose};

/// The robot's tree of links.
pub struct Kinematics {
    model: Model,
    data: Data,
    frames: Vec<Frame>,
    links: Vec<LinkFrame>,
    q: Vec<f64>,
    drives: Vec<Drive>,
}

impl Kinematics {
    /// From the URDF of the robot.
    pub fn new(robot: &Robot) -> Result<Self, ModelError> {
        let model = robot.model()?;
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
                let parent = first.or_else(|| joint.and_then(|j| carrier(model.parent_joint(j))));
                LinkFrame { name, parent, fixed: first.is_some() }
            })
            .collect();
        let (data, q) = (Data::new(&model), model.neutral());
        Ok(Self { model, data, frames, links, q, drives: robot.drives.clone() })
    }
}

impl LinkPoses for Kinematics {
    fn links(&self) -> &[LinkFrame] {
        &self.links
    }

    fn poses(&mut self, base: &RecordedPose, joint_angle: &Joints, out: &mut [RecordedPose]) {
        self.q[..3].copy_from_slice(&base.position);
        self.q[3..7].copy_from_slice(&base.orientation);
        let joints = self.q.len() - 7;
        self.q[7..].copy_from_slice(&joint_angle[..joints]);
        self.model.forward_kinematics(&mut self.data, &self.q);
        for (frame, pose) in self.frames.iter().zip(out) {
            let (position, orientation) = self.model.frame_place(&self.data, frame);
            *pose = RecordedPose { position, orientation };
        }
    }

    /// Torque of the motors on the joints, before friction of the gears and inertia of the rotors.
    fn torques(&mut self, sensors: &Sensors, out: &mut Joints) -> bool {
        // A model without motors says nothing, or zeros where the bus knows no NaN.
        let silent = |current: &f64| current.is_nan() || *current == 0.0;
        if sensors.motor_current.iter().take(self.drives.len()).all(silent) {
            return false;
        }
        out[..self.drives.len()].fill(0.0);
        for (drive, current) in self.drives.iter().zip(sensors.motor_current) {
            let of_joints = |values: &Joints| {
                let mut own = [0.0; 3];
                own.iter_mut().zip(&drive.joints).for_each(|(own, &j)| *own = values[j]);
                own
            };
            let gear =
                drive.transmission.at(of_joints(&sensors.joint_angle), of_joints(&sensors.joint_speed));
            let ratio = gear.map_or([f64::NAN; 3], |gear| gear.ratio);
            for (&j, ratio) in drive.joints.iter().zip(ratio) {
                out[j] += ratio * drive.motor.torque(current);
            }
        }
        true
    }
}
