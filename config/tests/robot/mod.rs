//! What holds for the data of every robot; each robot's own test names what is its own.

use config::Robot;
use multibody::{Data, Model};

/// A shipped robot and its model.
pub(crate) fn load(name: &str) -> (Robot, Model) {
    let robot = Robot::load(&config::root(None).join("robots").join(name)).unwrap();
    let model = robot.model().unwrap();
    (robot, model)
}

/// Joints that move, in the order of the file.
pub(crate) fn movable(urdf: &urdf_rs::Robot) -> impl Iterator<Item = &urdf_rs::Joint> {
    urdf.joints.iter().filter(|joint| joint.joint_type != urdf_rs::JointType::Fixed)
}

/// `rows` are joint, link and mass \[g\] in the order of the joints; masses with `torso` sum to the robot's.
pub(crate) fn has_joints_and_masses(name: &str, torso: i64, rows: &[(&str, &str, i64)]) {
    let (robot, model) = load(name);
    let urdf = urdf_rs::read_from_string(&robot.urdf).unwrap();
    let grams = |link: &str| {
        let link = urdf.links.iter().find(|l| l.name == link).unwrap();
        (link.inertial.mass.value * 1e3).round() as i64
    };
    assert_eq!(grams(&robot.torso), torso);
    assert_eq!((robot.joints.len(), movable(&urdf).count()), (rows.len(), rows.len()));
    for ((joint, link, mass), (is, row)) in rows.iter().zip(movable(&urdf).zip(&robot.joints)) {
        assert_eq!((row.name.as_str(), is.name.as_str()), (*joint, *joint));
        assert_eq!(is.child.link, *link);
        assert_eq!(grams(link), *mass, "{link}");
    }
    let sum: i64 = urdf.links.iter().map(|link| grams(&link.name)).sum();
    assert_eq!(sum, (robot.total_mass * 1e3).round() as i64);
    assert!((model.mass() - robot.total_mass).abs() < 1e-9);
}

/// Inertias of real bodies: no principal moment exceeds the sum of the other two.
pub(crate) fn inertias_are_possible(name: &str) {
    for link in urdf_rs::read_from_string(&load(name).0.urdf).unwrap().links {
        let i = link.inertial.inertia;
        let largest = i.ixx.max(i.iyy).max(i.izz);
        assert!(2.0 * largest <= i.ixx + i.iyy + i.izz, "{}", link.name);
    }
}

/// Reflection at the plane y = 0 turns a rotation about (x, y, z) into one about (-x, y, -z). So a left range is the
/// right one, or its negative, as the axes say; both differ by less than `apart` \[deg\]. Returns the number of pairs.
pub(crate) fn left_ranges_mirror_right_ones(name: &str, apart: f64) -> usize {
    let (robot, _) = load(name);
    let urdf = urdf_rs::read_from_string(&robot.urdf).unwrap();
    let mut pairs = 0;
    for right in movable(&urdf).filter(|joint| joint.name.starts_with("right")) {
        let name = right.name.replace("right", "left");
        let left = movable(&urdf).find(|joint| joint.name == name).unwrap();
        let [x, y, z] = right.axis.xyz.0;
        let mirrored = [-x, y, -z];
        let sign: f64 = (0..3).map(|k| mirrored[k] * left.axis.xyz.0[k]).sum();
        assert_eq!(sign.abs(), 1.0, "{name}: axes are not mirrored");
        let (a, b) = (right.limit.lower * sign, right.limit.upper * sign);
        let largest = (a.min(b) - left.limit.lower).abs().max((a.max(b) - left.limit.upper).abs());
        assert!(largest.to_degrees() < apart, "{name}: {} deg", largest.to_degrees());
        pairs += 1;
    }
    pairs
}

/// Software ranges are those of the URDF drawn in by `margins(joint)` \[deg\] at the lower and the upper end.
pub(crate) fn software_ranges_lie_inside(name: &str, margins: impl Fn(&str) -> [f64; 2]) {
    let (robot, _) = load(name);
    let urdf = urdf_rs::read_from_string(&robot.urdf).unwrap();
    for (joint, outer) in robot.joints.iter().zip(movable(&urdf)) {
        let inside = [joint.range[0] - outer.limit.lower, outer.limit.upper - joint.range[1]];
        for (is, wanted) in inside.map(f64::to_degrees).into_iter().zip(margins(&joint.name)) {
            assert!((is - wanted).abs() < 1e-3, "{}: {is} deg instead of {wanted}", joint.name);
        }
        assert!((joint.speed_limit - outer.limit.velocity).abs() < 1e-9, "{}", joint.name);
    }
}

/// In every pose all contact points lie in one horizontal plane, the feet are parallel and `apart(pose)` \[m\] from each
/// other, and the centre of gravity stands over the soles.
pub(crate) fn soles_are_flat_in_every_pose(name: &str, apart: impl Fn(&str) -> f64) {
    let (robot, model) = load(name);
    let mut data = Data::new(&model);
    for pose in ["crouch", "stand", "straight"] {
        assert!(robot.poses.contains_key(pose), "{pose}");
    }
    for (name, pose) in &robot.poses {
        let mut q = model.neutral();
        q[7..].copy_from_slice(pose);
        model.forward_kinematics(&mut data, &q);
        let mut soles = Vec::new();
        for foot in &robot.feet {
            let sole = model.frame_pose(&data, &model.frame(&foot.link, foot.sole).unwrap());
            assert!(
                (sole.rotation.matrix() - nalgebra::Matrix3::identity()).amax() < 1e-12,
                "{name}: sole is tilted"
            );
            for (link, at) in &foot.points {
                let point = model.frame_position(&data, &model.frame(link, *at).unwrap());
                let [x, y, z] = [0, 1, 2].map(|k| point[k] - sole.translation.vector[k]);
                assert!(z.abs() < 1e-12, "{name}: {link} {at:?} is {z} m off the plane of the sole");
                let [back, front, right, left] = foot.support;
                let inside =
                    x - back > -1e-12 && front - x > -1e-12 && y - right > -1e-12 && left - y > -1e-12;
                assert!(inside, "{name}: {link} {at:?} lies outside of the support rectangle");
            }
            soles.push(sole.translation.vector);
        }
        let between = soles[1] - soles[0];
        let off = [between.x, between.y - apart(name), between.z];
        assert!(off.iter().all(|x| x.abs() < 1e-12), "{name}: {between}");
        let com = model.cog(&mut data) - (soles[0] + soles[1]) / 2.0;
        let [back, front, ..] = robot.feet[0].support;
        assert!(com.x > back + 0.05 && com.x < front - 0.05 && com.y.abs() < 1e-3, "{name}: {com}");
    }
}

/// \[m\] Height of a link's origin over the right sole in a pose.
pub(crate) fn height_over_sole(robot: &Robot, model: &Model, pose: &str, link: &str) -> f64 {
    let mut data = Data::new(model);
    let mut q = model.neutral();
    q[7..].copy_from_slice(&robot.poses[pose]);
    model.forward_kinematics(&mut data, &q);
    let z = |link: &str, at| model.frame_position(&data, &model.frame(link, at).unwrap()).z;
    z(link, [0.0; 3]) - z(&robot.feet[0].link, robot.feet[0].sole)
}

/// One foot carries the whole robot upright, its centre of gravity `height` \[m\] up: K b^2 > m g z for tilting to the
/// side.
pub(crate) fn one_foot_is_stiff_enough_to_stand_on(name: &str, height: f64) {
    let (robot, _) = load(name);
    let points = robot.feet[0].points.iter();
    let stiffness: f64 = points.map(|(_, at)| robot.contact.normal_stiffness * at[1] * at[1]).sum();
    assert!(stiffness > robot.total_mass * 9.81 * height, "{stiffness} N m/rad");
}
