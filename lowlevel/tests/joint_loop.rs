//! The joint loop's transition table and its last word on every command, on Lola's limits.

use codec::frames::{DriveCommand, decode_targets, encode_sensors};
use config::{Robot, System};
use drives::cia402::{self, REFERENCED, status_of};
use lowlevel::JointLoop;
use lowlevel::joint_loop::LoopState;
use messages::{BusFrames, Detail, EventCode, JointMode, JointTargets, Sensors};
use proptest::prelude::*;

const DT: f64 = 1e-3;

struct Rig {
    robot: Robot,
    loop_: JointLoop,
    tick: u64,
    /// What the drives say: they follow what they were told, unless blocked.
    drives: Sensors,
    blocked: Vec<usize>,
    last: DriveCommand,
}

impl Rig {
    /// Powered and tracking at the pose `stand`.
    fn tracking() -> Self {
        let root = config::root(None);
        let robot = Robot::load(&root.join("robots/lola")).unwrap();
        let system = System::load(&root.join("system.toml")).unwrap();
        let mut drives = Sensors { power: 1, ..Sensors::default() };
        drives.drive_status.fill(u32::from(status_of(cia402::DriveState::OperationEnabled) | REFERENCED));
        for (j, q) in robot.poses["stand"].iter().enumerate() {
            drives.joint_angle[j] = *q;
        }
        let loop_ = JointLoop::new(&robot, &system, DT);
        let mut rig =
            Self { robot, loop_, tick: 0, drives, blocked: Vec::new(), last: DriveCommand::default() };
        for _ in 0..3 {
            let still = rig.still();
            rig.cycle(Some(&still));
        }
        assert_eq!(rig.loop_.state(), LoopState::Track);
        rig
    }

    /// Targets of the coming cycle that change nothing.
    fn still(&self) -> JointTargets {
        let mut t = JointTargets {
            mode: JointMode::Track as u64,
            angle: self.drives.joint_angle,
            ..JointTargets::default()
        };
        t.header.tick = self.tick + 1;
        t
    }

    /// One bus cycle; returns the watchdog's trip.
    fn cycle(&mut self, targets: Option<&JointTargets>) -> u64 {
        let mut answer = BusFrames::default();
        self.drives.header.tick = self.tick;
        encode_sensors(&self.robot.layout, &self.drives, &mut answer);
        self.tick += 1;
        self.cycle_with(Some(&answer), targets)
    }

    fn cycle_with(&mut self, answer: Option<&BusFrames>, targets: Option<&JointTargets>) -> u64 {
        self.loop_.receive(self.tick, self.tick * 1_000_000, answer);
        let (frames, reset) = self.loop_.send(targets, None);
        let trip = reset.trip;
        decode_targets(&self.robot.layout, frames, &mut self.last);
        for j in (0..self.robot.joints.len()).filter(|j| !self.blocked.contains(j)) {
            self.drives.joint_angle[j] = self.last.targets.angle[j];
            self.drives.joint_speed[j] = self.last.targets.speed[j];
        }
        trip
    }
}

#[test]
fn follows_targets_to_the_resolution_of_the_bus() {
    let mut rig = Rig::tracking();
    let mut wanted = rig.still();
    wanted.angle[5] += 0.0001;
    wanted.speed[5] = 0.2;
    rig.cycle(Some(&wanted));
    assert!((rig.last.targets.angle[5] - wanted.angle[5]).abs() < 2e-9);
    assert_eq!(rig.loop_.events().pop(), None);
}

#[test]
fn one_nan_in_any_joint_is_a_controlled_stop_that_names_it() {
    for j in 0..24 {
        let mut rig = Rig::tracking();
        let before = rig.last.targets.angle;
        let mut bad = rig.still();
        bad.speed[j] = f64::NAN;
        rig.cycle(Some(&bad));
        assert_eq!(rig.loop_.state(), LoopState::Stop(EventCode::TargetNotFinite));
        assert_eq!(rig.loop_.events().pop(), Some((EventCode::TargetNotFinite, Detail::Joint(j))));
        assert_eq!(rig.last.targets.angle, before);
    }
}

#[test]
fn silence_of_the_controller_is_carried_on_then_stopped_and_stays_stopped() {
    let mut rig = Rig::tracking();
    let mut moving = rig.still();
    for _ in 0..50 {
        moving = rig.still();
        for j in 0..24 {
            moving.speed[j] = 0.5;
            moving.angle[j] += 0.5 * DT;
        }
        rig.cycle(Some(&moving));
    }
    let mut cycles = 0;
    while rig.loop_.state() == LoopState::Track {
        rig.cycle(Some(&moving)); // the same old targets again
        cycles += 1;
        let carried_on = rig.last.targets.speed[5] > 0.49;
        assert_eq!(carried_on, rig.loop_.state() == LoopState::Track, "carried on at the last speed");
        assert!(cycles < 100);
    }
    assert_eq!(rig.loop_.state(), LoopState::Stop(EventCode::TargetsStale));
    assert_eq!(cycles, System::load(&config::root(None).join("system.toml")).unwrap().targets_missed + 1);
    for _ in 0..100 {
        rig.cycle(None);
    }
    assert!((0..24).all(|j| rig.last.targets.speed[j] == 0.0), "at rest");
    let still = rig.still();
    rig.cycle(Some(&still));
    assert_eq!(rig.loop_.state(), LoopState::Stop(EventCode::TargetsStale), "latched while the supply is on");
    rig.drives.power = 0;
    rig.cycle(None);
    rig.drives.power = 1;
    rig.cycle(None);
    let still = rig.still();
    rig.cycle(Some(&still));
    assert_eq!(rig.loop_.state(), LoopState::Track, "free again after the supply was off");
}

#[test]
fn a_blocked_joint_trips_the_supply() {
    let mut rig = Rig::tracking();
    rig.blocked = vec![5];
    let mut trip = 0;
    for _ in 0..200 {
        let mut t = rig.still();
        t.angle[5] = rig.last.targets.angle[5] + 1.0 * DT;
        t.speed[5] = 1.0;
        trip = rig.cycle(Some(&t));
        if trip != 0 {
            break;
        }
    }
    assert_eq!(trip, EventCode::FollowingError as u64);
    assert_eq!(rig.loop_.events().pop(), Some((EventCode::FollowingError, Detail::Joint(5))));
    // Regression: a watchdog that stood still then found nothing, for the joint follows again as soon as nothing leads it.
    rig.blocked.clear();
    for _ in 0..50 {
        let still = rig.still();
        assert_eq!(rig.cycle(Some(&still)), EventCode::FollowingError as u64, "until the supply is off");
    }
    rig.drives.power = 0;
    assert_eq!(rig.cycle(None), 0);
}

/// Two blocked joints, and a target that is NaN while they still do not follow: each is reported, and once.
#[test]
fn no_event_hides_another_one_of_its_cycle() {
    let mut rig = Rig::tracking();
    rig.blocked = vec![5, 11];
    let (mut events, mut after_trip) = (Vec::new(), 0);
    while after_trip < 5 {
        let mut t = rig.still();
        for j in [5, 11] {
            t.angle[j] = rig.last.targets.angle[j] + 1.0 * DT;
            t.speed[j] = 1.0;
        }
        if after_trip == 1 {
            t.angle[2] = f64::NAN;
        }
        after_trip += u32::from(rig.cycle(Some(&t)) != 0 || after_trip > 0);
        events.extend(rig.loop_.events().drain().filter(|(code, _)| *code != EventCode::TargetLimited));
    }
    let strayed = |j| (EventCode::FollowingError, Detail::Joint(j));
    let expected = [strayed(5), strayed(11), (EventCode::TargetNotFinite, Detail::Joint(2))];
    assert!(events.len() == 3 && expected.iter().all(|event| events.contains(event)), "{events:?}");
}

#[test]
fn a_silent_bus_is_a_controlled_stop() {
    let mut rig = Rig::tracking();
    for _ in 0..100 {
        rig.tick += 1;
        let mut t = rig.still();
        t.header.tick = rig.tick;
        rig.cycle_with(None, Some(&t));
    }
    assert_eq!(rig.loop_.state(), LoopState::Stop(EventCode::BusSilent));
}

/// A joint loop that was started while the supply was on took zero for the place of all joints, and drove there.
#[test]
fn a_loop_that_starts_with_power_begins_where_the_joints_are() {
    let rig = Rig::tracking();
    for (j, q) in rig.robot.poses["stand"].iter().enumerate() {
        assert!((rig.last.targets.angle[j] - q).abs() < 2e-9, "joint {j}");
    }
}

#[test]
fn without_power_the_targets_are_where_the_joints_are() {
    let mut rig = Rig::tracking();
    rig.drives.power = 0;
    let mut wild = rig.still();
    wild.angle[3] += 0.3;
    rig.cycle(Some(&wild));
    assert_eq!(rig.loop_.state(), LoopState::Off);
    assert!((rig.last.targets.angle[3] - rig.drives.joint_angle[3]).abs() < 2e-9);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// Whatever the targets: frames stay in range and below the speed limit, joint by joint, cycle by cycle.
    #[test]
    fn no_command_leaves_the_limits(seed in any::<u64>()) {
        let mut rig = Rig::tracking();
        let mut state = seed;
        let mut random = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        for _ in 0..30 {
            let mut t = rig.still();
            let before = rig.last.targets.angle;
            for j in 0..24 {
                t.angle[j] += random() * 0.05;
                t.speed[j] = random() * 30.0;
            }
            rig.cycle(Some(&t));
            for (j, joint) in rig.robot.joints.iter().enumerate() {
                let moved = (rig.last.targets.angle[j] - before[j]).abs();
                prop_assert!(moved <= joint.speed_limit * DT + 5e-9, "{} moved {moved} rad", joint.name);
                prop_assert!(rig.last.targets.angle[j] >= joint.range[0] - 5e-9 && rig.last.targets.angle[j] <= joint.range[1] + 5e-9);
            }
        }
    }
}
