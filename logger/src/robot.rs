//! A log of a configured robot.

use crate::kinematics::Kinematics;
use config::{Robot, Setup};
use ipc::Run;
use messages::MAX_JOINTS;
use multibody::ModelError;
use recording::{
    Composer, FootInfo, LinkPoses, RecordedPose, Recorder, RecordingError, RobotInfo, RunInfo, WallClock,
};
use std::path::Path;

/// Of a run what its configuration does not say.
#[derive(Clone, Debug, Default)]
pub struct Origin {
    /// Git commit of the software; empty: unknown.
    pub commit: String,
    /// Whether the robot is a simulated one.
    pub simulated: bool,
    /// Host and start time in real time; none in simulated time.
    pub clock: Option<WallClock>,
}

impl Origin {
    /// Of a run of this machine.
    pub fn of(run: &Run) -> Self {
        let host = || std::fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
        let clock = |[unix_ns, monotonic_ns]: [u64; 2]| WallClock {
            unix_ns,
            monotonic_ns,
            host: host().trim().into(),
        };
        Self { commit: run.commit.clone(), simulated: run.robot, clock: run.started.map(clock) }
    }
}

/// Robot of a log.
pub fn robot_info(robot: &Robot) -> RobotInfo {
    let foot = |foot: &config::robot::Foot| FootInfo {
        link: foot.link.clone(),
        sole: foot.sole,
        support: foot.support,
        sensor_link: foot.sensor_link.clone(),
        sensor: foot.sensor,
    };
    RobotInfo {
        name: robot.name.clone(),
        joints: robot.joints.iter().map(|j| j.name.clone()).collect(),
        urdf: robot.urdf.clone(),
        torso: robot.torso.clone(),
        imu: robot.imu,
        feet: [foot(&robot.feet[0]), foot(&robot.feet[1])],
        odom: [0.0; 3],
    }
}

/// Prefix of the configuration's files among the attachments of a log.
pub const CONFIG: &str = "config/";

/// Makes a log of a robot in a scene, with the poses of its links and the files of the configuration.
pub fn recorder(path: &Path, setup: &Setup, origin: &Origin) -> Result<Recorder, RecordingError> {
    let (robot, run, kinematics) = describe(setup, origin);
    let mut recorder = Recorder::create(path, &robot, &run)?;
    for (name, bytes) in setup.files.iter() {
        recorder.attach(&format!("{CONFIG}{name}"), bytes)?;
    }
    Ok(match kinematics {
        Some(kinematics) => recorder.with_links(Box::new(kinematics)),
        None => recorder,
    })
}

/// Maker of the messages that such a log holds, for viewers of the running robot.
pub fn composer(setup: &Setup, origin: &Origin) -> Composer {
    let (robot, run, kinematics) = describe(setup, origin);
    let composer = Composer::new(&robot, &run);
    match kinematics {
        Some(kinematics) => composer.with_links(Box::new(kinematics)),
        None => composer,
    }
}

/// Robot and run as a log describes them, and the kinematics of the links; none: there are no pictures of links.
fn describe(setup: &Setup, origin: &Origin) -> (RobotInfo, RunInfo, Option<Kinematics>) {
    let run = RunInfo {
        scene: setup.scene.name.clone(),
        config_hash: setup.hash,
        software: format!("gangwerk {}", env!("CARGO_PKG_VERSION")),
        commit: origin.commit.clone(),
        seed: setup.scene.seed,
        cycle_ns: (setup.scene.cycle * 1e9).round() as u64,
        clock: origin.clock.clone(),
    };
    let robot = &setup.robot;
    // A log is worth having without pictures of links.
    let warn = |error: &ModelError| tracing::warn!("messages without poses of links: {error}");
    let mut kinematics = Kinematics::new(robot).inspect_err(warn).ok();
    let mut info = robot_info(robot);
    if let (true, Some(kinematics)) = (origin.simulated, &mut kinematics) {
        info.odom = between_soles(kinematics, &info, &robot.poses[&setup.scene.start_pose]);
    }
    (info, run, kinematics)
}

/// \[m, m, rad\] Start of odometry: the middle of the soles, the torso being upright at the world's origin.
fn between_soles(kinematics: &mut Kinematics, info: &RobotInfo, pose: &[f64]) -> [f64; 3] {
    let mut angle = [0.0; MAX_JOINTS];
    angle[..pose.len()].copy_from_slice(pose);
    let mut links = vec![RecordedPose::IDENTITY; kinematics.links().len()];
    kinematics.poses(&RecordedPose::IDENTITY, &angle, &mut links);
    let sole = |foot: &FootInfo| {
        let at = kinematics.links().iter().position(|link| link.name == foot.link);
        at.map_or([0.0; 3], |at| links[at].place(foot.sole))
    };
    let [right, left] = [sole(&info.feet[0]), sole(&info.feet[1])];
    [0.5 * (right[0] + left[0]), 0.5 * (right[1] + left[1]), 0.0]
}
