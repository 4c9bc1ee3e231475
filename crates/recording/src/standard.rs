//! Standard ROS 2 messages made from our records: what viewers know how to show.

use crate::cdr::Encoder;
use crate::links::{Link, Pose};
use crate::polygon::{Point, convex_hull, sole_corners};
use crate::robot::{RobotInfo, SIDES};
use messages::record::{Visit, Wrench};
use messages::{MAX_JOINTS, Sensors, SimState};

/// Root of the tree of frames.
pub(crate) const WORLD: &str = "world";

/// \[N\] A foot that carries less does not count for the support polygon that is drawn.
const LOADED: f64 = 10.0;

fn header(e: &mut Encoder, stamp_ns: u64, frame: &str) {
    e.stamp(stamp_ns);
    e.string(frame);
}

/// `sensor_msgs/JointState`: link side; effort is not measured and stays empty.
pub(crate) fn joint_state(e: &mut Encoder, robot: &RobotInfo, sensors: &Sensors) {
    let n = robot.joints.len().min(MAX_JOINTS);
    header(e.begin(), sensors.header.stamp_ns, "");
    e.count(n);
    for name in &robot.joints[..n] {
        e.string(name);
    }
    for values in [&sensors.joint_angle, &sensors.joint_speed] {
        e.count(n);
        e.f64s(&values[..n]);
    }
    e.count(0);
}

/// `sensor_msgs/Imu`; covariances of zero mean "unknown".
pub(crate) fn imu(e: &mut Encoder, sensors: &Sensors) {
    header(e.begin(), sensors.header.stamp_ns, "imu");
    e.f64s(&sensors.imu.orientation);
    e.f64s(&[0.0; 9]);
    e.f64s(&sensors.imu.angular_velocity);
    e.f64s(&[0.0; 9]);
    e.f64s(&sensors.imu.acceleration);
    e.f64s(&[0.0; 9]);
}

/// `geometry_msgs/WrenchStamped` of one foot, in its sensor frame.
pub(crate) fn foot_wrench(e: &mut Encoder, sensors: &Sensors, foot: usize) {
    header(e.begin(), sensors.header.stamp_ns, &sensor_frame(foot));
    e.f64s(&sensors.foot_wrench[foot].force);
    e.f64s(&sensors.foot_wrench[foot].moment);
}

/// `std_msgs/String`.
pub(crate) fn text(e: &mut Encoder, text: &str) {
    e.begin().string(text);
}

fn sensor_frame(foot: usize) -> String {
    format!("{}_force_sensor", SIDES[foot])
}

/// Name of the sole frame as REP 120 wants it.
fn sole_frame(foot: usize) -> &'static str {
    ["r_sole", "l_sole"][foot]
}

fn transform(e: &mut Encoder, stamp_ns: u64, parent: &str, child: &str, pose: &Pose) {
    header(e, stamp_ns, parent);
    e.string(child);
    e.f64s(&pose.position);
    e.f64s(&pose.orientation);
}

/// `tf2_msgs/TFMessage`: world to torso, every link to its parent, and the frames of sensors and soles.
pub(crate) fn tf(e: &mut Encoder, robot: &RobotInfo, state: &SimState, links: &[Link], world: &[Pose]) {
    let stamp = state.header.stamp_ns;
    let fixed = fixed_frames(robot, links);
    let n = links.len().min(world.len());
    e.begin().count(n.max(1) + fixed.len());
    if n == 0 {
        let torso = Pose { position: state.position, orientation: state.orientation };
        transform(e, stamp, WORLD, &robot.torso, &torso);
    }
    for (link, pose) in links.iter().zip(world) {
        match link.parent {
            None => transform(e, stamp, WORLD, &link.name, pose),
            Some(p) => transform(e, stamp, &links[p].name, &link.name, &pose.seen_from(&world[p])),
        }
    }
    for (parent, child, position) in fixed {
        transform(e, stamp, parent, &child, &Pose::moved(position));
    }
}

/// (parent link, frame, position in the link \[m\]) of every frame that is not a link; those of unknown links are
/// left out, so that the tree stays connected.
fn fixed_frames<'a>(robot: &'a RobotInfo, links: &[Link]) -> Vec<(&'a str, String, [f64; 3])> {
    let mut frames = vec![(robot.torso.as_str(), "imu".to_string(), robot.imu)];
    for (i, foot) in robot.feet.iter().enumerate() {
        frames.push((&foot.link, sole_frame(i).into(), foot.sole));
        frames.push((&foot.sensor_link, sensor_frame(i), foot.sensor));
    }
    frames.retain(|(parent, ..)| *parent == robot.torso || links.iter().any(|l| l.name == *parent));
    frames
}

/// `visualization_msgs/MarkerArray`: centre of gravity, zero-moment point and support polygon of the simulated robot.
pub(crate) fn markers(e: &mut Encoder, robot: &RobotInfo, state: &SimState) {
    let polygon = support_polygon(robot, state);
    let zmp = zero_moment_point(state);
    e.begin().count(1 + usize::from(zmp.is_some()) + usize::from(!polygon.is_empty()));
    let mut marker = |name: &str, shape, at: [f64; 3], size: f64, color: [f32; 3], points: &[Point]| {
        header(e, state.header.stamp_ns, WORLD);
        e.string(name);
        for number in [0, shape, 0] {
            e.i32(number);
        }
        e.f64s(&at);
        e.f64s(&Pose::IDENTITY.orientation);
        e.f64s(&[size; 3]);
        color.into_iter().chain([1.0]).for_each(|c| e.f32(c));
        e.stamp(0); // lifetime: for ever
        e.u8(0); // frame_locked
        e.count(points.len());
        for [x, y] in points {
            e.f64s(&[*x, *y, 0.0]);
        }
        e.count(0); // colors
        e.string(""); // texture_resource
        header(e, 0, ""); // texture
        e.string("");
        e.count(0);
        e.count(0); // uv_coordinates
        e.string(""); // text
        e.string(""); // mesh_resource
        e.string(""); // mesh_file
        e.count(0);
        e.u8(0); // mesh_use_embedded_materials
    };
    const SPHERE: i32 = 2;
    const LINE_STRIP: i32 = 4;
    marker("centre_of_gravity", SPHERE, state.com, 0.05, [0.0, 0.45, 0.70], &[]);
    if let Some([x, y]) = zmp {
        marker("zero_moment_point", SPHERE, [x, y, 0.0], 0.03, [0.84, 0.37, 0.0], &[]);
    }
    if let Some(&first) = polygon.first() {
        let closed = [&polygon[..], &[first]].concat();
        marker("support_polygon", LINE_STRIP, [0.0; 3], 0.005, [0.0, 0.62, 0.45], &closed);
    }
}

fn support_polygon(robot: &RobotInfo, state: &SimState) -> Vec<Point> {
    let loaded = (0..2).filter(|&i| state.foot_wrench[i].force[2] > LOADED);
    let corners: Vec<Point> =
        loaded.flat_map(|i| sole_corners(&state.feet[i], &robot.feet[i].support)).collect();
    convex_hull(&corners)
}

/// Zero-moment point of both foot wrenches on the ground z = 0; none while no foot carries load.
fn zero_moment_point(state: &SimState) -> Option<Point> {
    let mut total = Wrench { force: [0.0; 3], moment: [0.0; 3] };
    for (wrench, sole) in state.foot_wrench.iter().zip(&state.feet) {
        let (f, m, p) = (wrench.force, wrench.moment, [sole[0], sole[1], sole[2]]);
        let about_origin = [
            m[0] + p[1] * f[2] - p[2] * f[1],
            m[1] + p[2] * f[0] - p[0] * f[2],
            m[2] + p[0] * f[1] - p[1] * f[0],
        ];
        for k in 0..3 {
            total.force[k] += f[k];
            total.moment[k] += about_origin[k];
        }
    }
    let f_z = total.force[2];
    (f_z > LOADED).then(|| [-total.moment[1] / f_z, total.moment[0] / f_z])
}
