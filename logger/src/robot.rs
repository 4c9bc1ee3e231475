//! A log of a configured robot.

use crate::kinematics::Kinematics;
use config::{Robot, Setup};
use recording::{FootInfo, Recorder, RecordingError, RobotInfo, RunInfo};
use std::path::Path;

/// What a log says about a robot.
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
    }
}

/// Where the files of the configuration are among the attachments of a log.
pub const CONFIG: &str = "config/";

/// Makes a log of a robot in a scene, with the poses of its links and the files of the configuration.
pub fn recorder(path: &Path, setup: &Setup) -> Result<Recorder, RecordingError> {
    let run = RunInfo {
        scene: setup.scene.name.clone(),
        config_hash: setup.hash,
        software: format!("gangwerk {}", env!("CARGO_PKG_VERSION")),
    };
    let robot = &setup.robot;
    let mut recorder = Recorder::create(path, &robot_info(robot), &run)?;
    for (name, bytes) in setup.files.iter() {
        recorder.attach(&format!("{CONFIG}{name}"), bytes)?;
    }
    match Kinematics::new(robot) {
        Ok(kinematics) => Ok(recorder.with_links(Box::new(kinematics))),
        // The log is worth having without pictures of links.
        Err(error) => {
            tracing::warn!("log without poses of links: {error}");
            Ok(recorder)
        }
    }
}
