//! Lola's data against the sources and against each other.

use config::Robot;
use multibody::{Data, Model};

fn lola() -> (Robot, Model) {
    let robot = Robot::load(&config::root(None).join("robots/lola")).unwrap();
    let names: Vec<&str> = robot.joints.iter().map(|joint| joint.name.as_str()).collect();
    let model = Model::from_urdf(&robot.urdf, &robot.torso, &names).unwrap();
    (robot, model)
}

/// Thesis, appendix B: order of the joints and masses \[g\], right ankle adduction corrected from 13.80 kg.
const ORDER: [(&str, &str, i64); 24] = [
    ("pelvis_rotation", "waist", 1316),
    ("pelvis_adduction", "pelvis", 6283),
    ("right_hip_rotation", "right_hip_yoke", 1844),
    ("right_hip_adduction", "right_hip_cross", 2838),
    ("right_hip_flexion", "right_thigh", 6503),
    ("right_knee_flexion", "right_shank", 3403),
    ("right_ankle_adduction", "right_ankle", 138),
    ("right_ankle_flexion", "right_foot", 1648),
    ("right_toe_flexion", "right_toe", 797),
    ("left_hip_rotation", "left_hip_yoke", 1844),
    ("left_hip_adduction", "left_hip_cross", 2838),
    ("left_hip_flexion", "left_thigh", 6419),
    ("left_knee_flexion", "left_shank", 3403),
    ("left_ankle_adduction", "left_ankle", 138),
    ("left_ankle_flexion", "left_foot", 1643),
    ("left_toe_flexion", "left_toe", 797),
    ("right_shoulder_flexion", "right_shoulder", 561),
    ("right_shoulder_adduction", "right_upper_arm", 1891),
    ("right_elbow_flexion", "right_forearm", 1486),
    ("left_shoulder_flexion", "left_shoulder", 561),
    ("left_shoulder_adduction", "left_upper_arm", 1900),
    ("left_elbow_flexion", "left_forearm", 1486),
    ("head_pan", "neck", 249),
    ("head_tilt", "head", 1013),
];

#[test]
fn masses_are_those_of_the_thesis() {
    let (robot, model) = lola();
    let urdf = urdf_rs::read_from_string(&robot.urdf).unwrap();
    let grams = |link: &str| {
        let link = urdf.links.iter().find(|l| l.name == link).unwrap();
        (link.inertial.mass.value * 1e3).round() as i64
    };
    assert_eq!(grams("torso"), 9886);
    for (i, (joint, link, mass)) in ORDER.into_iter().enumerate() {
        assert_eq!(robot.joints[i].name, joint);
        assert_eq!(urdf.joints[i].name, joint);
        assert_eq!(urdf.joints[i].child.link, link);
        assert_eq!(grams(link), mass, "{link}");
    }
    assert_eq!(urdf.links.iter().map(|link| grams(&link.name)).sum::<i64>(), 60_885);
    assert!((model.mass() - robot.total_mass).abs() < 1e-9);
}

/// Inertias of real bodies: no principal moment exceeds the sum of the other two.
#[test]
fn inertias_are_possible() {
    for link in urdf_rs::read_from_string(&lola().0.urdf).unwrap().links {
        let i = link.inertial.inertia;
        let largest = i.ixx.max(i.iyy).max(i.izz);
        assert!(2.0 * largest <= i.ixx + i.iyy + i.izz, "{}", link.name);
    }
}

/// Reflection at the plane y = 0 turns a rotation about (x, y, z) into one about (-x, y, -z). So a left range is the
/// right one, or its negative, as the axes say. The robot's own sides differ by up to 3.2 deg.
#[test]
fn left_ranges_mirror_right_ones() {
    let (robot, _) = lola();
    let urdf = urdf_rs::read_from_string(&robot.urdf).unwrap();
    let mut pairs = 0;
    for right in urdf.joints.iter().filter(|joint| joint.name.starts_with("right")) {
        let name = right.name.replace("right", "left");
        let left = urdf.joints.iter().find(|joint| joint.name == name).unwrap();
        let [x, y, z] = right.axis.xyz.0;
        let mirrored = [-x, y, -z];
        let sign: f64 = (0..3).map(|k| mirrored[k] * left.axis.xyz.0[k]).sum();
        assert_eq!(sign.abs(), 1.0, "{name}: axes are not mirrored");
        let (a, b) = (right.limit.lower * sign, right.limit.upper * sign);
        let largest = (a.min(b) - left.limit.lower).abs().max((a.max(b) - left.limit.upper).abs());
        assert!(largest.to_degrees() < 3.25, "{name}: {} deg", largest.to_degrees());
        pairs += 1;
    }
    assert_eq!(pairs, 10);
}

/// Software ranges are the measured ones drawn in by 5 deg, the upper end of shoulder adduction by 2 deg.
#[test]
fn software_ranges_lie_inside_the_measured_ones() {
    let (robot, _) = lola();
    for (joint, measured) in robot.joints.iter().zip(urdf_rs::read_from_string(&robot.urdf).unwrap().joints) {
        let upper = if joint.name.contains("shoulder_adduction") { 2.0 } else { 5.0 };
        let margins = [joint.range[0] - measured.limit.lower, measured.limit.upper - joint.range[1]];
        for (is, wanted) in margins.map(f64::to_degrees).into_iter().zip([5.0, upper]) {
            assert!((is - wanted).abs() < 1e-3, "{}: {is} deg instead of {wanted}", joint.name);
        }
        assert!((joint.speed_limit - measured.limit.velocity).abs() < 1e-9, "{}", joint.name);
    }
}

/// In every pose all contact points lie in one horizontal plane, the feet are parallel, and the centre of gravity
/// stands over the soles.
#[test]
fn soles_are_flat_in_every_pose() {
    let (robot, model) = lola();
    let mut data = Data::new(&model);
    assert_eq!(robot.poses.keys().collect::<Vec<_>>(), ["crouch", "stand", "straight"]);
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
        let apart = soles[1] - soles[0];
        assert!(apart.x.abs() < 1e-12 && (apart.y - 0.2).abs() < 1e-12 && apart.z.abs() < 1e-12, "{name}");
        let com = model.cog(&mut data) - (soles[0] + soles[1]) / 2.0;
        let [back, front, ..] = robot.feet[0].support;
        assert!(com.x > back + 0.05 && com.x < front - 0.05 && com.y.abs() < 1e-3, "{name}: {com}");
    }
}

/// Heights by hand: hip over sole = ankle height + projected thigh and shank.
#[test]
fn hip_height_of_the_standing_pose() {
    let (robot, model) = lola();
    let mut data = Data::new(&model);
    let mut q = model.neutral();
    q[7..].copy_from_slice(&robot.poses["stand"]);
    model.forward_kinematics(&mut data, &q);
    let z = |link: &str, at| model.frame_position(&data, &model.frame(link, at).unwrap()).z;
    let hip = z("right_thigh", [0.0; 3]) - z(&robot.feet[0].link, robot.feet[0].sole);
    let angle = robot.poses["stand"][robot.joint("right_ankle_flexion").unwrap()];
    assert!((hip - (0.080 + (0.424 + 0.426) * angle.cos())).abs() < 1e-12, "{hip}");
}

/// One foot carries the whole robot upright: K b^2 > m g z for tilting to the side.
#[test]
fn one_foot_is_stiff_enough_to_stand_on() {
    let (robot, _) = lola();
    let foot = &robot.feet[0];
    let stiffness: f64 =
        foot.points.iter().map(|(_, at)| robot.contact.normal_stiffness * at[1] * at[1]).sum();
    assert!(stiffness > robot.total_mass * 9.81 * 0.855, "{stiffness} N m/rad");
}
