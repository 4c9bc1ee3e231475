//! Objects that a scene calls known, as triangles in I_0: stand-in for the vision system of the thesis.

use std::error::Error;

use environment::Pose;
use multibody::Data;
use nalgebra::Vector3;

use crate::{Robot, Setup};

/// Corners of a triangle \[m\] @I_0.
pub type Triangle = [[f64; 3]; 3];

impl Setup {
    /// Origin of I_0 \[m\] @world of a simulated robot: on the ground, in the middle between its soles at the start.
    ///
    /// # Errors
    /// The robot's data do not fit together.
    pub fn start(&self) -> Result<Vector3<f64>, Box<dyn Error>> {
        middle_of_soles(&self.robot, &self.robot.poses[&self.scene.start_pose])
    }

    /// The triangles of each known object that is not under the ground, where nobody meets it.
    ///
    /// # Errors
    /// A mesh cannot be read, or the robot's data do not fit together.
    pub fn known_obstacles(&self) -> Result<Vec<Vec<Triangle>>, Box<dyn Error>> {
        let begin = self.start()?;
        let mut obstacles = Vec::new();
        for object in self.scene.objects.iter().filter(|o| o.known) {
            let mesh = object.shape.mesh()?;
            let pose = Pose::new(object.pose.position, object.pose.rotation);
            let place = |v: Vector3<f64>| <[f64; 3]>::from(pose.rotation * v + pose.position - begin);
            let triangles: Vec<Triangle> = mesh.faces().map(|corners| corners.map(place)).collect();
            if triangles.iter().flatten().any(|corner| corner[2] > 0.0) {
                obstacles.push(triangles);
            }
        }
        Ok(obstacles)
    }
}

/// On the ground, in the middle between the soles of a robot whose torso stands over the origin.
fn middle_of_soles(robot: &Robot, pose: &[f64]) -> Result<Vector3<f64>, Box<dyn Error>> {
    let model = robot.model()?;
    let mut data = Data::new(&model);
    let mut q = model.neutral();
    q[7..].copy_from_slice(pose);
    model.forward_kinematics(&mut data, &q);
    let mut middle = Vector3::zeros();
    for foot in &robot.feet {
        let sole = model.frame(&foot.link, foot.sole)?;
        middle += model.frame_pose(&data, &sole).translation.vector * 0.5;
    }
    middle.z = 0.0;
    Ok(middle)
}
