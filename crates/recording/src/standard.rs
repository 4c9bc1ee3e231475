//! Standard ROS 2 messages made from our records: what viewers know how to show.

use crate::cdr::CdrEncoder;
use crate::links::{LinkFrame, RecordedPose};
use crate::robot::{RobotInfo, SIDES};
use messages::{Joints, MAX_JOINTS, Sensors};

/// Root of the tree of frames: the simulated world, or where a real robot was first.
pub(crate) const WORLD: &str = "world";
/// Believed pose at the start.
pub(crate) const ODOM: &str = "odom";
/// In front of the names of the simulated robot's true frames and markers.
pub(crate) const TRUTH: &str = "truth/";

pub(crate) fn header(e: &mut CdrEncoder, stamp_ns: u64, frame: &str) {
    e.stamp(stamp_ns);
    e.string(frame);
}

/// `sensor_msgs/JointState`: link side; efforts \[N m\] only where motor currents tell them.
pub(crate) fn joint_state(
    e: &mut CdrEncoder,
    stamp_ns: u64,
    robot: &RobotInfo,
    sensors: &Sensors,
    torques: Option<&Joints>,
) {
    let n = robot.joints.len().min(MAX_JOINTS);
    header(e.begin(), stamp_ns, "");
    e.count(n);
    for name in &robot.joints[..n] {
        e.string(name);
    }
    for values in [&sensors.joint_angle, &sensors.joint_speed] {
        e.count(n);
        e.f64s(&values[..n]);
    }
    let torques = torques.map_or(&[][..], |torques| &torques[..n]);
    e.count(torques.len());
    e.f64s(torques);
}

/// `sensor_msgs/Imu`; covariances of zero mean "unknown".
pub(crate) fn imu(e: &mut CdrEncoder, stamp_ns: u64, sensors: &Sensors) {
    header(e.begin(), stamp_ns, "imu");
    e.f64s(&sensors.imu.orientation);
    e.f64s(&[0.0; 9]);
    e.f64s(&sensors.imu.angular_velocity);
    e.f64s(&[0.0; 9]);
    e.f64s(&sensors.imu.acceleration);
    e.f64s(&[0.0; 9]);
}

/// `geometry_msgs/WrenchStamped` of one foot, in its sensor frame.
pub(crate) fn foot_wrench(e: &mut CdrEncoder, stamp_ns: u64, sensors: &Sensors, foot: usize) {
    header(e.begin(), stamp_ns, &sensor_frame(foot));
    e.f64s(&sensors.foot_wrench[foot].force);
    e.f64s(&sensors.foot_wrench[foot].moment);
}

/// `std_msgs/String`.
pub(crate) fn text(e: &mut CdrEncoder, text: &str) {
    e.begin().string(text);
}

fn sensor_frame(foot: usize) -> String {
    format!("{}_force_sensor", SIDES[foot])
}

/// Name of the sole frame as REP 120 wants it.
fn sole_frame(foot: usize) -> &'static str {
    ["r_sole", "l_sole"][foot]
}

fn transform(e: &mut CdrEncoder, stamp_ns: u64, parent: &str, child: &str, pose: &RecordedPose) {
    header(e, stamp_ns, parent);
    e.string(child);
    e.f64s(&pose.position);
    e.f64s(&pose.orientation);
}

/// `tf2_msgs/TFMessage`: `base` to the torso, and every link that moves to its parent. Names begin with `prefix`.
pub(crate) fn tf(
    e: &mut CdrEncoder,
    stamp_ns: u64,
    base: &str,
    prefix: &str,
    links: &[LinkFrame],
    poses: &[RecordedPose],
) {
    let moving = || links.iter().zip(poses).filter(|(link, _)| !link.fixed);
    e.begin().count(moving().count());
    for (link, pose) in moving() {
        let name = format!("{prefix}{}", link.name);
        match link.parent {
            None => transform(e, stamp_ns, base, &name, pose),
            Some(p) => {
                let parent = format!("{prefix}{}", links[p].name);
                transform(e, stamp_ns, &parent, &name, &pose.seen_from(&poses[p]));
            }
        }
    }
}

/// The torso alone.
pub(crate) fn tf_of_torso(e: &mut CdrEncoder, stamp_ns: u64, base: &str, name: &str, torso: &RecordedPose) {
    e.begin().count(1);
    transform(e, stamp_ns, base, name, torso);
}

/// `tf2_msgs/TFMessage` of all frames that never move, of the robot as it believes to be and of the true one. `poses` are
/// those of the links in any state.
pub(crate) fn tf_static(
    e: &mut CdrEncoder,
    stamp_ns: u64,
    robot: &RobotInfo,
    links: &[LinkFrame],
    poses: &[RecordedPose],
) {
    let fixed = fixed_frames(robot, links);
    let still: Vec<_> = links.iter().zip(poses).filter(|(link, _)| link.fixed).collect();
    e.begin().count(1 + 2 * (fixed.len() + still.len()));
    let [x, y, heading] = robot.odom;
    let (sin, cos) = (0.5 * heading).sin_cos();
    let odom = RecordedPose { position: [x, y, 0.0], orientation: [0.0, 0.0, sin, cos] };
    transform(e, stamp_ns, WORLD, ODOM, &odom);
    for prefix in ["", TRUTH] {
        for (link, pose) in &still {
            let Some(p) = link.parent else { continue };
            let (parent, name) = (format!("{prefix}{}", links[p].name), format!("{prefix}{}", link.name));
            transform(e, stamp_ns, &parent, &name, &pose.seen_from(&poses[p]));
        }
        for (parent, child, position) in &fixed {
            let (parent, child) = (format!("{prefix}{parent}"), format!("{prefix}{child}"));
            transform(e, stamp_ns, &parent, &child, &RecordedPose::moved(*position));
        }
    }
}

/// (parent link, frame, position in the link \[m\]) of every frame that is not a link; those of unknown links are
/// left out, so that the tree stays connected.
fn fixed_frames<'a>(robot: &'a RobotInfo, links: &[LinkFrame]) -> Vec<(&'a str, String, [f64; 3])> {
    let mut frames = vec![(robot.torso.as_str(), "imu".to_string(), robot.imu)];
    for (i, foot) in robot.feet.iter().enumerate() {
        frames.push((&foot.link, sole_frame(i).into(), foot.sole));
        frames.push((&foot.sensor_link, sensor_frame(i), foot.sensor));
    }
    frames.retain(|(parent, ..)| *parent == robot.torso || links.iter().any(|l| l.name == *parent));
    frames
}
