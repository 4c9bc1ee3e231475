//! The equations of motion of one robot: bodies, drives and contact layer put together as deep as a scene asks.
//!
//! | type | joints | gears | contact | thesis |
//! |---|---|---|---|---|
//! | 1 | follow their targets (2.80), (2.81) | | points | reduced model |
//! | 2 | have dynamics of their own, with motors and their controllers | rigid | points | |
//! | 3 | as 2 | elastic | points | |
//! | 4 | as 2 | rigid | pads of finite elements | |
//! | 5 | as 2 | elastic | pads of finite elements | |
//!
//! The states are in [`crate::layout`], the drives in [`crate::train`], the contact in [`crate::feet`].

use std::error::Error;

use config::Robot;
use environment::Environment;
use messages::Wrench;
use multibody::{Data, Frame, Limbs, Model};
use nalgebra::{UnitQuaternion, Vector3, Vector6};

use crate::drive::{Drive, Motion};
use crate::feet::Feet;
use crate::implicit::Step;
use crate::layout::Layout;
pub use crate::outside::Outside;
use crate::outside::{at_base, outside_force};
use crate::sensors::carried;
use crate::train::{Fault, Given, Train, rotors};

/// The equations of motion of one robot.
#[derive(Clone)]
pub struct Plant {
    model: Model,
    data: Data,
    layout: Layout,
    environment: Environment,
    feet: Feet,
    /// What the feet's frames hang on.
    limbs: Limbs,
    soles: [Frame; 2],
    train: Option<Train>,
    /// \[s\] Length of the implicit steps by which the state moves; none if it moves by [`Plant::rate`].
    implicit: Option<f64>,
    scratch: Scratch,
}

/// What an evaluation leaves behind.
#[derive(Clone)]
struct Scratch {
    q: Vec<f64>,
    v: Vec<f64>,
    joint_acceleration: Vec<f64>,
    /// Where the joints are to be.
    reference: Vec<Motion>,
    force: Vec<f64>,
    acceleration: Vec<f64>,
    bias: Vec<f64>,
    layer_rate: Vec<f64>,
    next: Vec<f64>,
    rate: Vec<f64>,
    /// q, v and d of the last evaluation, whose kinematics, gears and contact forces still hold.
    seen: Vec<f64>,
    steps: Vec<Step>,
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
    /// \[rad/s^2\] @torso
    pub angular_acceleration: Vector3<f64>,
}

impl Plant {
    /// The model of `robot` of type `depth` on `environment`; allocates everything. `pose` \[rad\] is where the controllers
    /// of the drives are tuned.
    ///
    /// # Errors
    /// The robot's data do not fit together, or it lacks what the type needs: drives above type 1, pads above type 3.
    pub fn new(
        robot: &Robot,
        environment: Environment,
        depth: u8,
        pose: &[f64],
    ) -> Result<Self, Box<dyn Error>> {
        let (dynamic, elastic, pads) = (depth > 1, depth == 3 || depth == 5, depth > 3);
        if dynamic && robot.drives.is_empty() {
            return Err(format!(
                "robot `{}`: robot.toml has no [[drive]]; choose depth 1, or describe the drives",
                robot.name
            )
            .into());
        }
        let order: Vec<&str> = robot.joints.iter().map(|j| j.name.as_str()).collect();
        let model =
            Model::from_urdf(&robot.urdf, &robot.torso, &order)?.with_rotors(&rotors(robot, elastic))?;
        let feet = Feet::new(robot, &model, pads, environment.objects().len())?;
        let soles = [
            model.frame(&robot.feet[0].link, robot.feet[0].sole)?,
            model.frame(&robot.feet[1].link, robot.feet[1].sole)?,
        ];
        let driven = !robot.drives.is_empty();
        let train = driven.then(|| Train::new(robot, &model, elastic, pose)).transpose()?;
        let of_train = |count: fn(&Train) -> usize| train.as_ref().filter(|_| dynamic).map_or(0, count);
        let layout = Layout {
            joints: if dynamic { model.n() } else { 0 },
            elastic: of_train(Train::elastic),
            nodes: feet.nodes(),
            motors: of_train(Train::motors),
        };
        let scratch = Scratch::new(&model, &layout);
        let mut data = Data::new(&model);
        if let Some(train) = &train {
            train.set_constant_gears(&mut data);
        }
        let limbs = model.limbs(&feet.frames());
        Ok(Self {
            data,
            model,
            layout,
            environment,
            feet,
            limbs,
            soles,
            train,
            implicit: dynamic.then_some(1e-3),
            scratch,
        })
    }

    /// Where each state is.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Torso upright over flat soles, nodes pressed in by the robot's weight, at rest.
    pub fn standing(&mut self, joints: &[f64]) -> Vec<f64> {
        self.upright(joints, None)
    }

    /// Torso upright, soles `height` \[m\] over the ground, at rest.
    pub fn hanging(&mut self, joints: &[f64], height: f64) -> Vec<f64> {
        self.upright(joints, Some(height))
    }

    fn upright(&mut self, joints: &[f64], height: Option<f64>) -> Vec<f64> {
        let l = self.layout;
        let mut x = vec![0.0; l.len()];
        x[6] = 1.0;
        self.scratch.q[..7].copy_from_slice(&x[..7]);
        self.scratch.q[7..].copy_from_slice(joints);
        self.model.forward_kinematics(&mut self.data, &self.scratch.q);
        self.scratch.seen.fill(f64::NAN);
        let depth = match height {
            None => self.feet.deflection(self.model.mass() * -multibody::GRAVITY.z),
            Some(height) => -height,
        };
        x[2] = -self.feet.lowest(&self.model, &self.data) - depth;
        if height.is_none() {
            self.feet.press(&self.model, &self.data, depth, &mut x[l.layer()]);
        }
        x[7..7 + l.joints].copy_from_slice(&joints[..l.joints]);
        if let Some(train) = &self.train {
            train.relax(joints, &mut x[l.rotor_angle()]);
        }
        x
    }

    /// Where the joints are, and how fast, in a state; type 1: as its references say.
    pub fn joints(&self, x: &[f64], reference: &[Motion], out: &mut [Motion]) {
        let l = &self.layout;
        if l.joints == 0 {
            out.copy_from_slice(reference);
            return;
        }
        let (q, v) = (&x[l.pose()][7..], &x[l.speed()][6..]);
        for (j, m) in out.iter_mut().enumerate() {
            *m = Motion { angle: q[j], speed: v[j], acceleration: self.scratch.acceleration[6 + j] };
        }
    }

    /// The sampled controllers measure, at the begin of a cycle \[s\] in state `x`, and compute what they hold until the next.
    pub fn sample(&mut self, cycle: f64, x: &[f64], drives: &[Drive], outside: &Outside) {
        let l = self.layout;
        if l.joints > 0 && self.train.as_ref().is_some_and(Train::is_sampled) {
            self.load(0.0, x, drives);
            let Self { data, scratch, train: Some(train), .. } = self else { return };
            let given = given(&l, x, &scratch.reference, outside);
            train.load(&given, data);
            train.sample(cycle, &given);
        }
    }

    /// The derivative of `x` with the references of `drives`, `tau` \[s\] into the cycle.
    pub fn rate(&mut self, tau: f64, x: &[f64], drives: &[Drive], outside: &Outside, dx: &mut [f64]) {
        self.implicit = None;
        let l = self.layout;
        self.load(tau, x, drives);
        self.touch_ground(&x[l.layer()]);
        let Self { model, data, feet, scratch, train, .. } = self;
        dx[l.layer()].copy_from_slice(&scratch.layer_rate);
        if l.joints == 0 {
            self.base_rate(x, outside);
        } else {
            let Scratch { v, force, acceleration, .. } = scratch;
            outside_force(model, data, feet, outside, (x, &x[l.speed()]), force);
            if let Some(train) = train {
                let given = given(&l, x, &scratch.reference, outside);
                train.load(&given, data);
                train.explicit(&given, data, &mut force[6..], &mut dx[l.current()]);
                model.forward_dynamics_here(data, v, force, acceleration);
                train.rotor_rates(model, data, &mut dx[l.rotor_speed()]);
            }
        }
        let scratch = &self.scratch;
        dx[l.speed()].copy_from_slice(&scratch.acceleration[..6 + l.joints]);
        for (i, at) in l.rotor_angle().enumerate() {
            dx[at] = x[l.rotor_speed().start + i];
        }
        let velocity = orientation(x) * Vector3::from_column_slice(&x[l.speed()][..3]);
        dx[..3].copy_from_slice(velocity.as_slice());
        dx[3..7].copy_from_slice(&quaternion_rate(x, &x[l.speed()][3..6]));
        dx[7..7 + l.joints].copy_from_slice(&scratch.v[6..6 + l.joints]);
    }

    /// One semi-implicit step of `h` \[s\]: contact forces of its begin; motors, controllers, springs and dry friction of
    /// its end; then positions with the speeds of the end. First order.
    pub fn implicit_step(&mut self, tau: f64, h: f64, x: &mut [f64], drives: &[Drive], outside: &Outside) {
        let l = self.layout;
        self.implicit = Some(h);
        // References of the end of the step, with which the drives work.
        self.load(if l.joints == 0 { tau } else { tau + h }, x, drives);
        self.accelerate(h, x, outside);
        let Self { model, scratch, train, .. } = self;
        let Scratch { q, v, acceleration, next, .. } = scratch;
        for (v, a) in v.iter_mut().zip(&acceleration[..6 + l.joints]) {
            *v += h * a;
        }
        if let Some(train) = train.as_mut().filter(|_| l.joints > 0) {
            for j in train.held_joints() {
                v[6 + j] = 0.0;
            }
            let (before, current) = x.split_at_mut(l.current().start);
            let (before, rotor_speed) = before[..l.rotor_speed().end].split_at_mut(l.rotor_speed().start);
            let rotor_angle = &mut before[l.rotor_angle()];
            train.end(h, current, (rotor_angle, rotor_speed));
        }
        model.integrate(q, v, h, next);
        x[l.pose()].copy_from_slice(&next[..7 + l.joints]);
        x[l.speed()].copy_from_slice(&v[..6 + l.joints]);
        for (d, rate) in x[l.layer()].iter_mut().zip(&scratch.layer_rate) {
            *d += h * rate;
        }
    }

    /// What the state looks like from outside.
    pub fn snapshot(&mut self, tau: f64, x: &[f64], drives: &[Drive], outside: &Outside) -> Snapshot {
        match self.implicit {
            None => {
                let mut rate = std::mem::take(&mut self.scratch.rate);
                self.rate(tau, x, drives, outside, &mut rate);
                self.scratch.rate = rate;
            }
            Some(h) => self.try_acceleration(tau, h, x, drives, outside),
        }
        let (speed, change) = (&x[self.layout.speed()], &self.scratch.acceleration);
        let omega = Vector3::from_column_slice(&speed[3..6]);
        let acceleration =
            Vector3::from_column_slice(&change[..3]) + omega.cross(&Vector3::from_column_slice(&speed[..3]));
        let angular_acceleration = Vector3::from_column_slice(&change[3..6]);
        let Self { model, data, feet, soles, .. } = self;
        model.forward_kinematics_here(data);
        let mut foot_wrench = [Wrench { force: [0.0; 3], moment: [0.0; 3] }; 2];
        for (foot, wrench) in foot_wrench.iter_mut().enumerate() {
            let (force, moment) =
                feet.total(model, data, &model.frame_position(data, &soles[foot]), Some(foot));
            *wrench = Wrench { force: force.into(), moment: moment.into() };
        }
        let sole_places = std::array::from_fn(|i| {
            let pose = model.frame_pose(data, &soles[i]);
            let (r, p) = (pose.rotation.matrix(), pose.translation.vector);
            [p.x, p.y, p.z, r[(1, 0)].atan2(r[(0, 0)])]
        });
        Snapshot {
            foot_wrench,
            feet: sole_places,
            com: model.cog(data),
            specific_force: acceleration - orientation(x).inverse() * multibody::GRAVITY,
            angular_acceleration,
        }
    }

    /// What carries and moves the bodies below each force sensor; after [`Plant::snapshot`], whose acceleration it takes.
    pub fn carried(&mut self, sensors: &[Frame; 2]) -> [Wrench; 2] {
        let Self { model, data, scratch, .. } = self;
        model.inverse_dynamics_here(data, &scratch.v, &scratch.acceleration, &mut scratch.bias);
        sensors.map(|frame| carried::inertial(model, data, &frame))
    }

    /// Motors in a state: angles and speeds in joint units, which hold the joints' on entry, and currents.
    pub fn motors(&self, x: &[f64], angle: &mut [f64], speed: &mut [f64], current: &mut [f64]) {
        let l = &self.layout;
        if let Some(train) = &self.train {
            train.motor_side((&x[l.rotor_angle()], &x[l.rotor_speed()]), angle, speed);
        }
        current[..l.motors].copy_from_slice(&x[l.current()]);
    }

    /// Pose of a frame after [`Plant::snapshot`].
    pub fn frame_pose(&self, frame: &Frame) -> nalgebra::IsometryMatrix3<f64> {
        self.model.frame_pose(&self.data, frame)
    }

    /// The multibody model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The drives, for who tunes them; type 1 without motors has none.
    pub fn train_mut(&mut self) -> Option<&mut Train> {
        self.train.as_mut()
    }

    /// Moves the objects of the environment to `time` \[s\], as far as nothing touches them; what happened.
    pub fn advance(&mut self, time: f64) -> &[environment::Event] {
        if !self.environment.objects().is_empty() {
            self.scratch.seen.fill(f64::NAN);
        }
        self.environment.advance(time, self.feet.touched(), self.feet.places())
    }

    /// How the solver of the pads ended at worst since the last call.
    pub fn take_contact_report(&mut self) -> contact::Report {
        self.feet.take_worst()
    }

    /// Something a drive could not do, since the last call.
    pub fn take_fault(&mut self) -> Option<Fault> {
        self.train.as_mut().and_then(Train::take_fault)
    }

    /// Kinematics of the feet and forces of the ground for the loaded q and v, unless they hold already: a cycle begins
    /// with the state that the sensors have seen.
    fn touch_ground(&mut self, d: &[f64]) {
        let Self { model, data, environment, feet, limbs, scratch, .. } = self;
        let Scratch { q, v, layer_rate, seen, .. } = scratch;
        let now = || q.iter().chain(v.iter()).chain(d);
        if seen.iter().eq(now()) {
            return;
        }
        for (seen, now) in seen.iter_mut().zip(now()) {
            *seen = *now;
        }
        model.set_position(data, q);
        model.limb_motion_here(data, limbs, v);
        feet.update(model, data, environment, d, layer_rate);
    }

    /// Acceleration over an implicit step of `h` \[s\] from the loaded state: drives and dry friction at its end.
    fn accelerate(&mut self, h: f64, x: &[f64], outside: &Outside) {
        let l = self.layout;
        self.touch_ground(&x[l.layer()]);
        let Self { model, data, feet, scratch, train, .. } = self;
        let Some(train) = train.as_mut().filter(|_| l.joints > 0) else {
            return self.base_rate(x, outside);
        };
        let Scratch { v, force, acceleration, bias, .. } = scratch;
        outside_force(model, data, feet, outside, (x, &x[l.speed()]), force);
        let given = given(&l, x, &scratch.reference, outside);
        train.load(&given, data);
        train.free_rotors(data);
        model.dynamics_here(data, v, bias);
        for (f, b) in force.iter_mut().zip(&*bias) {
            *f -= b;
        }
        train.solve(h, &given, model, data, force, acceleration);
        if train.elastic() > 0 {
            model.accelerate(data, v, acceleration);
            train.turn_along(model, data);
        }
    }

    /// The acceleration that the next implicit step would find, and nothing moves.
    fn try_acceleration(&mut self, tau: f64, h: f64, x: &[f64], drives: &[Drive], outside: &Outside) {
        self.load(tau, x, drives);
        if let Some(train) = &self.train {
            self.scratch.steps.clear();
            self.scratch.steps.extend(train.steps());
        }
        self.accelerate(h, x, outside);
        if let Some(train) = &mut self.train {
            train.restore(&self.scratch.steps);
        }
    }

    /// Acceleration of the torso while the joints follow their references (2.80).
    fn base_rate(&mut self, x: &[f64], outside: &Outside) {
        let Self { model, data, feet, scratch, train, .. } = self;
        let Scratch { q, v, joint_acceleration, acceleration, .. } = scratch;
        if let Some(train) = train {
            train.load_prescribed(&q[7..], &v[6..], data);
        }
        let (force, moment) = feet.total(model, data, &Vector3::zeros(), None);
        let others = outside.total(model, x, &x[self.layout.speed()]);
        let base_force = at_base(x, &(force + others.0), &(moment + others.1));
        let (m, bias) = model.base_dynamics_here(data, v, joint_acceleration);
        let a = m.cholesky().map_or(Vector6::repeat(f64::NAN), |c| c.solve(&(base_force - bias)));
        acceleration[..6].copy_from_slice(a.as_slice());
        acceleration[6..].copy_from_slice(joint_acceleration);
    }

    fn load(&mut self, tau: f64, x: &[f64], drives: &[Drive]) {
        let l = &self.layout;
        let Scratch { q, v, joint_acceleration, reference, .. } = &mut self.scratch;
        for (r, drive) in reference.iter_mut().zip(drives) {
            *r = drive.at(tau);
        }
        q[..7 + l.joints].copy_from_slice(&x[l.pose()]);
        q[3..7].copy_from_slice(&<[f64; 4]>::from(orientation(x).into_inner().coords));
        v[..6 + l.joints].copy_from_slice(&x[l.speed()]);
        if l.joints == 0 {
            for (j, m) in reference.iter().enumerate() {
                (q[7 + j], v[6 + j], joint_acceleration[j]) = (m.angle, m.speed, m.acceleration);
            }
        }
    }
}

impl Scratch {
    fn new(model: &Model, layout: &Layout) -> Self {
        Self {
            q: model.neutral(),
            v: vec![0.0; model.nv()],
            joint_acceleration: vec![0.0; model.n()],
            reference: vec![Motion::default(); model.n()],
            force: vec![0.0; model.nv()],
            acceleration: vec![0.0; model.nv()],
            bias: vec![0.0; model.nv()],
            layer_rate: vec![0.0; 3 * layout.nodes],
            next: model.neutral(),
            rate: vec![0.0; layout.len()],
            seen: vec![f64::NAN; model.nq() + model.nv() + 3 * layout.nodes],
            steps: Vec::with_capacity(model.n()),
        }
    }
}

fn given<'a>(l: &Layout, x: &'a [f64], reference: &'a [Motion], outside: &Outside) -> Given<'a> {
    Given {
        joint: (&x[l.pose()][7..], &x[l.speed()][6..]),
        rotor: (&x[l.rotor_angle()], &x[l.rotor_speed()]),
        current: &x[l.current()],
        reference,
        powered: outside.powered,
        off: outside.off,
        braked: outside.braked,
        held: outside.held,
    }
}

/// world_from_torso of a state; the quaternion is normalised here, so that integrators need not.
pub fn orientation(x: &[f64]) -> UnitQuaternion<f64> {
    UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(x[6], x[3], x[4], x[5]))
}

/// o' = o w / 2, components x, y, z, w.
fn quaternion_rate(x: &[f64], w: &[f64]) -> [f64; 4] {
    let o = nalgebra::Quaternion::new(x[6], x[3], x[4], x[5]);
    let w = nalgebra::Quaternion::new(0.0, w[0], w[1], w[2]);
    (o * w * 0.5).coords.into()
}
