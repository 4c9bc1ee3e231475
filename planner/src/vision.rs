//! Stand-in for the vision system of the thesis: the triangles of the objects that a scene calls known, in I_0.

use std::error::Error;

use config::terrain::Shape;
use config::{Robot, Setup};
use environment::{Mesh, Pose};
use multibody::{Data, Model};
use nalgebra::Vector3;

use crate::obstacles::KnownObstacles;

/// The known objects of a scene.
///
/// # Errors
/// A mesh cannot be read, or the robot's data do not fit together.
pub fn known(setup: &Setup) -> Result<KnownObstacles, Box<dyn Error>> {
    let mut obstacles = KnownObstacles::default();
    let begin = middle_of_soles(&setup.robot, &setup.robot.poses[&setup.scene.start_pose])?;
    for object in setup.scene.objects.iter().filter(|o| o.known) {
        let mesh = match &object.shape {
            Shape::Box(size) => Mesh::cuboid(*size)?,
            Shape::Mesh { file, bytes, scale } => Mesh::parse(file, bytes, *scale)?,
        };
        let pose = Pose::new(object.pose.position, object.pose.rotation);
        let place = |v: Vector3<f64>| <[f64; 3]>::from(pose.rotation * v + pose.position - begin);
        obstacles.add(mesh.faces().map(|corners| corners.map(place)));
    }
    Ok(obstacles)
}

/// Origin of I_0: on the ground, in the middle between the soles of a robot whose torso stands over the origin.
fn middle_of_soles(robot: &Robot, pose: &[f64]) -> Result<Vector3<f64>, Box<dyn Error>> {
    let order: Vec<&str> = robot.joints.iter().map(|j| j.name.as_str()).collect();
    let model = Model::from_urdf(&robot.urdf, &robot.torso, &order)?;
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
