//! Archie's data against the thesis of 2013 and against each other.

use crate::robot;
use multibody::{Data, Model};
use nalgebra::{Matrix3, Vector3};

const NAME: &str = "archie";

/// Joints, the links behind them, masses \[g\] (README.md beside the data: estimates that sum to 20 kg).
const ORDER: [(&str, &str, i64); 12] = [
    ("right_hip_rotation", "right_hip_yoke", 500),
    ("right_hip_adduction", "right_hip_cross", 1600),
    ("right_hip_flexion", "right_thigh", 1600),
    ("right_knee_flexion", "right_shank", 1600),
    ("right_ankle_flexion", "right_ankle", 1500),
    ("right_ankle_adduction", "right_foot", 700),
    ("left_hip_rotation", "left_hip_yoke", 500),
    ("left_hip_adduction", "left_hip_cross", 1600),
    ("left_hip_flexion", "left_thigh", 1600),
    ("left_knee_flexion", "left_shank", 1600),
    ("left_ankle_flexion", "left_ankle", 1500),
    ("left_ankle_adduction", "left_foot", 700),
];

#[test]
fn masses_sum_to_the_20_kg_of_the_thesis() {
    robot::has_joints_and_masses(NAME, 5000, &ORDER);
}

/// Thesis 2.1, 3.1: legs of 69.6 cm, 26 cm between the feet when all joints are zero, frame {6} 4 cm below the hips.
#[test]
fn lengths_are_those_of_the_thesis() {
    let (archie, model) = robot::load(NAME);
    let soles = soles(&archie, &model, &[0.0; 12]).0;
    assert!((soles[1] - soles[0] - Vector3::new(0.0, 0.26, 0.0)).amax() < 1e-12);
    assert!((soles[0].z + 0.656).abs() < 1e-12);
    let [back, front, ..] = archie.feet[0].support;
    assert_eq!([back, front], [-0.065, 0.125], "l_ab and l_af, 4.3");
}

/// Positions \[m\] of both soles and of the centre of gravity in the torso.
fn soles(archie: &config::Robot, model: &Model, joints: &[f64]) -> ([Vector3<f64>; 2], Vector3<f64>) {
    let mut data = Data::new(model);
    let mut q = model.neutral();
    q[7..].copy_from_slice(joints);
    model.forward_kinematics(&mut data, &q);
    let sole = |foot: &config::robot::Foot| {
        model.frame_position(&data, &model.frame(&foot.link, foot.sole).unwrap())
    };
    let both = [sole(&archie.feet[0]), sole(&archie.feet[1])];
    (both, model.cog(&mut data))
}

/// Joint angles of one leg in the order of the URDF for the thesis's theta_1 to theta_6: from the foot to the torso, with
/// axes x, y, y, y, x, -z on the left and x, -y, -y, -y, x, -z on the right, theta_5 = pi/2 upright.
fn leg(side: f64, theta: [f64; 6]) -> [f64; 6] {
    let [t1, t2, t3, t4, t5, t6] = theta;
    [t6, -side * (t5 - std::f64::consts::FRAC_PI_2), t4, t3, t2, -side * t1]
}

/// Poses of frame {6} in frame {0}, position \[cm\], from the D-H parameters of tables 3.1 and 3.2, computed apart from this
/// project. Frame {0} is in the foot, on the axis of adduction: x up, z forward.
#[test]
fn kinematics_are_those_of_the_thesis() {
    let (_, model) = robot::load(NAME);
    let foot_from_0: Matrix3<f64> = Matrix3::new(0.0, 0.0, 1.0, 0.0, -1.0, 0.0, 1.0, 0.0, 0.0);
    let torso_from_6: Matrix3<f64> = Matrix3::new(0.0, -1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, -1.0);
    let right = std::f64::consts::PI - 1.4;
    #[rustfmt::skip]
    let cases = [
        (1.0, [0.1, 0.2, -0.7, 0.4, 1.4, -0.05], [55.219967872722, 19.200209481480, -8.640259495835],
            [0.074769632876, -0.095717363039, -0.992596437840, 0.996661840171, 0.039895478696, 0.071228695952,
             0.032782287090, -0.994608735731, 0.098380813478]),
        (-1.0, [-0.1, -0.2, 0.7, -0.4, right, 0.05], [55.219967872722, -19.200209481480, -8.640259495835],
            [-0.074769632876, -0.095717363039, -0.992596437840, 0.996661840171, -0.039895478696, -0.071228695952,
             -0.032782287090, -0.994608735731, 0.098380813478]),
        (-1.0, [0.069045872400, -0.515171943349, 1.199013363623, -0.759053908276, 1.444363862215, -0.090652556346],
            [50.0, -9.0, -7.0],
            [0.049979169271, 0.079814821411, -0.995555963732, 0.993760669166, 0.095540003756, 0.057548589053,
             0.099708650872, -0.992220591383, -0.074541820315]),
    ];
    let mut data = Data::new(&model);
    for (side, theta, position, rotation) in cases {
        let mut q = model.neutral();
        let at = if side < 0.0 { 7 } else { 13 };
        q[at..at + 6].copy_from_slice(&leg(side, theta));
        model.forward_kinematics(&mut data, &q);
        let foot = if side < 0.0 { "right_foot" } else { "left_foot" };
        let foot = model.frame_pose(&data, &model.frame(foot, [0.0; 3]).unwrap());
        let back = foot.inverse(); // foot_from_torso
        let p: Vector3<f64> = 100.0 * foot_from_0.transpose() * back.translation.vector;
        assert!((p - Vector3::<f64>::from(position)).amax() < 1e-9, "{p}");
        let r: Matrix3<f64> = foot_from_0.transpose() * back.rotation.matrix() * torso_from_6;
        assert!((r - Matrix3::<f64>::from_row_slice(&rotation)).amax() < 1e-9, "{r}");
    }
}

/// Angles of one leg, torso upright, sole flat: by hand. `sole`: in front of the torso, outwards, and below \[m\].
fn stretched(side: f64, [x, out, below]: [f64; 3]) -> [f64; 6] {
    let (out, down) = (out - 0.056, below + 0.04 - 0.056); // from the hip to the axis of ankle adduction
    let length = (out * out + down * down - 0.074f64.powi(2)).sqrt();
    let adduction = out.atan2(down) - 0.074f64.atan2(length);
    let (thigh, shank, down) = (0.30, 0.26, length - 0.08);
    let reach = x.hypot(down);
    let knee = ((reach * reach - thigh * thigh - shank * shank) / (2.0 * thigh * shank)).acos();
    let hip = (shank * knee.sin()).atan2(thigh + shank * knee.cos()) + x.atan2(down);
    [0.0, adduction, side * hip, -side * knee, side * (knee - hip), -adduction]
}

/// Thesis 6.2: on one foot, the other one lifted by 6.4 cm and carried 5 cm further out than it stands (w_p), the robot tips
/// over with the torso above the foot, and stands with the torso 1 to 5 cm further out. The foot, a spring against rolling,
/// leans under the weight, so that its inner edge is unloaded before the centre of gravity comes to stand above the outer
/// one. This is what width and stiffness of the foot were chosen by.
#[test]
fn stands_on_one_foot_where_he_stood() {
    let (archie, model) = robot::load(NAME);
    let off = |further: f64| {
        let right = stretched(-1.0, [-0.03, -further, 0.555]);
        let left = stretched(1.0, [-0.03, 0.22 + further, 0.555 - 0.064]);
        let (soles, com) = soles(&archie, &model, &[right, left].concat());
        assert!((soles[0] - Vector3::new(-0.03, further, -0.555)).amax() < 1e-12, "{}", soles[0]);
        assert!((soles[1] - Vector3::new(-0.03, 0.22 + further, -0.491)).amax() < 1e-12, "{}", soles[1]);
        com - soles[0]
    };
    let [.., edge] = archie.feet[0].support;
    let against_rolling = 4.0 * archie.contact.normal_stiffness * edge * edge;
    let weight = model.mass() * 9.81;
    let bears = |off: Vector3<f64>| edge * (1.0 - weight * off.z / against_rolling) - off.y.abs();
    assert!(bears(off(0.0)) < 0.0, "{}", bears(off(0.0)));
    for further in [0.01, 0.03, 0.05] {
        assert!(bears(off(further)) > 0.0, "{further} m: {} m", bears(off(further)));
    }
}

#[test]
fn inertias_are_possible() {
    robot::inertias_are_possible(NAME);
}

#[test]
fn left_ranges_mirror_right_ones() {
    assert_eq!(robot::left_ranges_mirror_right_ones(NAME, 1e-6), 6);
}

#[test]
fn software_ranges_lie_inside_the_ranges_of_the_joints() {
    robot::software_ranges_lie_inside(NAME, |joint| {
        // His own walk takes 58.2 of the 60 deg of ankle flexion, if the torso stands above the foot.
        if joint.ends_with("ankle_flexion") { [1.0, 1.0] } else { [2.0, 2.0] }
    });
}

/// The plane of a leg lies 7.4 cm outside of its hip, and leans inwards with the hip's adduction.
#[test]
fn soles_are_flat_in_every_pose() {
    let (archie, _) = robot::load(NAME);
    robot::soles_are_flat_in_every_pose(NAME, |pose| {
        let angle = |joint: &str| archie.poses[pose][archie.joint(joint).unwrap()];
        let [hip, ankle, lean] =
            ["right_hip_flexion", "right_ankle_flexion", "right_hip_adduction"].map(angle);
        let leg = 0.30 * hip.cos() + 0.26 * ankle.cos() + 0.08;
        2.0 * (0.056 + 0.074 * lean.cos() + leg * lean.sin())
    });
}

/// Heights by hand; and frame {6}, 4 cm lower, is where thesis 6.2 has it while walking.
#[test]
fn hip_height_of_the_standing_pose() {
    let (archie, model) = robot::load(NAME);
    let hip = robot::height_over_sole(&archie, &model, "stand", "right_hip_yoke");
    let angle = |joint: &str| archie.poses["stand"][archie.joint(joint).unwrap()];
    let leg = 0.30 * angle("right_hip_flexion").cos() + 0.26 * angle("right_ankle_flexion").cos() + 0.08;
    let lean = angle("right_hip_adduction");
    assert!((hip - (0.056 + leg * lean.cos() - 0.074 * lean.sin())).abs() < 1e-12, "{hip}");
    assert!((0.54..0.57).contains(&(hip - 0.04)), "{hip}");
}

#[test]
fn one_foot_is_stiff_enough_to_stand_on() {
    robot::one_foot_is_stiff_enough_to_stand_on(NAME, 0.516);
}

/// T_c = N m T_s / 2, points a bus cycle apart, steps that end at points and with cycles: what his drives cannot play is named
/// with what they can. Numbers by hand: 2 s are 6250 samples of 320 us, 300 points in a stride of two.
#[test]
fn patterns_whose_tables_no_drive_can_play_are_refused() {
    let root = config::root(None);
    let setup = config::Setup::load(&root, "archie_tables").unwrap();
    let (tables, pattern) = (setup.robot.tables.unwrap(), setup.gait.pattern.unwrap());
    assert_eq!((tables.spacing(&pattern), tables.problem(&pattern, 0.008)), (250, None));
    let said = |step_time: f64, points: u64, cycle: f64| {
        let pattern = config::pattern::Pattern { step_time, points, ..pattern };
        tables.problem(&pattern, cycle).map_or(String::new(), |(key, text)| format!("{key} = {text}"))
    };
    let t_c = |text: &str| {
        format!("T_c = {text}")
            .replace("MUST", "which must be whole, from 1 to 256; the nearest that can be played is")
    };
    assert_eq!(
        said(2.0, 300, 0.008),
        t_c(
            "2 s would be N m T_s / 2 with N = 300, T_s = 320 us and m = 41.667, MUST 2.016000 s, with m = 42"
        )
    );
    assert_eq!(
        said(24.0, 300, 0.008),
        t_c(
            "24 s would be N m T_s / 2 with N = 300, T_s = 320 us and m = 500.000, MUST 12.288000 s, with m = 256"
        )
    );
    assert_eq!(said(2.016, 300, 0.008), "");
    let odd = said(12.0, 375, 0.008);
    assert_eq!(odd, "N = 375 must be even: a new plan takes over at a point, after a step");
    let near = said(0.96, 300, 0.008);
    assert_eq!(near, "N = 300 points are 6.400 ms apart, and must be a bus cycle, 8 ms; fewer");
    assert_eq!(said(2.016, 300, 0.005), "T_c = 2.016 s must be whole bus cycles of 5 ms: 2.015 s");
}

/// A scene that plays tables of a gait without a pattern, or of one that no drive can play, is not loaded.
#[test]
fn scenes_whose_tables_no_drive_can_play_are_not_loaded() {
    let root = config::root(None);
    let text = std::fs::read_to_string(root.join("scenes/archie_tables.toml")).unwrap();
    let said = |from: &str, to: &str| {
        let file = std::env::temp_dir().join(format!("gangwerk-tables-{}.toml", std::process::id()));
        std::fs::write(&file, text.replacen(from, to, 1)).unwrap();
        let said = config::Setup::load(&root, file.to_str().unwrap()).unwrap_err().to_string();
        std::fs::remove_file(file).unwrap();
        said
    };
    let without = said("gait = \"archie_static\"", "gait = \"archie\"");
    assert!(without.contains("points") && without.contains("gait archie has no [pattern]"), "{without}");
    let cycle = said("cycle = 0.008", "cycle = 0.007");
    assert!(cycle.contains("pattern.T_c = 12 s must be whole bus cycles of 7 ms: 11.998 s"), "{cycle}");
}
