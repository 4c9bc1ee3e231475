//! One control cycle. Pure: no clock, no topics.

use config::gait::Control;
use config::parameters::PARAMETERS;
use config::{Gait, Robot};
use messages::command::ParameterCommand;
use messages::{ControllerState, EventCode, JointMode, JointTargets, MAX_JOINTS, Parameters, Plan, Sensors};
use multibody::ModelError;
use nalgebra::{Matrix3, Matrix6, Rotation3, SMatrix, Vector2, Vector3, Vector6};

use crate::contact_force::{FootWrench, Support, distribute, stabilize};
use crate::estimate::{Estimate, force_coordinates};
use crate::following::{Desired, PlanFollower};
use crate::force_control::{Forces, Modification, contact_stiffness, modify};
use crate::inverse_kinematics::{InverseKinematics, JointVector, TaskJacobian, TaskVector};
use crate::task_space::TaskSpace;
use crate::torso;

/// Inclination error \[rad\] from which the robot counts as falling: joints are brought to rest.
const FALLING: f64 = 0.5;
/// Cycles without load on either foot, while the plan wants load, after which the robot counts as lifted.
const LIFTED_CYCLES: u32 = 200;
/// Cycles that may be missed and made good for by a longer step; the joint loop carries on meanwhile.
const MISSED_CYCLES: u64 = 10;
/// Cycles in a row that are bridged with the last good sensor data if a value is not finite.
const BAD_CYCLES: u32 = 20;
/// Joints without a task go to their comfortable angles with this time constant \[1/s\] and at most this speed \[rad/s\].
const SETTLE: (f64, f64) = (2.0, 0.5);

/// The stabilizing control of one robot.
pub struct Controller {
    robot: Robot,
    control: Control,
    dt: f64,
    plan: PlanFollower,
    desired: TaskSpace,
    measured: TaskSpace,
    ik: InverseKinematics,
    free: Vec<bool>,
    stiffness: [Matrix3<f64>; 2],
    jacobian: TaskJacobian,
    modification: Modification,
    filtered: Vector6<f64>,
    /// q_d, q_d' of the last cycle.
    angle: [f64; MAX_JOINTS],
    speed: JointVector,
    started: bool,
    /// Tick of the last cycle, and the time since then \[s\]: more than a cycle if cycles were missed.
    last_tick: u64,
    elapsed: f64,
    unloaded: u32,
    /// The last sensor data without a NaN, and how many with one came since.
    good: Sensors,
    bad: u32,
    stopped: bool,
    targets: JointTargets,
    state: ControllerState,
    event: Option<(EventCode, u64)>,
}

impl Controller {
    /// The controller of `robot` walking as `gait` says, with a cycle of `dt` \[s\]; allocates everything.
    pub fn new(robot: &Robot, gait: &Gait, dt: f64) -> Result<Self, ModelError> {
        let desired = TaskSpace::new(robot)?;
        let free = desired.leg_joints(robot);
        let mut zero = TaskSpace::new(robot)?;
        zero.update(&vec![0.0; robot.joints.len()]);
        let stiffness = std::array::from_fn(|i| foot_stiffness(robot, &zero, i));
        Ok(Self {
            ik: InverseKinematics::new(&robot.joints, &free, gait.control.null_space_gain),
            robot: robot.clone(),
            control: gait.control,
            dt,
            plan: PlanFollower::new(),
            measured: zero,
            desired,
            free,
            stiffness,
            jacobian: TaskJacobian::zeros(),
            modification: Modification::default(),
            filtered: Vector6::zeros(),
            angle: [0.0; MAX_JOINTS],
            speed: JointVector::zeros(),
            started: false,
            last_tick: 0,
            elapsed: dt,
            unloaded: 0,
            good: Sensors::default(),
            bad: 0,
            stopped: false,
            targets: JointTargets::default(),
            state: ControllerState::default(),
            event: None,
        })
    }

    /// Something worth a line in the log, since the last call.
    pub fn take_event(&mut self) -> Option<(EventCode, u64)> {
        self.event.take()
    }

    /// Gives a parameter another value from the next cycle on; an event if there is no such parameter or value.
    pub fn set_parameter(&mut self, command: &ParameterCommand) -> Result<(), EventCode> {
        let parameter = PARAMETERS.get(command.number as usize);
        let set = parameter.is_some_and(|p| p.set(&mut self.control, command.value));
        if set { Ok(()) } else { Err(EventCode::CommandRefused) }
    }

    /// Writes the present values of all parameters.
    pub fn report_parameters(&self, record: &mut Parameters) {
        record.count = PARAMETERS.len() as u64;
        for (value, p) in record.values.iter_mut().zip(PARAMETERS) {
            *value = p.get(&self.control);
        }
    }

    /// One cycle: joint targets for its end, from the sensor data of its beginning and the newest plan.
    pub fn step(&mut self, sensors: &Sensors, newest: Option<&Plan>) -> (&JointTargets, &ControllerState) {
        let tick = sensors.header.tick;
        self.elapsed = self.dt * tick.saturating_sub(self.last_tick).clamp(1, MISSED_CYCLES) as f64;
        self.last_tick = tick;
        self.event = self.plan.update(tick, newest);
        let sensors = &self.admit(sensors);
        if sensors.power == 0 || !self.started {
            self.start_from(sensors);
        }
        for j in 0..self.robot.joints.len() {
            self.state.tracking_error[j] = self.angle[j] - sensors.joint_angle[j];
        }
        let t = self.plan.time(tick, self.dt);
        let (now, end) = (self.plan.sample(t), self.plan.sample(t + self.dt));
        self.measured.update_motion(
            &sensors.joint_angle,
            &sensors.joint_speed,
            &sensors.imu.angular_velocity,
        );
        let estimate = Estimate::new(&self.robot, sensors, &self.measured, &self.reference(&now));
        if self.plan.id() > 0 && sensors.power == 1 {
            self.watch(sensors, &now, &estimate);
        }
        if self.plan.id() > 0 && !self.stopped && sensors.power == 1 {
            self.stabilize(sensors, &now, &end, &estimate);
        } else {
            self.speed.fill(0.0);
        }
        self.report(sensors, t, &now, &estimate);
        (&self.targets, &self.state)
    }

    /// The sensor data if they are finite, otherwise the last ones that were, for a while.
    fn admit(&mut self, sensors: &Sensors) -> Sensors {
        let n = self.robot.joints.len();
        let (imu, wrench) = (&sensors.imu, &sensors.foot_wrench);
        let finite = sensors.joint_angle[..n].iter().chain(&sensors.joint_speed[..n]).all(|x| x.is_finite())
            && imu.orientation.iter().chain(&imu.angular_velocity).all(|x| x.is_finite())
            && wrench.iter().all(|w| w.force.iter().chain(&w.moment).all(|x| x.is_finite()));
        if finite {
            self.good = *sensors;
            self.bad = 0;
        } else {
            self.bad = self.bad.saturating_add(1);
            self.good.header = sensors.header;
            if self.bad == 1 {
                self.event = Some((EventCode::SensorNotFinite, 0));
            }
        }
        self.good
    }

    /// Stands still where the joints are: while the supply is off the targets follow the measured angles.
    fn start_from(&mut self, sensors: &Sensors) {
        self.angle = sensors.joint_angle;
        self.speed.fill(0.0);
        self.modification = Modification::default();
        self.filtered = force_coordinates(sensors);
        self.stopped = false;
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
            reference.torso.position = [std::f64::consts::FRAC_PI_2, std::f64::consts::FRAC_PI_2, 0.0];
        }
        reference
    }

    /// Falling and being lifted end in a controlled stop.
    fn watch(&mut self, sensors: &Sensors, now: &Desired, estimate: &Estimate) {
        let tilt = (0..2).map(|i| (now.torso.position[i] - estimate.angles[i]).abs()).fold(0.0, f64::max);
        let load = sensors.foot_wrench[0].force[2].max(sensors.foot_wrench[1].force[2]);
        self.unloaded = if load < crate::estimate::LOADED { self.unloaded + 1 } else { 0 };
        let why = if self.bad > BAD_CYCLES {
            Some(EventCode::SensorNotFinite)
        } else if !(tilt < FALLING) {
            Some(EventCode::Fallen)
        } else if self.unloaded > LIFTED_CYCLES {
            Some(EventCode::Lifted)
        } else {
            None
        };
        if let Some(why) = why.filter(|_| !self.stopped) {
            self.stopped = true;
            self.event = Some((why, 0));
        }
    }

    /// The chain of figure 5.8.
    fn stabilize(&mut self, sensors: &Sensors, now: &Desired, end: &Desired, estimate: &Estimate) {
        self.desired.update(&self.angle);
        let torso = torso::rotation(&Vector3::from(end.torso.position)).unwrap_or_else(Matrix3::identity);
        let forces = self.forces(sensors, now, end, estimate);
        self.desired.task_jacobian(&mut self.jacobian);
        let task = self.ik.factorise(&self.jacobian);
        let gain = self.force_gain(&task, &torso, end);
        self.modification = modify(&self.control, &gain, &forces, &self.modification, self.elapsed);
        let velocity = self.task_velocity(&torso, end);
        let given = self.given_speeds(end);
        let wanted = self.ik.speeds(&task, &velocity, &given, &self.angle);
        self.integrate(&wanted);
        self.state.limited += u64::from(task.damped) + u64::from(self.modification.limited);
    }

    /// Contact forces: what the plan wants with the stabilizing part, and what is measured (5.2)-(5.22).
    fn forces(&mut self, sensors: &Sensors, now: &Desired, end: &Desired, estimate: &Estimate) -> Forces {
        let error = Vector2::from_fn(|i, _| now.torso.position[i] - estimate.angles[i]);
        let rate = Vector2::from_fn(|i, _| now.torso.velocity[i] - estimate.rates[i]);
        let height = now.com.position[2] - estimate.com.z;
        let height_rate = now.com.velocity[2] - estimate.com_velocity.z;
        let stabilizing = stabilize(&self.control, error, rate, height, height_rate);
        let modified = self.foot_forces(now, stabilizing);
        let planned = self.foot_forces(now, (Vector3::zeros(), 0.0));
        let planned_next = self.foot_forces(end, (Vector3::zeros(), 0.0));
        for (i, w) in modified.iter().enumerate() {
            self.state.wrench_desired[i].force = w.force.into();
            self.state.wrench_desired[i].moment = w.moment.into();
        }
        let a = (self.elapsed / self.control.force_filter).min(1.0);
        self.filtered += (force_coordinates(sensors) - self.filtered) * a;
        Forces {
            desired: coordinates(&modified),
            desired_rate: (coordinates(&planned_next) - coordinates(&planned)) / self.dt,
            measured: self.filtered,
            load: now.load,
        }
    }

    /// lambda_d1 in the sensor frames, whose axes are those of the flat soles (5.20), (5.21).
    fn foot_forces(&self, at: &Desired, stabilizing: (Vector3<f64>, f64)) -> [FootWrench; 2] {
        let mass = self.desired.mass();
        let com = Vector3::from(at.com.position);
        let force = (Vector3::from(at.com.acceleration) - multibody::GRAVITY) * mass;
        let supports: [Support; 2] = std::array::from_fn(|i| self.support(at, i));
        let wrenches = distribute(
            &self.control,
            mass * -multibody::GRAVITY.z,
            (force, at.zmp.into(), com),
            stabilizing,
            &supports,
        );
        std::array::from_fn(|i| {
            let back = Rotation3::from_axis_angle(&Vector3::z_axis(), -supports[i].heading);
            FootWrench { force: back * wrenches[i].force, moment: back * wrenches[i].moment }
        })
    }

    /// Where a foot carries, as planned.
    fn support(&self, at: &Desired, foot: usize) -> Support {
        let (sole, sensor) = (self.desired.sole(foot), self.desired.sensor(foot));
        let offset = sole.rotation.transpose() * (sensor.position - sole.position); // sensor seen from the sole
        let [x, y, z, heading] = at.feet[foot].position;
        let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), heading);
        let [back, front, right, left] = self.robot.feet[foot].support;
        Support {
            sensor: Vector3::new(x, y, z) + turn * offset,
            load: at.load[foot],
            sole: [back - offset.x, front - offset.x, right - offset.y, left - offset.y],
            height: offset.z,
            heading,
        }
    }

    /// G: forces at both sensors per unit of modification, through the inverse kinematics (5.30).
    fn force_gain(
        &self,
        task: &crate::inverse_kinematics::Factorised,
        torso: &Matrix3<f64>,
        end: &Desired,
    ) -> Matrix6<f64> {
        let axes: [Matrix3<f64>; 2] = std::array::from_fn(|i| self.foot_axes(torso, end, i));
        let mut unit = SMatrix::<f64, 12, 6>::zeros();
        for foot in 0..2 {
            let (x, y, z) = (axes[foot].column(0), axes[foot].column(1), axes[foot].column(2));
            unit.fixed_view_mut::<3, 1>(6 * foot, 3 * foot).copy_from(&z);
            unit.fixed_view_mut::<3, 1>(6 * foot + 3, 3 * foot + 1).copy_from(&x);
            unit.fixed_view_mut::<3, 1>(6 * foot + 3, 3 * foot + 2).copy_from(&y);
        }
        let speeds = self.ik.columns(task, &unit);
        let mut gain = Matrix6::zeros();
        for foot in 0..2 {
            let rows = axes[foot].transpose();
            // Lift, roll and pitch of this sole against the torso.
            let mut motion = SMatrix::<f64, 3, 6>::zeros();
            for (j, twist) in
                self.desired.sole_jacobian(foot).column_iter().enumerate().filter(|(j, _)| self.free[*j])
            {
                let (linear, turn) = (rows * twist.fixed_rows::<3>(0), rows * twist.fixed_rows::<3>(3));
                motion += Vector3::new(linear.z, turn.x, turn.y) * speeds.row(j);
            }
            gain.fixed_rows_mut::<3>(3 * foot).copy_from(&(self.stiffness[foot] * motion));
        }
        gain
    }

    /// Axes of the planned foot (heading x, y, vertical) in torso axes.
    fn foot_axes(&self, torso: &Matrix3<f64>, at: &Desired, foot: usize) -> Matrix3<f64> {
        let heading = Rotation3::from_axis_angle(&Vector3::z_axis(), at.feet[foot].position[3]);
        torso.transpose() * heading.matrix()
    }

    /// x'_d1 with drift compensation K_x (x_d1 - x), torso axes (5.33), (5.35).
    fn task_velocity(&self, torso: &Matrix3<f64>, end: &Desired) -> TaskVector {
        let back = torso.transpose();
        let omega = back * torso_omega(torso, end);
        let com = Vector3::from(end.com.position);
        let com_velocity = Vector3::from(end.com.velocity);
        let mut x = TaskVector::zeros();
        for foot in 0..2 {
            let s = &end.feet[foot];
            let axes = self.foot_axes(torso, end, foot);
            let m = self.modification.value.fixed_rows::<3>(3 * foot).into_owned();
            let m_rate = self.modification.rate.fixed_rows::<3>(3 * foot).into_owned();
            let vertical = axes.column(2);

            let position =
                back * (Vector3::new(s.position[0], s.position[1], s.position[2]) - com) + vertical * m[0];
            let velocity = back * (Vector3::new(s.velocity[0], s.velocity[1], s.velocity[2]) - com_velocity)
                + vertical * m_rate[0]
                - omega.cross(&position);
            let tilt = Rotation3::from_axis_angle(&Vector3::y_axis(), m[2])
                * Rotation3::from_axis_angle(&Vector3::x_axis(), m[1]);
            let rotation = axes * tilt.matrix();
            let turning = axes * Vector3::new(m_rate[1], m_rate[2], s.velocity[3]) - omega;

            let is = self.desired.sole(foot);
            let position_error = position - (is.position - self.desired.com());
            let rotation_error = rotation_vector(&(rotation * is.rotation.transpose()));
            let k = self.control.drift_gain;
            x.fixed_rows_mut::<3>(6 * foot).copy_from(&(velocity + position_error * k));
            x.fixed_rows_mut::<3>(6 * foot + 3).copy_from(&(turning + rotation_error * k));
        }
        x
    }

    /// Speeds of the joints that no foot needs: toes as planned, the others to their comfortable angles.
    fn given_speeds(&self, end: &Desired) -> JointVector {
        let mut speeds = JointVector::zeros();
        for (j, joint) in self.robot.joints.iter().enumerate().filter(|(j, _)| !self.free[*j]) {
            speeds[j] = (SETTLE.0 * (joint.comfort - self.angle[j])).clamp(-SETTLE.1, SETTLE.1);
        }
        for (foot, toe) in self.robot.feet.iter().enumerate().filter_map(|(i, f)| Some((i, f.toe?))) {
            let s = &end.toes[foot];
            speeds[toe] = s.velocity[0] + self.control.drift_gain * (s.position[0] - self.angle[toe]);
        }
        speeds
    }

    /// q_d of the end of the cycle, trapezoidal, so that angle and speed agree; within speed and range.
    fn integrate(&mut self, wanted: &JointVector) {
        for (j, joint) in self.robot.joints.iter().enumerate() {
            let speed = wanted[j].clamp(-joint.speed_limit, joint.speed_limit);
            let angle = self.angle[j] + 0.5 * self.elapsed * (self.speed[j] + speed);
            let [low, high] = joint.range;
            let held = angle.clamp(low.min(self.angle[j]), high.max(self.angle[j]));
            if !(speed == wanted[j] && held == angle) {
                self.state.limited += 1;
            }
            // NaN moves nothing.
            if held.is_finite() && speed.is_finite() {
                self.speed[j] = if held == angle { speed } else { 0.0 };
                self.angle[j] = held;
            }
        }
    }

    fn report(&mut self, sensors: &Sensors, t: f64, now: &Desired, estimate: &Estimate) {
        self.targets.header = sensors.header;
        self.targets.mode = match (self.plan.id(), self.stopped) {
            (_, true) => JointMode::Stop,
            (0, _) => JointMode::Hold,
            _ => JointMode::Track,
        } as u64;
        self.targets.angle = self.angle;
        self.targets.speed = self.speed.into();
        let s = &mut self.state;
        s.header = sensors.header;
        s.plan_id = self.plan.id();
        s.plan_time = t;
        s.gait = self.plan.gait(t) as u64;
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

/// (F_z, T_x, T_y) of both feet.
fn coordinates(wrenches: &[FootWrench; 2]) -> Vector6<f64> {
    Vector6::from_fn(|i, _| {
        let w = &wrenches[i / 3];
        [w.force.z, w.moment.x, w.moment.y][i % 3]
    })
}

/// Stiffness of a flat foot with all its contact points closed (5.23).
fn foot_stiffness(robot: &Robot, zero: &TaskSpace, foot: usize) -> Matrix3<f64> {
    let (sole, sensor) = (zero.sole(foot), zero.sensor(foot));
    let sensor = sole.rotation.transpose() * (sensor.position - sole.position);
    let points = zero.contact_points(robot, foot);
    contact_stiffness(&points, sensor, robot.contact.normal_stiffness)
}

/// \[rad/s\] @I Planned angular velocity of the torso.
fn torso_omega(torso: &Matrix3<f64>, at: &Desired) -> Vector3<f64> {
    let rates = Vector3::from(at.torso.velocity);
    if rates == Vector3::zeros() {
        return rates;
    }
    torso::rates_from_omega(torso).try_inverse().map_or(Vector3::zeros(), |m| m * rates)
}

/// Rotation vector of a small rotation.
fn rotation_vector(r: &Matrix3<f64>) -> Vector3<f64> {
    // Twice the quaternion's vector part to first order; the drift loop sees it every cycle.
    Vector3::new(r[(2, 1)] - r[(1, 2)], r[(0, 2)] - r[(2, 0)], r[(1, 0)] - r[(0, 1)]) * 0.5
}
