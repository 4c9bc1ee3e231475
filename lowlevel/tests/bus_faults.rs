//! What the joint loop makes of a bus that loses, repeats, delays and bends frames. On Lola's limits and layout.

use codec::frames::{DriveCommand, decode_targets, encode_sensors};
use codec::layout::Carries;
use config::bus_fault::{BusFault, FaultKind, FrameDirection};
use config::{Robot, System};
use drives::cia402::{self, REFERENCED, status_of};
use fieldbus::{ErrorFrame, ErrorState, Injector};
use lowlevel::JointLoop;
use lowlevel::joint_loop::LoopState;
use messages::{BusFrames, Detail, EventCode, Frame, JointMode, JointTargets, Sensors};
use proptest::prelude::*;

#[global_allocator]
static ALLOCATOR: realtime::CountingAllocator = realtime::CountingAllocator;

const DT: f64 = 1e-3;
/// A joint of the left shank, and of an arm.
const KNEE: &str = "left_knee_flexion";
const ARM: &str = "left_shoulder_flexion";

struct Rig {
    robot: Robot,
    system: System,
    loop_: JointLoop,
    tick: u64,
    /// What the drives say: they follow what they were told.
    drives: Sensors,
    /// What lowlevel believes.
    seen: Sensors,
    trip: u64,
    events: Vec<(EventCode, Detail)>,
}

impl Rig {
    /// Powered and tracking at the pose `stand`, every joint moving slowly.
    fn moving() -> Self {
        let root = config::root(None);
        let robot = Robot::load(&root.join("robots/lola")).unwrap();
        let system = System::load(&root.join("system.toml")).unwrap();
        let mut drives = Sensors { power: 1, ..Sensors::default() };
        drives.drive_status.fill(u32::from(status_of(cia402::DriveState::OperationEnabled) | REFERENCED));
        for (j, q) in robot.poses["stand"].iter().enumerate() {
            (drives.joint_angle[j], drives.motor_angle[j]) = (*q, *q);
        }
        drives.imu.orientation = [0.0, 0.0, 0.0, 1.0];
        let loop_ = JointLoop::new(&robot, &system, DT);
        let (seen, events) = (Sensors::default(), Vec::new());
        let mut rig = Self { robot, system, loop_, tick: 0, drives, seen, trip: 0, events };
        for _ in 0..200 {
            let answer = rig.answer();
            rig.cycle(Some(&answer));
        }
        assert_eq!(rig.loop_.state(), LoopState::Track);
        rig.events.clear();
        rig
    }

    /// What the drives say of the last cycle.
    fn answer(&mut self) -> BusFrames {
        let mut frames = BusFrames::default();
        self.drives.header.tick = self.tick;
        encode_sensors(&self.robot.layout, &self.drives, &mut frames);
        frames
    }

    /// One cycle in which this comes from the drives; targets move all joints slowly to and fro.
    fn cycle(&mut self, answer: Option<&BusFrames>) -> BusFrames {
        self.tick += 1;
        self.seen = *self.loop_.receive(self.tick, self.tick * 1_000_000, answer);
        let mut targets = JointTargets { mode: JointMode::Track as u64, ..JointTargets::default() };
        targets.header.tick = self.tick;
        let t = self.tick as f64 * DT;
        for (j, q) in self.robot.poses["stand"].iter().enumerate() {
            (targets.angle[j], targets.speed[j]) = (q + 0.01 * (3.0 * t).sin(), 0.03 * (3.0 * t).cos());
        }
        let (frames, reset) = self.loop_.send(Some(&targets), None);
        self.trip = reset.trip;
        let mut told = DriveCommand::default();
        decode_targets(&self.robot.layout, frames, &mut told);
        let frames = *frames;
        for j in 0..self.robot.joints.len() {
            (self.drives.joint_angle[j], self.drives.joint_speed[j]) =
                (told.targets.angle[j], told.targets.speed[j]);
            (self.drives.motor_angle[j], self.drives.motor_speed[j]) =
                (told.targets.angle[j], told.targets.speed[j]);
        }
        self.events.extend(self.loop_.events().drain());
        frames
    }

    fn joint(&self, name: &str) -> usize {
        self.robot.joints.iter().position(|j| j.name == name).unwrap()
    }

    /// The line of the local controller that reads a joint.
    fn line(&self, name: &str) -> u32 {
        let j = self.joint(name);
        let reads = |m: &&codec::layout::BusMessage| m.signals.iter().any(|s| s.carries == Carries::Angle(j));
        self.robot.layout.sent(false).find(reads).unwrap().node as u32
    }

    /// A cycle without the frames of a line.
    fn cycle_without(&mut self, line: u32) -> BusFrames {
        let answer = self.answer();
        let rest = only(&answer, |f| f.line != line);
        self.cycle(Some(&rest))
    }

    fn has(&self, code: EventCode) -> bool {
        self.events.iter().any(|(c, _)| *c == code)
    }
}

fn only(frames: &BusFrames, keep: impl Fn(&Frame) -> bool) -> BusFrames {
    let mut rest = BusFrames { header: frames.header, ..BusFrames::default() };
    for frame in frames.as_slice().iter().filter(|f| keep(f)) {
        rest.push(frame);
    }
    rest
}

fn error_frame(line: u32, said: ErrorFrame) -> Frame {
    let (id, data) = said.encode();
    let mut frame = Frame { line, id, len: 8, ..Frame::default() };
    frame.data[..8].copy_from_slice(&data);
    frame
}

/// Sensors but for their header and counters, bit by bit.
fn readings(s: &Sensors) -> Vec<u64> {
    let joints = [&s.joint_angle, &s.joint_speed, &s.motor_angle, &s.motor_speed].into_iter().flatten();
    let feet = s.foot_wrench.iter().flat_map(|w| w.force.iter().chain(&w.moment));
    let imu = s.imu.orientation.iter().chain(&s.imu.angular_velocity).chain(&s.imu.acceleration);
    joints.chain(feet).chain(imu).map(|x| x.to_bits()).collect()
}

#[test]
fn a_silent_node_is_carried_on_within_bounds_then_held_then_a_stop_that_names_it() {
    let mut rig = Rig::moving();
    let (line, j, other) = (rig.line(KNEE), rig.joint(KNEE), rig.joint("right_knee_flexion"));
    let (k, n) = (rig.system.bus.carried_on, rig.system.bus.missed);
    let (start, speed) = (rig.seen.joint_angle[j], rig.seen.joint_speed[j]);
    assert!(speed > 0.02, "it moves");
    for cycle in 1..=n {
        rig.cycle_without(line);
        let moved = rig.seen.joint_angle[j] - start;
        assert!((moved - f64::from(cycle.min(k)) * speed * DT).abs() < 1e-12, "cycle {cycle}: {moved}");
        assert_eq!(rig.seen.joint_speed[j] == 0.0, cycle > k);
        assert!(rig.seen.joint_speed[other] > 0.02, "the others are read");
        assert_eq!(rig.loop_.state(), LoopState::Track, "cycle {cycle}");
    }
    rig.cycle_without(line);
    assert_eq!(rig.loop_.state(), LoopState::Stop(EventCode::NodeSilent));
    let detail = |cycles: u32| Detail::NodeCycles(line as usize, cycles);
    assert!(rig.events.contains(&(EventCode::FramesLost, Detail::Node(line as usize))), "{:?}", rig.events);
    assert!(rig.events.contains(&(EventCode::NodeHeld, detail(k + 1))), "{:?}", rig.events);
    assert!(rig.events.contains(&(EventCode::NodeSilent, detail(n + 1))), "{:?}", rig.events);
    assert_eq!(rig.trip, 0, "the supply holds the joints");
    let lost = rig.loop_.bus_counters().lost;
    assert_eq!(lost % u64::from(n + 1), 0);
    assert!(lost >= u64::from(n + 1));
}

#[test]
fn a_node_that_comes_back_in_time_is_told_and_nobody_stops() {
    let mut rig = Rig::moving();
    let line = rig.line(KNEE);
    for _ in 0..rig.system.bus.missed {
        rig.cycle_without(line);
    }
    let (answer, place) = (rig.answer(), rig.drives.joint_angle[rig.joint(KNEE)]);
    rig.cycle(Some(&answer));
    assert_eq!(rig.loop_.state(), LoopState::Track);
    let back = (EventCode::NodeBack, Detail::NodeCycles(line as usize, rig.system.bus.missed));
    assert!(rig.events.contains(&back), "{:?}", rig.events);
    assert!((rig.seen.joint_angle[rig.joint(KNEE)] - place).abs() < 2e-9, "read again");
}

#[test]
fn the_robot_walks_on_without_a_node_it_can_spare() {
    let mut rig = Rig::moving();
    let line = rig.line(ARM);
    for _ in 0..100 {
        rig.cycle_without(line);
    }
    assert_eq!(rig.loop_.state(), LoopState::Track);
    assert!(rig.has(EventCode::NodeHeld) && !rig.has(EventCode::NodeSilent), "{:?}", rig.events);
}

#[test]
fn a_bus_without_any_frame_is_silent() {
    let mut rig = Rig::moving();
    for _ in 0..=rig.system.bus.missed {
        rig.cycle(None);
    }
    assert_eq!(rig.loop_.state(), LoopState::Stop(EventCode::BusSilent));
}

#[test]
fn a_line_off_the_bus_is_no_power_and_only_the_way_over_power_off_leads_back() {
    let mut rig = Rig::moving();
    let line = rig.line(KNEE);
    let off = error_frame(line, ErrorFrame { state: Some(ErrorState::Off), ..ErrorFrame::default() });
    let mut answer = rig.answer();
    answer.push(&off);
    rig.cycle(Some(&answer));
    assert_eq!((rig.loop_.state(), rig.trip), (LoopState::Stop(EventCode::BusOff), EventCode::BusOff as u64));
    assert!(rig.events.contains(&(EventCode::BusOff, Detail::Number(line.into()))), "{:?}", rig.events);
    for _ in 0..50 {
        let answer = rig.answer();
        rig.cycle(Some(&answer));
        assert_eq!(rig.trip, EventCode::BusOff as u64, "frames alone do not bring it back under power");
    }
    rig.drives.power = 0;
    let answer = rig.answer();
    rig.cycle(Some(&answer));
    assert_eq!(
        (rig.loop_.state(), rig.trip),
        (LoopState::Off, 0),
        "the watchdog's reset edge is let through"
    );
    rig.drives.power = 1;
    for _ in 0..3 {
        let answer = rig.answer();
        rig.cycle(Some(&answer));
    }
    assert_eq!((rig.loop_.state(), rig.trip), (LoopState::Track, 0));
    assert!(rig.has(EventCode::BusActive));
    let counters = rig.loop_.bus_counters();
    assert_eq!((counters.bus_off, counters.error_frames), (1, 1));
}

#[test]
fn warnings_are_told_once_and_change_nothing() {
    let mut rig = Rig::moving();
    for state in [ErrorState::Warning, ErrorState::Warning, ErrorState::Passive, ErrorState::Active] {
        let mut answer = rig.answer();
        answer.push(&error_frame(2, ErrorFrame { state: Some(state), ..ErrorFrame::default() }));
        rig.cycle(Some(&answer));
    }
    assert_eq!(
        rig.events,
        [
            (EventCode::BusWarning, Detail::Number(2)),
            (EventCode::BusPassive, Detail::Number(2)),
            (EventCode::BusActive, Detail::Number(2))
        ]
    );
    assert_eq!(rig.loop_.state(), LoopState::Track);
    assert_eq!(rig.loop_.bus_counters().error_frames, 4);
}

/// One node's frame says that the supply is off, eight say that it is on; and the other way round.
#[test]
fn one_bent_bit_neither_switches_off_nor_on() {
    for power in [1, 0] {
        let mut rig = Rig::moving();
        rig.drives.power = power;
        let answer = rig.answer();
        rig.cycle(Some(&answer));
        let bent = Sensors { power: 1 - power, ..rig.drives };
        let (mut answer, mut wrong) = (rig.answer(), BusFrames::default());
        let wrong_header = messages::Header { tick: rig.tick, ..bent.header };
        encode_sensors(&rig.robot.layout, &Sensors { header: wrong_header, ..bent }, &mut wrong);
        let last = (0..answer.count as usize)
            .rev()
            .find(|&i| answer.frames[i].data != wrong.frames[i].data)
            .expect("some node tells of the supply");
        answer.frames[last] = wrong.frames[last];
        rig.cycle(Some(&answer));
        assert_eq!(rig.seen.power, power);
    }
}

#[test]
fn a_drive_that_says_once_that_it_is_not_enabled_is_not_believed() {
    let mut rig = Rig::moving();
    let j = rig.joint(KNEE);
    let mut says = |status: u32| {
        rig.drives.drive_status[j] = status | u32::from(REFERENCED);
        let answer = rig.answer();
        rig.cycle(Some(&answer));
        rig.seen.drive_status[j] & !u32::from(REFERENCED)
    };
    let seen = [0x237, 0x237, 0x233, 0x237, 0x208, 0x208, 0x208, 0x237].map(&mut says);
    assert_eq!(seen, [0x237, 0x237, 0x237, 0x237, 0x237, 0x208, 0x208, 0x237]);
}

/// A joint that finds out where it is reads another angle at once. A bent bit that says so opens no door to its neighbours.
#[test]
fn a_joint_that_finds_its_reference_is_believed_the_second_time() {
    let mut rig = Rig::moving();
    let (j, neighbour) = (rig.joint(KNEE), rig.joint("left_ankle_adduction"));
    assert_eq!(rig.line(KNEE), rig.line("left_ankle_adduction"));
    let mut says = |referenced: bool, off: [f64; 2]| {
        rig.drives.drive_status[j] &= !u32::from(REFERENCED);
        rig.drives.drive_status[j] |= u32::from(if referenced { REFERENCED } else { 0 });
        let place = [rig.drives.joint_angle[j], rig.drives.joint_angle[neighbour]];
        rig.drives.joint_angle[j] += off[0];
        rig.drives.joint_angle[neighbour] += off[1];
        let answer = rig.answer();
        rig.cycle(Some(&answer));
        [rig.seen.joint_angle[j] - place[0], rig.seen.joint_angle[neighbour] - place[1]]
            .map(|x| (x * 10.0).round() / 10.0)
    };
    assert_eq!(says(false, [0.0, 0.0]), [0.0, 0.0], "bent for one cycle");
    assert_eq!(says(true, [0.0, 1.0]), [0.0, 0.0], "and back, while the neighbour lies");
    assert_eq!(says(false, [0.7, 0.0]), [0.0, 0.0]);
    assert_eq!(says(false, [0.7, 1.0]), [0.0, 0.0], "the neighbour's lie holds the whole node");
    assert_eq!(says(true, [0.0, 0.0]), [0.0, 0.0]);
    assert_eq!(says(false, [0.7, 0.0]), [0.0, 0.0]);
    assert_eq!(says(false, [0.7, 0.0]), [0.7, 0.0], "said twice");
}

/// Regression: landings on hard soles, as MuJoCo has them at 3 and 5 km/h, were refused as bent. What a landing changes
/// comes together; what a bent bit changes comes alone, in whichever component.
#[test]
fn a_hard_landing_is_a_reading_and_a_bent_force_is_none() {
    // [N, N m] The readings of the cycle of touchdown, from zeros.
    let landings = [[29.4, 145.8, 1302.9, -44.8, 47.4, -9.7], [-1459.0, -351.9, 2124.6, 35.5, -306.8, -22.8]];
    let land = |rig: &mut Rig, [fx, fy, fz, mx, my, mz]: [f64; 6]| {
        (rig.drives.foot_wrench[0].force, rig.drives.foot_wrench[0].moment) = ([fx, fy, fz], [mx, my, mz]);
        let answer = rig.answer();
        rig.cycle(Some(&answer));
        !rig.has(EventCode::FrameRefused)
    };
    for landing in landings {
        let mut rig = Rig::moving();
        assert!(land(&mut rig, landing) && land(&mut rig, [0.0; 6]), "{landing:?}: {:?}", rig.events);
    }
    // The bits of 1024 N and 256 N m, while standing, when the rest plays by some newtons.
    let standing = [10.0, -5.0, 300.0, 2.0, 8.0, 0.5];
    for (component, bit) in [(0, 1024.0), (1, 1024.0), (2, 1024.0), (3, 256.0), (4, 256.0), (5, 256.0)] {
        let mut rig = Rig::moving();
        assert!(land(&mut rig, standing));
        let mut bent = standing.map(|x| x + 0.01 * x);
        bent[component] += bit;
        assert!(!land(&mut rig, bent), "component {component} bent by {bit}");
    }
    // A frame of rubbish: everything changes, by more than any landing.
    let mut rig = Rig::moving();
    assert!(!land(&mut rig, [5000.0, -9000.0, 20_000.0, 700.0, -900.0, 2000.0]));
}

#[test]
fn nothing_is_allocated_while_the_bus_fails() {
    let mut rig = Rig::moving();
    let answers: Vec<BusFrames> = (0..60)
        .map(|i| {
            rig.tick += 1;
            let whole = rig.answer();
            rig.tick -= 1;
            rig.cycle(Some(&whole));
            let mut part = only(&whole, |f| f.line as usize != i % 9);
            part.push(&error_frame(
                1,
                ErrorFrame { state: Some(ErrorState::Warning), ..ErrorFrame::default() },
            ));
            part
        })
        .collect();
    let tick = rig.tick;
    realtime::allocations::arm();
    for (i, answer) in answers.iter().enumerate() {
        rig.loop_.receive(tick + 1 + i as u64, 0, Some(answer));
        rig.loop_.send(None, None);
        rig.loop_.events().drain().for_each(drop);
    }
    realtime::allocations::disarm();
    assert_eq!(realtime::allocations::counted(), [0, 0]);
}

/// Sent frames of two runs, and what was read: one with a fault, one in which the frames it touched are simply absent.
fn both(kind: FaultKind, share: f64, cycles: u32, seed: u64) -> Result<(), TestCaseError> {
    let (mut with, mut without) = (Rig::moving(), Rig::moving());
    let fault = BusFault {
        share,
        cycles,
        way: Some(FrameDirection::FromDrives),
        ..BusFault::new(kind, 0.0, f64::INFINITY)
    };
    let mut injector = Injector::new(&[fault], &with.robot.layout, DT, seed).unwrap().unwrap();
    for _ in 0..60 {
        let whole = with.answer();
        without.answer();
        let came = *injector.pass(FrameDirection::FromDrives, &whole);
        // Of what came, the whole frames of this cycle, each once.
        let same =
            |a: &Frame, b: &Frame| a.line == b.line && a.id == b.id && a.len == b.len && a.data == b.data;
        let arrived = only(&whole, |f| came.as_slice().iter().any(|c| same(c, f)));
        let frames = with.cycle(Some(&came));
        let wanted = without.cycle(Some(&arrived));
        prop_assert_eq!(readings(&with.seen), readings(&without.seen));
        prop_assert!(frames.as_slice().iter().zip(wanted.as_slice()).all(|(a, b)| same(a, b)));
        prop_assert_eq!(frames.count, wanted.count);
        prop_assert_eq!(with.loop_.state(), without.loop_.state());
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Late, repeated and reordered frames: as if they had never come.
    #[test]
    fn late_and_repeated_frames_are_as_good_as_absent(seed in any::<u64>(), cycles in 1..20u32, share in 0.0..0.5f64) {
        both(FaultKind::Late, share, cycles, seed)?;
        both(FaultKind::Duplicated, share, cycles, seed)?;
        both(FaultKind::Duplicated, share, 0, seed)?;
        both(FaultKind::Reordered, share, 0, seed)?;
    }

    /// Whatever bit is bent without being noticed: no angle is believed that is further off than the bound of a jump, no
    /// force beyond its own, and the counter tells.
    #[test]
    fn a_bent_bit_is_refused_or_harmless(seed in any::<u64>()) {
        let mut rig = Rig::moving();
        let fault = BusFault { share: 0.05, way: Some(FrameDirection::FromDrives), ..BusFault::new(FaultKind::Flipped, 0.0, f64::INFINITY) };
        let mut injector = Injector::new(&[fault], &rig.robot.layout, DT, seed).unwrap().unwrap();
        let weight = rig.robot.total_mass * 9.80665;
        for _ in 0..60 {
            let truth = rig.drives;
            let whole = rig.answer();
            let came = *injector.pass(FrameDirection::FromDrives, &whole);
            rig.cycle(Some(&came));
            // Two cycles of allowance: a node refused once may jump twice as far.
            for (j, joint) in rig.robot.joints.iter().enumerate() {
                let most = 2.0 * (rig.system.bus.jump + 3.0 * rig.system.bus.jump_speed * joint.speed_limit * DT);
                prop_assert!((rig.seen.joint_angle[j] - truth.joint_angle[j]).abs() <= most, "{}", joint.name);
            }
            for foot in rig.seen.foot_wrench {
                prop_assert!(foot.force.iter().all(|f| f.abs() <= 6.0 * rig.system.bus.jump_force * weight));
            }
            let norm: f64 = rig.seen.imu.orientation.iter().map(|q| q * q).sum();
            prop_assert!((norm - 1.0).abs() < 0.15, "{norm}");
        }
        let c = rig.loop_.bus_counters();
        prop_assert!(injector.injected().flipped == 0 || c.refused + c.late + c.lost > 0 || injector.injected().flipped < 8);
    }
}
