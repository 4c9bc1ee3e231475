//! Drives of every shipped robot against its URDF, and Lola's against what her joints ask of them.

use crate::robot;
use std::f64::consts::TAU;

use config::Robot;
use config::drive::Drive;
use drives::{Friction, Transmission};
use multibody::{Data, Model};

/// Robots with drives.
fn driven() -> Vec<(Robot, Model)> {
    let folders = std::fs::read_dir(config::root(None).join("robots")).unwrap();
    let names = folders.map(|folder| folder.unwrap().file_name().into_string().unwrap());
    let robots: Vec<_> = names.map(|name| robot::load(&name)).filter(|(r, _)| !r.drives.is_empty()).collect();
    assert!(!robots.is_empty());
    robots
}

/// Joint angles inside of the software ranges, another set for every `seed`.
fn pose(robot: &Robot, seed: usize) -> Vec<f64> {
    let share = |i: usize| 0.5 + 0.49 * ((1 + i) as f64 * (1.7 + seed as f64)).sin();
    robot.joints.iter().enumerate().map(|(i, j)| j.range[0] + share(i) * (j.range[1] - j.range[0])).collect()
}

/// Angle of a drive's motor at the robot's joint angles.
fn motor_angle(drive: &Drive, q: &[f64]) -> f64 {
    let at = std::array::from_fn(|i| drive.joints.get(i).map_or(0.0, |joint| q[*joint]));
    drive.transmission.at(at, [0.0; 3]).unwrap().angle
}

/// A harmonic drive's stator sits on the parent of its joint, its rotor turns about the joint's axis.
#[test]
fn harmonic_drives_sit_on_their_joints() {
    for (robot, _) in driven() {
        let urdf = urdf_rs::read_from_string(&robot.urdf).unwrap();
        let harmonic = |drive: &&Drive| matches!(drive.transmission, Transmission::Harmonic { .. });
        for drive in robot.drives.iter().filter(harmonic) {
            let name = &robot.joints[drive.joints[0]].name;
            let joint = urdf.joints.iter().find(|joint| joint.name == *name).unwrap();
            assert_eq!(drive.stator, joint.parent.link, "{name}");
            assert_eq!(drive.axis, joint.axis.xyz.0, "{name}");
            assert_eq!(joint.origin.rpy.0, [0.0; 3], "{name}: axes of joint and link differ");
        }
    }
}

/// The linkages close in the robot itself: screw lengths from motor angles are distances between points that the URDF's
/// kinematics carry along.
#[test]
fn linkages_close_in_the_robot() {
    for (robot, model) in driven() {
        let urdf = urdf_rs::read_from_string(&robot.urdf).unwrap();
        let links = |joint: usize| {
            let joint = urdf.joints.iter().find(|j| j.name == robot.joints[joint].name).unwrap();
            (joint.parent.link.clone(), joint.child.link.clone())
        };
        let mut data = Data::new(&model);
        let mut place = |q: &[f64], link: &str, at: [f64; 3]| {
            let mut all = model.neutral();
            all[7..].copy_from_slice(q);
            model.forward_kinematics(&mut data, &all);
            model.frame_position(&data, &model.frame(link, at).unwrap())
        };
        let zero = vec![0.0; robot.joints.len()];
        for (drive, seed) in robot.drives.iter().flat_map(|d| (0..20).map(move |seed| (d, seed))) {
            let q = pose(&robot, seed);
            let turned = motor_angle(drive, &q);
            let name = &drive.name;
            match drive.transmission {
                Transmission::Harmonic { ratio } => assert_eq!(turned, ratio * q[drive.joints[0]], "{name}"),
                Transmission::Knee(knee) => {
                    let (g, (upper, lower)) = (knee.geometry(), links(drive.joints[0]));
                    let mut length =
                        |q: &[f64]| (place(q, &lower, g.attachment) - place(q, &upper, g.pivot)).norm();
                    let grown = length(&q) - length(&zero);
                    assert!((grown - turned * g.lead / TAU).abs() < 1e-12, "{name}");
                }
                Transmission::Ankle(ankle) => {
                    let g = ankle.geometry();
                    let (shank, foot) = (links(drive.joints[1]).0, links(drive.joints[2]).1);
                    let screw = (turned / g.belt - g.knee_share * q[drive.joints[0]]) / g.bevel;
                    let mut coupler = |q: &[f64], l: f64| {
                        let nut: [f64; 3] = std::array::from_fn(|k| g.screw_top[k] + l * g.screw_axis[k]);
                        (place(q, &foot, g.attachment) - place(q, &shank, nut)).norm()
                    };
                    // The nut at angles 0, by bisection above the foot's attachment.
                    let (mut near, mut far) = (0.0, 0.5);
                    for _ in 0..60 {
                        let middle = 0.5 * (near + far);
                        if coupler(&zero, middle) > g.coupler {
                            near = middle;
                        } else {
                            far = middle;
                        }
                    }
                    let length = coupler(&q, near + screw * g.lead / TAU);
                    assert!((length - g.coupler).abs() < 1e-12, "{name}: coupler of {length} m");
                }
            }
        }
    }
}

/// Rotors count as much at their joints as rotors of legs, arms and heads do.
#[test]
fn reflected_inertias_are_plausible() {
    for (robot, _) in driven() {
        for drive in &robot.drives {
            for seed in 0..20 {
                let q = pose(&robot, seed);
                let at = std::array::from_fn(|i| drive.joints.get(i).map_or(0.0, |joint| q[*joint]));
                let ratio = drive.transmission.at(at, [0.0; 3]).unwrap().ratio;
                let largest = ratio.iter().fold(0.0_f64, |most, n| most.max(n.abs()));
                let reflected = drive.rotor_inertia * largest * largest;
                assert!((0.01..2.5).contains(&reflected), "{}: {reflected} kg m^2", drive.name);
            }
        }
    }
}

/// Of a joint: largest torque of its drives over the joint's range, and the ratio that goes with it.
fn best(robot: &Robot, joint: usize, seeds: usize) -> (f64, f64) {
    let of_pose = |seed: usize| {
        let q = pose(robot, seed);
        let mut sum = (0.0, 0.0_f64);
        for drive in &robot.drives {
            let moved = if drive.joints.len() == 3 { &drive.joints[1..] } else { &drive.joints[..] };
            if !moved.contains(&joint) {
                continue;
            }
            let slot = drive.joints.iter().position(|j| *j == joint).unwrap();
            let at = std::array::from_fn(|i| drive.joints.get(i).map_or(0.0, |joint| q[*joint]));
            let ratio = drive.transmission.at(at, [0.0; 3]).unwrap().ratio[slot].abs();
            let efficiency = if let Friction::Screw(screw) = drive.friction { screw.direct } else { 1.0 };
            sum.0 += drive.motor.torque(drive.current_limit) * ratio * efficiency;
            sum.1 = sum.1.max(ratio);
        }
        sum
    };
    (0..seeds).map(of_pose).fold((0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a })
}

/// Lola's drives reach the torques and speeds that URDF and `speed_limit` name: at the current limit and the best lever,
/// and without load at that lever.
#[test]
fn lola_has_the_torques_and_speeds_of_her_joints() {
    let (robot, _) = robot::load("lola");
    let urdf = urdf_rs::read_from_string(&robot.urdf).unwrap();
    for (i, joint) in robot.joints.iter().enumerate() {
        let limit = &urdf.joints.iter().find(|j| j.name == joint.name).unwrap().limit;
        let (torque, ratio) = best(&robot, i, 200);
        let drive = &robot.drives[i];
        let speed = drive.voltage_limit / drive.motor.torque_constant / ratio;
        assert!(torque >= 0.999 * limit.effort, "{}: {torque} of {} N m", joint.name, limit.effort);
        assert!(speed >= 0.99 * joint.speed_limit, "{}: {speed} of {} rad/s", joint.name, joint.speed_limit);
    }
}

/// One leg holds her low: hip, knee and foot in line, thigh inclined by 35 deg, so the knee stands 0.424 sin 35 before
/// the line of the weight. Motors at their limits hold twice that.
#[test]
fn lola_stands_low_on_one_leg() {
    let (robot, _) = robot::load("lola");
    let drive = &robot.drives[robot.joint("right_knee_flexion").unwrap()];
    let ratio = drive.transmission.at([70.0_f64.to_radians(), 0.0, 0.0], [0.0; 3]).unwrap().ratio[0];
    let needed = robot.total_mass * 9.81 * 0.424 * 35.0_f64.to_radians().sin();
    let Friction::Screw(screw) = drive.friction else { panic!("a knee has a screw") };
    let available = drive.motor.torque(drive.current_limit) * ratio * screw.direct;
    assert!((needed - 145.3).abs() < 0.1 && available > 1.5 * needed, "{needed}, {available} N m");
}

/// Thesis, table 2.4: 46 mechanical states less 30 are 16 elastic drives: arms 6, pelvis 2, hips 6, toes 2. Screws and
/// head are rigid.
#[test]
fn lola_has_16_elastic_drives() {
    let (robot, _) = robot::load("lola");
    let elastic: Vec<&str> =
        robot.drives.iter().filter(|d| d.elasticity.is_some()).map(|d| d.name.as_str()).collect();
    let count = |part: &str| elastic.iter().filter(|name| name.contains(part)).count();
    assert_eq!(elastic.len(), 16);
    assert_eq!(
        [count("shoulder") + count("elbow"), count("pelvis"), count("hip"), count("toe")],
        [6, 2, 6, 2]
    );
}

/// Friction parameters are those of the thesis, table C.1: T_0 N is 0.155 of the rated torque for every gear of ratio 100.
#[test]
fn friction_of_table_c1() {
    let (robot, _) = robot::load("lola");
    let rated = [
        ("pelvis_rotation", 40.0),
        ("pelvis_adduction", 67.0),
        ("right_hip_flexion", 76.0 * 0.1618 / 0.155),
        ("right_shoulder_flexion", 24.0),
        ("left_elbow_flexion", 7.8),
        ("head_pan", 5.0),
    ];
    for (name, rated) in rated {
        let drive = &robot.drives[robot.joint(name).unwrap()];
        let (Friction::Harmonic(gear), Transmission::Harmonic { ratio }) =
            (drive.friction, drive.transmission)
        else {
            panic!("{name} has a harmonic drive");
        };
        let share = gear.starting * ratio.abs() / rated;
        assert!((share - 0.155).abs() < 3e-4, "{name}: {share}");
    }
}
