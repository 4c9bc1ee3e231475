//! A walk made of sines, for the tests of the figures: nothing here is dynamics.

use messages::record::Wrench;
use messages::topics::{CONTROLLER_STATE, SENSORS, SIM_STATE};
use messages::{ControllerState, GaitState, Header, Joints, Sensors, SimState};
use recording::{FootInfo, LinkFrame, LinkPoses, RecordedPose, Recorder, RobotInfo, RunInfo};
use std::path::Path;

const STEP: f64 = 0.8;
const LENGTH: f64 = 0.4;
const HALF_WIDTH: f64 = 0.13;
const WEIGHT: f64 = 550.0;
const DURATION: f64 = 9.0;

/// Name, parent.
const LINKS: [(&str, Option<usize>); 10] = [
    ("torso", None),
    ("right_thigh", Some(0)),
    ("right_shank", Some(1)),
    ("right_foot", Some(2)),
    ("left_thigh", Some(0)),
    ("left_shank", Some(4)),
    ("left_foot", Some(5)),
    ("head", Some(0)),
    ("right_arm", Some(0)),
    ("left_arm", Some(0)),
];

/// Poses of all bodies at a time.
struct Pace {
    com: [f64; 3],
    zmp: [f64; 2],
    feet: [[f64; 4]; 2],
    /// Share of the left foot.
    load: f64,
}

fn pace(t: f64) -> Pace {
    let walked = (t - 1.0).clamp(0.0, DURATION - 2.5);
    let step = (walked / STEP).floor();
    let phase = walked / STEP - step;
    let left_swings = step % 2.0 == 0.0;
    let blend = |a: f64| a * a * (3.0 - 2.0 * a);
    let lift = ((phase - 0.2) / 0.8).clamp(0.0, 1.0);
    let standing = walked == 0.0 || t > DURATION - 1.5;
    let mut feet = [[0.0, -HALF_WIDTH, 0.0, 0.0], [0.0, HALF_WIDTH, 0.0, 0.0]];
    for (i, foot) in feet.iter_mut().enumerate() {
        let swings = (i == 1) == left_swings && !standing;
        foot[0] = LENGTH * (step + if swings { 2.0 * blend(lift) - 1.0 } else { 0.0 });
        foot[2] = if swings { 0.06 * (std::f64::consts::PI * lift).sin() } else { 0.0 };
    }
    let target = if standing {
        0.5
    } else if left_swings {
        0.0
    } else {
        1.0
    };
    let load = if standing || phase > 0.2 {
        target
    } else {
        (1.0 - target) * (1.0 - phase / 0.2) + target * phase / 0.2
    };
    let y = HALF_WIDTH * (2.0 * load - 1.0);
    let sway = if standing {
        0.0
    } else {
        -0.06 * (std::f64::consts::PI * phase).sin() * if left_swings { 1.0 } else { -1.0 }
    };
    let x = LENGTH * walked / STEP;
    Pace { com: [x, sway, 0.88 + 0.005 * (15.7 * t).sin()], zmp: [x, 0.9 * y], feet, load }
}

/// Behind the joints: soles in the torso frame \[m\], right and left.
const SOLES: usize = 8;

/// Two-link legs by the law of cosines.
struct Sticks(Vec<LinkFrame>);
impl LinkPoses for Sticks {
    fn links(&self) -> &[LinkFrame] {
        &self.0
    }
    fn poses(&mut self, torso: &RecordedPose, joint_angle: &Joints, out: &mut [RecordedPose]) {
        out[0] = *torso;
        for (foot, thigh) in [(0, 1), (1, 4)] {
            let sole = torso.place(std::array::from_fn(|k| joint_angle[SOLES + 3 * foot + k]));
            let hip = torso.place([0.0, sole[1], -0.1]);
            let ankle = [sole[0], sole[1], sole[2] + 0.1];
            let (dx, dz) = (ankle[0] - hip[0], ankle[2] - hip[2]);
            let length = dx.hypot(dz).min(0.87);
            let bend = (0.44f64.powi(2) - (length / 2.0).powi(2)).max(0.0).sqrt();
            let knee = [
                (hip[0] + ankle[0]) / 2.0 - dz / length * bend,
                sole[1],
                (hip[2] + ankle[2]) / 2.0 + dx / length * bend,
            ];
            out[thigh] = RecordedPose::moved(hip);
            out[thigh + 1] = RecordedPose::moved(knee);
            out[thigh + 2] = RecordedPose::moved(ankle);
        }
        out[7] = torso.then(&RecordedPose::moved([0.0, 0.0, 0.55]));
        out[8] = torso.then(&RecordedPose::moved([0.05, -0.25, 0.1]));
        out[9] = torso.then(&RecordedPose::moved([0.05, 0.25, 0.1]));
    }
}

/// Optional parts of a log.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum LogPart {
    Links,
    Truth,
    Sensors,
    Tracking,
    Margin,
    Inclination,
}

/// Writes the walk without some parts.
pub(super) fn write(path: &Path, without: &[LogPart]) {
    let with = |part: LogPart| !without.contains(&part);
    let foot = |side: &str| FootInfo {
        link: format!("{side}_foot"),
        sole: [0.0, 0.0, -0.1],
        support: [-0.1, 0.2, -0.06, 0.06],
        sensor_link: format!("{side}_foot"),
        sensor: [0.0; 3],
    };
    let joints = ["hip_flexion", "knee_flexion", "ankle_flexion", "toe_flexion"];
    let robot = RobotInfo {
        name: "sticks".into(),
        joints: ["right", "left"].iter().flat_map(|s| joints.map(|j| format!("{s}_{j}"))).collect(),
        urdf: "<robot name=\"sticks\"/>".into(),
        torso: "torso".into(),
        imu: [0.0; 3],
        feet: [foot("right"), foot("left")],
        odom: [0.0; 3],
    };
    let run =
        RunInfo { scene: "synthetic".into(), config_hash: 1, software: "0.1.0".into(), ..RunInfo::default() };
    let mut recorder = Recorder::create(path, &robot, &run).expect("log");
    if with(LogPart::Links) {
        let tree = LINKS
            .iter()
            .map(|(name, parent)| LinkFrame { name: (*name).into(), parent: *parent, fixed: false })
            .collect();
        recorder = recorder.with_links(Box::new(Sticks(tree)));
    }
    for tick in 0..(DURATION * 1000.0) as u64 {
        let t = tick as f64 * 1e-3;
        let header = Header { tick, stamp_ns: tick * 1_000_000, epoch: 1 };
        let (sensors, mut controller, state) = records(header, t);
        if !with(LogPart::Tracking) {
            controller.tracking_error = Default::default();
        }
        if !with(LogPart::Margin) {
            controller.zmp_margin = f64::NAN;
        }
        if !with(LogPart::Inclination) {
            controller.inclination_error = [f64::NAN; 2];
        }
        recorder.write(&CONTROLLER_STATE, &controller).expect("log");
        if with(LogPart::Sensors) {
            recorder.write(&SENSORS, &sensors).expect("log");
        }
        if with(LogPart::Truth) {
            recorder.write(&SIM_STATE, &state).expect("log");
        }
    }
    recorder.finish().expect("log");
}

fn records(header: Header, t: f64) -> (Sensors, ControllerState, SimState) {
    let pace = pace(t);
    let wobble = |k: f64| 0.004 * (7.85 * t + k).sin() + 0.0015 * (31.0 * t + 2.0 * k).sin();
    let share = [1.0 - pace.load, pace.load];
    let mut sensors = Sensors { header, ..Sensors::default() };
    let mut controller = ControllerState {
        header,
        plan_id: 1,
        gait: if t < 1.0 { GaitState::Standing } else { GaitState::Walking } as u64,
        com: [pace.com[0], pace.com[1] + wobble(1.0), pace.com[2] + wobble(0.3) / 4.0],
        com_desired: pace.com,
        feet: pace.feet,
        inclination_error: [2.0 * wobble(0.0), 1.5 * wobble(0.7)],
        zmp_desired: pace.zmp,
        zmp: [pace.zmp[0] + 3.0 * wobble(0.2), pace.zmp[1] + 2.0 * wobble(1.3)],
        zmp_margin: 0.02 + wobble(0.0),
        ..ControllerState::default()
    };
    for foot in 0..2 {
        let desired = WEIGHT * share[foot];
        controller.wrench_desired[foot] = Wrench { force: [0.0, 0.0, desired], moment: [0.0; 3] };
        sensors.foot_wrench[foot].force[2] = desired * (1.0 + 12.0 * wobble(foot as f64));
    }
    for joint in 0..8 {
        controller.tracking_error[joint] = 0.3 * wobble(joint as f64);
        sensors.joint_angle[joint] = 20.0 * wobble(joint as f64);
    }
    let torso = RecordedPose {
        position: [pace.com[0] - 0.02, pace.com[1], 1.0],
        orientation: [0.0, 0.02, 0.0, 0.02f64.mul_add(-0.02, 1.0).sqrt()],
    };
    sensors.imu.orientation = torso.orientation;
    for (foot, [x, y, z, _]) in pace.feet.into_iter().enumerate() {
        let sole = RecordedPose::moved([x, y, z]).seen_from(&torso).position;
        sensors.joint_angle[SOLES + 3 * foot..][..3].copy_from_slice(&sole);
    }
    let state = SimState {
        header,
        time: t,
        position: torso.position,
        orientation: torso.orientation,
        joint_angle: sensors.joint_angle,
        com: pace.com,
        foot_wrench: share.map(|s| Wrench { force: [0.0, 0.0, WEIGHT * s], moment: [0.0; 3] }),
        feet: pace.feet,
        ..SimState::default()
    };
    (sensors, controller, state)
}
