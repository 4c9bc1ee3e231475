//! One control cycle. Pure: no clock, no topics.

mod contacts;
mod cycle;
mod force_targets;
mod joints;
mod speeds;
mod task;
mod telemetry;

use config::gait::StabilizerGains;
use config::parameters::STABILIZER;
use config::{Gait, Robot};
use messages::{
    Command, ControllerState, Detail, EventCode, EventQueue, GaitState, Header, JointTables, JointTargets,
    MAX_JOINTS, Parameters, Plan, Reason, Sensors, StartUp, Verdict,
};
use multibody::ModelError;
use nalgebra::{Rotation2, Vector2, Vector3};
use std::f64::consts::FRAC_PI_2;

use crate::contact_force::FootWrench;
use crate::estimate::TaskEstimate;
use crate::force_control::{Modification, modify};
use crate::gaze::Gaze;
use crate::ground_slope::{GroundSlope, WalkedCycle};
use crate::inclination_trim::InclinationTrim;
use crate::open_loop::{OpenLoop, encoders_only};
use crate::plan_follower::{Desired, PlanFollower};
use crate::pose_switch;
use crate::task_space::TaskSpace;
use crate::watch::SafetyWatch;
use contacts::{FootContacts, measured_forces};
use cycle::{ControlCycle, CycleClock, planned_torso};
use force_targets::force_targets;
use joints::JointState;
use speeds::{JointSpeeds, torso_motion};
use task::task_velocity;
use telemetry::{CycleOutcome, MetLimits, Telemetry};

/// Feedback path 2.
const MEASURED: u64 = 2;

/// Desired and measured task space of a cycle, and the desired wrenches of the feet, if the robot was stabilized.
struct Followed {
    now: Desired,
    estimate: TaskEstimate,
    wrenches: Option<[FootWrench; 2]>,
}

/// The stabilizing control of one robot.
#[derive(Clone)]
pub struct Controller {
    robot: Robot,
    control: StabilizerGains,
    clock: CycleClock,
    plan: PlanFollower,
    watch: SafetyWatch,
    /// Kinematics of the measured joints, and of those that figure 5.8 feeds back.
    measured: TaskSpace,
    desired: TaskSpace,
    contacts: FootContacts,
    trim: InclinationTrim,
    /// Of a gait whose steps react.
    slope: Option<GroundSlope>,
    modification: Modification,
    speeds: JointSpeeds,
    joints: JointState,
    /// In place of the stabilizer, if the gait is a pattern.
    open_loop: Option<OpenLoop>,
    telemetry: Telemetry,
}

impl Controller {
    /// The controller of `robot` walking as `gait` says, with a cycle of `dt` \[s\]; allocates everything.
    pub fn new(robot: &Robot, gait: &Gait, dt: f64) -> Result<Self, ModelError> {
        let desired = TaskSpace::new(robot)?;
        let mut measured = TaskSpace::new(robot)?;
        measured.update(&vec![0.0; robot.joints.len()]);
        Ok(Self {
            robot: robot.clone(),
            control: gait.control,
            clock: CycleClock::new(dt),
            plan: PlanFollower::new([0, 1].map(|i| [robot.feet[i].support[0], robot.feet[i].support[1]])),
            watch: SafetyWatch::new(robot.weight(), gait.pattern.is_some()),
            speeds: JointSpeeds::new(robot, &desired, gait.arm_swing)?,
            measured,
            desired,
            contacts: FootContacts::new(),
            trim: InclinationTrim::default(),
            slope: gait.reaction.map(|_| GroundSlope::default()),
            modification: Modification::default(),
            joints: JointState::new(),
            open_loop: gait.pattern.map(|pattern| OpenLoop::new(robot, &pattern, dt)),
            telemetry: Telemetry::default(),
        })
    }

    /// Memory from cycle to cycle besides the plan, for studies that disturb it: joint targets \[rad\],
    /// modification \[m, rad, rad\], filtered forces \[N, N m, N m\].
    pub fn memory(&mut self) -> [&mut [f64]; 3] {
        let n = self.robot.joints.len();
        [
            &mut self.joints.angle[..n],
            self.modification.value.as_mut_slice(),
            self.contacts.filtered.as_mut_slice(),
        ]
    }

    /// Events that were not taken yet.
    pub fn events(&mut self) -> &mut EventQueue {
        if let Some(gaze) = &mut self.speeds.gaze {
            self.telemetry.events.append(gaze.events());
        }
        &mut self.telemetry.events
    }

    /// Takes a command of the domains stabilize and head from the next cycle on; the event that came of it.
    pub fn command(&mut self, command: &Command) -> Option<(EventCode, Detail)> {
        let id = Detail::Message(command.address().1.into());
        if let Command::Parameter(change) = command {
            let parameter = STABILIZER.get(change.number as usize);
            // The open loop has none of these gains.
            let set =
                self.open_loop.is_none() && parameter.is_some_and(|p| p.set(&mut self.control, change.value));
            let refused = (EventCode::CommandRefused, id);
            return Some(if set {
                (EventCode::ParameterSet, Detail::Number(change.number.into()))
            } else {
                refused
            });
        }
        let taken = self.speeds.gaze.as_mut().is_some_and(|gaze| gaze.command(command));
        (!taken).then_some((EventCode::HeadRefused, id))
    }

    /// Writes the present values of all parameters.
    pub fn report_parameters(&self, record: &mut Parameters) {
        telemetry::report_parameters(&self.control, record);
    }

    /// One cycle: joint targets for its end, from the sensor data of its beginning and the newest plan.
    pub fn step(&mut self, sensors: &Sensors, newest: Option<&Plan>) -> (&JointTargets, &ControllerState) {
        let tick = sensors.header.tick;
        let missed = self.clock.begin(tick);
        let oldest = tick - missed.unwrap_or(0);
        let start_up = StartUp::from_number(sensors.start_up);
        // Joints without supply, or held by a stop, follow no plan; nor is there one when they move again.
        if sensors.power == 0 || start_up == StartUp::Stopped || self.watch.stopped().is_some() {
            self.plan.drop_all(tick);
        }
        // A plan that came in time is taken, if this process was stopped at its start.
        self.plan.update(oldest, newest, &mut self.telemetry.events);
        let own = self.open_loop.as_ref().map(|_| encoders_only(sensors));
        let sensors = own.as_ref().unwrap_or(sensors);
        let (mut sensors, failed) = self.watch.admit(sensors, self.robot.joints.len());
        self.trim.correct(&mut sensors.imu.orientation);
        if failed {
            self.telemetry.events.push(EventCode::SensorNotFinite, Detail::Nothing);
        }
        let sensors = &sensors;
        let (angles, speeds) = (&sensors.joint_angle, &sensors.joint_speed);
        self.measured.update_motion(angles, speeds, &sensors.imu.angular_velocity);
        // A joint that finds its angle moves by itself.
        let moves = matches!(start_up, StartUp::NotHomed | StartUp::Homing);
        if sensors.power == 0 || missed.is_none() || moves {
            self.start_from(sensors);
        }

        // The targets go through the cycles that were missed: those of this one do not jump.
        let lag = self.joints.lag(sensors, self.robot.joints.len());
        let mut wrenches = None;
        for past in oldest..tick {
            wrenches = self.follow(sensors, &lag, past).wrenches.or(wrenches);
        }
        let Followed { now, estimate, wrenches: new } = self.follow(sensors, &lag, tick);
        // Standing on its feet, the robot learns what its inclination reads too much.
        let gait = self.plan.gait(self.plan.time(tick, self.clock.dt));
        if new.is_some() && gait == GaitState::Standing {
            let carried: f64 = sensors.foot_wrench.iter().map(|w| w.force[2]).sum();
            self.trim.learn(&estimate, carried / self.robot.weight(), self.clock.dt);
        }
        if let Some(slope) = self.slope.as_mut().filter(|_| new.is_some() && gait == GaitState::Walking) {
            slope.learn(&WalkedCycle {
                sensors,
                weight: self.robot.weight(),
                soles: [0, 1].map(|i| self.measured.sole(i).rotation),
                now: &now,
                estimate: &estimate,
                heading: self.plan.plan().origin[2],
                dt: self.clock.dt,
            });
        }
        self.fill_tables(&sensors.header);
        let com = match &self.open_loop {
            Some(_) => self.com_of_targets(&now),
            None => now.body.position,
        };
        let outcome = CycleOutcome {
            plan: &self.plan,
            leads: self.leads(),
            watch: &self.watch,
            joints: &self.joints,
            modification: &self.modification,
            wrenches: new.or(wrenches),
            lag: &lag,
            com,
            now: &now,
            reference: &self.reference(&now),
            estimate: &estimate,
            trim: self.trim.angles(),
            slope: self.ground_slope().into(),
            head_offset: self.speeds.gaze.as_ref().map_or([0.0; 3], Gaze::offset),
        };
        self.telemetry.report(sensors, &self.clock, &outcome);
        (&self.telemetry.targets, &self.telemetry.state)
    }

    /// Tables for drives that play them, if they were completed in the last cycle: they are published before its targets.
    pub fn tables(&self) -> Option<&JointTables> {
        self.open_loop.as_ref().and_then(OpenLoop::tables)
    }

    /// Fills tables of the plan to come; one that the drives cannot play is refused.
    fn fill_tables(&mut self, header: &Header) {
        let Self { open_loop: Some(open_loop), plan, robot, joints, .. } = self else { return };
        let follows = plan.id() > 0;
        if !open_loop.fill_tables(robot, plan.next(), (header, follows), &joints.angle) {
            plan.refuse_next(&mut self.telemetry.events);
        }
    }

    /// True if joints are led to targets: by a plan, or to rest where the tables of the first one begin.
    fn leads(&self) -> bool {
        let awaits = self.open_loop.as_ref().is_some_and(OpenLoop::plays_tables);
        self.plan.id() > 0 || awaits && self.plan.next().is_some()
    }

    /// Joint targets for the end of the cycle `tick`.
    fn follow(&mut self, sensors: &Sensors, lag: &[f64; MAX_JOINTS], tick: u64) -> Followed {
        self.plan.update(tick, None, &mut self.telemetry.events);
        let dt = self.clock.dt;
        let t = self.plan.time(tick, dt);
        let (now, end) = (self.plan.sample(t), self.plan.sample(t + dt));
        let reported = self.telemetry.state.plan_id;
        self.modification.absorb_plan_switch(self.plan.height_steps(reported, &now, &end));
        let before = self.plan.measured_switch(reported, &end);
        let first = reported == 0 && self.plan.plan().measured == 1;
        if let Some(before) = if first { Some(self.own_pose(&now)) } else { before } {
            pose_switch::take_up(&mut self.modification, &before, &now);
        }
        let estimate = TaskEstimate::new(&self.robot, sensors, &self.measured, &self.reference(&now));
        let powered = self.plan.id() > 0 && sensors.power == 1;
        if powered {
            // A fall, or being lifted, ends the plan before anything is made of it.
            if let Some(why) = self.watch.check(sensors, &now, &estimate) {
                self.telemetry.events.push(why, Detail::Nothing);
            }
        }
        let moves = powered && self.watch.stopped().is_none();
        let wrenches = if moves && self.open_loop.is_some() {
            self.play(t + dt);
            None
        } else if moves {
            let (wrenches, limits) = self.stabilize(sensors, lag, &now, &end, &estimate);
            self.telemetry.note_limits(&limits, &self.clock);
            Some(wrenches)
        } else {
            self.joints.rest();
            None
        };
        Followed { now, estimate, wrenches }
    }

    /// Joint targets for plan time `t` \[s\] without any feedback.
    fn play(&mut self, t: f64) {
        let Some(open_loop) = &mut self.open_loop else { return };
        match open_loop.targets(&self.robot, self.plan.plan(), &self.joints.angle, t) {
            Ok((angle, speed)) => (self.joints.angle, self.joints.speed) = (angle, speed.into()),
            Err((foot, _)) => {
                // The planner lets no such plan go out; joints stay where they are.
                self.joints.rest();
                let joints = self.robot.legs.as_ref().map_or(0, |legs| legs[foot].joints.len() as u64);
                let limits = MetLimits { damped: false, modification: false, joints };
                self.telemetry.note_limits(&limits, &self.clock);
            }
        }
    }

    /// \[m\] Centre of gravity of the joint targets, the torso being where the plan wants it.
    fn com_of_targets(&mut self, now: &Desired) -> [f64; 3] {
        self.desired.update(&self.joints.angle);
        (Vector3::from(now.body.position) + planned_torso(now) * self.desired.com()).into()
    }

    /// Stands still where the joints are: while the supply is off the targets follow the measured angles.
    fn start_from(&mut self, sensors: &Sensors) {
        self.watch.reset();
        self.trim = InclinationTrim::default();
        self.slope.iter_mut().for_each(|slope| *slope = GroundSlope::default());
        self.contacts.reset(measured_forces(&self.measured, sensors));
        self.modification.reset();
        self.speeds.reset();
        self.open_loop.iter_mut().for_each(OpenLoop::reset);
        self.joints.reset(&sensors.joint_angle);
    }

    /// \[1\] @I_0 Rise of the ground per metre.
    fn ground_slope(&self) -> Vector2<f64> {
        self.slope.as_ref().map_or_else(Vector2::zeros, GroundSlope::slope)
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

    /// The pose that the joints are led to before the first plan, seen from an upright torso at the origin.
    fn own_pose(&mut self, desired: &Desired) -> Desired {
        self.desired.update(&self.joints.angle);
        let mut own = *desired;
        own.torso.position = [FRAC_PI_2, FRAC_PI_2, 0.0];
        own.pitch.iter_mut().for_each(|pitch| pitch.position = [0.0]);
        own.body.position = self.desired.com().into();
        for (foot, sample) in own.feet.iter_mut().enumerate() {
            let sole = self.desired.sole(foot);
            let [x, y, z] = sole.position.into();
            sample.position = [x, y, z, sole.rotation[(1, 0)].atan2(sole.rotation[(0, 0)])];
        }
        own
    }

    /// The chain of figure 5.8: contacts, force targets, modification, task, joint speeds, joint targets. Returns the
    /// desired wrenches of the feet and the limits that were met.
    fn stabilize(
        &mut self,
        sensors: &Sensors,
        lag: &[f64; MAX_JOINTS],
        now: &Desired,
        end: &Desired,
        estimate: &TaskEstimate,
    ) -> ([FootWrench; 2], MetLimits) {
        // Direct kinematics of what is fed back, and the task of the feet there.
        let fed_back = self.control.feedback == MEASURED;
        self.desired.update(if fed_back { &sensors.joint_angle } else { &self.joints.angle });
        let task = self.speeds.linearise(&mut self.desired);
        let cycle = ControlCycle {
            robot: &self.robot,
            control: &self.control,
            dt: self.clock.dt,
            now,
            end,
            estimate,
            torso: planned_torso(end),
            kinematics: &self.desired,
            slope: Rotation2::new(-self.plan.plan().origin[2]) * self.ground_slope(),
        };
        let onset = self.joints.onset(&self.control);

        // Contacts, and the forces that the feet shall have.
        let footing = self.contacts.update_contacts(&cycle, measured_forces(&self.measured, sensors));
        let forces = force_targets(&cycle, &footing);
        // Modification of the foot trajectories that brings the forces there.
        let motion = self.speeds.sole_motion(&cycle, &task);
        self.modification =
            modify(cycle.control, &motion, &footing.feet, &forces.targets, &self.modification, cycle.dt);
        // Task, joint speeds, joint targets.
        let velocity = task_velocity(&cycle, &self.modification, &forces.deformation, onset.drift);
        let torso = torso_motion(&cycle, self.plan.plan(), sensors.imu.angular_velocity);
        let speeds = self.speeds.solve(&cycle, (&task, &velocity), &self.joints, onset, &torso, lag);
        let held = self.joints.integrate(&self.robot, &speeds, self.clock.dt);

        let limits = MetLimits { damped: task.damped, modification: self.modification.limited, joints: held };
        (forces.wrenches, limits)
    }
}

/// Answer to the operator: refused if the event that came of the command says so.
pub fn verdict(event: Option<(EventCode, Detail)>) -> Verdict {
    match event {
        Some((code @ (EventCode::HeadRefused | EventCode::CommandRefused), detail)) => {
            Err(Reason::Event { code, detail })
        }
        _ => Ok(()),
    }
}
