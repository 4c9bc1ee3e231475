//! Eye of the simulated robot: a depth camera in its head, by rays against ground and objects of the scene.
//!
//! A stand-in for the stereo cameras of the thesis (6.1): what hides hides, what is too far is not there, distances are noisy and
//! some rays find nothing. It looks at the truth, `sim_state`, and is no part of a cycle: who sees is a program beside the robot.

use std::error::Error;

use config::{Robot, Scene};
use environment::Environment;
use messages::SimState;
use multibody::{Data, Frame, Model};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};

use crate::sensors::noise::Noise;
use crate::terrain::environment;

/// Rays and errors of a depth camera: estimates of what one for robots does.
#[derive(Clone, Copy, Debug)]
pub struct Lens {
    /// Rays across and upwards.
    pub rays: [usize; 2],
    /// \[rad\] Angle between the outermost rays across and upwards.
    pub angle: [f64; 2],
    /// \[m\] Nearest and farthest that is seen.
    pub range: [f64; 2],
    /// \[1/m\] Standard deviation of a distance, over its square: as with two cameras side by side.
    pub noise: f64,
    /// \[1\] Share of the rays that find nothing.
    pub lost: f64,
}

impl Default for Lens {
    fn default() -> Self {
        Self { rays: [64, 48], angle: [1.5, 1.05], range: [0.3, 5.0], noise: 0.004, lost: 0.02 }
    }
}

/// The camera head of a simulated robot.
pub struct Eye {
    environment: Environment,
    lens: Lens,
    noise: Noise,
    /// Unit vectors of the rays @camera, x ahead.
    rays: Vec<Vector3<f64>>,
    model: Model,
    data: Data,
    q: Vec<f64>,
    camera: Frame,
}

impl Eye {
    /// The eye of a robot in a scene; its errors are those of `seed`.
    ///
    /// # Errors
    /// The robot has no camera head, or the files of robot and scene do not fit together.
    pub fn new(robot: &Robot, scene: &Scene, lens: Lens, seed: u64) -> Result<Self, Box<dyn Error>> {
        let head = robot.head.as_ref().ok_or("this robot has no camera head: [head] in robot.toml")?;
        let model = robot.model()?;
        let camera = model.frame(&head.link, head.camera)?;
        let (data, q) = (Data::new(&model), model.neutral());
        let [across, upwards] = lens.rays;
        let share = |k: usize, of: usize| (k as f64 + 0.5) / of as f64 - 0.5;
        let ray = |k: usize| {
            // A plane of pixels: equal tangents.
            let [y, z] = [share(k % across, across), -share(k / across, upwards)];
            let [y, z] = [2.0 * y * (0.5 * lens.angle[0]).tan(), 2.0 * z * (0.5 * lens.angle[1]).tan()];
            Vector3::new(1.0, -y, z).normalize()
        };
        let rays = (0..across * upwards).map(ray).collect();
        Ok(Self {
            environment: environment(scene)?,
            lens,
            noise: Noise::new(seed, 0),
            rays,
            model,
            data,
            q,
            camera,
        })
    }

    /// Points \[m\] @camera that are seen of the world as it is: x along the camera's axis, z up.
    pub fn look(&mut self, truth: &SimState) -> Vec<[f64; 3]> {
        self.environment.place_at(truth.time, &truth.object_delay);
        let world_from_camera = self.pose(truth);
        let from = world_from_camera.translation.vector;
        let [nearest, farthest] = self.lens.range;
        let mut points = Vec::with_capacity(self.rays.len());
        for ray in &self.rays {
            // Drawn for each ray, so that what one of them meets changes no other one.
            let (error, lost) = (self.noise.gaussian(), self.noise.symmetric());
            let Some(way) = self.environment.ray(&from, &(world_from_camera.rotation * ray), farthest) else {
                continue;
            };
            let measured = way * (1.0 + self.lens.noise * way * error);
            if way >= nearest && lost.abs() >= self.lens.lost {
                points.push((ray * measured).into());
            }
        }
        points
    }

    /// world_from_camera
    fn pose(&mut self, truth: &SimState) -> Isometry3<f64> {
        let joints = self.q.len() - 7;
        self.q[7..].copy_from_slice(&truth.joint_angle[..joints]);
        self.model.forward_kinematics(&mut self.data, &self.q);
        let camera = self.model.frame_pose(&self.data, &self.camera);
        let [x, y, z, w] = truth.orientation;
        let rotation = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
        let torso = Isometry3::from_parts(Translation3::from(truth.position), rotation);
        torso
            * Isometry3::from_parts(
                camera.translation,
                UnitQuaternion::from_rotation_matrix(&camera.rotation),
            )
    }
}
