//! Direct kinematics of the task space (thesis 4.4.2): soles, sensors and centre of gravity, seen from the torso.
//!
//! All vectors are in torso axes from the torso's origin, so that nothing here depends on where the robot is.

use config::Robot;
use config::robot::Foot;
use multibody::{Data, Frame, Model, ModelError};
use nalgebra::{Dyn, Matrix3, OMatrix, U3, U6, Vector3};

use crate::inverse_kinematics::TaskJacobian;

/// Pose of a sole or a sensor against the torso.
#[derive(Clone, Copy, Debug)]
pub struct FramePose {
    /// \[m\] @torso
    pub position: Vector3<f64>,
    /// torso_from_frame
    pub rotation: Matrix3<f64>,
}

/// Kinematics of one set of joint angles.
#[derive(Clone)]
pub struct TaskSpace {
    model: Model,
    data: Data,
    q: Vec<f64>,
    v: Vec<f64>,
    soles: [Frame; 2],
    sensors: [Frame; 2],
    points: [Vec<Frame>; 2],
    com_jacobian: OMatrix<f64, U3, Dyn>,
    sole_jacobian: [OMatrix<f64, U6, Dyn>; 2],
    com: Vector3<f64>,
    /// For buffers of one column per joint.
    n: usize,
}

impl TaskSpace {
    /// Of `robot`; allocates everything.
    pub fn new(robot: &Robot) -> Result<Self, ModelError> {
        let model = robot.model()?;
        let n = model.n();
        let sole = |i: usize| model.frame(&robot.feet[i].link, robot.feet[i].sole);
        let sensor = |i: usize| model.frame(&robot.feet[i].sensor_link, robot.feet[i].sensor);
        let points = |i: usize| {
            let foot: &Foot = &robot.feet[i];
            foot.points.iter().map(|(link, p)| model.frame(link, *p)).collect::<Result<Vec<_>, _>>()
        };
        Ok(Self {
            points: [points(0)?, points(1)?],
            soles: [sole(0)?, sole(1)?],
            sensors: [sensor(0)?, sensor(1)?],
            data: Data::new(&model),
            q: model.neutral(),
            v: vec![0.0; model.nv()],
            com_jacobian: OMatrix::zeros_generic(U3, Dyn(n)),
            sole_jacobian: std::array::from_fn(|_| OMatrix::zeros_generic(U6, Dyn(n))),
            com: Vector3::zeros(),
            model,
            n,
        })
    }

    /// Robot's mass \[kg\].
    pub fn mass(&self) -> f64 {
        self.model.mass()
    }

    /// Joints between the torso and the soles, except toe joints: those that inverse kinematics may use.
    pub fn leg_joints(&self, robot: &Robot) -> Vec<bool> {
        let mut free = vec![false; self.n];
        for (i, sole) in self.soles.iter().enumerate() {
            let mut at = sole.joint();
            while let Some(j) = at {
                free[j] = robot.feet[i].toe != Some(j);
                at = self.model.parent_joint(j);
            }
        }
        free
    }

    /// Takes new joint angles \[rad\]; poses and centre of gravity are then up to date.
    pub fn update(&mut self, angles: &[f64]) {
        self.q[7..].copy_from_slice(&angles[..self.n]);
        self.model.forward_kinematics(&mut self.data, &self.q);
        self.com = self.model.cog(&mut self.data);
    }

    /// Takes new joint angles \[rad\] and speeds \[rad/s\] and the torso's angular velocity \[rad/s\] @torso.
    pub fn update_motion(&mut self, angles: &[f64], speeds: &[f64], omega: &[f64; 3]) {
        self.update(angles);
        self.v[3..6].copy_from_slice(omega);
        self.v[6..].copy_from_slice(&speeds[..self.n]);
        self.model.motion(&mut self.data, &self.v);
    }

    /// \[m/s\] @torso Velocity of the centre of gravity, the place `at` @sole of the sole of `foot` being at rest, after
    /// [`TaskSpace::update_motion`].
    pub(crate) fn com_velocity(&self, foot: usize, at: &Vector3<f64>) -> Vector3<f64> {
        self.model.cog_motion(&self.data).0 + self.torso_velocity(foot, at)
    }

    /// \[m\] Centre of gravity.
    pub fn com(&self) -> Vector3<f64> {
        self.com
    }

    /// Sole frame of a foot.
    pub fn sole(&self, foot: usize) -> FramePose {
        self.place(&self.soles[foot])
    }

    /// \[m\] Origins of the joints from a sole up to the torso.
    pub fn chain(&self, foot: usize) -> impl Iterator<Item = Vector3<f64>> + '_ {
        let joints = std::iter::successors(self.soles[foot].joint(), |&joint| self.model.parent_joint(joint));
        joints.map(|joint| self.model.joint_position(&self.data, joint))
    }

    /// \[m\], \[m/rad\] Centre of gravity of all that a joint carries, and how the joint moves it.
    pub fn limb(&self, joint: usize) -> (Vector3<f64>, Vector3<f64>) {
        self.model.carried_cog(&self.data, joint)
    }

    /// Of each foot the first joint from the torso on that the other foot does not hang on.
    pub fn hips(&self) -> [usize; 2] {
        let chain =
            |foot: usize| std::iter::successors(self.soles[foot].joint(), |&j| self.model.parent_joint(j));
        let own = |foot: usize| chain(foot).take_while(|&j| chain(1 - foot).all(|k| k != j)).last();
        [own(0).unwrap_or(0), own(1).unwrap_or(0)]
    }

    /// A link's own frame.
    pub fn link(&self, name: &str) -> Result<FramePose, ModelError> {
        Ok(self.place(&self.model.frame(name, [0.0; 3])?))
    }

    /// \[m/s\] @torso Velocity of the torso's origin, the place `at` @sole of the sole of `foot` being at rest, after
    /// [`TaskSpace::update_motion`].
    pub(crate) fn torso_velocity(&self, foot: usize, at: &Vector3<f64>) -> Vector3<f64> {
        let sole = self.model.frame_velocity(&self.data, &self.soles[foot]);
        -sole.linear - sole.angular.cross(&(self.sole(foot).rotation * at))
    }

    /// Sensor frame of a foot.
    pub fn sensor(&self, foot: usize) -> FramePose {
        self.place(&self.sensors[foot])
    }

    /// \[m\] Contact points of a foot relative to its sole frame, in the present joint angles.
    pub(crate) fn contact_points(&self, foot: usize) -> impl Iterator<Item = Vector3<f64>> + Clone + '_ {
        let sole = self.sole(foot);
        let back = sole.rotation.transpose();
        let at = |frame| self.model.frame_position(&self.data, frame);
        self.points[foot].iter().map(move |frame| back * (at(frame) - sole.position))
    }

    fn place(&self, frame: &Frame) -> FramePose {
        let pose = self.model.frame_pose(&self.data, frame);
        FramePose { position: pose.translation.vector, rotation: *pose.rotation.matrix() }
    }

    /// Jacobian of both soles' position relative to the centre of gravity and of their rotation; the rows of the
    /// soles' motion relative to the torso stay available as [`TaskSpace::sole_jacobian`].
    pub fn task_jacobian(&mut self, jacobian: &mut TaskJacobian) {
        self.model.cog_jacobian_of_joints(&self.data, &mut self.com_jacobian);
        for foot in 0..2 {
            let sole = &mut self.sole_jacobian[foot];
            self.model.frame_jacobian_of_joints(&self.data, &self.soles[foot], sole);
            for j in 0..self.n {
                for row in 0..6 {
                    let com = if row < 3 { self.com_jacobian[(row, j)] } else { 0.0 };
                    jacobian[(6 * foot + row, j)] = sole[(row, j)] - com;
                }
            }
        }
    }

    /// Jacobian of a sole against the torso, 6 x joints, from the last [`TaskSpace::task_jacobian`].
    pub fn sole_jacobian(&self, foot: usize) -> &OMatrix<f64, U6, Dyn> {
        &self.sole_jacobian[foot]
    }
}
