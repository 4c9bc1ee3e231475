//! The equations of motion of one robot: bodies, drives and contact layer put together as deep as a scene asks.
//!
//! Components: [`config::components`]; states: [`crate::layout`]; drives: [`crate::train`]; contact: [`crate::feet`].

mod moving_joints;
mod observation;

use std::error::Error;

use config::components::JointModel;
use config::plant_mismatch::PlantMismatch;
use config::{Components, Robot};
use environment::Environment;
use multibody::{Data, Model};
use nalgebra::{Vector3, Vector6};

use crate::drive::{JointCubic, JointMotion};
use crate::external_forces::at_base;
use crate::ground::GroundContact;
use crate::inputs::DriveSwitches;
pub use crate::inputs::{PlantInputs, Substep};
pub use crate::layout::orientation;
use crate::layout::{StateLayout, quaternion_rate};
use crate::masses;
use crate::shaft::TrainInputs;
use crate::train::{Train, TrainFault, rotors};

use moving_joints::{MovingJoints, of_moving};
pub use observation::Snapshot;

/// The equations of motion of one robot.
#[derive(Clone)]
pub struct Plant {
    model: Model,
    data: Data,
    components: Components,
    layout: StateLayout,
    ground: GroundContact,
    joints: Joints,
    /// Joints of the robot that this one has, if it has not all of them.
    moving: Option<MovingJoints>,
    scratch: Scratch,
}

/// Cause of the joints' motion, with its drives.
#[derive(Clone)]
enum Joints {
    /// They follow their references (2.80); rotors of drives, if the robot has some, turn along.
    Following(Option<Train>),
    /// Motors move them.
    Driven(Train),
}

/// Kinematics and forces of one evaluation.
#[derive(Clone)]
struct Scratch {
    q: Vec<f64>,
    v: Vec<f64>,
    joint_acceleration: Vec<f64>,
    /// References of the joints.
    reference: Vec<JointMotion>,
    force: Vec<f64>,
    acceleration: Vec<f64>,
    bias: Vec<f64>,
    next: Vec<f64>,
}

impl Plant {
    /// The model of `robot` with these components, or those of a type, on `environment`; allocates everything. `pose`
    /// \[rad\] is where the controllers of the drives are tuned, and locked joints held.
    ///
    /// # Errors
    /// The robot's data do not fit together, or it lacks what is to be computed: drives or pads.
    pub fn new(
        robot: &Robot,
        environment: Environment,
        components: impl Into<Components>,
        pose: &[f64],
    ) -> Result<Self, Box<dyn Error>> {
        let components = components.into();
        let driven = components.joints == JointModel::Motors;
        if driven && robot.drives.is_empty() {
            return Err(format!(
                "robot `{}`: robot.toml has no [[drive]]; choose depth 1, or describe the drives",
                robot.name
            )
            .into());
        }
        // Bodies first, then what acts on them: feet and drives name links and joints of the model.
        let computed = components.of_robot(robot);
        let outside = components.moving(robot);
        let name = |j: usize| robot.joints[j].name.as_str();
        let order: Vec<&str> = outside.iter().map(|&j| name(j)).collect();
        let locked: Vec<(&str, f64)> =
            (0..robot.joints.len()).filter(|j| !outside.contains(j)).map(|j| (name(j), pose[j])).collect();
        let model = Model::from_urdf_locked(&robot.urdf, &robot.torso, &order, &locked)?
            .with_rotors(&rotors(&computed))?;
        let moving = (!locked.is_empty()).then(|| MovingJoints {
            outside,
            reference: vec![JointMotion::default(); robot.joints.len()],
            locked: pose.to_vec(),
        });
        let pose = of_moving(moving.as_ref(), pose);
        let ground = GroundContact::new(robot, &model, environment, components.contact)?;
        let described = !computed.drives.is_empty();
        let train =
            described.then(|| Train::new(&computed, &model, components.currents, &pose)).transpose()?;
        let mut data = Data::new(&model);
        if let Some(train) = &train {
            train.set_constant_gears(&mut data);
        }
        // From here on the components are in `joints` and in `layout`, and are not asked for again.
        let nodes = ground.feet.nodes();
        let (joints, layout) = match train {
            Some(train) if driven => {
                let (elastic, motors) = (train.elastic(), train.motors());
                (Joints::Driven(train), StateLayout { joints: model.n(), elastic, nodes, motors })
            }
            train => (Joints::Following(train), StateLayout { joints: 0, elastic: 0, nodes, motors: 0 }),
        };
        let scratch = Scratch::new(&model);
        Ok(Self { model, data, components, layout, ground, joints, moving, scratch })
    }

    /// Bodies that do not weigh what they are described to; drives stay tuned to the described ones.
    ///
    /// # Errors
    /// A body would have an inertia that does not exist.
    pub(crate) fn weigh(&mut self, mismatch: &PlantMismatch) -> Result<(), multibody::ModelError> {
        self.model = masses::with_mismatch(self.model.clone(), mismatch)?;
        Ok(())
    }

    /// Components.
    pub fn components(&self) -> &Components {
        &self.components
    }

    /// Places of the states.
    pub fn layout(&self) -> &StateLayout {
        &self.layout
    }

    /// Torso upright over flat soles, nodes pressed in by the robot's weight, at rest. On tilted ground all of it is tilted: the
    /// soles lie on the ground.
    pub fn standing(&mut self, joints: &[f64]) -> Vec<f64> {
        let mut x = self.upright(joints, None);
        let Some(turn) = self.ground.turn_at_origin() else { return x };
        let turned = turn * Vector3::from_column_slice(&x[..3]);
        x[..3].copy_from_slice(turned.as_slice());
        x[3..7].copy_from_slice(turn.coords.as_slice());
        for node in x[self.layout.layer()].chunks_exact_mut(3) {
            let turned = turn * Vector3::from_column_slice(node);
            node.copy_from_slice(turned.as_slice());
        }
        x
    }

    /// Torso upright, soles `height` \[m\] over the ground, at rest.
    pub fn hanging(&mut self, joints: &[f64], height: f64) -> Vec<f64> {
        self.upright(joints, Some(height))
    }

    fn upright(&mut self, joints: &[f64], height: Option<f64>) -> Vec<f64> {
        let l = self.layout;
        let joints = of_moving(self.moving.as_ref(), joints);
        let mut x = vec![0.0; l.len()];
        x[6] = 1.0;
        self.scratch.q[..7].copy_from_slice(&x[..7]);
        self.scratch.q[7..].copy_from_slice(&joints);
        self.model.forward_kinematics(&mut self.data, &self.scratch.q);
        self.ground.forget();
        let Self { ground: GroundContact { feet, .. }, .. } = self;
        let depth = match height {
            None => feet.deflection(self.model.mass() * multibody::GRAVITY_ACCELERATION),
            Some(height) => -height,
        };
        x[2] = -feet.lowest(&self.model, &self.data) - depth;
        if height.is_none() {
            feet.press(&self.model, &self.data, depth, &mut x[l.layer()]);
        }
        x[7..7 + l.joints].copy_from_slice(&joints[..l.joints]);
        if let Joints::Driven(train) = &self.joints {
            train.relax(&joints, &mut x[l.rotor_angle()]);
        }
        x
    }

    /// The sampled controllers measure, at the beginning of a cycle \[s\] in state `x`, and compute what they hold in it.
    pub fn sample(&mut self, cycle: f64, x: &[f64], drives: &[JointCubic], inputs: &PlantInputs) {
        let Joints::Driven(train) = &self.joints else { return };
        if train.is_sampled() {
            self.load(0.0, x, drives);
            let switches = self.switches(inputs);
            let Self { data, layout, scratch, joints: Joints::Driven(train), .. } = self else { return };
            let given = train_inputs(layout, x, &scratch.reference, switches);
            train.load(&given, data);
            train.sample(cycle, &given);
        }
    }

    /// The controllers with a clock of their own measure and compute, if the beginning of a step is one of their instants. Steps
    /// are whole fractions of their periods, and cycles whole multiples.
    pub fn tick(&mut self, step: Substep, x: &[f64], drives: &[JointCubic], inputs: &PlantInputs) {
        let Joints::Driven(train) = &self.joints else { return };
        if train.is_due(step) {
            self.load(f64::from(step.index) * step.h, x, drives);
            let switches = self.switches(inputs);
            let Self { data, layout, scratch, joints: Joints::Driven(train), .. } = self else { return };
            let given = train_inputs(layout, x, &scratch.reference, switches);
            train.load(&given, data);
            train.tick(step, &given);
        }
    }

    /// The derivative of `x` with the references of `drives`, `tau` \[s\] into the cycle.
    pub fn rate(&mut self, tau: f64, x: &[f64], drives: &[JointCubic], inputs: &PlantInputs, dx: &mut [f64]) {
        let l = self.layout;
        self.load(tau, x, drives);
        self.touch_ground(&x[l.layer()]);
        dx[l.layer()].copy_from_slice(&self.ground.layer_rate);
        let switches = self.switches(inputs);
        let Self { model, data, ground, scratch, joints, .. } = self;
        match joints {
            Joints::Following(_) => self.base_rate(x, inputs),
            Joints::Driven(train) => {
                let Scratch { v, force, acceleration, .. } = scratch;
                external_force(model, data, ground, inputs, (x, &x[l.speed()]), force);
                let given = train_inputs(&l, x, &scratch.reference, switches);
                train.load(&given, data);
                train.explicit(&given, data, &mut force[6..], &mut dx[l.current()]);
                model.forward_dynamics_here(data, v, force, acceleration);
                train.rotor_rates(model, data, &mut dx[l.rotor_speed()]);
            }
        }
        // Positions follow from the speeds, whatever moves them.
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
    pub fn implicit_step(
        &mut self,
        tau: f64,
        h: f64,
        x: &mut [f64],
        drives: &[JointCubic],
        inputs: &PlantInputs,
    ) {
        let l = self.layout;
        let reference = match self.joints {
            Joints::Following(_) => tau,
            Joints::Driven(_) => tau + h, // the drives work at the end of the step
        };
        self.load(reference, x, drives);
        self.accelerate(h, x, inputs);
        let Self { model, ground, scratch, joints, .. } = self;
        let Scratch { q, v, acceleration, next, .. } = scratch;
        for (v, a) in v.iter_mut().zip(&acceleration[..6 + l.joints]) {
            *v += h * a;
        }
        if let Joints::Driven(train) = joints {
            for j in train.held_joints() {
                v[6 + j] = 0.0; // what the stiff damper of a sticking shaft leaves is rounding
            }
            let (before, current) = x.split_at_mut(l.current().start);
            let (before, rotor_speed) = before[..l.rotor_speed().end].split_at_mut(l.rotor_speed().start);
            let rotor_angle = &mut before[l.rotor_angle()];
            train.end(h, current, (rotor_angle, rotor_speed));
        }
        // Positions with the speeds of the end, which makes the step semi-implicit.
        model.integrate(q, v, h, next);
        x[l.pose()].copy_from_slice(&next[..7 + l.joints]);
        x[l.speed()].copy_from_slice(&v[..6 + l.joints]);
        for (d, rate) in x[l.layer()].iter_mut().zip(&ground.layer_rate) {
            *d += h * rate;
        }
    }

    /// The multibody model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The drives, for who tunes them; none of a robot without motors.
    pub fn train_mut(&mut self) -> Option<&mut Train> {
        match &mut self.joints {
            Joints::Following(train) => train.as_mut(),
            Joints::Driven(train) => Some(train),
        }
    }

    /// Sets the speed of rotors \[rad/s\] over which [`Plant::rate`] changes the sign of dry friction.
    pub fn set_friction_ramp(&mut self, ramp: f64) {
        if let Joints::Driven(train) = &mut self.joints {
            train.friction_ramp = ramp;
        }
    }

    /// Moves the objects of the environment to `time` \[s\], as far as nothing touches them; returns what happened.
    pub fn advance(&mut self, time: f64) -> &[environment::ObjectEvent] {
        self.ground.advance(time)
    }

    /// \[s\] By how much each object of the environment that moves is late.
    pub(crate) fn object_delays(&self) -> impl Iterator<Item = f64> {
        self.ground.environment().delays()
    }

    /// Worst end of the solver of the pads since the last call.
    pub(crate) fn take_contact_report(&mut self) -> contact::SolverReport {
        self.ground.feet.take_worst()
    }

    /// Something a drive could not do, since the last call.
    pub fn take_fault(&mut self) -> Option<TrainFault> {
        let fault = self.train_mut().and_then(Train::take_fault)?;
        Some(TrainFault { drive: self.outside(fault.drive), ..fault })
    }

    /// Kinematics of the feet and forces of the ground for the loaded q and v.
    fn touch_ground(&mut self, d: &[f64]) {
        let Self { model, data, ground, scratch, .. } = self;
        ground.touch(model, data, [&scratch.q, &scratch.v, d]);
    }

    /// Acceleration over an implicit step of `h` \[s\] from the loaded state: drives and dry friction at its end.
    fn accelerate(&mut self, h: f64, x: &[f64], inputs: &PlantInputs) {
        let l = self.layout;
        self.touch_ground(&x[l.layer()]);
        let switches = self.switches(inputs);
        let Self { model, data, ground, scratch, joints, .. } = self;
        let Joints::Driven(train) = joints else { return self.base_rate(x, inputs) };
        let Scratch { v, force, acceleration, bias, .. } = scratch;
        external_force(model, data, ground, inputs, (x, &x[l.speed()]), force);
        // Gears before the dynamics: the mass matrix holds the geared rotors, the bias their gyroscopic moments.
        let given = train_inputs(&l, x, &scratch.reference, switches);
        train.load(&given, data);
        train.free_rotors(data);
        model.dynamics_here(data, v, bias);
        for (f, b) in force.iter_mut().zip(&*bias) {
            *f -= b;
        }
        train.solve(h, &given, model, data, force, acceleration);
        // A free rotor is turned along by its stator, which only the accelerations of the bodies tell.
        if train.elastic() > 0 {
            model.accelerate(data, v, acceleration);
            train.turn_along(model, data);
        }
    }

    /// Acceleration of the torso while the joints follow their references (2.80).
    fn base_rate(&mut self, x: &[f64], inputs: &PlantInputs) {
        let Self { model, data, ground, scratch, joints, .. } = self;
        let Scratch { q, v, joint_acceleration, acceleration, .. } = scratch;
        if let Joints::Following(Some(train)) = joints {
            train.load_prescribed(&q[7..], &v[6..], data);
        }
        let (force, moment) = ground.feet.total(model, data, &Vector3::zeros(), None);
        let others = inputs.forces.total(model, x, &x[self.layout.speed()]);
        let base_force = at_base(x, &(force + others.0), &(moment + others.1));
        let (m, bias) = model.base_dynamics_here(data, v, joint_acceleration);
        let a = m.cholesky().map_or(Vector6::repeat(f64::NAN), |c| c.solve(&(base_force - bias)));
        acceleration[..6].copy_from_slice(a.as_slice());
        acceleration[6..].copy_from_slice(joint_acceleration);
    }

    /// Position, speed and references of the joints at `x`, `tau` \[s\] into the cycle, for the model.
    fn load(&mut self, tau: f64, x: &[f64], drives: &[JointCubic]) {
        let l = &self.layout;
        let Scratch { q, v, joint_acceleration, reference, .. } = &mut self.scratch;
        // References: of all joints, or of those that the model moves.
        match &mut self.moving {
            None => {
                for (r, drive) in reference.iter_mut().zip(drives) {
                    *r = drive.at(tau);
                }
            }
            Some(moving) => {
                for (r, drive) in moving.reference.iter_mut().zip(drives) {
                    *r = drive.at(tau);
                }
                for (r, &j) in reference.iter_mut().zip(&moving.outside) {
                    *r = moving.reference[j];
                }
            }
        }
        // State; joints that follow their references without motors have those.
        q[..7 + l.joints].copy_from_slice(&x[l.pose()]);
        q[3..7].copy_from_slice(&<[f64; 4]>::from(orientation(x).into_inner().coords));
        v[..6 + l.joints].copy_from_slice(&x[l.speed()]);
        if let Joints::Following(_) = self.joints {
            for (j, m) in reference.iter().enumerate() {
                (q[7 + j], v[6 + j], joint_acceleration[j]) = (m.angle, m.speed, m.acceleration);
            }
        }
    }
}

impl Scratch {
    fn new(model: &Model) -> Self {
        Self {
            q: model.neutral(),
            v: vec![0.0; model.nv()],
            joint_acceleration: vec![0.0; model.n()],
            reference: vec![JointMotion::default(); model.n()],
            force: vec![0.0; model.nv()],
            acceleration: vec![0.0; model.nv()],
            bias: vec![0.0; model.nv()],
            next: model.neutral(),
        }
    }
}

/// Generalized force of ground, push and rope (2.40) in a state x with these speeds.
fn external_force(
    model: &Model,
    data: &Data,
    ground: &GroundContact,
    inputs: &PlantInputs,
    (x, speed): (&[f64], &[f64]),
    force: &mut [f64],
) {
    force.fill(0.0);
    ground.feet.add_to(model, data, force);
    inputs.forces.add_to(model, x, speed, force);
}

fn train_inputs<'a>(
    l: &StateLayout,
    x: &'a [f64],
    reference: &'a [JointMotion],
    switches: DriveSwitches,
) -> TrainInputs<'a> {
    TrainInputs {
        joint: (&x[l.pose()][7..], &x[l.speed()][6..]),
        rotor: (&x[l.rotor_angle()], &x[l.rotor_speed()]),
        current: &x[l.current()],
        reference,
        switches,
    }
}
