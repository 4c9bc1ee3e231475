//! Ground under a robot: environment, contact elements of the feet, and the motion of the links that carry them.

use std::error::Error;

use config::Robot;
use config::components::ContactModel;
use environment::Environment;
use multibody::{Data, Frame, Limbs, Model};
use nalgebra::{UnitQuaternion, Vector3};

use crate::feet::Feet;

/// Ground under a robot, with the scratch of its contact forces.
#[derive(Clone)]
pub(crate) struct GroundContact {
    environment: Environment,
    pub(crate) feet: Feet,
    /// Bodies between the torso and the contact elements.
    limbs: Limbs,
    pub(crate) soles: [Frame; 2],
    /// \[m/s\] Rates of the nodes at the last evaluation.
    pub(crate) layer_rate: Vec<f64>,
    /// q, v and d of the last evaluation, whose kinematics and contact forces still hold.
    seen: Vec<f64>,
}

impl GroundContact {
    /// The contact elements of a robot on `environment`.
    ///
    /// # Errors
    /// A link does not exist, or the robot has no pads.
    pub(crate) fn new(
        robot: &Robot,
        model: &Model,
        environment: Environment,
        contact: [ContactModel; 2],
    ) -> Result<Self, Box<dyn Error>> {
        let feet = Feet::new(robot, model, contact, environment.objects().len())?;
        let sole = |i: usize| model.frame(&robot.feet[i].link, robot.feet[i].sole);
        let layer = 3 * feet.nodes();
        Ok(Self {
            limbs: model.limbs(&feet.frames()),
            soles: [sole(0)?, sole(1)?],
            layer_rate: vec![0.0; layer],
            seen: vec![f64::NAN; model.nq() + model.nv() + layer],
            environment,
            feet,
        })
    }

    /// Kinematics of the feet and forces of the ground for the position that `data` holds, q, with v and d, unless they
    /// hold already: a cycle begins with the state that the sensors have seen.
    pub(crate) fn touch(&mut self, model: &Model, data: &mut Data, [q, v, d]: [&[f64]; 3]) {
        let now = || q.iter().chain(v).chain(d);
        if self.seen.iter().eq(now()) {
            return;
        }
        for (seen, now) in self.seen.iter_mut().zip(now()) {
            *seen = *now;
        }
        model.set_position(data, q);
        model.limb_motion_here(data, &self.limbs, v);
        self.feet.update(model, data, &self.environment, d, &mut self.layer_rate);
    }

    /// world_from_ground, if tilted ground goes through the origin.
    pub(crate) fn turn_at_origin(&self) -> Option<UnitQuaternion<f64>> {
        let up = self.environment.up()?;
        UnitQuaternion::rotation_between(&Vector3::z(), &up.into())
    }

    /// Another position was given to `data`, or the environment changes: nothing holds any more.
    pub(crate) fn forget(&mut self) {
        self.seen.fill(f64::NAN);
    }

    /// Ground and objects.
    pub(crate) const fn environment(&self) -> &Environment {
        &self.environment
    }

    /// Moves the objects of the environment to `time` \[s\], as far as nothing touches them; returns what happened.
    pub(crate) fn advance(&mut self, time: f64) -> &[environment::ObjectEvent] {
        if !self.environment.objects().is_empty() {
            self.forget();
        }
        self.environment.advance(time, self.feet.touched(), self.feet.places())
    }
}
