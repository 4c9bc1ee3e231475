//! One cycle of the joint loop. Pure: no clock, no bus, no shared memory.
//!
//! ```text
//! receive   frames ──► what is missing: line guard ──► force sensors: start-up ──► sensor data
//! send      targets ──► state ──► setpoints: follow, brake or track ──► checks ──► frames, watchdog reset
//! ```

mod explored;

use codec::frames::{DriveCommand, Received, decode_sensors, encode_command};
use codec::layout::Carries;
use config::{Robot, System};
use messages::{
    BusCounters, BusFrames, Command, Detail, EventCode, EventQueue, Header, JointMode, JointTables,
    JointTargets, Sensors, StartUp, TableFault, Verdict, WatchdogReset,
};

use crate::limits::following_limit;
use crate::line_guard::LineGuard;
use crate::reports::{Reports, drive_fault};
use crate::setpoints::Setpoints;
use crate::start_up::{StartUpSequence, is_enabled, knows_angle};
use crate::table_master::{TableCycle, TableMaster, TableState};
use crate::target_age::TargetAge;
use drives::cia402::{Wanted, controlword};

/// State of the joint loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoopState {
    /// Motor supply off: setpoints follow the measured angles.
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
    state: LoopState,
    age: TargetAge,
    setpoints: Setpoints,
    guard: LineGuard,
    /// Drives that play tables; none: they are sent a point in every cycle.
    tables: Option<TableMaster>,
    start_up: StartUpSequence,
    reports: Reports,
    sensors: Sensors,
    received: Received,
    /// Plan of tables that were refused because the drives play none.
    refused_plan: u64,
    output: LoopOutput,
}

/// Records that leave the joint loop.
#[derive(Clone, Default)]
struct LoopOutput {
    command: DriveCommand,
    frames: BusFrames,
    reset: WatchdogReset,
}

impl JointLoop {
    /// The joint loop of `robot` with a bus cycle of `dt` \[s\].
    pub fn new(robot: &Robot, system: &System, dt: f64) -> Self {
        Self {
            robot: robot.clone(),
            system: system.clone(),
            dt,
            state: LoopState::Off,
            age: TargetAge::new(system.targets_missed),
            setpoints: Setpoints::new(),
            guard: LineGuard::new(robot, system, dt),
            tables: TableMaster::new(robot, dt),
            start_up: StartUpSequence::new(robot.joints.len(), robot.weight(), feels(robot)),
            reports: Reports::new(),
            sensors: Sensors::default(),
            received: Received::default(),
            refused_plan: 0,
            output: LoopOutput::default(),
        }
    }

    /// The state.
    pub fn state(&self) -> LoopState {
        self.state
    }

    /// Frames of the last cycle for the drives.
    pub fn commanded(&self) -> &BusFrames {
        &self.output.frames
    }

    /// Events that were not taken yet.
    pub fn events(&mut self) -> &mut EventQueue {
        let Self { reports, guard, start_up, tables, .. } = self;
        reports.events().append(guard.events());
        if let Some(tables) = tables {
            reports.events().append(tables.events());
        }
        reports.events().append(start_up.events());
        reports.events()
    }

    /// Takes a command of the domains system and joint, between [`JointLoop::receive`] and [`JointLoop::send`].
    ///
    /// # Errors
    /// Why it is refused.
    pub fn command(&mut self, command: &Command) -> Verdict {
        self.start_up.command(command, &self.sensors)
    }

    /// Takes tables for the drives, between [`JointLoop::receive`] and [`JointLoop::send`]: those of a new plan are checked,
    /// loaded and begun in the cycle that they name, older ones are known already.
    pub fn take_tables(&mut self, tables: &JointTables) {
        match &mut self.tables {
            Some(master) => master.take(tables),
            None if tables.plan > self.refused_plan => {
                self.refused_plan = tables.plan;
                let fault = TableFault::NoTables;
                let detail = Detail::Table { joint: 0, point: 0, fault };
                self.reports.events().push(EventCode::TablesRefused, detail);
            }
            None => {}
        }
    }

    /// Where tables that were taken are; none if the drives play none.
    pub fn table_state(&self) -> Option<TableState> {
        self.tables.as_ref().map(TableMaster::state)
    }

    /// Faults of the bus so far.
    pub fn bus_counters(&self) -> BusCounters {
        self.guard.counters()
    }

    /// First half of the cycle: sensor data from the frames of the bus, stamped.
    ///
    /// The order matters. Frames overwrite, reading by reading, what stands in the sensor data; what is missing stays. So
    /// the data must hold raw readings when they come, and the guard must have copied what it expects.
    pub fn receive(&mut self, tick: u64, stamp_ns: u64, frames: Option<&BusFrames>) -> &Sensors {
        // Cycles that the joint loop itself slept through: readings may have moved that much further.
        let elapsed = stamp_ns.saturating_sub(self.sensors.header.stamp_ns) as f64 * 1e-9;
        let skipped = if tick > 1 { ((elapsed / self.dt).round() - 1.0).max(0.0) as u32 } else { 0 };
        self.sensors.header = Header { tick, stamp_ns, epoch: 0 };
        // Forces without the offsets that the cycle before took away: a missing one would lose them twice.
        self.start_up.restore(&mut self.sensors);
        // Last readings carried on, which stand for those that do not come and bound those that do.
        self.guard.expect(&mut self.sensors);
        if let Some(frames) = frames {
            self.received = decode_sensors(&self.robot.layout, frames, &mut self.sensors);
        }
        if let Some(tables) = &mut self.tables {
            tables.receive(frames);
        }
        // What cannot be goes back to what was expected, before anybody uses it.
        self.guard.judge(frames, &self.received, skipped, &mut self.sensors);
        self.sensors.frames_missed = self.guard.counters().lost;
        // Offsets last: of forces that are believed.
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
        if self.state == LoopState::Off {
            self.follow_measured(); // whatever comes next begins where the joints are
        }
        // State of the loop, then that of the start-up, which a stop holds.
        self.age.step(targets);
        self.state = self.next_state(targets, cause);
        if self.state == LoopState::Off {
            self.output.reset.trip = 0;
        }
        let stopped = matches!(self.state, LoopState::Stop(_));
        self.start_up.step(&self.sensors, stopped, |j| self.guard.spares(j));
        match self.state {
            LoopState::Off => self.follow_measured(),
            LoopState::Hold | LoopState::Stop(_) => self.setpoints.brake_all(&self.robot, self.dt),
            LoopState::Track => self.track(targets),
        }
        self.setpoints.end_cycle(self.state == LoopState::Track);
        self.follow_the_unable();
        // Checks of what will be sent; those that cut the power come before the frames, which then say so.
        // A line that is off is why a joint on it is not followed, and comes first.
        self.check_lines();
        self.check_following();
        let stands = self.start_up.state() == StartUp::Standing;
        self.reports.drive_faults(&self.robot, &self.sensors, |j| stands && self.guard.spares(j));
        self.step_tables();
        self.write_frames();
        (&self.output.frames, &self.output.reset)
    }

    /// The transition table.
    fn next_state(&mut self, targets: Option<&JointTargets>, cause: Option<EventCode>) -> LoopState {
        use LoopState::{Hold, Off, Stop, Track};
        let powered = self.sensors.power == 1;
        let mode = targets.map_or(JointMode::Off, |t| JointMode::from(t.mode));
        let late = self.age.is_late();
        let needed = (0..self.robot.joints.len()).filter(|&j| !self.spares(j));
        let tripped = needed.clone().find_map(|j| drive_fault(&self.sensors, j));
        let off = needed.clone().find(|&j| !is_enabled(&self.sensors, j));
        let lost = needed.clone().find(|&j| self.start_up.ready() && !knows_angle(&self.sensors, j));
        let mute = self.guard.cause();
        match self.state {
            _ if !powered => Off,
            Stop(why) => Stop(why),
            // A controller that cannot be reached is only asked to stop.
            Off | Hold | Track if mute.is_some() => self.stop_by_bus(mute),
            Hold | Track if tripped.is_some() => {
                self.stop(EventCode::DriveTripped, tripped.unwrap_or_default())
            }
            // The others are held: to let go of them all, so that it can be homed, is for a robot that is not yet on.
            Hold | Track if lost.is_some() => {
                self.stop(EventCode::NotHomed, Detail::Joint(lost.unwrap_or(0)))
            }
            Off => Hold,
            Hold if mode == JointMode::Track && !late && off.is_none() && self.start_up.ready() => Track,
            Hold => Hold,
            Track if cause.is_some() => self.stop(cause.unwrap_or(EventCode::SafeStop), Detail::Nothing),
            Track if off.is_some() => self.stop(EventCode::DriveNotEnabled, Detail::Joint(off.unwrap_or(0))),
            // Targets go on as planned, the drives do not.
            Track if self.tables.as_ref().is_some_and(TableMaster::refused) => Stop(EventCode::TablesRefused),
            Track if late => self.stop(EventCode::TargetsStale, Detail::Cycles(self.age.cycles().into())),
            Track if mode == JointMode::Stop => self.stop(EventCode::SafeStop, Detail::Nothing),
            Track if mode == JointMode::Track => Track,
            Track => Hold,
        }
    }

    /// A stop because of the bus.
    fn stop_by_bus(&mut self, cause: Option<(EventCode, Detail)>) -> LoopState {
        match cause {
            // Reported when it happened.
            Some((EventCode::BusOff, _)) | None => LoopState::Stop(EventCode::BusOff),
            Some((why, detail)) => self.stop(why, detail),
        }
    }

    fn stop(&mut self, why: EventCode, detail: Detail) -> LoopState {
        self.reports.stop(why, detail);
        LoopState::Stop(why)
    }

    /// True if the robot stands, and can do so without the local controller of joint `j`.
    fn spares(&self, j: usize) -> bool {
        self.start_up.state() == StartUp::Standing && self.guard.spares(j)
    }

    fn follow_measured(&mut self) {
        for j in 0..self.robot.joints.len() {
            self.setpoints.follow_measured(j, &self.sensors);
        }
    }

    /// True if targets move joint `j`.
    fn leads(&self, j: usize) -> bool {
        !self.start_up.begins() && is_enabled(&self.sensors, j)
    }

    /// A joint whose drive has no torque, or moves by itself, is where it is: what comes next begins there.
    fn follow_the_unable(&mut self) {
        for j in 0..self.robot.joints.len() {
            if !self.leads(j) {
                self.setpoints.follow_measured(j, &self.sensors);
            }
        }
    }

    /// Follows new targets if they are finite: one that is not makes the whole set worth nothing.
    fn track(&mut self, targets: Option<&JointTargets>) {
        let fresh = targets.filter(|_| self.age.is_fresh());
        if let Some(bad) = fresh.and_then(|t| self.first_not_finite(t)) {
            self.sensors.targets_limited += 1;
            self.state = self.stop(EventCode::TargetNotFinite, Detail::Joint(bad));
            return self.setpoints.brake_all(&self.robot, self.dt);
        }
        let Self { robot, setpoints, sensors, start_up, .. } = self;
        let leads = |j: usize| !start_up.begins() && is_enabled(sensors, j);
        let held = setpoints.track(robot, sensors, fresh, self.age.was_stale(), leads, self.dt);
        self.sensors.targets_limited += u64::from(held.count_ones());
        self.reports.limits(held, self.sensors.header.tick, self.dt);
    }

    fn first_not_finite(&self, t: &JointTargets) -> Option<usize> {
        (0..self.robot.joints.len()).find(|&j| !(t.angle[j].is_finite() && t.speed[j].is_finite()))
    }

    /// Joints that nobody reaches must not be driven: power off.
    fn check_lines(&mut self) {
        if self.state != LoopState::Off && self.guard.off().is_some() {
            self.trip(EventCode::BusOff);
        }
    }

    /// A joint that is not where it was commanded to be is broken, blocked or not ours: power off.
    fn check_following(&mut self) {
        if self.state == LoopState::Off {
            return self.reports.forget_following_errors();
        }
        // A joint that was not read is where it is believed to be.
        for j in 0..self.robot.joints.len() {
            if !(self.guard.reads(j) && self.leads(j)) {
                continue;
            }
            let setpoint = self.setpoints.of(j);
            let error = (setpoint.angle - self.sensors.joint_angle[j]).abs();
            let limit =
                following_limit(self.system.following_error, self.system.following_time, setpoint.speed);
            if error > limit {
                self.trip(EventCode::FollowingError);
                self.reports.following_error(j);
            }
        }
    }

    /// Asks for power off until it is off: a watchdog that stands still for a while shall find it. The first reason stands.
    fn trip(&mut self, why: EventCode) {
        if self.output.reset.trip == 0 {
            self.output.reset.trip = why as u64;
        }
    }

    /// Drives play tables while the joints are led, and no longer.
    fn step_tables(&mut self) {
        let Some(tables) = &mut self.tables else { return };
        let setpoints = &self.setpoints;
        tables.step(&TableCycle {
            tick: self.sensors.header.tick,
            powered: self.sensors.power == 1,
            led: self.state == LoopState::Track && self.output.reset.trip == 0,
            setpoint: &|j| (setpoints.of(j).angle, setpoints.of(j).speed),
        });
    }

    fn write_frames(&mut self) {
        let LoopOutput { command, frames, reset } = &mut self.output;
        let header = Header { epoch: 0, ..self.sensors.header };
        reset.header = header;
        reset.supply = self.sensors.power;
        command.targets.header = header;
        command.targets.mode = match self.state {
            LoopState::Off => JointMode::Off,
            _ if self.start_up.state() == StartUp::Homing => JointMode::Home,
            LoopState::Hold | LoopState::Stop(_) => JointMode::Hold,
            LoopState::Track => JointMode::Track,
        } as u64;
        // A controlword answers the statusword of the same drive: one step of CiA 402 in a cycle.
        for j in 0..self.robot.joints.len() {
            let setpoint = self.setpoints.of(j);
            (command.targets.angle[j], command.targets.speed[j]) = (setpoint.angle, setpoint.speed);
            let wanted = match reset.trip {
                0 => self.start_up.wanted(j, &self.sensors),
                _ => Wanted::Stop,
            };
            command.control[j] = controlword(self.sensors.drive_status[j] as u16, wanted).into();
        }
        let mut telegrams: &[messages::Frame] = &[];
        if let Some(tables) = &mut self.tables {
            command.due = tables.due(header.tick, &command.control, command.targets.mode);
            command.network = tables.network_command();
            telegrams = tables.telegrams();
        }
        encode_command(&self.robot.layout, command, telegrams, frames);
    }
}

/// True if the robot's drives bring forces of its feet.
fn feels(robot: &Robot) -> bool {
    let mut signals = robot.layout.sent(false).flat_map(|m| &m.signals);
    signals.any(|signal| matches!(signal.carries, Carries::Force(..)))
}
