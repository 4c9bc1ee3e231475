//! The start-up against drives that behave as CiA 402 says: what is asked of them, what is refused, what is told.

use codec::frames::{DriveCommand, decode_targets, encode_sensors};
use codec::layout::Carries;
use config::{Robot, System};
use drives::cia402::{self, DriveFault, DriveInputs, REFERENCED};
use lowlevel::JointLoop;
use lowlevel::joint_loop::LoopState;
use messages::{
    BusFrames, Command, Detail, EventCode, JointMode, JointTargets, Reason, Sensors, StartUp, Verdict,
};

/// \[N\] Lola's weight.
const WEIGHT: f64 = 60.885 * 9.81;
/// Joint without an absolute encoder, and one with.
const HEAD: usize = 22;
const KNEE: usize = 5;
/// Joint of an arm, which a robot that stands can do without.
const ARM: usize = 17;

/// Drives at the far end, which go where they are told at once.
struct Rig {
    robot: Robot,
    loop_: JointLoop,
    drives: Vec<cia402::DriveStateMachine>,
    known: Vec<bool>,
    fault: Option<(usize, DriveFault)>,
    said: Sensors,
    seen: Sensors,
    told: DriveCommand,
    /// \[rad\] Where the controller wants the joints, but for 1 mrad to and fro.
    wanted: messages::Joints,
    /// A joint that creeps away instead of following.
    creeps: Option<usize>,
    /// A joint whose local controller is not heard.
    mute: Option<usize>,
    events: Vec<(EventCode, Detail)>,
    /// To the command of the last cycle, if there was one.
    answer: Option<Verdict>,
    tick: u64,
}

impl Rig {
    /// Supply off, both feet loaded with this much \[N\].
    fn new(load: f64) -> Self {
        let root = config::root(None);
        let robot = Robot::load(&root.join("robots/lola")).unwrap();
        let system = System::load(&root.join("system.toml")).unwrap();
        let mut said = Sensors::default();
        for (j, q) in robot.poses["stand"].iter().enumerate() {
            said.joint_angle[j] = *q;
        }
        for wrench in &mut said.foot_wrench {
            wrench.force[2] = 0.5 * load;
        }
        let mut drives = vec![cia402::DriveStateMachine::default(); robot.joints.len()];
        drives.iter_mut().for_each(|drive| _ = drive.step(&DriveInputs::default()));
        let mut rig = Self {
            loop_: JointLoop::new(&robot, &system, 1e-3),
            known: vec![true; drives.len()],
            robot,
            drives,
            fault: None,
            seen: Sensors::default(),
            told: DriveCommand::default(),
            wanted: said.joint_angle,
            creeps: None,
            mute: None,
            said,
            events: Vec::new(),
            answer: None,
            tick: 0,
        };
        rig.cycles(3);
        rig
    }

    /// With the supply on, and every drive on as far as it may be.
    fn on(load: f64) -> Self {
        let mut rig = Self::new(load);
        rig.said.power = 1;
        rig.cycles(5);
        rig
    }

    fn cycles(&mut self, count: usize) {
        for _ in 0..count {
            self.cycle(None);
        }
    }

    /// One bus cycle, with a command between its halves.
    fn cycle(&mut self, command: Option<Command>) {
        let mut answer = BusFrames::default();
        self.said.header.tick = self.tick;
        for (j, drive) in self.drives.iter().enumerate() {
            let known = if self.known[j] { REFERENCED } else { 0 };
            self.said.drive_status[j] = u32::from(drive.statusword() | known);
            self.said.drive_error[j] = drive.error().map_or(0, |fault| fault as u32);
        }
        encode_sensors(&self.robot.layout, &self.said, &mut answer);
        if let Some(j) = self.mute {
            self.cut(j, &mut answer);
        }
        self.tick += 1;
        self.seen = *self.loop_.receive(self.tick, self.tick * 1_000_000, Some(&answer));
        self.answer = command.map(|command| self.loop_.command(&command));
        let mut targets = JointTargets { mode: JointMode::Track as u64, ..JointTargets::default() };
        targets.header.tick = self.tick;
        targets.angle = self.wanted;
        let step = if self.tick.is_multiple_of(2) { 1e-5 } else { -1e-5 };
        targets.angle.iter_mut().for_each(|q| *q += step);
        let (frames, _) = self.loop_.send(Some(&targets), None);
        decode_targets(&self.robot.layout, frames, &mut self.told);
        self.events.extend(self.loop_.events().drain());
        let home = self.told.targets.mode == JointMode::Home as u64;
        for j in 0..self.drives.len() {
            self.drives[j].step(&DriveInputs {
                control: Some(self.told.control[j] as u16),
                supply: self.said.power == 1,
                permit: home || self.known[j],
                fault: self.fault.filter(|fault| fault.0 == j).map(|fault| fault.1),
                still: true,
            });
            if self.creeps == Some(j) {
                self.said.joint_angle[j] += 5e-3;
            } else if self.drives[j].drives() && !home {
                self.said.joint_angle[j] = self.told.targets.angle[j];
            }
        }
    }

    /// Takes away what the local controller of joint `j` says.
    fn cut(&self, j: usize, frames: &mut BusFrames) {
        let reads = |m: &&codec::layout::BusMessage| m.signals.iter().any(|s| s.carries == Carries::Angle(j));
        let line = self.robot.layout.messages.iter().find(reads).unwrap().node as u32;
        let all = *frames;
        frames.count = 0;
        for frame in all.as_slice().iter().filter(|frame| frame.line != line) {
            frames.push(frame);
        }
    }

    /// Supply off and on again, with a reset between or without.
    fn again(&mut self, reset: bool) {
        self.said.power = 0;
        self.cycles(5);
        self.cycle(reset.then_some(Command::Reset));
        self.cycles(5);
        self.said.power = 1;
        self.cycles(10);
    }

    fn state(&self) -> StartUp {
        StartUp::from_number(self.seen.start_up)
    }

    fn enabled(&self) -> usize {
        self.drives.iter().filter(|drive| drive.drives()).count()
    }

    fn load(&mut self, newton: f64) {
        self.said.foot_wrench.iter_mut().for_each(|wrench| wrench.force[2] = 0.5 * newton);
    }
}

#[test]
fn a_standing_robot_is_on_in_the_cycle_after_its_supply() {
    let mut rig = Rig::new(WEIGHT);
    assert_eq!((rig.state(), rig.enabled()), (StartUp::Off, 0));
    rig.said.power = 1;
    rig.cycle(None);
    assert_eq!(rig.enabled(), 24, "in the very cycle in which the supply was seen");
    rig.cycles(3);
    assert_eq!((rig.state(), rig.loop_.state()), (StartUp::Standing, LoopState::Track));
    assert!(rig.events.is_empty(), "{:?}", rig.events);
}

#[test]
fn a_joint_that_does_not_know_its_angle_keeps_all_drives_off_until_it_was_homed() {
    let mut rig = Rig::new(0.0);
    let before = rig.said.joint_angle;
    rig.known[HEAD] = false;
    rig.said.power = 1;
    rig.cycles(1000);
    assert_eq!((rig.state(), rig.enabled()), (StartUp::NotHomed, 0));
    assert_eq!(rig.events, [(EventCode::NotHomed, Detail::Joint(HEAD))], "told once");
    assert_eq!((rig.said.joint_angle, rig.loop_.state()), (before, LoopState::Hold), "nothing moves");
    rig.cycle(Some(Command::Home));
    rig.cycles(10);
    assert_eq!((rig.state(), rig.enabled()), (StartUp::Homing, 1));
    assert_eq!(rig.told.targets.mode, JointMode::Home as u64);
    (rig.known[HEAD], rig.said.joint_angle[HEAD]) = (true, 0.7);
    rig.wanted[HEAD] = 0.7;
    rig.cycles(5);
    assert_eq!((rig.state(), rig.enabled()), (StartUp::Hanging, 24));
    assert_eq!(rig.events[1].0, EventCode::Homed);
    let led = rig.told.targets.angle[HEAD];
    assert!((led - 0.7).abs() < 0.01, "begins at the angle that was found: {led}");
    assert_eq!(rig.events.len(), 2, "{:?}", rig.events);
    rig.cycle(Some(Command::Home));
    assert_eq!(rig.events.last(), Some(&(EventCode::CommandRefused, Detail::Message(0))), "homing is done");
}

/// Every command that the joint loop decides, in every state of the start-up.
#[test]
fn commands_are_answered_by_the_state_they_come_in() {
    let hanging = |load: f64| {
        let mut rig = Rig::on(0.0);
        rig.load(load);
        rig.cycles(3);
        rig
    };
    let unknown = |home: bool| {
        let mut rig = Rig::new(0.0);
        (rig.known[HEAD], rig.said.power) = (false, 1);
        rig.cycles(10);
        rig.cycle(home.then_some(Command::Home));
        rig.cycles(2);
        rig
    };
    let zeroed = || {
        let mut rig = Rig::on(0.0);
        rig.cycle(Some(Command::ZeroForce));
        rig.cycles(110);
        rig
    };
    let stopped = || {
        let mut rig = Rig::on(WEIGHT);
        rig.fault = Some((KNEE, DriveFault::OverTemperature));
        rig.cycles(5);
        rig
    };
    let most = 0.15 * WEIGHT;
    let loaded = |load: f64| Err(Reason::Loaded { load: 0.5 * load, most });
    let (yes, not_now) = (Ok(()), Err(Reason::NotNow));
    type State<'a> = (StartUp, &'a dyn Fn() -> Rig, Verdict, Verdict);
    let table: [State; 8] = [
        // State, how it is reached, answer to joint/home, answer to joint/zero_force.
        (StartUp::Off, &|| Rig::new(0.0), not_now, not_now),
        (StartUp::NotHomed, &|| unknown(false), yes, not_now),
        (StartUp::Homing, &|| unknown(true), yes, not_now),
        (StartUp::Hanging, &|| hanging(0.0), not_now, yes),
        (StartUp::Hanging, &|| hanging(0.4 * WEIGHT), not_now, loaded(0.4 * WEIGHT)),
        (StartUp::Zeroed, &zeroed, not_now, yes),
        (StartUp::Standing, &|| Rig::on(WEIGHT), not_now, loaded(WEIGHT)),
        (StartUp::Stopped, &stopped, not_now, not_now),
    ];
    for (state, reach, home, zero) in table {
        for (command, wanted) in [(Command::Home, home), (Command::ZeroForce, zero), (Command::Reset, yes)] {
            let mut rig = reach();
            assert_eq!(rig.state(), state);
            rig.cycle(Some(command));
            let found = rig.answer.expect("there was a command");
            match (found, wanted) {
                (Err(Reason::Loaded { load: a, most: b }), Err(Reason::Loaded { load, most })) => {
                    assert!((a - load).abs() < 0.1 && (b - most).abs() < 0.5, "{state:?}: {a} N, {b} N");
                }
                _ => assert_eq!(found, wanted, "{state:?}, {}", command.name()),
            }
            let refusals = rig
                .events
                .iter()
                .filter(|(code, _)| matches!(code, EventCode::CommandRefused | EventCode::ZeroRefused));
            assert_eq!(refusals.count(), usize::from(found.is_err()), "{state:?}, {}", command.name());
        }
    }
}

#[test]
fn force_sensors_read_zero_after_zeroing_and_the_robot_stands_once_its_feet_carry() {
    let mut rig = Rig::on(-30.0); // feet that hang on their sensors
    rig.cycles(100);
    assert_eq!(rig.state(), StartUp::Hanging);
    rig.cycle(Some(Command::ZeroForce));
    rig.cycles(101);
    assert_eq!(rig.state(), StartUp::Zeroed);
    assert_eq!(rig.events, [(EventCode::ForceZeroed, Detail::Newtons(15))]);
    assert!(rig.seen.foot_wrench.iter().all(|w| w.force[2].abs() < 1e-9), "{:?}", rig.seen.foot_wrench);
    rig.load(0.85 * WEIGHT - 30.0);
    rig.cycles(300);
    assert_eq!(rig.state(), StartUp::Zeroed, "still held by the crane");
    rig.load(WEIGHT - 30.0);
    rig.cycles(110);
    assert_eq!(rig.state(), StartUp::Standing);
    let load: f64 = rig.seen.foot_wrench.iter().map(|w| w.force[2]).sum();
    assert!((load - WEIGHT).abs() < 1e-3, "{load} N");
}

#[test]
fn frames_that_are_missing_do_not_take_the_offset_away_twice() {
    let mut rig = Rig::on(-30.0);
    rig.cycle(Some(Command::ZeroForce));
    rig.cycles(101);
    for _ in 0..5 {
        rig.tick += 1;
        rig.seen = *rig.loop_.receive(rig.tick, 0, None);
        let mut nothing = BusFrames::default();
        nothing.header.tick = rig.tick;
        rig.seen = *rig.loop_.receive(rig.tick, 0, Some(&nothing));
    }
    assert!(rig.seen.foot_wrench.iter().all(|w| w.force[2].abs() < 1e-9), "{:?}", rig.seen.foot_wrench);
}

#[test]
fn zeroing_with_load_on_the_feet_is_refused() {
    let mut standing = Rig::on(WEIGHT);
    standing.cycle(Some(Command::ZeroForce));
    assert_eq!(standing.events, [(EventCode::ZeroRefused, Detail::Newtons((0.5 * WEIGHT) as u64))]);
    let mut off = Rig::new(0.0);
    off.cycle(Some(Command::ZeroForce));
    assert_eq!(off.events, [(EventCode::ZeroRefused, Detail::Newtons(0))], "drives off");
    let mut lowered = Rig::on(0.0);
    lowered.cycle(Some(Command::ZeroForce));
    lowered.cycles(50);
    lowered.load(0.5 * WEIGHT);
    lowered.cycles(200);
    assert_eq!(
        lowered.events,
        [(EventCode::ZeroRefused, Detail::Newtons((0.25 * WEIGHT) as u64))],
        "while it is measured"
    );
    assert!(lowered.seen.foot_wrench.iter().all(|w| w.force[2] > 0.2 * WEIGHT), "nothing taken away");
    assert_eq!(lowered.state(), StartUp::Hanging);
}

#[test]
fn a_drive_with_a_fault_is_a_controlled_stop_that_names_it_and_only_a_reset_ends_it() {
    let mut rig = Rig::on(WEIGHT);
    rig.fault = Some((KNEE, DriveFault::OverTemperature));
    rig.cycles(3);
    rig.fault = None;
    rig.cycles(50);
    let named = Detail::Drive { joint: KNEE, error: DriveFault::OverTemperature as u16 };
    assert_eq!(rig.events, [(EventCode::DriveTripped, named)]);
    assert_eq!(
        (rig.loop_.state(), rig.state()),
        (LoopState::Stop(EventCode::DriveTripped), StartUp::Stopped)
    );
    assert_eq!(rig.enabled(), 23, "the others hold");
    assert!((0..24).all(|j| rig.told.targets.speed[j] == 0.0));

    rig.again(false);
    assert_eq!(rig.events, [(EventCode::DriveTripped, named); 2], "a fault is not forgotten by itself");
    rig.again(true);
    assert_eq!((rig.state(), rig.enabled(), rig.events.len()), (StartUp::Standing, 24, 2));
}

/// The drives of a silent node have stopped by themselves: told when they are heard again.
#[test]
fn a_fault_behind_a_silent_line_is_named_when_its_frames_come_back() {
    let mut rig = Rig::on(WEIGHT);
    rig.mute = Some(KNEE);
    rig.cycles(21);
    rig.fault = Some((KNEE, DriveFault::Heartbeat));
    rig.cycles(10);
    (rig.fault, rig.mute) = (None, None);
    assert_eq!(rig.loop_.state(), LoopState::Stop(EventCode::NodeSilent));
    let named = (EventCode::DriveTripped, Detail::Drive { joint: KNEE, error: 0x8130 });
    assert!(!rig.events.contains(&named), "nobody has said so yet: {:?}", rig.events);
    rig.cycles(50);
    assert_eq!(rig.events.iter().filter(|event| **event == named).count(), 1, "{:?}", rig.events);
    assert_eq!((rig.loop_.state(), rig.enabled()), (LoopState::Stop(EventCode::NodeSilent), 23));
    rig.again(false);
    assert_eq!((rig.loop_.state(), rig.enabled()), (LoopState::Stop(EventCode::DriveTripped), 23));
    rig.again(true);
    assert_eq!((rig.state(), rig.loop_.state(), rig.enabled()), (StartUp::Standing, LoopState::Track, 24));
}

/// Of each node that can be spared; only a robot that stands goes on.
#[test]
fn a_robot_that_stands_goes_on_without_a_drive_it_can_spare() {
    let mut rig = Rig::on(WEIGHT);
    rig.fault = Some((ARM, DriveFault::Heartbeat));
    rig.cycles(3);
    rig.fault = None;
    rig.cycles(300);
    let detail = Detail::Drive { joint: ARM, error: 0x8130 };
    assert_eq!(rig.events, [(EventCode::DriveHeld, detail)]);
    assert_eq!((rig.state(), rig.loop_.state(), rig.enabled()), (StartUp::Standing, LoopState::Track, 23));
    rig.again(false);
    assert_eq!(rig.loop_.state(), LoopState::Stop(EventCode::DriveTripped), "it does not begin so");
    rig.again(true);
    assert_eq!((rig.state(), rig.loop_.state(), rig.enabled()), (StartUp::Standing, LoopState::Track, 24));

    let mut hangs = Rig::on(0.0);
    hangs.fault = Some((ARM, DriveFault::Heartbeat));
    hangs.cycles(3);
    assert_eq!(hangs.loop_.state(), LoopState::Stop(EventCode::DriveTripped));
}

#[test]
fn a_drive_that_drops_out_or_does_not_come_is_named() {
    let mut rig = Rig::on(WEIGHT);
    rig.drives[KNEE] = cia402::DriveStateMachine::default(); // its controller started again
    rig.drives[KNEE].step(&DriveInputs::default());
    rig.cycles(4);
    assert_eq!(rig.events, [(EventCode::DriveNotEnabled, Detail::Joint(KNEE))]);
    assert_eq!(rig.loop_.state(), LoopState::Stop(EventCode::DriveNotEnabled));

    let mut dead = Rig::new(WEIGHT);
    dead.said.power = 1;
    for _ in 0..300 {
        dead.drives[KNEE] = cia402::DriveStateMachine::default();
        dead.cycle(None);
    }
    assert_eq!(
        (dead.events.clone(), dead.state()),
        (vec![(EventCode::DriveNotEnabled, Detail::Joint(5))], StartUp::Enabling)
    );
}

#[test]
fn a_joint_that_does_not_follow_is_told_to_stop_at_once() {
    let mut rig = Rig::on(WEIGHT);
    rig.creeps = Some(KNEE);
    while rig.events.is_empty() && rig.tick < 1000 {
        rig.cycle(None);
    }
    assert_eq!(rig.events, [(EventCode::FollowingError, Detail::Joint(KNEE))]);
    assert!(rig.drives.iter().all(|drive| drive.state() == cia402::DriveState::QuickStop));
}
