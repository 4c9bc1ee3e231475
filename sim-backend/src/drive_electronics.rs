//! The drives' own electronics: states of CiA 402, references, protection; one power stage per drive.
//!
//! Row i of the drives drives joint i. States are always there; references and protection only where the scene asks for
//! them by `[drives]`, and what needs motors only where the model has motors. A local controller that received nothing
//! for too long ([`crate::command_timeout`]) is a fault of its drives in every scene.

use config::protection::Protection;
use config::{Robot, Scene};
use drives::cia402::{self, DriveFault, DriveInputs, REFERENCED, WARNING, WORDS};
use drives::homing::{HomeSwitch, Homing};
use messages::{JointMode, MAX_JOINTS, Sensors};

use crate::command_timeout::CommandTimeout;
use crate::drive::JointMotion;

/// \[rad/s\] Speed of a reference below which it is at rest, but for rounding.
const REST: f64 = 1e-9;

/// Action of a joint in this cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Action {
    /// No torque.
    Off,
    /// Follows its targets.
    Follow,
    /// Comes to rest on its ramp, and is held.
    Ramp,
    /// Looks for its reference with this joint speed \[rad/s\].
    Search(f64),
}

/// Commands of the bus in this cycle.
pub(crate) struct ReceivedCommand<'a> {
    /// The newest controlwords.
    pub control: &'a [u32; MAX_JOINTS],
    /// Demanded of the joints, a [`JointMode`].
    pub mode: u64,
    /// Nodes that received them.
    pub timeout: &'a CommandTimeout,
    /// Joints (bits) whose tables ended in motion.
    pub exhausted: u32,
}

/// A joint without absolute encoder.
#[derive(Clone, Copy, Debug)]
struct Search {
    switch: HomeSwitch,
    homing: Homing,
    began_closed: bool,
    /// \[rad\] Shortfall of its encoder's reading.
    origin: f64,
}

/// Electronics of all drives.
#[derive(Clone, Debug)]
pub(crate) struct DriveElectronics {
    drives: Vec<cia402::DriveStateMachine>,
    /// Joints that look for their references, or have found them.
    searches: Vec<Option<Search>>,
    protection: Option<Protection>,
    /// \[°C\] Windings.
    temperature: Vec<f64>,
    /// \[A\] Current limits.
    limit: Vec<f64>,
    actions: Vec<Action>,
    /// \[s\] For how long they have had no torque.
    off_for: Vec<f64>,
}

impl DriveElectronics {
    /// The drives of a scene, whose joints begin at `pose` \[rad\]; self-tests passed.
    pub(crate) fn new(robot: &Robot, scene: &Scene, pose: &[f64]) -> Self {
        // Self-tests take one cycle, and are over.
        let start = scene.drives.as_ref();
        let mut drives = vec![cia402::DriveStateMachine::default(); robot.joints.len()];
        for drive in &mut drives {
            drive.step(&DriveInputs::default());
        }
        // A joint without absolute encoder counts from where it is, and knows on which side of its switch that is.
        let search = |(switch, angle): (&Option<HomeSwitch>, &f64)| {
            let switch = switch.filter(|_| start.is_some_and(|start| start.homing))?;
            let began_closed = *angle >= switch.angle;
            Some(Search { switch, homing: Homing::Search, began_closed, origin: *angle })
        };
        let protection = robot.protection.clone().filter(|_| start.is_some());
        let windings = protection.iter().flat_map(|p| &p.windings);
        Self {
            searches: robot.homes.iter().zip(pose).map(search).collect(),
            temperature: windings.map(|winding| winding.surroundings).collect(),
            actions: vec![Action::Off; drives.len()],
            off_for: vec![f64::INFINITY; drives.len()],
            protection,
            drives,
            limit: robot.drives.iter().map(|drive| drive.current_limit).collect(),
        }
    }

    /// One bus cycle of `dt` \[s\]: states, and actions of the joints. `goals` and `now` are where the joints were to be
    /// and are; `current` \[A\], if there are motors with protection to look after. Returns the first joint whose drive
    /// has stopped in this cycle because its commands timed out.
    ///
    /// A controlword that no master sends is a bent one: the one before holds. From the one that enables operation, and
    /// from a fault, no single bit leads to another that is sent.
    pub(crate) fn step(
        &mut self,
        command: &ReceivedCommand<'_>,
        supply: bool,
        dt: f64,
        goals: &[JointMotion],
        now: &[JointMotion],
        current: Option<&[f64]>,
    ) -> Option<usize> {
        let mut stopped = None;
        let home = command.mode == JointMode::Home as u64;
        for j in 0..self.drives.len() {
            let drive = self.drives[j];
            let silent = drive.drives() && command.timeout.is_timed_out(j);
            let word = command.control[j] as u16;
            let inputs = DriveInputs {
                control: WORDS.contains(&word).then_some(word),
                supply,
                permit: home || self.knows(j),
                fault: self
                    .fault(j, &drive, dt, goals[j], now[j], current)
                    .or(silent.then_some(DriveFault::Heartbeat))
                    .or((command.exhausted >> j & 1 == 1).then_some(DriveFault::QueueEmpty)),
                still: goals[j].speed.abs() < REST,
            };
            self.drives[j].step(&inputs);
            // Reported once, as its error begins.
            if drive.error().is_none() && self.drives[j].error() == Some(DriveFault::Heartbeat) {
                stopped = stopped.or(Some(j));
            }
            self.actions[j] = self.choose(j, now[j].angle);
            self.off_for[j] = if self.actions[j] == Action::Off { self.off_for[j] + dt } else { 0.0 };
        }
        stopped
    }

    /// Action of a joint in this cycle.
    pub(crate) fn action(&self, j: usize) -> Action {
        self.actions[j]
    }

    /// \[s\] For how long a drive has had no torque, this cycle included; infinite: it never had any.
    pub(crate) fn off_for(&self, j: usize) -> f64 {
        self.off_for[j]
    }

    /// True if a joint knows its angle.
    fn knows(&self, j: usize) -> bool {
        self.searches[j].is_none_or(|search| search.homing == Homing::Found)
    }

    /// Fault of a drive that its protection finds.
    fn fault(
        &mut self,
        j: usize,
        drive: &cia402::DriveStateMachine,
        dt: f64,
        goal: JointMotion,
        now: JointMotion,
        current: Option<&[f64]>,
    ) -> Option<DriveFault> {
        let (p, current) = self.protection.as_ref().zip(current)?;
        let winding = &p.windings[j];
        self.temperature[j] = winding.after(self.temperature[j], current[j], dt);
        let limit = p.following_error + p.following_time * goal.speed.abs();
        let strays = drive.drives() && !((goal.angle - now.angle).abs() <= limit);
        // Voltage control knows no current limit: what flows is looked at.
        let most = p.over_current * self.limit[j];
        let burns = !(current[j].abs() <= most);
        let hot = !(self.temperature[j] <= winding.highest);
        burns
            .then_some(DriveFault::OverCurrent)
            .or(hot.then_some(DriveFault::OverTemperature))
            .or(strays.then_some(DriveFault::FollowingError))
    }

    fn choose(&mut self, j: usize, angle: f64) -> Action {
        let drive = &self.drives[j];
        match &mut self.searches[j] {
            _ if !drive.drives() => Action::Off,
            _ if drive.ramps() => Action::Ramp,
            Some(search) if search.homing != Homing::Found => {
                let closed = angle >= search.switch.angle;
                let speed = search.homing.step(&search.switch, search.began_closed, closed);
                if search.homing == Homing::Found {
                    search.origin = angle - search.switch.angle;
                }
                Action::Search(speed)
            }
            _ => Action::Follow,
        }
    }

    /// \[rad\] How much less than its angle a joint's encoders read: not 0 where it does not know its angle, or knows it
    /// as well as its home switch.
    pub(crate) fn origin(&self, j: usize) -> f64 {
        self.searches[j].map_or(0.0, |search| search.origin)
    }

    /// Writes status, error and temperature of every drive.
    pub(crate) fn report(&self, out: &mut Sensors) {
        for (j, drive) in self.drives.iter().enumerate() {
            let known = if self.knows(j) { REFERENCED } else { 0 };
            let hot = self.protection.as_ref().is_some_and(|p| self.temperature[j] > p.warning);
            let warning = if hot { WARNING } else { 0 };
            out.drive_status[j] = u32::from(drive.statusword() | known | warning);
            out.drive_error[j] = drive.error().map_or(0, |fault| fault as u32);
        }
        out.temperature[..self.temperature.len()].copy_from_slice(&self.temperature);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command_timeout::TIMEOUT_CYCLES;
    use codec::frames::Received;
    use config::{Setup, root};
    use drives::cia402::{DISABLE_VOLTAGE, DriveState, ENABLE_OPERATION, FAULT_RESET, SHUTDOWN};

    const KNEE: usize = 5;
    const HEAD: usize = 22;
    const DT: f64 = 1e-3;

    /// The drives of the scene `startup`, with what they see.
    struct Rig {
        electronics: DriveElectronics,
        goals: Vec<JointMotion>,
        now: Vec<JointMotion>,
        current: [f64; MAX_JOINTS],
        mode: JointMode,
        supply: bool,
        word: u16,
        timeout: CommandTimeout,
        receives: bool,
        stopped: Option<usize>,
    }

    impl Rig {
        fn new(homing: bool) -> Self {
            let mut setup = Setup::load(&root(None), "startup").unwrap();
            setup.scene.drives.as_mut().unwrap().homing = homing;
            let pose = &setup.robot.poses["hang"];
            let goals: Vec<JointMotion> =
                pose.iter().map(|&angle| JointMotion { angle, ..JointMotion::default() }).collect();
            let mut rig = Self {
                electronics: DriveElectronics::new(&setup.robot, &setup.scene, pose),
                now: goals.clone(),
                goals,
                current: [0.0; MAX_JOINTS],
                mode: JointMode::Hold,
                supply: true,
                word: 0x06,
                timeout: CommandTimeout::new(&setup.robot.layout),
                receives: true,
                stopped: None,
            };
            rig.step();
            rig.word = 0x0F;
            rig.step();
            rig
        }

        fn step(&mut self) {
            let received = Received::default();
            self.timeout.step(self.receives.then_some(&received));
            let control = &[u32::from(self.word); MAX_JOINTS];
            let command =
                ReceivedCommand { control, mode: self.mode as u64, timeout: &self.timeout, exhausted: 0 };
            let (goals, now, current) = (&self.goals, &self.now, Some(&self.current[..]));
            self.stopped = self.electronics.step(&command, self.supply, DT, goals, now, current);
        }

        fn steps(&mut self, count: u32) {
            (0..count).for_each(|_| self.step());
        }

        fn state(&self, j: usize) -> DriveState {
            self.electronics.drives[j].state()
        }

        fn error(&self, j: usize) -> Option<DriveFault> {
            self.electronics.drives[j].error()
        }
    }

    #[test]
    fn a_joint_without_reference_is_enabled_only_to_find_it() {
        let mut rig = Rig::new(true);
        assert_eq!((rig.state(HEAD), rig.electronics.action(HEAD)), (DriveState::SwitchedOn, Action::Off));
        assert_eq!(
            (rig.state(KNEE), rig.electronics.action(KNEE)),
            (DriveState::OperationEnabled, Action::Follow)
        );
        assert_eq!(rig.electronics.origin(HEAD), rig.now[HEAD].angle, "its encoder counts from zero");
        rig.mode = JointMode::Home;
        let mut cycles = 0;
        while !rig.electronics.knows(HEAD) && cycles < 20_000 {
            rig.step();
            if let Action::Search(speed) = rig.electronics.action(HEAD) {
                rig.now[HEAD].angle += speed * DT;
                rig.goals[HEAD] = rig.now[HEAD];
            }
            cycles += 1;
        }
        assert!(rig.electronics.origin(HEAD).abs() < 2e-5, "{} rad", rig.electronics.origin(HEAD));
        rig.mode = JointMode::Hold;
        rig.step();
        assert_eq!(rig.electronics.action(HEAD), Action::Follow);
    }

    /// From 25 degrees at twice the continuous current the limit is reached after tau ln(4/3); then it brakes, and lets go.
    #[test]
    fn a_hot_winding_ends_in_a_fault_after_a_warning() {
        let mut rig = Rig::new(false);
        rig.current[KNEE] = 40.0;
        let (mut cycles, mut warned, mut out) = (0, 0, Sensors::default());
        while rig.state(KNEE) == DriveState::OperationEnabled {
            rig.step();
            cycles += 1;
            rig.electronics.report(&mut out);
            warned += u32::from(out.drive_status[KNEE] & u32::from(WARNING) != 0);
        }
        let expected = 60.0 * (4.0_f64 / 3.0).ln() / DT;
        assert!((f64::from(cycles) - expected).abs() < 5.0, "{cycles} cycles, not {expected}");
        assert!(warned > 1000 && (out.temperature[KNEE] - 120.0).abs() < 0.01);
        assert_eq!(rig.error(KNEE), Some(DriveFault::OverTemperature));
        assert_eq!(rig.electronics.action(KNEE), Action::Ramp);
        rig.step();
        assert_eq!(rig.state(KNEE), DriveState::Fault, "no reset while it is hot");
        rig.electronics.report(&mut out);
        assert_eq!(out.drive_error[KNEE], 0x4310);
        assert_eq!(rig.state(KNEE + 1), DriveState::OperationEnabled);
    }

    #[test]
    fn a_current_beyond_the_limit_lets_go_at_once() {
        let mut rig = Rig::new(false);
        rig.current[KNEE] = -59.0;
        rig.step();
        assert_eq!(rig.state(KNEE), DriveState::OperationEnabled);
        rig.current[KNEE] = -61.0;
        rig.step();
        assert_eq!(
            (rig.error(KNEE), rig.electronics.action(KNEE)),
            (Some(DriveFault::OverCurrent), Action::Off)
        );
        rig.current[HEAD] = f64::NAN;
        rig.step();
        assert_eq!(rig.error(HEAD), Some(DriveFault::OverCurrent), "no number is no small one");
    }

    #[test]
    fn the_following_error_scales_with_the_speed() {
        let mut rig = Rig::new(false);
        rig.goals[KNEE].speed = 1.0;
        rig.now[KNEE].angle -= 0.07; // 0.06 rad at rest, 0.08 rad at 1 rad/s
        rig.step();
        assert_eq!(rig.state(KNEE), DriveState::OperationEnabled);
        rig.goals[KNEE].speed = 0.0;
        rig.step();
        assert_eq!(
            (rig.error(KNEE), rig.electronics.action(KNEE)),
            (Some(DriveFault::FollowingError), Action::Ramp)
        );
    }

    /// Its reference comes to rest, its torque goes; frames alone do not wake it, nor does an old reset.
    #[test]
    fn a_drive_without_commands_stops_by_itself_and_only_a_reset_leads_back() {
        let mut rig = Rig::new(false);
        (rig.goals[KNEE].speed, rig.receives) = (1.0, false);
        rig.steps(TIMEOUT_CYCLES);
        assert_eq!((rig.state(KNEE), rig.stopped), (DriveState::OperationEnabled, None));
        rig.step();
        assert_eq!((rig.state(KNEE), rig.stopped), (DriveState::FaultReaction, Some(0)));
        assert_eq!(
            (rig.error(KNEE), rig.electronics.action(KNEE)),
            (Some(DriveFault::Heartbeat), Action::Ramp)
        );
        rig.step();
        assert_eq!((rig.state(KNEE), rig.stopped), (DriveState::FaultReaction, None), "not yet at rest");
        rig.goals[KNEE].speed = 0.0;
        rig.steps(2);
        assert_eq!((rig.state(KNEE), rig.electronics.action(KNEE)), (DriveState::Fault, Action::Off));
        rig.receives = true;
        rig.steps(100);
        let mut out = Sensors::default();
        rig.electronics.report(&mut out);
        assert_eq!((rig.state(KNEE), out.drive_error[KNEE]), (DriveState::Fault, 0x8130));
        rig.word = FAULT_RESET;
        rig.step();
        assert_eq!((rig.state(KNEE), rig.error(KNEE)), (DriveState::SwitchOnDisabled, None));
    }

    #[test]
    fn a_drive_without_torque_needs_no_commands() {
        let mut rig = Rig::new(false);
        rig.word = SHUTDOWN;
        rig.step();
        rig.receives = false;
        rig.steps(1000);
        assert_eq!((rig.state(KNEE), rig.error(KNEE)), (DriveState::Ready, None));
    }

    #[test]
    fn a_bent_controlword_changes_nothing() {
        let mut rig = Rig::new(false);
        for bit in 0..16 {
            rig.word = ENABLE_OPERATION ^ 1 << bit;
            rig.step();
            assert_eq!(rig.state(KNEE), DriveState::OperationEnabled, "bit {bit}");
        }
        rig.now[KNEE].angle -= 0.2;
        rig.word = DISABLE_VOLTAGE;
        rig.steps(2);
        rig.now[KNEE] = rig.goals[KNEE];
        for bit in 0..16 {
            rig.word = DISABLE_VOLTAGE ^ 1 << bit;
            rig.step();
            assert_eq!(rig.state(KNEE), DriveState::Fault, "bit {bit}");
        }
    }

    #[test]
    fn without_supply_no_drive_has_torque() {
        let mut rig = Rig::new(false);
        rig.supply = false;
        rig.step();
        assert!((0..24).all(|j| rig.electronics.action(j) == Action::Off && rig.error(j).is_none()));
    }
}
