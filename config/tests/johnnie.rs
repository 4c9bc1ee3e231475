//! Johnnie's data against the sources and against each other.

use crate::robot;

const NAME: &str = "johnnie";

/// Joints that move, the links behind them, masses \[g\] (README.md beside the data: estimates that sum to 40 kg).
const ORDER: [(&str, &str, i64); 15] = [
    ("body_rotation", "pelvis", 4500),
    ("right_hip_rotation", "right_hip_yoke", 1000),
    ("right_hip_adduction", "right_hip_cross", 1700),
    ("right_hip_flexion", "right_thigh", 4200),
    ("right_knee_flexion", "right_shank", 3000),
    ("right_ankle_adduction", "right_ankle", 150),
    ("right_ankle_flexion", "right_foot", 1250),
    ("left_hip_rotation", "left_hip_yoke", 1000),
    ("left_hip_adduction", "left_hip_cross", 1700),
    ("left_hip_flexion", "left_thigh", 4200),
    ("left_knee_flexion", "left_shank", 3000),
    ("left_ankle_adduction", "left_ankle", 150),
    ("left_ankle_flexion", "left_foot", 1250),
    ("right_shoulder_flexion", "right_shoulder", 400),
    ("left_shoulder_flexion", "left_shoulder", 400),
];

#[test]
fn masses_sum_to_the_40_kg_of_the_thesis() {
    robot::has_joints_and_masses(NAME, 10_500, &ORDER);
}

/// Thesis, table 2.5: 21 mechanical degrees of freedom in the full model, 26 with elastic gears, 24 of contact, 15
/// electrical; and 17 joints on the robot.
#[test]
fn counts_are_those_of_table_2_5() {
    let (johnnie, model) = robot::load(NAME);
    assert_eq!(model.nv(), 21);
    assert_eq!(johnnie.drives.len(), 15);
    assert_eq!(model.nv() + johnnie.drives.iter().filter(|drive| drive.elasticity.is_some()).count(), 26);
    assert_eq!(3 * johnnie.feet.iter().map(|foot| foot.points.len()).sum::<usize>(), 24);
    let urdf = urdf_rs::read_from_string(&johnnie.urdf).unwrap();
    assert_eq!(urdf.joints.len(), 17);
    let fixed = urdf.joints.iter().filter(|joint| joint.joint_type == urdf_rs::JointType::Fixed);
    let fixed: Vec<&str> = fixed.map(|joint| joint.name.as_str()).collect();
    assert_eq!(fixed, ["right_shoulder_adduction", "left_shoulder_adduction"]);
}

/// Thesis 5.6: a swing leg of 8.2 % of the robot's mass: foot, ankle and 63 % of the shank.
#[test]
fn the_leg_point_of_the_gait_fits_the_masses() {
    let gait = config::Gait::load(&config::root(None).join("gaits/johnnie.toml")).unwrap();
    let leg = (1.25 + 0.15 + 0.63 * 3.0) / 40.0;
    assert!((gait.model.leg_mass - leg).abs() < 5e-4, "{leg}");
}

#[test]
fn inertias_are_possible() {
    robot::inertias_are_possible(NAME);
}

/// Ranges are Lola's, whose own sides differ by up to 3.2 deg; shoulders by nothing.
#[test]
fn left_ranges_mirror_right_ones() {
    assert_eq!(robot::left_ranges_mirror_right_ones(NAME, 3.25), 7);
}

#[test]
fn software_ranges_lie_inside_the_ranges_of_the_joints() {
    robot::software_ranges_lie_inside(NAME, |_| [5.0, 5.0]);
}

#[test]
fn soles_are_flat_in_every_pose() {
    robot::soles_are_flat_in_every_pose(NAME, |_| 0.2);
}

/// Heights by hand: the 2 cm between the ankle axes belong to the shank, whose angle they share.
#[test]
fn hip_height_of_the_standing_pose() {
    let (johnnie, model) = robot::load(NAME);
    let hip = robot::height_over_sole(&johnnie, &model, "stand", "right_thigh");
    let angle = johnnie.poses["stand"][johnnie.joint("right_ankle_flexion").unwrap()];
    assert!((hip - (0.070 + (0.020 + 0.420 + 0.420) * angle.cos())).abs() < 1e-12, "{hip}");
}

#[test]
fn one_foot_is_stiff_enough_to_stand_on() {
    robot::one_foot_is_stiff_enough_to_stand_on(NAME, 0.862);
}
