//! One bus cycle of the simulated robot. Pure: frames in, frames out.

use config::{Robot, Scene};
use messages::command::PushCommand;
use messages::frames::{decode_targets, encode_sensors};
use messages::{BusFrames, EventCode, Imu, JointMode, JointTargets, Power, Sensors, SimState};
use multibody::{Frame, ModelError};
use nalgebra::Vector3;

use crate::drive::{Drive, Motion};
use crate::integrate::Stepper;
use crate::plant::{Outside, Plant, Snapshot, orientation};
use crate::power::PowerLine;

/// Tilt of the torso \[rad\] from which a robot counts as fallen; it is also fallen below half its initial height.
const FALLEN_TILT: f64 = std::f64::consts::FRAC_PI_4;

/// A robot in simulation.
pub struct SimBackend {
    robot: Robot,
    scene: Scene,
    plant: Plant,
    stepper: Stepper,
    state: Vec<f64>,
    /// How the joints are to move in this cycle.
    drives: Vec<Drive>,
    /// Where that ends.
    goals: Vec<Motion>,
    /// How they move.
    motions: Vec<Motion>,
    sensor_frames: [Frame; 2],
    power: PowerLine,
    targets: JointTargets,
    /// Tick of the newest targets followed.
    followed: u64,
    cycles: u64,
    initial_height: f64,
    fallen: bool,
    /// Pushes by command, besides those of the scene: force and when it ends \[s\].
    push: Option<(PushCommand, f64)>,
    sensors: Sensors,
    frames: BusFrames,
    sim_state: SimState,
    event: Option<(EventCode, u64)>,
}

impl SimBackend {
    /// The robot of a scene in its start pose.
    pub fn new(robot: &Robot, scene: &Scene) -> Result<Self, ModelError> {
        let pose = &robot.poses[&scene.start_pose];
        let mut plant = Plant::new(robot, scene.depth, pose)?;
        let state = plant.standing(pose);
        let sensor = |i: usize| plant.model().frame(&robot.feet[i].sensor_link, robot.feet[i].sensor);
        let mut sim = Self {
            sensor_frames: [sensor(0)?, sensor(1)?],
            stepper: Stepper::new(state.len()),
            drives: pose.iter().map(|&q| Drive::resting(q)).collect(),
            goals: pose.iter().map(|&angle| Motion { angle, ..Motion::default() }).collect(),
            motions: pose.iter().map(|&angle| Motion { angle, ..Motion::default() }).collect(),
            initial_height: state[2],
            robot: robot.clone(),
            scene: scene.clone(),
            plant,
            state,
            power: PowerLine::default(),
            targets: JointTargets::default(),
            followed: 0,
            cycles: 0,
            fallen: false,
            push: None,
            sensors: Sensors::default(),
            frames: BusFrames::default(),
            sim_state: SimState::default(),
            event: None,
        };
        let snapshot = sim.plant.snapshot(0.0, &sim.state, &sim.drives, &Outside::default());
        sim.measure(&snapshot, [0.0; 3], false);
        Ok(sim)
    }

    /// Something worth a line in the log, since the last call.
    pub fn take_event(&mut self) -> Option<(EventCode, u64)> {
        self.event.take()
    }

    /// Begins a push now.
    pub fn push(&mut self, push: &PushCommand) {
        self.push = Some((*push, self.time() + push.duration));
    }

    /// The truth about the robot, after the last step.
    pub fn state(&self) -> &SimState {
        &self.sim_state
    }

    /// State of the equations of motion, as [`crate::layout`] has it.
    pub fn integrated(&self) -> &[f64] {
        &self.state
    }

    /// Simulated time \[s\].
    pub fn time(&self) -> f64 {
        self.cycles as f64 * self.scene.cycle
    }

    /// One bus cycle: follows the newest targets, lets time pass, answers with what the sensors see.
    ///
    /// A fallen robot stays as it fell: only soles meet the ground in this model.
    pub fn step(&mut self, frames: Option<&BusFrames>, power: Option<&Power>) -> (&BusFrames, &SimState) {
        let powered = self.power.step(power);
        let dt = self.scene.cycle;
        let mut outside = Outside { push: self.current_push(), powered: false };
        if !self.fallen {
            outside.powered = self.begin_cycle(frames, powered);
            let h = dt / f64::from(self.scene.substeps);
            for i in 0..self.scene.substeps {
                let Self { plant, stepper, state, drives, .. } = self;
                stepper.step(self.scene.integrator, plant, f64::from(i) * h, h, state, drives, &outside);
            }
            let unit = orientation(&self.state);
            self.state[3..7].copy_from_slice(unit.coords.as_slice());
            for (goal, drive) in self.goals.iter_mut().zip(&self.drives) {
                *goal = drive.at(dt);
            }
        }
        self.cycles += 1;
        let snapshot = self.plant.snapshot(dt, &self.state, &self.drives, &outside);
        self.plant.joints(&self.state, &self.goals, &mut self.motions);
        self.check_fall();
        if let Some(frames) = frames {
            self.sensors.header = frames.header;
            self.sim_state.header = frames.header;
        }
        self.measure(&snapshot, outside.push, powered);
        encode_sensors(&self.robot.nodes, &self.sensors, &mut self.frames);
        (&self.frames, &self.sim_state)
    }

    /// Chooses how each joint is to move during this cycle; true if the drives may act.
    fn begin_cycle(&mut self, frames: Option<&BusFrames>, powered: bool) -> bool {
        let dt = self.scene.cycle;
        let fresh = frames.is_some_and(|f| {
            f.header.tick > self.followed
                && decode_targets(&self.robot.nodes, f, &mut self.targets) == self.robot.nodes.len()
        });
        if fresh {
            self.followed = self.targets.header.tick;
        }
        let driven = powered && self.targets.mode != JointMode::Off as u64;
        for j in 0..self.drives.len() {
            let (from, joint) = (self.goals[j], &self.robot.joints[j]);
            self.drives[j] = match (driven, fresh) {
                (false, _) if self.plant.layout().joints > 0 => Drive::resting(self.motions[j].angle),
                (false, _) => Drive::brake(joint, from, dt),
                (true, true) => Drive::follow(from, self.targets.angle[j], self.targets.speed[j], dt),
                // No new frame: the local controllers carry on at the last speed.
                (true, false) => Drive::follow(from, from.angle + from.speed * dt, from.speed, dt),
            };
        }
        driven
    }

    /// Sum of the pushes that act now \[N\].
    fn current_push(&mut self) -> [f64; 3] {
        let t = self.time() + 0.5 * self.scene.cycle; // mid-cycle: rounding adds no cycle and takes none
        let mut sum = [0.0; 3];
        let scripted =
            self.scene.pushes.iter().filter(|(at, p)| *at <= t && t < at + p.duration).map(|(_, p)| p);
        let commanded = self.push.iter().filter(|(_, until)| t < *until).map(|(p, _)| p);
        for p in scripted.chain(commanded) {
            for k in 0..3 {
                sum[k] += p.force[k];
            }
        }
        sum
    }

    fn check_fall(&mut self) {
        let up = orientation(&self.state) * Vector3::z();
        // A tilt that is not a number is a fall too.
        let stands = up.z > FALLEN_TILT.cos() && self.state[2] > 0.5 * self.initial_height;
        if !stands && !self.fallen {
            self.fallen = true;
            self.event = Some((EventCode::Fallen, 0));
        }
    }

    /// Ideal sensors, and the truth beside them.
    fn measure(&mut self, s: &Snapshot, push: [f64; 3], powered: bool) {
        let x = &self.state;
        let (sensors, truth) = (&mut self.sensors, &mut self.sim_state);
        for (j, m) in self.motions.iter().enumerate() {
            sensors.joint_angle[j] = m.angle;
            sensors.joint_speed[j] = m.speed;
            truth.joint_angle[j] = m.angle;
        }
        sensors.power = u64::from(powered);
        for i in 0..2 {
            let pose = self.plant.frame_pose(&self.sensor_frames[i]);
            let back = pose.rotation.inverse();
            let force = Vector3::from(s.foot_wrench[i].force);
            let sole = Vector3::new(s.feet[i][0], s.feet[i][1], s.feet[i][2]);
            let lever = sole - pose.translation.vector;
            let moment = Vector3::from(s.foot_wrench[i].moment) + lever.cross(&force);
            sensors.foot_wrench[i].force = (back * force).into();
            sensors.foot_wrench[i].moment = (back * moment).into();
        }
        let o = orientation(x);
        let speed = &x[self.plant.layout().speed()];
        let (imu, omega) = (Vector3::from(self.robot.imu), Vector3::from_column_slice(&speed[3..6]));
        sensors.imu = Imu {
            orientation: o.coords.into(),
            angular_velocity: omega.into(),
            // The angular acceleration's share at an IMU away from the origin is left out: zero for Lola.
            acceleration: (s.specific_force + omega.cross(&omega.cross(&imu))).into(),
        };
        truth.time = self.cycles as f64 * self.scene.cycle;
        truth.position = [x[0], x[1], x[2]];
        truth.orientation = o.coords.into();
        truth.velocity = [speed[0], speed[1], speed[2]];
        truth.angular_velocity = omega.into();
        truth.com = s.com.into();
        truth.foot_wrench = s.foot_wrench;
        truth.feet = s.feet;
        truth.push = push;
        truth.power = u64::from(powered);
        truth.fallen = u64::from(self.fallen);
    }
}
