//! The contact layer under the feet: what the ground does to each segment, and how fast the nodes move.
//!
//! | symbol | name | unit | frame |
//! |---|---|---|---|
//! | d | displacement of a node from its place on the undeformed sole | m | world |
//! | F, T | force and moment of the ground on a segment (2.38), (2.39) | N, N m | world, about the segment's origin |

use config::Robot;
use multibody::{Data, Frame, Model, ModelError};
use nalgebra::Vector3;

use contact::point::{self, Law, State};

/// Force of the ground at one node.
#[derive(Clone, Copy, Debug)]
pub struct Touch {
    /// Right or left foot.
    pub foot: usize,
    /// \[m\] @world The node, deformed.
    pub at: Vector3<f64>,
    /// \[N\] @world
    pub force: Vector3<f64>,
    /// Open, sticking or sliding.
    pub state: State,
}

/// A link that carries contact elements.
struct Segment {
    frame: Frame,
    foot: usize,
    /// Places of its nodes, link axes.
    nodes: Vec<Vector3<f64>>,
    force: Vector3<f64>,
    moment: Vector3<f64>,
}

/// Contact elements of both feet.
pub struct Feet {
    law: Law,
    segments: Vec<Segment>,
    touches: Vec<Touch>,
}

impl Feet {
    /// The contact points of a robot.
    pub fn new(robot: &Robot, model: &Model) -> Result<Self, ModelError> {
        let mut segments: Vec<Segment> = Vec::new();
        let mut names: Vec<&str> = Vec::new();
        for (foot, description) in robot.feet.iter().enumerate() {
            for (link, at) in &description.points {
                let i = match names.iter().position(|n| n == link) {
                    Some(i) => i,
                    None => {
                        names.push(link);
                        segments.push(Segment::new(model.frame(link, [0.0; 3])?, foot));
                        names.len() - 1
                    }
                };
                segments[i].nodes.push(Vector3::from(*at));
            }
        }
        let touches = segments.iter().flat_map(|s| s.nodes.iter().map(|_| Touch::none(s.foot))).collect();
        Ok(Self { law: law(robot), segments, touches })
    }

    /// Contact nodes of both feet.
    pub fn nodes(&self) -> usize {
        self.touches.len()
    }

    /// Frames of all segments.
    pub fn frames(&self) -> Vec<Frame> {
        self.segments.iter().map(|s| s.frame).collect()
    }

    /// Stiffness of all nodes together, normal to the ground \[N/m\].
    pub fn normal_stiffness(&self) -> f64 {
        self.law.stiffness[2] * self.nodes() as f64
    }

    /// Height \[m\] of every undeformed node, in the order of the state; after the model's kinematics.
    pub fn heights<'a>(&'a self, model: &'a Model, data: &'a Data) -> impl Iterator<Item = f64> + 'a {
        let of = move |s: &'a Segment| {
            let pose = model.frame_pose(data, &s.frame);
            s.nodes.iter().map(move |n| (pose * nalgebra::Point3::from(*n)).z)
        };
        self.segments.iter().flat_map(of)
    }

    /// Forces of the ground and rates of the nodes `rate` for displacements `d`, after the model's kinematics and motion.
    pub fn update(&mut self, model: &Model, data: &Data, d: &[f64], rate: &mut [f64]) {
        let Self { law, segments, touches } = self;
        let mut touches = touches.iter_mut();
        let mut at = 0;
        for s in segments {
            let (pose, twist) = (model.frame_pose(data, &s.frame), model.frame_velocity(data, &s.frame));
            (s.force, s.moment) = (Vector3::zeros(), Vector3::zeros());
            for (place, touch) in s.nodes.iter().zip(&mut touches) {
                let arm = pose.rotation * place;
                let d = Vector3::new(d[at], d[at + 1], d[at + 2]);
                let w = twist.linear + twist.angular.cross(&arm);
                let node = pose.translation.vector + arm + d;
                let answer = point::solve(law, d.into(), w.into(), node.z);
                rate[at..at + 3].copy_from_slice(&answer.rate);
                let force = Vector3::from(answer.force);
                *touch = Touch { at: node, force, state: answer.state, ..*touch };
                if answer.state != State::Open {
                    s.force += force; // (2.38)
                    s.moment += (arm + d).cross(&force); // (2.39) with the deformed node
                }
                at += 3;
            }
        }
    }

    /// Adds what the ground does to a generalized force (2.40), after [`Feet::update`].
    pub fn add_to(&self, model: &Model, data: &Data, generalized: &mut [f64]) {
        for s in self.segments.iter().filter(|s| s.force != Vector3::zeros()) {
            model.add_wrench(data, &s.frame, &s.force, &s.moment, generalized);
        }
    }

    /// Force and moment about the world's origin of the ground on the robot, world axes.
    pub fn total(&self, model: &Model, data: &Data) -> (Vector3<f64>, Vector3<f64>) {
        self.segments.iter().filter(|s| s.force != Vector3::zeros()).fold(Default::default(), |(f, n), s| {
            let at = model.frame_position(data, &s.frame);
            (f + s.force, n + s.moment + at.cross(&s.force))
        })
    }

    /// Every node, in the order of the state.
    pub fn touches(&self) -> &[Touch] {
        &self.touches
    }
}

impl Touch {
    fn none(foot: usize) -> Self {
        Self { foot, at: Vector3::zeros(), force: Vector3::zeros(), state: State::Open }
    }
}

impl Segment {
    fn new(frame: Frame, foot: usize) -> Self {
        Self { frame, foot, nodes: Vec::new(), force: Vector3::zeros(), moment: Vector3::zeros() }
    }
}

fn law(robot: &Robot) -> Law {
    let c = &robot.contact;
    let stiffness = [c.tangential_stiffness, c.tangential_stiffness, c.normal_stiffness];
    // Penetration of a finite step is taken back within a few milliseconds, much faster than the layer relaxes.
    Law { stiffness, damping: stiffness.map(|k| k * c.damping_time), friction: c.friction, recovery: 200.0 }
}
