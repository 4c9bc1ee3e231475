//! Terrain of a scene, as the environment of the equations of motion.

use std::error::Error;

use config::Scene;
use config::terrain::{TerrainObject, TerrainPose};
use environment::{Environment, Object, Pose, Schedule};

/// Flat ground, lower or tilted if the scene says so, with the objects of a scene.
///
/// # Errors
/// A mesh cannot be read.
pub fn environment(scene: &Scene) -> Result<Environment, Box<dyn Error>> {
    let objects = scene.objects.iter().map(object).collect::<Result<Vec<_>, _>>()?;
    let mismatch = &scene.plant_mismatch;
    Ok(Environment::new(objects).at_height(mismatch.ground_height).tilted(mismatch.ground_tilt))
}

fn object(o: &TerrainObject) -> Result<Object, Box<dyn Error>> {
    let later: Vec<(f64, Pose)> = o.poses.iter().map(|(time, p)| (*time, pose(p))).collect();
    let schedule = Schedule::new(o.appears, o.vanishes, pose(&o.pose), &later);
    Ok(Object::new(o.name.clone(), o.shape.mesh()?, o.friction, schedule).keeping_clear(o.keeps_clear))
}

fn pose(p: &TerrainPose) -> Pose {
    Pose::new(p.position, p.rotation)
}
