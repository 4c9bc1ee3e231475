//! One cycle of the joint loop. Pure: no clock, no bus, no shared memory.

use codec::frames::{DriveCommand, Received, decode_sensors, encode_targets};
use config::{Robot, System};
use messages::{
    BusCounters, BusFrames, Command, EventCode, Header, JointMode, JointTargets, Sensors, StartUp, Verdict,
    WatchdogReset,
};

use crate::braking::brake;
use crate::limits::{Motion, admit, following_limit};
use crate::line_guard::LineGuard;
use crate::rejoin::Rejoin;
use crate::start_up::{StartUpSequence, is_enabled};
use drives::cia402::{self, Wanted, controlword};

/// \[m/s^2\]
const GRAVITY: f64 = 9.81;

/// \[s\] A joint that is held back is told of again after so long without it.
const QUIET: f64 = 1.0;

/// What the joint loop is doing with the joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// Motor supply off: targets follow the measured angles.
    Off,
    /// Supply on, nobody commands: joints stay.
    Hold,
    /// Targets are followed.
    Track,
    /// Controlled stop for this reason, latched until the supply was off.
    Stop(EventCode),
}

/// The joint loop of one robot.
#[derive(Clone)]
pub struct JointLoop {
    robot: Robot,
    system: System,
    dt: f64,
    state: State,
    /// What the drives were told last.
    last: [Motion; messages::MAX_JOINTS],
    /// Tick of the newest targets that were used.
    used: u64,
    /// Cycles since targets were new, now and in the cycle before.
    stale: u32,
    stale_before: u32,
    /// Whether targets were followed in the cycle before.
    tracked: bool,
    rejoin: [Rejoin; messages::MAX_JOINTS],
    /// Tick at which each joint was held back last.
    limited: [Option<u64>; messages::MAX_JOINTS],
    /// Drives with a fault that was told.
    named: [bool; messages::MAX_JOINTS],
    guard: LineGuard,
    start_up: StartUpSequence,
    sensors: Sensors,
    command: DriveCommand,
    received: Received,
    frames: BusFrames,
    reset: WatchdogReset,
    event: Option<(EventCode, u64)>,
}

impl JointLoop {
    /// The joint loop of `robot` with a bus cycle of `dt` \[s\].
    pub fn new(robot: &Robot, system: &System, dt: f64) -> Self {
        Self {
            robot: robot.clone(),
            system: system.clone(),
            dt,
            state: State::Off,
            last: [Motion { angle: 0.0, speed: 0.0 }; messages::MAX_JOINTS],
            used: 0,
            stale: 0,
            stale_before: 0,
            tracked: false,
            rejoin: [Rejoin::default(); messages::MAX_JOINTS],
            limited: [None; messages::MAX_JOINTS],
            named: [false; messages::MAX_JOINTS],
            guard: LineGuard::new(robot, system, dt),
            start_up: StartUpSequence::new(robot.joints.len(), robot.total_mass * GRAVITY),
            sensors: Sensors::default(),
            command: DriveCommand::default(),
            received: Received::default(),
            frames: BusFrames::default(),
            reset: WatchdogReset::default(),
            event: None,
        }
    }

    /// What the loop is doing.
    pub fn state(&self) -> State {
        self.state
    }

    /// What the drives were told in the last cycle.
    pub fn told(&self) -> &BusFrames {
        &self.frames
    }

    /// Something worth a line in the log, since the last call.
    pub fn take_event(&mut self) -> Option<(EventCode, u64)> {
        self.event.take().or_else(|| self.guard.take_event()).or_else(|| self.start_up.take_event())
    }

    /// Takes a command of the domains system and joint, between [`JointLoop::receive`] and [`JointLoop::send`].
    ///
    /// # Errors
    /// Why it is refused.
    pub fn command(&mut self, command: &Command) -> Verdict {
        self.start_up.command(command, &self.sensors)
    }

    /// What went wrong on the bus so far.
    pub fn bus_counters(&self) -> BusCounters {
        self.guard.counters()
    }

    /// First half of the cycle: what the bus brought, stamped.
    pub fn receive(&mut self, tick: u64, stamp_ns: u64, frames: Option<&BusFrames>) -> &Sensors {
        let elapsed = stamp_ns.saturating_sub(self.sensors.header.stamp_ns) as f64 * 1e-9;
        let skipped = if tick > 1 { ((elapsed / self.dt).round() - 1.0).max(0.0) as u32 } else { 0 };
        self.sensors.header = Header { tick, stamp_ns, epoch: 0 };
        self.start_up.restore(&mut self.sensors);
        self.guard.expect(&mut self.sensors);
        if let Some(frames) = frames {
            self.received = decode_sensors(&self.robot.layout, frames, &mut self.sensors);
        }
        self.guard.judge(frames, &self.received, skipped, &mut self.sensors);
        self.sensors.frames_missed = self.guard.counters().lost;
        self.start_up.receive(&mut self.sensors);
        &self.sensors
    }

    /// Second half of the cycle: the newest targets, checked, as frames for the drives; and the watchdog's reset.
    ///
    /// `cause` is a reason of the run-time system's own for a controlled stop (too many overruns).
    pub fn send(
        &mut self,
        targets: Option<&JointTargets>,
        cause: Option<EventCode>,
    ) -> (&BusFrames, &WatchdogReset) {
        self.reset.trip = 0;
        if self.state == State::Off {
            self.follow_measured(); // whatever comes next begins where the joints are
        }
        self.choose_state(targets, cause);
        let stopped = matches!(self.state, State::Stop(_));
        self.start_up.step(&self.sensors, stopped, |j| self.guard.spares(j));
        match self.state {
            State::Off => self.follow_measured(),
            State::Hold => self.brake_all(),
            State::Stop(_) => self.brake_all(),
            State::Track => self.track(targets),
        }
        self.tracked = self.state == State::Track;
        if !self.tracked {
            self.rejoin.iter_mut().for_each(Rejoin::forget);
        }
        self.follow_the_unable();
        self.check_following();
        self.check_lines();
        self.name_faults();
        self.write_frames();
        (&self.frames, &self.reset)
    }

    /// The transition table.
    fn choose_state(&mut self, targets: Option<&JointTargets>, cause: Option<EventCode>) {
        let powered = self.sensors.power == 1;
        let mode = targets.map_or(JointMode::Off, |t| JointMode::from(t.mode));
        self.stale_before = self.stale;
        if targets.is_some_and(|t| t.header.tick > self.used) {
            self.used = targets.map_or(0, |t| t.header.tick);
            self.stale = 0;
        } else {
            self.stale = self.stale.saturating_add(1);
        }
        let late = self.stale > self.system.targets_missed;
        let needed = (0..self.robot.joints.len()).filter(|&j| !self.spares(j));
        let tripped = needed.clone().find_map(|j| fault(&self.sensors, j));
        let off = needed.clone().find(|&j| !is_enabled(&self.sensors, j));
        let mute = self.guard.cause();
        self.state = match self.state {
            _ if !powered => State::Off,
            State::Stop(why) => State::Stop(why),
            State::Off | State::Hold | State::Track if mute.is_some() => self.unheard(mute),
            State::Hold | State::Track if tripped.is_some() => {
                self.stop(EventCode::DriveTripped, tripped.unwrap_or(0))
            }
            State::Off => State::Hold,
            State::Hold if mode == JointMode::Track && !late && self.start_up.ready() => State::Track,
            State::Hold => State::Hold,
            State::Track if cause.is_some() => self.stop(cause.unwrap_or(EventCode::SafeStop), 0),
            State::Track if off.is_some() => self.stop(EventCode::DriveNotEnabled, off.unwrap_or(0) as u64),
            State::Track if late => self.stop(EventCode::TargetsStale, self.stale.into()),
            State::Track if mode == JointMode::Stop => self.stop(EventCode::SafeStop, 0),
            State::Track if mode == JointMode::Track => State::Track,
            State::Track => State::Hold,
        };
    }

    /// A stop because of the bus.
    fn unheard(&mut self, cause: Option<(EventCode, u64)>) -> State {
        match cause {
            Some((EventCode::BusOff, _)) | None => State::Stop(EventCode::BusOff), // told when it happened
            Some((why, detail)) => self.stop(why, detail),
        }
    }

    fn stop(&mut self, why: EventCode, detail: u64) -> State {
        self.event = Some((why, detail));
        State::Stop(why)
    }

    /// Whether the robot stands, and can do so without the local controller of joint `j`.
    fn spares(&self, j: usize) -> bool {
        self.start_up.state() == StartUp::Standing && self.guard.spares(j)
    }

    /// Tells of drives with a fault, each once, one in a cycle: those that stop nobody, and those whose frames come back
    /// after the stop.
    fn name_faults(&mut self) {
        for j in 0..self.robot.joints.len() {
            let Some(detail) = fault(&self.sensors, j) else {
                self.named[j] = false;
                continue;
            };
            let held = if self.spares(j) { EventCode::DriveHeld } else { EventCode::DriveTripped };
            let tells = !self.named[j] && self.event.is_none();
            if tells {
                self.event = Some((held, detail));
            }
            // The one that stopped the joints was told in this cycle.
            self.named[j] |= tells || self.event == Some((EventCode::DriveTripped, detail));
        }
    }

    fn follow_measured(&mut self) {
        for j in 0..self.robot.joints.len() {
            self.last[j] = Motion { angle: self.sensors.joint_angle[j], speed: 0.0 };
        }
    }

    /// Whether targets move joint `j`.
    fn leads(&self, j: usize) -> bool {
        !self.start_up.begins() && is_enabled(&self.sensors, j)
    }

    /// A joint whose drive has no torque, or moves by itself, is where it is: what comes next begins there.
    fn follow_the_unable(&mut self) {
        for j in 0..self.robot.joints.len() {
            if !self.leads(j) {
                self.last[j] = Motion { angle: self.sensors.joint_angle[j], speed: 0.0 };
            }
        }
    }

    fn brake_all(&mut self) {
        for (j, joint) in self.robot.joints.iter().enumerate() {
            self.last[j] = brake(joint, self.last[j], self.dt);
        }
    }

    /// New targets if they are new and finite, otherwise the last ones carried on at their speed. At first and after a pause
    /// the joints come to them gently.
    fn track(&mut self, targets: Option<&JointTargets>) {
        let fresh = targets.filter(|_| self.stale == 0);
        if let Some(bad) = fresh.and_then(|t| self.first_not_finite(t)) {
            self.sensors.targets_limited += 1;
            self.state = self.stop(EventCode::TargetNotFinite, bad as u64);
            return self.brake_all();
        }
        let mut held = 0u64;
        for (j, joint) in self.robot.joints.iter().enumerate() {
            if !self.leads(j) {
                self.rejoin[j].forget();
                continue; // it has no torque
            }
            let last = self.last[j];
            // Neither what is carried on nor what is left of an offset leads out of the joint's range.
            let inside = |m: Motion| Motion {
                angle: m.angle.clamp(joint.range[0].min(last.angle), joint.range[1].max(last.angle)),
                ..m
            };
            let carried = inside(Motion { angle: last.angle + last.speed * self.dt, speed: last.speed });
            let wanted = match fresh {
                Some(t) => {
                    let target = Motion { angle: t.angle[j], speed: t.speed[j] };
                    if self.stale_before > 0 || !self.tracked {
                        self.rejoin[j].begin(carried, target);
                        carried
                    } else if self.rejoin[j].is_over() {
                        target
                    } else {
                        inside(self.rejoin[j].step(target, self.dt))
                    }
                }
                None => carried,
            };
            let possible = || self.robot.acceleration(j, &self.sensors.joint_angle);
            if let Ok((motion, limited)) = admit(joint, possible, last, wanted, self.dt) {
                self.last[j] = motion;
                if limited {
                    self.sensors.targets_limited += 1;
                    held |= 1 << j;
                }
            }
        }
        (0..self.robot.joints.len()).filter(|j| held >> j & 1 == 1).for_each(|j| self.tell_limited(j));
    }

    /// Tells that joint `j` is held back: once, until it was not for [`QUIET`]; in the next cycle if something else is told in
    /// this one.
    fn tell_limited(&mut self, j: usize) {
        let tick = self.sensors.header.tick;
        let quiet = |last: u64| tick.saturating_sub(last) as f64 * self.dt > QUIET;
        let begins = self.limited[j].is_none_or(quiet);
        if begins && self.event.is_some() {
            return;
        }
        if begins {
            self.event = Some((EventCode::TargetLimited, j as u64));
        }
        self.limited[j] = Some(tick);
    }

    fn first_not_finite(&self, t: &JointTargets) -> Option<usize> {
        (0..self.robot.joints.len()).find(|&j| !(t.angle[j].is_finite() && t.speed[j].is_finite()))
    }

    /// A joint that is not where it was told to be is broken, blocked or not ours: power off.
    fn check_following(&mut self) {
        if self.state == State::Off {
            return;
        }
        // A joint that was not read is where it is believed to be.
        for j in 0..self.robot.joints.len() {
            if !(self.guard.reads(j) && self.leads(j)) {
                continue;
            }
            let error = (self.last[j].angle - self.sensors.joint_angle[j]).abs();
            let limit =
                following_limit(self.system.following_error, self.system.following_time, self.last[j].speed);
            if error > limit {
                self.reset.trip = EventCode::FollowingError as u64;
                self.event = Some((EventCode::FollowingError, j as u64));
            }
        }
    }

    /// Joints that nobody reaches must not be driven: power off.
    fn check_lines(&mut self) {
        if self.state != State::Off && self.guard.off().is_some() {
            self.reset.trip = EventCode::BusOff as u64;
        }
    }

    fn write_frames(&mut self) {
        let header = Header { epoch: 0, ..self.sensors.header };
        self.reset.header = header;
        self.reset.supply = self.sensors.power;
        self.command.targets.header = header;
        self.command.targets.mode = match self.state {
            State::Off => JointMode::Off,
            _ if self.start_up.state() == StartUp::Homing => JointMode::Home,
            State::Hold | State::Stop(_) => JointMode::Hold,
            State::Track => JointMode::Track,
        } as u64;
        for j in 0..self.robot.joints.len() {
            self.command.targets.angle[j] = self.last[j].angle;
            self.command.targets.speed[j] = self.last[j].speed;
            let wanted = match self.state {
                _ if self.reset.trip != 0 => Wanted::Stop,
                _ => self.start_up.wanted(j, &self.sensors),
            };
            self.command.control[j] = controlword(self.sensors.drive_status[j] as u16, wanted).into();
        }
        encode_targets(&self.robot.layout, &self.command, &mut self.frames);
    }
}

/// Fault of the drive of joint `j`: joint and error code, as in [`EventCode::DriveTripped`].
fn fault(sensors: &Sensors, j: usize) -> Option<u64> {
    let state = cia402::state_of(sensors.drive_status[j] as u16);
    let broken = matches!(state, Some(cia402::State::Fault | cia402::State::FaultReaction));
    broken.then(|| j as u64 + (u64::from(sensors.drive_error[j]) << 16))
}
