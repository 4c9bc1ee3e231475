//! Joints of the simulated robot: commands of the bus, electronics of the drives, references of one cycle.

use codec::frames::{DriveCommand, DriveReplies, decode_targets};
use config::components::JointModel;
use config::robot::Joint;
use config::{Robot, Scene};
use messages::{BusFrames, Sensors};

use crate::command_timeout::{CommandTimeout, Follows};
use crate::drive::{JointCubic, JointMotion};
use crate::drive_electronics::{Action, DriveElectronics, ReceivedCommand};
use crate::inputs::DriveSwitches;
use crate::table_drives::SimulatedTables;

/// Joints of one robot, from the frames of the bus to references.
#[derive(Clone)]
pub(crate) struct SimulatedJoints {
    electronics: DriveElectronics,
    timeout: CommandTimeout,
    /// Tables of the drives, where they play them.
    tables: Option<SimulatedTables>,
    command: DriveCommand,
    /// Tick of the newest targets followed.
    followed: u64,
    /// \[rad\] Excess of each joint's encoders.
    offset: Vec<f64>,
    /// References in this cycle, and where they end.
    references: Vec<JointCubic>,
    goals: Vec<JointMotion>,
    /// Motions of the joints themselves.
    motions: Vec<JointMotion>,
}

impl SimulatedJoints {
    /// Joints of a robot at rest in the start pose of a scene.
    pub(crate) fn new(robot: &Robot, scene: &Scene) -> Self {
        let pose = &robot.poses[&scene.start_pose];
        let resting = |&angle: &f64| JointMotion { angle, ..JointMotion::default() };
        let offset = |joint: &Joint| scene.plant_mismatch.joint_offset.of(&joint.name).unwrap_or(0.0);
        Self {
            electronics: DriveElectronics::new(robot, scene, pose),
            timeout: CommandTimeout::new(&robot.layout),
            tables: SimulatedTables::new(robot, scene),
            command: DriveCommand::default(),
            followed: 0,
            offset: robot.joints.iter().map(offset).collect(),
            references: pose.iter().map(|&q| JointCubic::resting(q)).collect(),
            goals: pose.iter().map(resting).collect(),
            motions: pose.iter().map(resting).collect(),
        }
    }

    /// References of this cycle.
    pub(crate) fn references(&self) -> &[JointCubic] {
        &self.references
    }

    /// Motions of the joints.
    pub(crate) fn motions(&self) -> &[JointMotion] {
        &self.motions
    }

    /// Takes angle \[rad\] and speed \[rad/s\] of each joint.
    pub(crate) fn look(&mut self, joint: impl Fn(usize) -> (f64, f64)) {
        for (j, m) in self.motions.iter_mut().enumerate() {
            (m.angle, m.speed) = joint(j);
        }
    }

    /// Electronics of the drives.
    pub(crate) fn electronics(&self) -> &DriveElectronics {
        &self.electronics
    }

    /// Replies of drives that play tables, beside their readings; once a cycle.
    pub(crate) fn replies(&mut self, errors: &[u32]) -> DriveReplies<'_> {
        self.tables.as_mut().map_or_else(DriveReplies::default, |tables| tables.replies(errors))
    }

    /// \[rad\] Excess of the readings of joint `j`, by its offset and by where its encoder began to count.
    pub(crate) fn reading_error(&self, j: usize) -> f64 {
        self.offset[j] - self.electronics.origin(j)
    }

    /// Begins a cycle of `dt` \[s\]: takes the commands, and chooses the reference of each joint. Returns which drives have
    /// torque, and the first node of the bus whose drives have just stopped because its commands timed out.
    pub(crate) fn begin_cycle(
        &mut self,
        robot: &Robot,
        model: JointModel,
        frames: Option<&BusFrames>,
        powered: bool,
        sensors: &Sensors,
        dt: f64,
    ) -> (DriveSwitches, Option<usize>) {
        let new = self.take_commands(robot, frames);
        // The current that a winding is warmed by is what its own sensor says.
        let current = (model == JointModel::Motors).then_some(&sensors.motor_current[..]);
        let stopped = self.switch_drives(powered, current, dt);
        if let Some(tables) = &mut self.tables {
            tables.receive(new, |j| self.electronics.action(j) == Action::Follow);
        }
        for (j, joint) in robot.joints.iter().enumerate() {
            self.references[j] = self.reference(j, joint, model, dt);
        }
        (self.switches(robot, powered), stopped)
    }

    /// Takes the commands, node by node; an older cycle is nobody's command. Returns the frames that are new.
    fn take_commands<'f>(&mut self, robot: &Robot, frames: Option<&'f BusFrames>) -> Option<&'f BusFrames> {
        let new = frames.filter(|f| f.header.tick > self.followed);
        let received = new.map(|f| decode_targets(&robot.layout, f, &mut self.command));
        if self.timeout.step(received.as_ref()) {
            self.followed = self.command.targets.header.tick;
        }
        if let Some(tables) = &mut self.tables {
            tables.manage(new);
            tables.deafen(&mut self.command.control);
        }
        new
    }

    /// States of the drives after their commands, with what currents \[A\] their sensors read. Returns the first node whose drives
    /// have just stopped.
    fn switch_drives(&mut self, powered: bool, current: Option<&[f64]>, dt: f64) -> Option<usize> {
        let tables = self.tables.as_ref();
        let exhausted = |j: &usize| tables.is_some_and(|tables| tables.is_exhausted(*j));
        let exhausted = (0..self.offset.len()).filter(exhausted).fold(0, |bits, j| bits | 1 << j);
        let DriveCommand { control, targets, .. } = &self.command;
        let command = ReceivedCommand { control, mode: targets.mode, timeout: &self.timeout, exhausted };
        let stopped = self.electronics.step(&command, powered, dt, &self.goals, &self.motions, current);
        stopped.map(|joint| self.timeout.node_of(joint))
    }

    /// Reference of joint `j` by what its drive does.
    fn reference(&mut self, j: usize, joint: &Joint, model: JointModel, dt: f64) -> JointCubic {
        let (from, action) = (self.goals[j], self.electronics.action(j));
        let zero = self.electronics.origin(j) - self.offset[j];
        let targets = &self.command.targets;
        let angle = targets.angle[j] - self.offset[j] + self.electronics.origin(j);
        let follows = self.timeout.follows(j, angle - from.angle, joint.speed_limit * dt);
        // What plays tables is told where to go by SYNC alone; without a table it comes to rest, and stays.
        if let Some(tables) = &mut self.tables {
            if matches!(action, Action::Follow) {
                let sync = self.timeout.hears(j).then_some(self.followed as u8);
                let played = tables.reference(j, from, zero, sync);
                return played.unwrap_or_else(|| JointCubic::brake(joint, from, dt));
            }
            tables.stop(j);
        }
        match (action, follows) {
            // A limp joint with a motor moves as it will; one that only follows comes to rest and stays.
            (Action::Off, _) if model == JointModel::Motors => JointCubic::resting(self.motions[j].angle),
            (Action::Off | Action::Ramp, _) => JointCubic::brake(joint, from, dt),
            (Action::Search(speed), _) => {
                let change = joint.braking * dt;
                let speed = from.speed + (speed - from.speed).clamp(-change, change);
                JointCubic::follow(from, from.angle + 0.5 * (from.speed + speed) * dt, speed, dt)
            }
            (Action::Follow, Follows::Target) => JointCubic::follow(from, angle, targets.speed[j], dt),
            (Action::Follow, Follows::LastSpeed) => {
                JointCubic::follow(from, from.angle + from.speed * dt, from.speed, dt)
            }
        }
    }

    /// Drives without torque, and their brakes: they close some time after the torque has gone, and are open until a drive has
    /// had torque once.
    fn switches(&self, robot: &Robot, powered: bool) -> DriveSwitches {
        let mut switches = DriveSwitches { powered, ..DriveSwitches::default() };
        for j in 0..robot.joints.len() {
            switches.off |= u64::from(self.electronics.action(j) == Action::Off) << j;
            let (brake, off_for) = (robot.drives.get(j).and_then(|d| d.brake), self.electronics.off_for(j));
            // Infinity, not `is_some_and`: a comparison with what stands in an absent brake may be with a subnormal number.
            let delay = brake.map_or(f64::INFINITY, |brake| brake.delay);
            switches.braked |= u64::from(off_for > delay) << j;
            switches.held |= u64::from(off_for == f64::INFINITY) << j;
        }
        switches
    }

    /// Ends a cycle of `dt` \[s\]: the references have come to their goals.
    pub(crate) fn end_cycle(&mut self, dt: f64) {
        for (goal, reference) in self.goals.iter_mut().zip(&self.references) {
            *goal = reference.at(dt);
        }
    }

    /// References stay where they are.
    pub(crate) fn come_to_rest(&mut self) {
        for (goal, reference) in self.goals.iter_mut().zip(&mut self.references) {
            goal.speed = 0.0;
            *reference = JointCubic::resting(goal.angle);
        }
    }
}
