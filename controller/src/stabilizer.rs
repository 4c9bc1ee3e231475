//! One control cycle. Pure: no clock, no topics.

mod forces;
mod task;

use config::gait::Control;
use config::parameters::STABILIZER;
use config::{Gait, Robot, WITH_LOAD};
use messages::{
    Command, ControllerState, EventCode, GaitState, JointMode, JointTargets, MAX_JOINTS, Parameters, Plan,
    Reason, Sensors, StartUp, Verdict,
};
use multibody::ModelError;
use nalgebra::{Matrix3, Vector3, Vector6};
use std::f64::consts::FRAC_PI_2;

use crate::approach::PLANNED;
use crate::arms::Arms;
use crate::contact::Contact;
use crate::estimate::Estimate;
use crate::following::{Desired, PlanFollower};
use crate::force_control::{Compliance, Guide, Modification, modify};
use crate::gaze::{Gaze, TorsoMotion};
use crate::inverse_kinematics::{InverseKinematics, JointVector, TaskJacobian};
use crate::task_space::TaskSpace;
use crate::torso;
use crate::watch::{FALLING, Watch};

/// Cycles that may be missed and are made good for, one after the other; the joint loop carries on meanwhile.
const MISSED_CYCLES: u64 = 20;
/// \[s\] A limit is told again after so long without it.
const QUIET: f64 = 1.0;
/// \[s\] Time in which drift compensation, null-space motion and returns set in when the joints begin to move: they may rest
/// far from comfort, and where they rest is not quite where a plan begins.
const RAMP: f64 = 0.5;
/// \[1\] Times what the drives can accelerate, asked of them: a little less than what the joint loop passes, which knows the
/// measured angles, and these lag.
const ASKED: f64 = 0.97 * WITH_LOAD;
/// Feedback path 2.
const MEASURED: u64 = 2;

/// The stabilizing control of one robot.
#[derive(Clone)]
pub struct Controller {
    robot: Robot,
    control: Control,
    dt: f64,
    plan: PlanFollower,
    desired: TaskSpace,
    measured: TaskSpace,
    ik: InverseKinematics,
    free: Vec<bool>,
    contacts: [Contact; 2],
    /// K and K^+ of each foot, and how its modification moves apart from forces.
    stiffness: [Matrix3<f64>; 2],
    compliance: [Compliance; 2],
    guides: [Guide; 2],
    /// lambda_d0 at the beginning and at the end of the cycle.
    planned_force: [Vector6<f64>; 2],
    jacobian: TaskJacobian,
    modification: Modification,
    filtered: Vector6<f64>,
    /// q_d, q_d' of the last cycle.
    angle: [f64; MAX_JOINTS],
    speed: JointVector,
    started: bool,
    /// \[s\] Since the joints were at rest.
    moving: f64,
    /// Tick of the last cycle.
    last_tick: u64,
    /// \[m\] @I_0 Heights at which the plan wanted the soles at the end of the last cycle.
    sole_height: [f64; 2],
    watch: Watch,
    gaze: Option<Gaze>,
    arms: Option<Arms>,
    targets: JointTargets,
    state: ControllerState,
    events: Events,
    /// Tick of the last damped task, limited modification and limited joint.
    told: [Option<u64>; 3],
}

/// What happened and was not fetched yet, the first one first.
#[derive(Clone, Default)]
struct Events([Option<(EventCode, u64)>; 4]);

impl Events {
    /// The newest ones are dropped if nobody fetches them.
    fn add(&mut self, event: Option<(EventCode, u64)>) {
        if let Some(free) = self.0.iter_mut().find(|e| e.is_none()) {
            *free = event;
        }
    }

    fn take(&mut self) -> Option<(EventCode, u64)> {
        self.0.rotate_left(1);
        self.0[self.0.len() - 1].take()
    }
}

impl Controller {
    /// The controller of `robot` walking as `gait` says, with a cycle of `dt` \[s\]; allocates everything.
    pub fn new(robot: &Robot, gait: &Gait, dt: f64) -> Result<Self, ModelError> {
        let desired = TaskSpace::new(robot)?;
        let free = desired.leg_joints(robot);
        let mut zero = TaskSpace::new(robot)?;
        zero.update(&vec![0.0; robot.joints.len()]);
        Ok(Self {
            ik: InverseKinematics::new(&robot.joints, &free, gait.control.null_space_gain),
            robot: robot.clone(),
            control: gait.control,
            dt,
            plan: PlanFollower::new([0, 1].map(|i| [robot.feet[i].support[0], robot.feet[i].support[1]])),
            measured: zero,
            desired,
            free,
            contacts: [Contact::default(); 2],
            stiffness: [Matrix3::zeros(); 2],
            compliance: [Compliance::new(&Matrix3::zeros()); 2],
            guides: [Guide::default(); 2],
            planned_force: [Vector6::zeros(); 2],
            jacobian: TaskJacobian::zeros(),
            modification: Modification::default(),
            filtered: Vector6::zeros(),
            angle: [0.0; MAX_JOINTS],
            speed: JointVector::zeros(),
            started: false,
            moving: 0.0,
            last_tick: 0,
            sole_height: [0.0; 2],
            watch: Watch::default(),
            gaze: Gaze::new(robot)?,
            arms: Arms::new(robot, gait.arm_swing)?,
            targets: JointTargets::default(),
            state: ControllerState::default(),
            events: Events::default(),
            told: [None; 3],
        })
    }

    /// What it carries from cycle to cycle besides the plan, for studies that disturb it: joint targets \[rad\],
    /// modification \[m, rad, rad\], filtered forces \[N, N m, N m\].
    pub fn memory(&mut self) -> [&mut [f64]; 3] {
        let n = self.robot.joints.len();
        [&mut self.angle[..n], self.modification.value.as_mut_slice(), self.filtered.as_mut_slice()]
    }

    /// Something worth a line in the log, since the last step; to be called until there is none.
    pub fn take_event(&mut self) -> Option<(EventCode, u64)> {
        self.events.take().or_else(|| self.gaze.as_mut()?.take_event())
    }

    /// Takes a command of the domains stabilize and head from the next cycle on; what to say about it.
    pub fn command(&mut self, command: &Command) -> Option<(EventCode, u64)> {
        let id = command.address().1.into();
        if let Command::Parameter(change) = command {
            let parameter = STABILIZER.get(change.number as usize);
            let set = parameter.is_some_and(|p| p.set(&mut self.control, change.value));
            let refused = (EventCode::CommandRefused, id);
            return Some(if set { (EventCode::ParameterSet, change.number.into()) } else { refused });
        }
        let taken = self.gaze.as_mut().is_some_and(|gaze| gaze.command(command));
        (!taken).then_some((EventCode::HeadRefused, id))
    }

    /// Writes the present values of all parameters.
    pub fn report_parameters(&self, record: &mut Parameters) {
        record.count = STABILIZER.len() as u64;
        for (value, p) in record.values.iter_mut().zip(STABILIZER) {
            *value = p.get(&self.control);
        }
    }

    /// One cycle: joint targets for its end, from the sensor data of its beginning and the newest plan.
    pub fn step(&mut self, sensors: &Sensors, newest: Option<&Plan>) -> (&JointTargets, &ControllerState) {
        let tick = sensors.header.tick;
        let missed =
            if self.started { tick.saturating_sub(self.last_tick + 1).min(MISSED_CYCLES) } else { 0 };
        self.last_tick = tick;
        let start_up = StartUp::from_number(sensors.start_up);
        // Joints without supply, or held by a stop, follow no plan; nor is there one when they move again.
        if sensors.power == 0 || start_up == StartUp::Stopped || self.watch.stopped().is_some() {
            self.plan.drop_all(tick);
        }
        // A plan that came in time is taken, if this process was stopped at its start.
        self.events.add(self.plan.update(tick - missed, newest));
        let (sensors, event) = self.watch.admit(sensors, self.robot.joints.len());
        self.events.add(event.map(|code| (code, 0)));
        let sensors = &sensors;
        let (angles, speeds) = (&sensors.joint_angle, &sensors.joint_speed);
        self.measured.update_motion(angles, speeds, &sensors.imu.angular_velocity);
        // A joint that finds its angle moves by itself.
        let moves = matches!(start_up, StartUp::NotHomed | StartUp::Homing);
        if sensors.power == 0 || !self.started || moves {
            self.start_from(sensors);
        }
        for j in 0..self.robot.joints.len() {
            self.state.tracking_error[j] = self.angle[j] - sensors.joint_angle[j];
        }
        // The targets go through the cycles that were missed: those of this one do not jump.
        for past in tick - missed..tick {
            self.follow(sensors, past);
        }
        let (now, estimate) = self.follow(sensors, tick);
        self.report(sensors, self.plan.time(tick, self.dt), &now, &estimate);
        (&self.targets, &self.state)
    }

    /// Joint targets for the end of the cycle `tick`; what was wanted and what was seen.
    fn follow(&mut self, sensors: &Sensors, tick: u64) -> (Desired, Estimate) {
        self.events.add(self.plan.update(tick, None));
        let t = self.plan.time(tick, self.dt);
        let (now, end) = (self.plan.sample(t), self.plan.sample(t + self.dt));
        self.take_over(&now, &end);
        let estimate = Estimate::new(&self.robot, sensors, &self.measured, &self.reference(&now));
        let powered = self.plan.id() > 0 && sensors.power == 1;
        if powered {
            let why = self.watch.check(sensors, &now, &estimate);
            self.events.add(why.map(|code| (code, 0)));
        }
        if powered && self.watch.stopped().is_none() {
            self.stabilize(sensors, &now, &end, &estimate);
        } else {
            self.speed.fill(0.0);
            self.moving = 0.0;
        }
        (now, estimate)
    }

    /// A plan that goes on from a sensed contact has its foot where the ground is, not where the plan before wanted it:
    /// the modification takes up the difference, and the foot does not jump.
    fn take_over(&mut self, now: &Desired, end: &Desired) {
        let height = self.plan.plan().height;
        let switched = self.state.plan_id > 0 && self.state.plan_id != self.plan.id();
        for foot in 0..2 {
            let jump = self.sole_height[foot] - (height + now.feet[foot].position[2]);
            if switched && jump.abs() > 1e-4 {
                self.modification.value[3 * foot] += jump;
            }
            self.sole_height[foot] = height + end.feet[foot].position[2];
        }
    }

    /// Stands still where the joints are: while the supply is off the targets follow the measured angles.
    fn start_from(&mut self, sensors: &Sensors) {
        self.angle = sensors.joint_angle;
        self.speed.fill(0.0);
        self.modification = Modification::default();
        self.contacts = [Contact::default(); 2];
        self.filtered = self.force_coordinates(sensors);
        self.watch.restart();
        if let Some(gaze) = &mut self.gaze {
            gaze.halt();
        }
        if let Some(arms) = &mut self.arms {
            arms.halt();
        }
        self.started = true;
    }

    /// Before the first plan the robot's own pose is the reference: planning frame under the middle of the soles.
    fn reference(&self, desired: &Desired) -> Desired {
        let mut reference = *desired;
        if self.plan.id() == 0 {
            let half = 0.5 * (self.measured.sole(1).position.y - self.measured.sole(0).position.y);
            reference.feet[0].position = [0.0, -half, 0.0, 0.0];
            reference.feet[1].position = [0.0, half, 0.0, 0.0];
            reference.load = [0.5; 2];
            reference.torso.position = [FRAC_PI_2, FRAC_PI_2, 0.0];
        }
        reference
    }

    /// The chain of figure 5.8.
    fn stabilize(&mut self, sensors: &Sensors, now: &Desired, end: &Desired, estimate: &Estimate) {
        let measured = self.control.feedback == MEASURED;
        self.desired.update(if measured { &sensors.joint_angle } else { &self.angle });
        let torso = torso::rotation(&Vector3::from(end.torso.position)).unwrap_or_else(Matrix3::identity);
        self.feel(sensors, now, end, estimate);
        let forces = self.forces(now, end, estimate);
        self.desired.task_jacobian(&mut self.jacobian);
        let task = self.ik.factorise(&self.jacobian);
        let motion = self.sole_motion(&task, &torso, end);
        let feet = std::array::from_fn(|i| (self.compliance[i], self.guides[i]));
        self.modification = modify(&self.control, &motion, &feet, &forces, &self.modification, self.dt);
        let velocity = self.task_velocity(&torso, end);
        let mut given = self.given_speeds(end);
        if let Some(gaze) = &mut self.gaze {
            let torso = TorsoMotion {
                origin: self.plan.plan().origin,
                height: self.plan.plan().height,
                turn: estimate.turn,
                rotation: estimate.rotation,
                position: estimate.torso,
                velocity: estimate.torso_velocity,
                omega: sensors.imu.angular_velocity.into(),
            };
            gaze.drive(&torso, self.dt, &self.angle, &self.speed, &mut given);
        }
        let setting_in = (self.drift(), self.share());
        if let Some(arms) = &mut self.arms {
            arms.drive(&self.desired, &self.angle, self.dt, setting_in, &mut given);
        }
        let wanted = self.ik.speeds(&task, &velocity, &given, &self.angle, self.share());
        self.moving += self.dt;
        let held = self.integrate(&wanted);
        self.tell_limits([task.damped, self.modification.limited, held]);
    }

    /// Share of drift compensation, null-space motion and returns that is wanted: all of it a while after the joints began to
    /// move. A leg that is nearly straight has no length to spare for any of them before the plan has lowered the body.
    pub(super) fn share(&self) -> f64 {
        let x = (self.moving / RAMP).min(1.0);
        x * x * (3.0 - 2.0 * x)
    }

    /// \[1/s\] K_x (5.35).
    pub(super) fn drift(&self) -> f64 {
        self.control.drift_gain * self.share()
    }

    /// An event where a nearly singular task begins to be damped (1), a modification (2) or a joint (3) meets its limit,
    /// each once until it was quiet for [`QUIET`].
    fn tell_limits(&mut self, met: [bool; 3]) {
        self.state.limited += u64::from(met[0]) + u64::from(met[1]);
        for (what, last) in (1..).zip(&mut self.told).filter(|(what, _)| met[*what as usize - 1]) {
            let since = |last| self.last_tick.saturating_sub(last) as f64 * self.dt;
            if last.is_none_or(|last| since(last) > QUIET) {
                self.events.add(Some((EventCode::ControlLimited, what)));
            }
            *last = Some(self.last_tick);
        }
    }

    /// q_d of the end of the cycle, trapezoidal, so that angle and speed agree; within range, speed and what the drives can
    /// accelerate with a landing's load, which asks for more. Whether one of these held a joint.
    fn integrate(&mut self, wanted: &JointVector) -> bool {
        let before = self.state.limited;
        for (j, joint) in self.robot.joints.iter().enumerate() {
            if !wanted[j].is_finite() {
                self.state.limited += 1;
                continue;
            }
            // Towards the end of its range no faster than it can brake in what will be left of it: s^2 <= 2 b r at the end of
            // the cycle. Without a limit of acceleration this is NaN, which min and max pass over.
            let [low, high] = joint.range;
            let braking = PLANNED * joint.acceleration;
            let braked = |room: f64, speed: f64| {
                let half = 0.5 * braking * self.dt;
                let left = (room - 0.5 * self.dt * speed).max(0.0);
                (half * half + 2.0 * braking * left).sqrt() - half
            };
            let speed = wanted[j].min(braked(high - self.angle[j], self.speed[j]));
            let speed = speed.max(-braked(self.angle[j] - low, -self.speed[j]));
            let mut speed = speed.clamp(-joint.speed_limit, joint.speed_limit);
            if (speed - self.speed[j]).abs() > ASKED * joint.acceleration * self.dt {
                let most = ASKED * self.robot.acceleration(j, &self.angle) * self.dt;
                speed = speed.clamp(self.speed[j] - most, self.speed[j] + most);
            }
            let angle = self.angle[j] + 0.5 * self.dt * (self.speed[j] + speed);
            let held = angle.clamp(low.min(self.angle[j]), high.max(self.angle[j]));
            self.state.limited += u64::from(speed != wanted[j] || held != angle);
            if held.is_finite() {
                self.speed[j] = if held == angle { speed } else { 0.0 };
                self.angle[j] = held;
            }
        }
        self.state.limited > before
    }

    /// Where in a walk the robot is. Who lies, or was stopped, is in none.
    fn gait(&self, sensors: &Sensors, t: f64, estimate: &Estimate) -> GaitState {
        // Without a plan nobody watches the inclination; an IMU that says nothing yet is no fall.
        let lies = (0..2).any(|i| (FRAC_PI_2 - estimate.angles[i]).abs() > FALLING);
        match self.watch.stopped() {
            Some(EventCode::Fallen) => GaitState::Fallen,
            _ if self.plan.id() == 0 && lies => GaitState::Fallen,
            Some(_) => GaitState::Halted,
            None if StartUp::from_number(sensors.start_up) == StartUp::Stopped => GaitState::Halted,
            None => self.plan.gait(t),
        }
    }

    fn report(&mut self, sensors: &Sensors, t: f64, now: &Desired, estimate: &Estimate) {
        self.targets.header = sensors.header;
        self.targets.mode = match (self.plan.id(), self.watch.stopped()) {
            (_, Some(_)) => JointMode::Stop,
            (0, _) => JointMode::Hold,
            _ => JointMode::Track,
        } as u64;
        self.targets.angle = self.angle;
        self.targets.speed = self.speed.into();
        let gait = self.gait(sensors, t, estimate);
        let s = &mut self.state;
        s.header = sensors.header;
        s.plan_id = self.plan.id();
        s.plan_time = t;
        s.gait = gait as u64;
        s.contact = self.watch.contact().map(u64::from);
        s.phase = [0, 1].map(|foot| self.plan.plan().phase(foot, t) as u64);
        s.not_standing = u64::from(match StartUp::from_number(sensors.start_up) {
            StartUp::Off => sensors.power == 0,
            _ if matches!(gait, GaitState::Fallen | GaitState::Halted) => true,
            other => !other.stands(),
        });
        s.origin = self.plan.plan().origin;
        s.com_desired = now.com.position;
        s.feet_desired = now.feet.map(|f| f.position);
        s.zmp_desired = now.zmp;
        s.load_left = now.load[1];
        estimate.report(now, s);
        for foot in 0..2 {
            let m = self.modification.value.fixed_rows::<3>(3 * foot);
            s.modification[foot] = [m[0], -m[1], m[2]]; // z, s1, s0: s1 is minus roll, s0 is pitch (errata 2.4)
        }
    }
}

/// What the operator is answered: refused if the event that came of the command says so.
pub fn verdict(told: Option<(EventCode, u64)>) -> Verdict {
    match told {
        Some((code @ (EventCode::HeadRefused | EventCode::CommandRefused), detail)) => {
            Err(Reason::Event { code, detail })
        }
        _ => Ok(()),
    }
}
