//! Archie's legs in closed form against his URDF, and what is refused when his file is read.

use crate::robot;
use std::fs;
use std::path::PathBuf;

use config::{Leg, LegError, Robot};
use multibody::{Data, Frame, Model};
use nalgebra::{IsometryMatrix3, Matrix3, Matrix6xX, Rotation3, SMatrix, SVector, Vector3};

const NAME: &str = "archie";

/// A reproducible stream of numbers in -1 .. 1 (splitmix64).
struct Dice(u64);

impl Dice {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, size: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| size * self.unit())
    }
}

/// A leg beside the multibody model of the URDF with the base at rest in the origin.
struct Beside {
    model: Model,
    data: Data,
    leg: Leg,
    sole: Frame,
    ranges: [[f64; 2]; 6],
}

fn both() -> [Beside; 2] {
    [0, 1].map(|side| {
        let (robot, model) = robot::load(NAME);
        let leg = robot.legs.as_ref().unwrap()[side].clone();
        let foot = &robot.feet[side];
        let sole = model.frame(&foot.link, foot.sole).unwrap();
        let ranges = leg.joints.map(|joint| robot.joints[joint].range);
        Beside { data: Data::new(&model), model, leg, sole, ranges }
    })
}

impl Beside {
    fn place(&mut self, q: &[f64; 6]) -> IsometryMatrix3<f64> {
        let mut all = self.model.neutral();
        for (&joint, &angle) in self.leg.joints.iter().zip(q) {
            all[7 + joint] = angle;
        }
        self.model.forward_kinematics(&mut self.data, &all);
        self.model.frame_pose(&self.data, &self.sole)
    }

    /// Posture within the software ranges, `inside` \[rad\] from their ends.
    fn posture(&self, dice: &mut Dice, inside: f64) -> [f64; 6] {
        self.ranges.map(|[lo, hi]| {
            let (middle, half) = ((lo + hi) / 2.0, (hi - lo) / 2.0 - inside);
            middle + half * dice.unit()
        })
    }

    /// Angles by Newton's method on the URDF's kinematics, from a guess: the second route.
    fn newton(&mut self, mut q: [f64; 6], rotation: &Matrix3<f64>, position: &Vector3<f64>) -> [f64; 6] {
        for _ in 0..20 {
            let pose = self.place(&q);
            // Sine of the angle left times its axis; through the arc cosine half of the digits would go.
            let turn = rotation * pose.rotation.matrix().transpose();
            let turn = 0.5 * (turn - turn.transpose());
            let turn = Vector3::new(turn.m32, turn.m13, turn.m21);
            let shift = position - pose.translation.vector;
            let mut error = SVector::<f64, 6>::zeros();
            error.fixed_rows_mut::<3>(0).copy_from(&shift);
            error.fixed_rows_mut::<3>(3).copy_from(&turn);
            if error.amax() < 1e-14 {
                break;
            }
            let mut whole = Matrix6xX::zeros(self.model.n());
            self.model.frame_jacobian_of_joints(&self.data, &self.sole, &mut whole);
            let own = SMatrix::<f64, 6, 6>::from_fn(|row, k| whole[(row, self.leg.joints[k])]);
            let step = own.lu().solve(&error).expect("a regular Jacobian");
            for (angle, change) in q.iter_mut().zip(step.iter()) {
                *angle += change;
            }
        }
        q
    }
}

fn apart(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    let worst = a.iter().zip(b).map(|(x, y)| (x - y).abs());
    worst.fold(0.0, |m, d| if d.is_nan() || m.is_nan() { f64::NAN } else { m.max(d) })
}

/// Any common frame: poses of sole and torso, from the URDF, give the URDF's angles.
#[test]
fn angles_are_those_of_the_urdf() {
    for mut beside in both() {
        let mut dice = Dice(1);
        let mut worst = [0.0_f64; 3];
        for _ in 0..20_000 {
            let q = beside.posture(&mut dice, 0.0);
            // With the hip level with axis 1 or below it, another posture has the same pose.
            let theta = beside.leg.theta(&q);
            if 0.08 + 0.26 * theta[1].cos() + 0.30 * (theta[1] + theta[2]).cos() < 1e-3 {
                continue;
            }
            let sole = beside.place(&q);
            let (rotation, position) = beside.leg.sole_in_torso(&q);
            worst[0] = worst[0].max((rotation - sole.rotation.matrix()).amax());
            worst[1] = worst[1].max((position - sole.translation.vector).amax());
            let common = IsometryMatrix3::new(dice.vector(2.0), dice.vector(3.0));
            let (r, p) = (common.rotation * sole.rotation, (common * sole).translation.vector);
            let torso = (common.rotation.matrix(), &common.translation.vector);
            let back = beside.leg.angles((r.matrix(), &p), torso);
            let back = back.unwrap_or_else(|e| panic!("{q:?}: {e}"));
            worst[2] = worst[2].max(apart(&back, &q));
        }
        println!("rotation {:.1e}, position {:.1e} m, angles {:.1e} rad", worst[0], worst[1], worst[2]);
        assert!(worst[0] < 1e-14 && worst[1] < 1e-14 && worst[2] < 1e-12, "{worst:?}");
    }
}

/// Random smooth paths of the torso over the soles in task space: closed form and Newton on the URDF.
#[test]
fn newton_s_method_agrees_along_smooth_paths() {
    for (side, mut beside) in [-1.0, 1.0].into_iter().zip(both()) {
        let mut dice = Dice(2);
        let mut worst: f64 = 0.0;
        for _ in 0..20 {
            // Middle, amplitude, circular frequency and phase of x, y, z and three small rotations.
            let amplitudes = [0.06, 0.03, 0.02, 0.08, 0.08, 0.08].map(|size| size * dice.unit());
            let waves: [(f64, f64); 6] = std::array::from_fn(|_| (2.0 + dice.unit(), 3.0 * dice.unit()));
            let at = |k: usize, t: f64| amplitudes[k] * (waves[k].0 * t + waves[k].1).sin();
            let mut q: Option<[f64; 6]> = None;
            for step in 0..500 {
                let t = 0.01 * f64::from(step);
                let position = Vector3::new(at(0, t), 0.09 * side + at(1, t), -0.545 + at(2, t));
                let rotation = *Rotation3::new(Vector3::new(at(3, t), at(4, t), at(5, t))).matrix();
                let torso = (&Matrix3::identity(), &Vector3::zeros());
                let closed = beside.leg.angles((&rotation, &position), torso);
                let closed = closed.unwrap_or_else(|e| panic!("{position} {rotation}: {e}"));
                // The first guess is the standing pose's, then the angles of the step before.
                let guess = q.unwrap_or_else(|| beside.ranges.map(|[lo, hi]| f64::midpoint(lo, hi)));
                let next = beside.newton(guess, &rotation, &position);
                worst = worst.max(apart(&next, &closed));
                q = Some(next);
            }
        }
        println!("side {side}: {worst:.1e} rad");
        assert!(worst < 1e-12, "{worst} rad");
    }
}

/// A joint just inside of its software range, at its end, and just outside: named with its index, angle and range.
#[test]
fn joint_limits_are_those_of_the_robot() {
    let torso = (&Matrix3::identity(), &Vector3::zeros());
    for beside in both() {
        let mut dice = Dice(3);
        for k in 0..6 {
            for (end, outwards) in [(0, -1.0), (1, 1.0)] {
                let mut q = beside.posture(&mut dice, 0.02);
                let mut answer = |off: f64| {
                    q[k] = beside.ranges[k][end] + outwards * off;
                    let (r, p) = beside.leg.sole_in_torso(&q);
                    beside.leg.angles((&r, &p), torso)
                };
                assert!(answer(-1e-6).is_ok() && answer(0.0).is_ok(), "joint {k}");
                match answer(1e-3) {
                    Err(LegError::JointLimit { joint, value, range }) => {
                        assert_eq!((joint, range), (beside.leg.joints[k], beside.ranges[k]));
                        assert!((value - (range[end] + outwards * 1e-3)).abs() < 1e-12);
                    }
                    other => panic!("joint {k}: {other:?}"),
                }
            }
        }
    }
}

/// Two matrices that are no rotations must not pass as one because their product is.
#[test]
fn each_pose_must_be_a_rotation() {
    for beside in both() {
        let q = beside.posture(&mut Dice(4), 0.1);
        let (r, p) = beside.leg.sole_in_torso(&q);
        let one = Matrix3::identity();
        let answer = |s: &Matrix3<f64>, t: &Matrix3<f64>| {
            beside.leg.angles((s, &p), (t, &Vector3::zeros())).unwrap_err()
        };
        assert!(matches!(answer(&-r, &-one), LegError::NotARotation { mirrored: true, .. }));
        assert!(matches!(answer(&(r * 2.0), &(one * 0.5)), LegError::NotARotation { mirrored: false, .. }));
        assert_eq!(answer(&(r * f64::NAN), &one), LegError::NotFinite);
    }
}

#[test]
fn other_robots_need_no_legs_in_closed_form() {
    for name in ["lola", "johnnie"] {
        assert!(robot::load(name).0.legs.is_none());
    }
}

/// Archie's directory, to be spoiled; gone when dropped.
struct Copy(PathBuf);

impl Copy {
    fn new(name: &str) -> Self {
        let to = std::env::temp_dir().join(format!("gangwerk-legs-{name}-{}", std::process::id()));
        let from = config::root(None).join("robots").join(NAME);
        fs::create_dir_all(to.join("can")).unwrap();
        for folder in ["", "can"] {
            for file in fs::read_dir(from.join(folder)).unwrap().map(Result::unwrap) {
                if file.path().is_file() {
                    fs::copy(file.path(), to.join(folder).join(file.file_name())).unwrap();
                }
            }
        }
        Self(to)
    }

    /// The error when `from`, which is in the file once or more, is replaced where it is first.
    fn spoiled(&self, file: &str, from: &str, to: &str) -> String {
        let whole = fs::read_to_string(self.0.join(file)).unwrap();
        assert!(whole.contains(from), "{from}");
        fs::write(self.0.join(file), whole.replacen(from, to, 1)).unwrap();
        let error = Robot::load(&self.0).expect_err(to).to_string();
        fs::write(self.0.join(file), whole).unwrap();
        let error = error.replace(&format!("{}: ", self.0.join("robot.toml").display()), "");
        // Lines move when something is added to the file.
        match error.strip_prefix("line ").and_then(|rest| rest.split_once(": ")) {
            Some((_, text)) => text.to_owned(),
            None => error,
        }
    }
}

impl Drop for Copy {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Right leg's rows, spoiled one by one.
#[test]
fn rows_that_are_not_the_urdf_are_refused() {
    let archie = Copy::new("rows");
    let row = |joint: &str, entry: &str, to: &str| {
        let text = fs::read_to_string(archie.0.join("robot.toml")).unwrap();
        let line =
            text.lines().find(|line| line.contains(&format!("joint = \"right_{joint}\", sign"))).unwrap();
        assert!(line.contains(entry), "{line}");
        archie.spoiled("robot.toml", line, &line.replacen(entry, to, 1))
    };
    let reversed = "turns about an axis of the URDF that is 180.000000 deg off the one here; correct `sign` (180 deg: it is \
                    reversed), or angles of the rows before it";
    for (k, joint) in
        ["ankle_adduction", "ankle_flexion", "knee_flexion", "hip_flexion", "hip_adduction", "hip_rotation"]
            .into_iter()
            .enumerate()
    {
        let sign = if joint.ends_with("adduction") || k > 0 { "sign = 1" } else { "sign = -1" };
        assert_eq!(
            row(joint, sign, "sign = -1"),
            format!("leg.right.rows[{k}]: joint `right_{joint}` {reversed}")
        );
    }
    let beside = "correct lengths of the rows before it";
    assert_eq!(
        row("ankle_adduction", "a = 0.08", "a = 0.081"),
        format!(
            "leg.right.rows[1]: the axis of joint `right_ankle_flexion` in the URDF is 1.000000 mm beside the one here; {beside}"
        )
    );
    // Each spoiled entry, and how its one sentence begins.
    let torso = "leg.right.rows[5]: with all joints at zero the torso of the URDF is";
    for (joint, entry, to, begins) in [
        (
            "knee_flexion",
            "d = -0.074",
            "d = -0.075",
            "leg.right.rows[4]: the axis of joint `right_hip_adduction` in the URDF is 1.000000 mm beside",
        ),
        ("hip_rotation", "a = -0.056", "a = -0.057", &format!("{torso} 1.000000 mm and 0.000000 rad off")),
        ("hip_rotation", "d = 0.04", "d = 0.041", &format!("{torso} 1.000000 mm and 0.000000 rad off")),
        (
            "hip_rotation",
            "theta_deg = 0",
            "theta_deg = 1",
            &format!("{torso} 1.291527 mm and 0.017452 rad off"),
        ),
        (
            "knee_flexion",
            "theta_deg = 0",
            "theta_deg = 1",
            "leg.right.rows[3]: the axis of joint `right_hip_flexion` in the URDF is 5.235921 mm beside",
        ),
        (
            "knee_flexion",
            "alpha_deg = 0",
            "alpha_deg = 1",
            "leg.right.rows: row 3: alpha is 0.017453292519943295; the closed form takes 0",
        ),
        (
            "knee_flexion",
            "right_knee_flexion",
            "left_knee_flexion",
            "leg.right.rows[2]: joint `left_knee_flexion`, but from `right_foot` to the torso the URDF has joint `right_knee_flexion` here",
        ),
        (
            "knee_flexion",
            "right_knee_flexion",
            "right_knee",
            "leg.right.rows[2].joint: there is no joint `right_knee`",
        ),
        (
            "knee_flexion",
            "sign = 1",
            "sign = 0.5",
            "leg.right.rows[2].sign: 0.5 is not allowed; it takes 1 or -1",
        ),
        ("knee_flexion", "a = 0.3", "a = nan", "leg.right.rows[2].a: NaN is not allowed"),
    ] {
        let error = row(joint, entry, to);
        assert!(error.starts_with(begins) && !error.contains('\n'), "{error}");
    }
}

/// The robot changed, and not the rows.
#[test]
fn a_urdf_that_is_not_the_rows_is_refused() {
    let archie = Copy::new("urdf");
    let shank = archie.spoiled("archie.urdf", "<origin xyz=\"0 0 -0.26\"/>", "<origin xyz=\"0 0 -0.261\"/>");
    assert!(
        shank.starts_with(
            "leg.right.rows[2]: the axis of joint `right_knee_flexion` in the URDF is 1.000000 mm beside"
        ),
        "{shank}"
    );
    let fixed = archie.spoiled("archie.urdf", "type=\"revolute\"", "type=\"fixed\"");
    assert!(
        fixed.contains("archie.urdf: joint `right_hip_rotation` is in the joint order but not in the URDF"),
        "{fixed}"
    );
    let misspelt = archie.spoiled("robot.toml", "[leg.right]", "[leg.rihgt]");
    assert!(
        misspelt.contains("leg.right: missing") && misspelt.contains("leg.rihgt: unknown key"),
        "{misspelt}"
    );
}
