//! Leg joints of a plan: both legs solved for the poses of soles and torso at an instant.

use crate::leg::LegError;
use crate::robot::Robot;
use messages::Plan;
use nalgebra::{Rotation3, Vector3};

impl Robot {
    /// Writes the angles \[rad\] of both legs' joints at time `t` \[s\] of a plan that leads the torso, which stays upright.
    /// Other joints keep theirs.
    ///
    /// # Errors
    /// Foot and reason, where a leg cannot take its pose. A robot whose legs have no closed form: [`LegError::NotFinite`].
    pub fn angles_of_plan(&self, plan: &Plan, t: f64, angles: &mut [f64]) -> Result<(), (usize, LegError)> {
        let Some(legs) = &self.legs else { return Err((0, LegError::NotFinite)) };
        let turned = |heading: f64| Rotation3::from_axis_angle(&Vector3::z_axis(), heading);
        let body = Vector3::from(plan.body.sample(t).position);
        let torso = turned(plan.torso.sample(t).position[2]);
        for (foot, leg) in legs.iter().enumerate() {
            let [rear, front, ..] = self.feet[foot].support;
            let (sole, pitch) = plan.sole(foot, t, [rear, front]);
            let [x, y, z, heading] = sole.position;
            let flat = turned(heading) * Rotation3::from_axis_angle(&Vector3::y_axis(), pitch.position[0]);
            let solved = leg
                .angles((flat.matrix(), &Vector3::new(x, y, z)), (torso.matrix(), &body))
                .map_err(|why| (foot, why))?;
            for (joint, angle) in leg.joints.into_iter().zip(solved) {
                angles[joint] = angle;
            }
        }
        Ok(())
    }
}
