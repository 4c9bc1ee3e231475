//! A robot that is small enough: two joints it needs, of which the second one may not know its angle, at one local
//! controller; one joint it can spare, at another one.

use codec::layout::{BusMessage, BusSignal, Carries, FrameLayout};
use config::{Robot, System};

/// Joints; the last one is spare.
pub(crate) const JOINTS: usize = 3;
/// Joints that the robot cannot stand without.
pub(crate) const NEEDED: usize = 2;
/// Local controller of each joint.
pub(crate) const NODE: [usize; JOINTS] = [0, 0, 1];
/// \[s\] Long enough for everything that dies out to do so in one cycle.
pub(crate) const DT: f64 = 0.5;
/// \[N\] Weight.
pub(crate) const WEIGHT: f64 = 60.885 * 9.81;
/// Cycles without frames of a node, and without new targets, that are borne.
pub(crate) const MISSED: u32 = 1;

fn message(id: u32, node: usize, to_drives: bool, numbers: &[(Carries, u32, f64)]) -> BusMessage {
    let mut start = 0;
    let signals = numbers.iter().map(|&(carries, bits, scale)| {
        let signed = scale < 1.0;
        let signal = BusSignal { name: String::new(), start, bits, signed, scale, offset: 0.0, carries };
        start += bits;
        signal
    });
    let signals: Vec<BusSignal> = signals.collect();
    BusMessage { name: String::new(), id, len: start.div_ceil(8), node, to_drives, cyclic: true, signals }
}

fn layout() -> FrameLayout {
    let mut messages = Vec::new();
    for node in 0..2 {
        let joints = (0..JOINTS).filter(|j| NODE[*j] == node);
        let mut says = vec![(Carries::Counter, 8, 1.0), (Carries::Supply, 1, 1.0)];
        let mut hears = vec![(Carries::Counter, 8, 1.0), (Carries::Mode, 4, 1.0)];
        for j in joints {
            says.extend([(Carries::Status(j), 16, 1.0), (Carries::Angle(j), 32, 1e-6)]);
            says.push((Carries::Error(j), 16, 1.0));
            hears.extend([(Carries::Control(j), 16, 1.0), (Carries::Target(j), 32, 1e-6)]);
        }
        if node == 0 {
            says.extend([0, 1].map(|foot| (Carries::Force(foot, 2), 32, 1e-3)));
            says.extend([0, 1].map(|foot| (Carries::Force(foot, 0), 8, 1e-3)));
        }
        messages.push(message(0x10, node, true, &hears));
        messages.push(message(0x20, node, false, &says));
    }
    FrameLayout::new(vec![String::new(); 2], messages)
}

/// Lola with all but three joints taken away; the system with short times.
pub(crate) fn small() -> (Robot, System) {
    let root = config::root(None);
    let mut robot = Robot::load(&root.join("robots/lola")).unwrap();
    let mut system = System::load(&root.join("system.toml")).unwrap();
    robot.joints.truncate(JOINTS);
    for joint in &mut robot.joints {
        (joint.range, joint.acceleration) = ([-2.0, 2.0], f64::INFINITY);
    }
    robot.urdf.clear();
    robot.poses.clear();
    robot.drives.clear();
    robot.homes.clear();
    robot.can.nodes.clear();
    (robot.head, robot.arms, robot.protection) = (None, None, None);
    robot.classic = Err(String::new());
    (robot.layout, robot.spare) = (layout(), vec![1]);
    (system.bus.carried_on, system.bus.missed, system.targets_missed) = (0, MISSED, MISSED);
    system.processes.clear();
    (robot, system)
}
