//! One bus cycle of the simulated robot. Pure: frames in, frames out.

use std::error::Error;

use codec::frames::{DriveCommand, decode_targets, encode_sensors};
use config::bus_fault::{BusFault, Way};
use config::{Robot, Scene};
use fieldbus::Injector;
use messages::command::{LowerCommand, PushCommand};
use messages::{BusFrames, EventCode, Imu, Power, Sensors, SimState, Wrench};
use multibody::Frame;
use nalgebra::Vector3;

use crate::crane::Crane;
use crate::drive::{Drive, Motion};
use crate::hearing::{Follows, Hearing};
use crate::integrate::Stepper;
use crate::plant::{Outside, Plant, Snapshot, orientation};
use crate::power::PowerLine;
use crate::sensors::{SensorSet, Truth, carried};
use crate::stages::{Action, Stages, Told};
use crate::terrain;

/// Tilt of the torso \[rad\] from which a robot counts as fallen; it is also fallen below half its initial height.
const FALLEN_TILT: f64 = std::f64::consts::FRAC_PI_4;
/// Share of its initial height below which a fallen robot's torso lies on the ground.
const LYING: f64 = 0.25;

/// Cycles without their frames that are made good for at most: by then every drive has come to rest by itself.
const MOST_OVERWRITTEN: u64 = 100;

/// A robot in simulation.
#[derive(Clone)]
pub struct SimBackend {
    robot: Robot,
    scene: Scene,
    plant: Plant,
    stepper: Stepper,
    state: Vec<f64>,
    /// State at the begin of the cycle.
    last_good: Vec<f64>,
    /// How the joints are to move in this cycle.
    drives: Vec<Drive>,
    /// Where that ends.
    goals: Vec<Motion>,
    /// How they move.
    motions: Vec<Motion>,
    sensor_frames: [Frame; 2],
    sensor_set: SensorSet,
    power: PowerLine,
    stages: Stages,
    crane: Option<Crane>,
    /// \[rad\] By how much the encoders of each joint read too much.
    offset: Vec<f64>,
    command: DriveCommand,
    /// Tick of the newest targets followed.
    followed: u64,
    hearing: Hearing,
    /// Faults of the bus, if the scene has any.
    injector: Option<Injector>,
    cycles: u64,
    initial_height: f64,
    fallen: bool,
    /// It lies on the ground, or its numbers are lost: nothing moves any more.
    lies: bool,
    /// Pushes by command, besides those of the scene: force and when it ends \[s\].
    push: Option<(PushCommand, f64)>,
    sensors: Sensors,
    frames: BusFrames,
    sim_state: SimState,
    event: Option<(EventCode, u64)>,
}

impl SimBackend {
    /// The robot of a scene in its start pose. The relay of its motor supply falls in the first cycle without a moved toggle.
    ///
    /// # Errors
    /// The robot's data do not fit together or do not allow the depth of the scene, or an object cannot be read.
    pub fn new(robot: &Robot, scene: &Scene) -> Result<Self, Box<dyn Error>> {
        if scene.auto.is_some() {
            return Err(
                format!("scene `{}`: no model has been chosen for depth = \"auto\" yet", scene.name).into()
            );
        }
        let pose = &robot.poses[&scene.start_pose];
        let real = really(robot, scene);
        let mut plant = Plant::new(&real, terrain::environment(scene)?, scene.depth, pose)?;
        let state = match &scene.crane {
            None => plant.standing(pose),
            Some(crane) => plant.hanging(pose, crane.height),
        };
        let drives: Vec<Drive> = pose.iter().map(|&q| Drive::resting(q)).collect();
        let crane = scene.crane.map(|crane| hooked(&crane, &mut plant, &state, &drives));
        let sensor = |i: usize| plant.model().frame(&robot.feet[i].sensor_link, robot.feet[i].sensor);
        let sensor_frames = [sensor(0)?, sensor(1)?];
        let hanging = carried::hanging(plant.model(), &sensor_frames, pose);
        let mut sim = Self {
            sensor_frames,
            sensor_set: SensorSet::new(&scene.sensors, robot, &hanging, scene.seed, scene.cycle),
            last_good: state.clone(),
            stepper: stepper(scene, state.len()),
            drives,
            goals: pose.iter().map(|&angle| Motion { angle, ..Motion::default() }).collect(),
            motions: pose.iter().map(|&angle| Motion { angle, ..Motion::default() }).collect(),
            initial_height: state[2],
            robot: robot.clone(),
            scene: scene.clone(),
            plant,
            state,
            power: PowerLine::falling_after(1),
            stages: Stages::new(robot, scene, pose),
            crane,
            offset: offsets(robot, scene),
            command: DriveCommand::default(),
            followed: 0,
            hearing: Hearing::new(&robot.layout),
            injector: Injector::new(&scene.bus_faults, &robot.layout, scene.cycle, scene.seed)?,
            cycles: 0,
            fallen: false,
            lies: false,
            push: None,
            sensors: Sensors::default(),
            frames: BusFrames::default(),
            sim_state: SimState::default(),
            event: None,
        };
        let snapshot = sim.plant.snapshot(0.0, &sim.state, &sim.drives, &Outside::default());
        sim.measure(&snapshot, &Outside::default(), false);
        Ok(sim)
    }

    /// Something worth a line in the log, since the last call.
    pub fn take_event(&mut self) -> Option<(EventCode, u64)> {
        self.event.take()
    }

    /// Brings about these faults of the bus from now on, instead of the scene's; times count from the start.
    ///
    /// # Errors
    /// A fault names a local controller that the robot does not have.
    pub fn inject(&mut self, faults: &[BusFault]) -> Result<(), String> {
        let Self { robot, scene, injector, .. } = self;
        *injector = Injector::new(faults, &robot.layout, scene.cycle, scene.seed)?;
        Ok(())
    }

    /// Begins a push now.
    pub fn push(&mut self, push: &PushCommand) {
        self.push = Some((*push, self.time() + push.duration));
    }

    /// Lowers the crane from now on; whether there is one.
    pub fn lower(&mut self, way: &LowerCommand) -> bool {
        self.crane.as_mut().map(|crane| crane.lower(way.distance)).is_some()
    }

    /// The truth about the robot, after the last step.
    pub fn state(&self) -> &SimState {
        &self.sim_state
    }

    /// State of the equations of motion, as [`crate::layout`] has it.
    pub fn integrated(&self) -> &[f64] {
        &self.state
    }

    /// The same, for studies that disturb it between two cycles.
    pub fn integrated_mut(&mut self) -> &mut [f64] {
        &mut self.state
    }

    /// Where each of its numbers is.
    pub fn layout(&self) -> &crate::layout::Layout {
        self.plant.layout()
    }

    /// Simulated time \[s\].
    pub fn time(&self) -> f64 {
        self.cycles as f64 * self.scene.cycle
    }

    /// The same with a relay that falls after so many cycles without a moved toggle.
    pub fn with_relay(self, quiet: u32) -> Self {
        Self { power: PowerLine::falling_after(quiet), ..self }
    }

    /// One bus cycle: follows the newest targets, lets time pass, answers with what the sensors see.
    ///
    /// A robot that falls goes on falling until its torso meets the ground, and stays there at rest: only soles have a
    /// contact in this model.
    pub fn step(&mut self, frames: Option<&BusFrames>, power: Option<&Power>) -> (&BusFrames, &SimState) {
        let powered = self.power.step(power);
        // Off and without a reason: the watchdog has seen a reset edge.
        let reset = matches!(power, Some(Power { on: 0, reason: 0, .. }));
        self.step_powered(frames, powered, reset)
    }

    /// A bus cycle of the past, which was missed: the relay, a device of its own, is as it is. Where frames were overwritten
    /// before they came here, time passes without them.
    pub fn step_late(&mut self, frames: Option<&BusFrames>) -> (&BusFrames, &SimState) {
        let before = self.sensors.header.tick;
        let gap = frames.map_or(0, |f| f.header.tick.saturating_sub(before + 1));
        for _ in 0..gap.min(MOST_OVERWRITTEN) {
            self.step_powered(None, self.power.is_closed(), false);
        }
        self.step_powered(frames, self.power.is_closed(), false)
    }

    fn step_powered(
        &mut self,
        frames: Option<&BusFrames>,
        powered: bool,
        reset: bool,
    ) -> (&BusFrames, &SimState) {
        if self.injector.is_some() {
            return self.step_with_faults(frames, powered, reset);
        }
        self.advance(frames, powered);
        (&self.frames, &self.sim_state)
    }

    /// The same with a bus that has faults: each way once per tick.
    fn step_with_faults(
        &mut self,
        frames: Option<&BusFrames>,
        powered: bool,
        reset: bool,
    ) -> (&BusFrames, &SimState) {
        let Some(mut injector) = self.injector.take() else { return (&self.frames, &self.sim_state) };
        let new = frames.filter(|f| f.header.tick > self.sensors.header.tick);
        if let Some(frames) = new.filter(|_| reset) {
            injector.reset(frames.header.tick);
        }
        let passed = new.map(|frames| injector.pass(Way::ToDrives, frames));
        self.advance(passed, powered);
        self.frames = *injector.pass(Way::FromDrives, &self.frames);
        self.injector = Some(injector);
        (&self.frames, &self.sim_state)
    }

    fn advance(&mut self, frames: Option<&BusFrames>, powered: bool) {
        let dt = self.scene.cycle;
        let mut outside = Outside { push: self.current_push(), ..Outside::default() };
        if let Some(crane) = &mut self.crane {
            outside.rope = Some(crane.step(&self.state, dt));
        }
        let told = self.event.filter(|_| self.fallen);
        let fell_before = self.fallen;
        if !self.lies {
            outside.powered = powered;
            [outside.off, outside.braked, outside.held] = self.begin_cycle(frames, powered);
            self.last_good.copy_from_slice(&self.state);
            self.plant.sample(dt, &self.state, &self.drives, &outside);
            let h = dt / f64::from(self.scene.substeps);
            for i in 0..self.scene.substeps {
                let Self { plant, stepper, state, drives, .. } = self;
                stepper.step(plant, f64::from(i) * h, h, state, drives, &outside);
            }
            self.end_cycle();
        }
        self.cycles += 1;
        let snapshot = self.plant.snapshot(dt, &self.state, &self.drives, &outside);
        self.plant.joints(&self.state, &self.goals, &mut self.motions);
        self.check_fall();
        if let Some(frames) = frames {
            self.sensors.header = frames.header;
            self.sim_state.header = frames.header;
        }
        if self.measure(&snapshot, &outside, powered) {
            encode_sensors(&self.robot.layout, &self.sensors, &mut self.frames);
        }
        if fell_before {
            // Sensors out of range and contacts that are not found say nothing new of a robot on its way down.
            self.event = self.event.filter(|(code, _)| *code == EventCode::Diverged).or(told);
        }
    }

    /// Chooses how each joint is to move during this cycle; the drives without torque, those whose brakes are closed, and
    /// those that are held from outside, one bit each.
    fn begin_cycle(&mut self, frames: Option<&BusFrames>, powered: bool) -> [u64; 3] {
        let dt = self.scene.cycle;
        let new = frames.filter(|f| f.header.tick > self.followed);
        let received = new.map(|f| decode_targets(&self.robot.layout, f, &mut self.command));
        if self.hearing.step(received.as_ref()) {
            self.followed = self.command.targets.header.tick;
        }
        let DriveCommand { control, targets } = &self.command;
        let motors = self.plant.layout().motors > 0;
        let current = motors.then_some(&self.sensors.motor_current[..]);
        let told = Told { control, mode: targets.mode, hearing: &self.hearing };
        if let Some(joint) = self.stages.step(&told, powered, dt, &self.goals, &self.motions, current) {
            self.event.get_or_insert((EventCode::NodeStopped, self.hearing.node_of(joint) as u64));
        }
        let [mut off, mut braked, mut held] = [0; 3];
        for (j, joint) in self.robot.joints.iter().enumerate() {
            let (from, action) = (self.goals[j], self.stages.action(j));
            let angle = targets.angle[j] - self.offset[j] + self.stages.origin(j);
            let follows = self.hearing.follows(j, angle - from.angle, joint.speed_limit * dt);
            self.drives[j] = match (action, follows) {
                (Action::Off, _) if self.plant.layout().joints > 0 => Drive::resting(self.motions[j].angle),
                (Action::Off | Action::Ramp, _) => Drive::brake(joint, from, dt),
                (Action::Search(speed), _) => {
                    let change = joint.braking * dt;
                    let speed = from.speed + (speed - from.speed).clamp(-change, change);
                    Drive::follow(from, from.angle + 0.5 * (from.speed + speed) * dt, speed, dt)
                }
                (Action::Follow, Follows::Target) => Drive::follow(from, angle, targets.speed[j], dt),
                (Action::Follow, Follows::LastSpeed) => {
                    Drive::follow(from, from.angle + from.speed * dt, from.speed, dt)
                }
            };
            off |= u64::from(action == Action::Off) << j;
            let (brake, off_for) = (self.robot.drives.get(j).and_then(|d| d.brake), self.stages.off_for(j));
            braked |= u64::from(brake.is_some_and(|brake| off_for > brake.delay)) << j;
            held |= u64::from(off_for == f64::INFINITY) << j;
        }
        [off, braked, held]
    }

    /// Checks and tidies the state the steps have left.
    fn end_cycle(&mut self) {
        if let Some(lost) = self.state.iter().position(|x| !x.is_finite()) {
            self.state.copy_from_slice(&self.last_good);
            self.event = Some((EventCode::Diverged, lost as u64));
            self.fallen = true;
            self.come_to_rest();
        }
        let unit = orientation(&self.state);
        self.state[3..7].copy_from_slice(unit.coords.as_slice());
        for (goal, drive) in self.goals.iter_mut().zip(&self.drives) {
            *goal = drive.at(self.scene.cycle);
        }
        if let Some(gave_up) = self.stepper.take_gave_up() {
            self.event.get_or_insert((EventCode::IntegratorGaveUp, gave_up.state as u64));
        }
        if let Some(fault) = self.plant.take_fault() {
            // A state that is no number is the graver news.
            self.event.get_or_insert((EventCode::DriveFault, fault.drive as u64));
        }
        let report = self.plant.take_contact_report();
        if !report.converged {
            self.event.get_or_insert((EventCode::ContactNotConverged, report.sweeps.into()));
        }
        for event in self.plant.advance((self.cycles + 1) as f64 * self.scene.cycle) {
            let (code, object) = match *event {
                environment::Event::Refused(i) => (EventCode::ObjectHeld, i),
                environment::Event::Resumed(i) => (EventCode::ObjectResumed, i),
                environment::Event::Appeared(_) | environment::Event::Vanished(_) => continue,
            };
            self.event.get_or_insert((code, object as u64));
        }
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
        if self.fallen && !self.lies && self.state[2] < LYING * self.initial_height {
            self.come_to_rest();
        }
    }

    /// The ground takes all motion.
    fn come_to_rest(&mut self) {
        let layout = self.plant.layout();
        for moving in [layout.speed(), layout.rotor_speed(), layout.current()] {
            self.state[moving].fill(0.0);
        }
        for (goal, drive) in self.goals.iter_mut().zip(&mut self.drives) {
            goal.speed = 0.0;
            *drive = Drive::resting(goal.angle);
        }
        self.lies = true;
    }

    /// What the sensors see, and the truth beside it; false if a reading is no number and must not go on the bus.
    fn measure(&mut self, s: &Snapshot, outside: &Outside, powered: bool) -> bool {
        let x = &self.state;
        let truth = &mut self.sim_state;
        let mut seen = Truth { motor_current: [f64::NAN; messages::MAX_JOINTS], ..Truth::default() };
        for (j, m) in self.motions.iter().enumerate() {
            (seen.joint_angle[j], seen.joint_speed[j]) = (m.angle, m.speed);
            truth.joint_angle[j] = m.angle;
        }
        (seen.motor_angle, seen.motor_speed) = (seen.joint_angle, seen.joint_speed);
        self.plant.motors(x, &mut seen.motor_angle, &mut seen.motor_speed, &mut seen.motor_current);
        truth.motor_angle = seen.motor_angle;
        for (j, offset) in self.offset.iter().enumerate() {
            let offset = offset - self.stages.origin(j);
            if offset != 0.0 {
                seen.joint_angle[j] += offset;
                seen.motor_angle[j] += offset;
            }
        }
        for i in 0..2 {
            let pose = self.plant.frame_pose(&self.sensor_frames[i]);
            let force = Vector3::from(s.foot_wrench[i].force);
            let sole = Vector3::new(s.feet[i][0], s.feet[i][1], s.feet[i][2]);
            let lever = sole - pose.translation.vector;
            let moment = Vector3::from(s.foot_wrench[i].moment) + lever.cross(&force);
            let back = pose.rotation.inverse();
            seen.contact[i] = Wrench { force: (back * force).into(), moment: (back * moment).into() };
        }
        if self.sensor_set.needs_inertia() {
            seen.inertial = self.plant.carried(&self.sensor_frames);
        }
        let o = orientation(x);
        let speed = &x[self.plant.layout().speed()];
        let (imu, omega) = (Vector3::from(self.robot.imu), Vector3::from_column_slice(&speed[3..6]));
        seen.imu = Imu {
            orientation: o.coords.into(),
            angular_velocity: omega.into(),
            acceleration: (s.specific_force
                + s.angular_acceleration.cross(&imu)
                + omega.cross(&omega.cross(&imu)))
            .into(),
        };
        let report = self.sensor_set.measure(&seen, &mut self.sensors);
        self.sensors.power = u64::from(powered);
        self.stages.report(&mut self.sensors);
        if report.invalid > 0 {
            self.event.get_or_insert((EventCode::SensorNotFinite, report.invalid.into()));
        } else if report.clipped > 0 {
            self.event.get_or_insert((EventCode::SensorClipped, report.clipped.into()));
        }
        truth.time = self.cycles as f64 * self.scene.cycle;
        truth.position = [x[0], x[1], x[2]];
        truth.orientation = o.coords.into();
        truth.velocity = [speed[0], speed[1], speed[2]];
        truth.angular_velocity = omega.into();
        truth.com = s.com.into();
        truth.foot_wrench = s.foot_wrench;
        truth.feet = s.feet;
        truth.push = outside.push;
        truth.rope = outside.rope.map_or(0.0, |rope| rope.tension(x, &x[self.plant.layout().speed()]));
        truth.power = u64::from(powered);
        truth.fallen = u64::from(self.fallen);
        report.invalid == 0
    }
}

/// The robot as it is, where that is not what its software believes.
fn really(robot: &Robot, scene: &Scene) -> Robot {
    let (mut robot, factor) = (robot.clone(), scene.unknown.contact_stiffness);
    robot.contact.normal_stiffness *= factor;
    robot.contact.tangential_stiffness *= factor;
    if let Some(pads) = &mut robot.contact.pads {
        pads.modulus *= factor;
    }
    robot
}

/// The crane of a scene with its hook above the centre of gravity, which hangs in balance.
fn hooked(crane: &config::crane::Crane, plant: &mut Plant, state: &[f64], drives: &[Drive]) -> Crane {
    let snapshot = plant.snapshot(0.0, state, drives, &Outside::default());
    let torso = Vector3::from_column_slice(&state[..3]);
    let mut hook = snapshot.com - torso;
    hook.z = crane.hook;
    Crane::new(crane, hook, torso + hook, plant.model().mass())
}

/// \[rad\] By how much the encoders of each joint read too much.
fn offsets(robot: &Robot, scene: &Scene) -> Vec<f64> {
    let offset = |joint: &config::robot::Joint| scene.unknown.joint_offset.of(&joint.name).unwrap_or(0.0);
    robot.joints.iter().map(offset).collect()
}

fn stepper(scene: &Scene, states: usize) -> Stepper {
    let stepper = Stepper::new(scene.integrator, states);
    match scene.tolerance {
        Some(tolerance) => stepper.with_tolerance(tolerance),
        None => stepper,
    }
}
