//! The reduced model, type 1 of thesis table 2.4: six torso degrees of freedom with the full multibody terms, joints
//! that follow their targets (2.74)-(2.81), and massless viscoelastic contact points.
//!
//! | symbol | name | unit | frame | in the state vector |
//! |---|---|---|---|---|
//! | r | origin of the torso | m | world | 0..3 |
//! | o | quaternion world_from_torso (x, y, z, w) | 1 | | 3..7 |
//! | v, w | velocity of the origin, angular velocity | m/s, rad/s | torso | 7..13 |
//! | d | displacement of each contact node | m | world | 13.. |
//!
//! The ground is the plane z = 0. Counting velocities and displacements this is the ODE of 60 states of table 2.4 (12
//! mechanical, 48 of contact), plus one redundant quaternion component.

use config::Robot;
use config::robot::Contact;
use contact::point::{self, Law};
use messages::Wrench;
use multibody::{Data, Frame, Model, ModelError};
use nalgebra::{UnitQuaternion, Vector3, Vector6};

use crate::drive::Drive;

const POSE: usize = 7;
const NODES: usize = 13;

/// One contact point.
struct Node {
    frame: Frame,
    foot: usize,
}

/// The equations of motion of one robot on flat ground.
pub struct Plant {
    model: Model,
    data: Data,
    nodes: Vec<Node>,
    soles: [Frame; 2],
    law: Law,
    scratch: Scratch,
}

/// What a right-hand side leaves behind.
struct Scratch {
    q: Vec<f64>,
    v: Vec<f64>,
    joint_acceleration: Vec<f64>,
    rate: Vec<f64>,
    /// Place of each node and force of the ground on it, world.
    contacts: Vec<(Vector3<f64>, Vector3<f64>)>,
}

/// Result of one evaluation at the end of a cycle: what sensors and logs want to know.
#[derive(Clone, Copy, Debug)]
pub struct Snapshot {
    /// \[N, N m\] @world Ground on each foot, moment about the sole frame.
    pub foot_wrench: [Wrench; 2],
    /// \[m, rad\] @world Sole frames: x, y, z, heading.
    pub feet: [[f64; 4]; 2],
    /// \[m\] @world
    pub com: Vector3<f64>,
    /// \[m/s^2\] @torso Acceleration of the torso's origin less gravity.
    pub specific_force: Vector3<f64>,
}

/// Everything that acts on the robot from outside except the ground.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outside {
    /// \[N\] @world Push at the torso's own centre of gravity.
    pub push: [f64; 3],
}

impl Plant {
    /// Builds the model of `robot`; allocates everything.
    pub fn new(robot: &Robot) -> Result<Self, ModelError> {
        let order: Vec<&str> = robot.joints.iter().map(|j| j.name.as_str()).collect();
        let model = Model::from_urdf(&robot.urdf, &robot.torso, &order)?;
        let mut nodes = Vec::new();
        for (foot, f) in robot.feet.iter().enumerate() {
            for (link, at) in &f.points {
                nodes.push(Node { frame: model.frame(link, *at)?, foot });
            }
        }
        let soles = [
            model.frame(&robot.feet[0].link, robot.feet[0].sole)?,
            model.frame(&robot.feet[1].link, robot.feet[1].sole)?,
        ];
        let scratch = Scratch {
            q: model.neutral(),
            v: vec![0.0; model.nv()],
            joint_acceleration: vec![0.0; model.n()],
            rate: vec![0.0; NODES + 3 * nodes.len()],
            contacts: vec![Default::default(); nodes.len()],
        };
        Ok(Self { data: Data::new(&model), law: law(&robot.contact), model, nodes, soles, scratch })
    }

    /// Length of the state vector.
    pub fn states(&self) -> usize {
        NODES + 3 * self.nodes.len()
    }

    /// Torso upright over flat soles, nodes pressed in by the robot's weight, at rest.
    pub fn standing(&mut self, joints: &[f64]) -> Vec<f64> {
        let mut x = vec![0.0; self.states()];
        x[6] = 1.0;
        self.scratch.q[..POSE].copy_from_slice(&x[..POSE]);
        self.scratch.q[POSE..].copy_from_slice(joints);
        self.model.forward_kinematics(&mut self.data, &self.scratch.q);
        let low = |n: &Node| self.model.frame_position(&self.data, &n.frame).z;
        let lowest = self.nodes.iter().map(low).fold(f64::INFINITY, f64::min);
        let weight = self.model.mass() * -multibody::GRAVITY.z;
        let deflection = weight / (self.law.stiffness[2] * self.nodes.len() as f64);
        x[2] = -lowest - deflection;
        for (i, n) in self.nodes.iter().enumerate() {
            x[NODES + 3 * i + 2] = (-(low(n) + x[2])).max(0.0);
        }
        x
    }

    /// The derivative of `x` when the joints move as `drives` say, `tau` \[s\] into the cycle.
    pub fn rate(&mut self, tau: f64, x: &[f64], drives: &[Drive], outside: &Outside, dx: &mut [f64]) {
        self.load(tau, x, drives);
        let Self { model, data, nodes, law, scratch, .. } = self;
        model.forward_motion(data, &scratch.q, &scratch.v);
        let mut base_force = Vector6::zeros();
        for (i, node) in nodes.iter().enumerate() {
            let at = NODES + 3 * i;
            let d = [x[at], x[at + 1], x[at + 2]];
            let p = model.frame_position(data, &node.frame);
            let w = model.frame_velocity(data, &node.frame).linear;
            let answer = point::solve(law, d, w.into(), p.z + d[2]);
            dx[at..at + 3].copy_from_slice(&answer.rate);
            scratch.contacts[i] = (p + Vector3::from(d), answer.force.into());
            if answer.state != point::State::Open {
                base_force += at_base(x, &scratch.contacts[i].0, &scratch.contacts[i].1);
            }
        }
        let pushed = Vector3::new(x[0], x[1], x[2]) + orientation(x) * model.base_cog();
        base_force += at_base(x, &pushed, &outside.push.into());
        let (m, bias) = model.base_dynamics(data, &scratch.q, &scratch.v, &scratch.joint_acceleration);
        let acceleration = m.cholesky().map_or(Vector6::zeros(), |c| c.solve(&(base_force - bias))); // (2.80)
        let o = orientation(x);
        let velocity = o * Vector3::new(x[7], x[8], x[9]);
        dx[..3].copy_from_slice(velocity.as_slice());
        dx[3..7].copy_from_slice(&quaternion_rate(x));
        dx[POSE..NODES].copy_from_slice(acceleration.as_slice());
    }

    /// What the state looks like from outside.
    pub fn snapshot(&mut self, tau: f64, x: &[f64], drives: &[Drive], outside: &Outside) -> Snapshot {
        let mut rate = std::mem::take(&mut self.scratch.rate);
        self.rate(tau, x, drives, outside, &mut rate);
        let velocity = Vector3::new(x[7], x[8], x[9]);
        let omega = Vector3::new(x[10], x[11], x[12]);
        let acceleration = Vector3::new(rate[7], rate[8], rate[9]) + omega.cross(&velocity);
        self.scratch.rate = rate;
        let Self { model, data, nodes, soles, scratch, .. } = self;
        model.forward_kinematics(data, &scratch.q);
        let mut foot_wrench = [Wrench { force: [0.0; 3], moment: [0.0; 3] }; 2];
        for (node, (at, force)) in nodes.iter().zip(&scratch.contacts) {
            let moment = (at - model.frame_position(data, &soles[node.foot])).cross(force);
            for k in 0..3 {
                foot_wrench[node.foot].force[k] += force[k];
                foot_wrench[node.foot].moment[k] += moment[k];
            }
        }
        let feet = std::array::from_fn(|i| {
            let pose = model.frame_pose(data, &soles[i]);
            let (r, p) = (pose.rotation.matrix(), pose.translation.vector);
            [p.x, p.y, p.z, r[(1, 0)].atan2(r[(0, 0)])]
        });
        Snapshot {
            foot_wrench,
            feet,
            com: model.cog(data),
            specific_force: acceleration - orientation(x).inverse() * multibody::GRAVITY,
        }
    }

    /// Pose of a frame after [`Plant::snapshot`].
    pub fn frame_pose(&self, frame: &Frame) -> nalgebra::IsometryMatrix3<f64> {
        self.model.frame_pose(&self.data, frame)
    }

    /// The multibody model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    fn load(&mut self, tau: f64, x: &[f64], drives: &[Drive]) {
        let Scratch { q, v, joint_acceleration, .. } = &mut self.scratch;
        q[..POSE].copy_from_slice(&x[..POSE]);
        q[3..POSE].copy_from_slice(&<[f64; 4]>::from(orientation(x).into_inner().coords));
        v[..6].copy_from_slice(&x[POSE..NODES]);
        for (j, drive) in drives.iter().enumerate().take(joint_acceleration.len()) {
            let m = drive.at(tau);
            (q[POSE + j], v[6 + j], joint_acceleration[j]) = (m.angle, m.speed, m.acceleration);
        }
    }
}

fn law(c: &Contact) -> Law {
    let stiffness = [c.tangential_stiffness, c.tangential_stiffness, c.normal_stiffness];
    // Penetration of a finite step is taken back within a few milliseconds, much faster than the layer relaxes.
    Law { stiffness, damping: stiffness.map(|k| k * c.damping_time), friction: c.friction, recovery: 200.0 }
}

/// world_from_torso of a state; the quaternion is normalised here, so that integrators need not.
pub fn orientation(x: &[f64]) -> UnitQuaternion<f64> {
    UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(x[6], x[3], x[4], x[5]))
}

/// o' = o w / 2, components x, y, z, w.
fn quaternion_rate(x: &[f64]) -> [f64; 4] {
    let o = nalgebra::Quaternion::new(x[6], x[3], x[4], x[5]);
    let w = nalgebra::Quaternion::new(0.0, x[10], x[11], x[12]);
    (o * w * 0.5).coords.into()
}

/// Force and moment about the torso's origin, torso axes, of a force \[N\] acting at `at` \[m\], both in the world.
fn at_base(x: &[f64], at: &Vector3<f64>, force: &Vector3<f64>) -> Vector6<f64> {
    let inverse = orientation(x).inverse();
    let (f, m) = (inverse * force, inverse * (at - Vector3::new(x[0], x[1], x[2])).cross(force));
    Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrate::Stepper;
    use config::scene::Integrator;

    fn lola() -> (Plant, Vec<f64>) {
        let robot = Robot::load(&config::root(None).join("robots/lola")).unwrap();
        let pose = robot.poses["stand"].clone();
        (Plant::new(&robot).unwrap(), pose)
    }

    /// The count of thesis table 2.4 for type 1: 12 mechanical and 48 contact states.
    #[test]
    fn has_the_states_of_table_2_4() {
        let (plant, _) = lola();
        assert_eq!(plant.states() - 1, 60);
    }

    /// Standing still: the ground carries the weight, the centre of pressure lies under the centre of gravity.
    #[test]
    fn settles_into_static_equilibrium() {
        let (mut plant, pose) = lola();
        let drives: Vec<Drive> = pose.iter().map(|&q| Drive::resting(q)).collect();
        let mut x = plant.standing(&pose);
        let mut stepper = Stepper::new(x.len());
        let none = Outside::default();
        for _ in 0..15_000 {
            stepper
                .step(Integrator::Euler, 0.0, 1e-3, &mut x, |t, x, dx| plant.rate(t, x, &drives, &none, dx));
        }
        let s = plant.snapshot(0.0, &x, &drives, &none);
        let weight = plant.model().mass() * 9.81;
        let fz: f64 = s.foot_wrench.iter().map(|w| w.force[2]).sum();
        assert!((fz - weight).abs() < 1e-3, "{fz} N");
        // (3.5), (3.6) about the ground, both feet
        let p_x: f64 = (0..2)
            .map(|i| s.feet[i][0] * s.foot_wrench[i].force[2] - s.foot_wrench[i].moment[1])
            .sum::<f64>()
            / fz;
        let p_y: f64 = (0..2)
            .map(|i| s.feet[i][1] * s.foot_wrench[i].force[2] + s.foot_wrench[i].moment[0])
            .sum::<f64>()
            / fz;
        // The soles sit within 2 mm of the ground, so horizontal forces shift the centre of pressure by less than that.
        assert!((p_x - s.com.x).abs() < 1e-4 && (p_y - s.com.y).abs() < 1e-4, "{p_x} {p_y} {}", s.com);
    }

    /// In the air nothing acts but gravity: momentum about the CoG is kept, the CoG falls as a parabola.
    #[test]
    fn falls_freely() {
        let (mut plant, pose) = lola();
        let drives: Vec<Drive> = pose.iter().map(|&q| Drive::resting(q)).collect();
        let mut x = plant.standing(&pose);
        x[2] += 1.0;
        x[10..13].copy_from_slice(&[0.3, -0.2, 0.5]);
        x[NODES..].fill(0.0);
        let mut stepper = Stepper::new(x.len());
        let none = Outside::default();
        let start = plant.snapshot(0.0, &x, &drives, &none).com;
        let momentum = |plant: &mut Plant, x: &[f64]| {
            plant.load(0.0, x, &drives);
            let Plant { model, data, scratch, .. } = plant;
            model.forward_motion(data, &scratch.q, &scratch.v);
            model.cog(data);
            model.momentum(data)
        };
        let before = momentum(&mut plant, &x);
        for _ in 0..300 {
            stepper.step(Integrator::RungeKutta4, 0.0, 1e-3, &mut x, |t, x, dx| {
                plant.rate(t, x, &drives, &none, dx);
            });
        }
        let after = momentum(&mut plant, &x);
        let end = plant.snapshot(0.0, &x, &drives, &none).com;
        let v0 = before.linear / plant.model().mass();
        let expected = start + v0 * 0.3 - Vector3::z() * (0.5 * 9.81 * 0.09);
        assert!((end - expected).norm() < 1e-9, "{}", (end - expected).norm());
        assert!((after.angular - before.angular).norm() < 1e-9 * before.angular.norm());
    }

    /// Joints that move by themselves turn the floating torso against them: total momentum stays.
    #[test]
    fn moving_joints_keep_the_momentum_in_the_air() {
        let (mut plant, pose) = lola();
        let mut drives: Vec<Drive> = pose.iter().map(|&q| Drive::resting(q)).collect();
        for (j, d) in drives.iter_mut().enumerate() {
            let from = crate::drive::Motion { angle: pose[j], ..Default::default() };
            *d = Drive::follow(from, pose[j] + 0.02, 0.0, 0.1);
        }
        let mut x = plant.standing(&pose);
        x[2] += 1.0;
        x[NODES..].fill(0.0);
        let mut stepper = Stepper::new(x.len());
        let none = Outside::default();
        for i in 0..50 {
            let t0 = f64::from(i) * 1e-3;
            stepper.step(Integrator::RungeKutta4, t0, 1e-3, &mut x, |t, x, dx| {
                plant.rate(t, x, &drives, &none, dx);
            });
        }
        plant.load(0.05, &x, &drives);
        let Plant { model, data, scratch, .. } = &mut plant;
        model.forward_motion(data, &scratch.q, &scratch.v);
        model.cog(data);
        let m = model.momentum(data);
        assert!((m.linear + Vector3::z() * (model.mass() * 9.81 * 0.05)).norm() < 1e-7, "{}", m.linear);
        assert!(m.angular.norm() < 1e-7, "{}", m.angular);
    }
}
