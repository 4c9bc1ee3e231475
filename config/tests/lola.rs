//! Lola's data against the sources and against each other.

use crate::robot;

const NAME: &str = "lola";

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
    assert_eq!(9886 + ORDER.iter().map(|row| row.2).sum::<i64>(), 60_885);
    robot::has_joints_and_masses(NAME, 9886, &ORDER);
}

#[test]
fn inertias_are_possible() {
    robot::inertias_are_possible(NAME);
}

/// The robot's own sides differ by up to 3.2 deg.
#[test]
fn left_ranges_mirror_right_ones() {
    assert_eq!(robot::left_ranges_mirror_right_ones(NAME, 3.25), 10);
}

/// Software ranges are the measured ones drawn in by 5 deg, the upper end of shoulder adduction by 2 deg.
#[test]
fn software_ranges_lie_inside_the_measured_ones() {
    robot::software_ranges_lie_inside(NAME, |joint| {
        [5.0, if joint.contains("shoulder_adduction") { 2.0 } else { 5.0 }]
    });
}

#[test]
fn soles_are_flat_in_every_pose() {
    robot::soles_are_flat_in_every_pose(NAME, |_| 0.2);
}

/// Heights by hand: hip over sole = ankle height + projected thigh and shank.
#[test]
fn hip_height_of_the_standing_pose() {
    let (lola, model) = robot::load(NAME);
    let hip = robot::height_over_sole(&lola, &model, "stand", "right_thigh");
    let angle = lola.poses["stand"][lola.joint("right_ankle_flexion").unwrap()];
    assert!((hip - (0.080 + (0.424 + 0.426) * angle.cos())).abs() < 1e-12, "{hip}");
}

#[test]
fn one_foot_is_stiff_enough_to_stand_on() {
    robot::one_foot_is_stiff_enough_to_stand_on(NAME, 0.855);
}
