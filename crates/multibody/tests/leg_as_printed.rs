//! What the thesis of 2013 prints about its legs and is not used, coded as printed, so that the evidence stays: each test
//! shows where it goes wrong, and by how much. Numbers were computed apart from this project (errata 3, sections 1 and 4).
//! In cm.

use crate::legs::{A1, A2, A3, A6, D3, D6, Dice, STANDING, apart, heights, leg, off, posture, rows};
use nalgebra::{Matrix3, Matrix4, Vector3};

/// Which formulas are taken as printed.
#[derive(Clone, Copy)]
struct Printed {
    /// (3-30), (3-69): psi by its sine.
    psi: bool,
    /// (3-52), (3-91): the positive root for cos(phi + theta_2).
    root: bool,
    /// (3-62), (3-98): sqrt(1 - r33).
    theta_5: bool,
    /// (3-37), (3-76): the knee's cosine as it comes.
    knee: bool,
}

const ALL: Printed = Printed { psi: true, root: true, theta_5: true, knee: true };

/// (3-27)-(3-64) of the left leg, side +1; (3-67)-(3-100) of the right one, with (3-75) and (3-84) where (3-80) differs.
fn angles(side: f64, which: Printed, r: &Matrix3<f64>, p: &Vector3<f64>) -> [f64; 6] {
    let hip: Vector3<f64> = p + r * Vector3::new(-side * A6, 0.0, -D6);
    let across = hip.x.hypot(hip.y);
    let rho = (across * across - D3 * D3).sqrt();
    let psi = if which.psi { (D3 / across).asin() } else { D3.atan2(rho) };
    let t1 = hip.y.atan2(hip.x) - side * psi;
    let u = hip.x + side * D3 * t1.sin() - A1 * t1.cos();
    let v = hip.y - side * D3 * t1.cos() - A1 * t1.sin();
    let c3 = (hip.z * hip.z + u * u + v * v - A3 * A3 - A2 * A2) / (2.0 * A2 * A3);
    let c3 = if which.knee { c3 } else { c3.min(1.0) };
    let t3 = (-side * (1.0 - c3 * c3).sqrt()).atan2(c3);
    let phi = (A3 * t3.sin()).atan2(A3 * t3.cos() + A2);
    let w = if which.root { u.hypot(v) } else { u * t1.cos() + v * t1.sin() };
    let t2 = (side * hip.z).atan2(w) - phi;
    let mut three = Matrix3::identity();
    for (row, t) in rows(side).iter().zip([t1, t2, t3]) {
        three *= row.transform(t).0;
    }
    let h = three.transpose() * r;
    let s5 = if which.theta_5 { (1.0 - h.m33).sqrt() } else { h.m13.hypot(h.m23) };
    let t5 = s5.atan2(-side * h.m33);
    [t1, t2, t3, (-h.m23).atan2(-h.m13), t5, (side * h.m32).atan2(-side * h.m31)]
}

/// (3-62), (3-98): sqrt(1 - r33) for sqrt(1 - r33^2). Right only at 90 deg.
#[test]
fn theta_5_by_the_printed_root() {
    let printed = |side: f64, degrees: f64| {
        let q = [0.1, 0.2 * side, -0.7 * side, 0.3, degrees.to_radians(), 0.1];
        let (r, p) = leg(side).pose(&q);
        assert!(apart(&leg(side).angles(&r, &p).unwrap(), &q) < 1e-12);
        angles(side, ALL, &r, &p)[4].to_degrees()
    };
    for (degrees, left, right) in [(75.0, 77.01, 73.27), (60.0, 67.79, 54.74), (90.0, 90.0, 90.0)] {
        assert!((printed(1.0, degrees) - left).abs() < 5e-3, "{}", printed(1.0, degrees));
        assert!((printed(-1.0, degrees) - right).abs() < 5e-3, "{}", printed(-1.0, degrees));
    }
    assert!((printed(1.0, 10.0) - 55.05).abs() < 5e-3);
    // V3: the same two poses that the corrected form meets.
    let at = |side: f64| angles(side, ALL, &STANDING, &Vector3::new(52.0, side * 10.0, 6.0))[4];
    assert!((at(1.0) - 1.625926908141).abs() < 1e-11 && (at(-1.0) - 1.515665745448).abs() < 1e-11);
}

/// (3-48), (3-87) with the positive root: where the hip is below axis 2, theta_2 and theta_4 of another pose.
#[test]
fn theta_2_by_the_positive_root() {
    let q = [0.05, -1.0, -1.2, 0.2, 1.5, 0.1]; // V5c
    let (r, p) = leg(1.0).pose(&q);
    let root = Printed { psi: false, root: true, theta_5: false, knee: false };
    let back = angles(1.0, root, &r, &p);
    assert!((back[1] + 0.843936507879).abs() < 1e-10 && (back[3] - 0.043936507879).abs() < 1e-10, "{back:?}");
    // The leg is mirrored at axis 2: the hip moves by 2 w, and the torso with it.
    assert!((norm(&leg(1.0).pose(&back), &p) - 2.0 * 3.607173565).abs() < 1e-8);

    // So it is wherever w < 0: 2.5 % of the postures with the hip over axis 1, up to 2 a1 = 16 cm.
    for side in [1.0, -1.0] {
        let mut dice = Dice(11);
        let mut errors = Vec::new();
        let n = 100_000;
        for _ in 0..n {
            let q = posture(side, dice.units());
            let (rho, w) = heights(&q);
            if w < 0.0 && rho > 0.0 {
                let (r, p) = leg(side).pose(&q);
                let error = norm(&leg(side).pose(&angles(side, root, &r, &p)), &p);
                assert!((error + 2.0 * w).abs() < 1e-9, "{q:?}: {error}, w = {w} cm");
                errors.push(error);
            }
        }
        errors.sort_by(f64::total_cmp);
        let (median, worst) = (errors[errors.len() / 2], errors[errors.len() - 1]);
        let share = errors.len() as f64 / f64::from(n);
        println!("side {side}: {share} of the postures, median {median} cm, worst {worst} cm");
        assert!((15.9..2.0 * A1).contains(&worst) && (share - 0.025).abs() < 0.002);
    }
}

fn norm(pose: &(Matrix3<f64>, Vector3<f64>), p: &Vector3<f64>) -> f64 {
    (pose.1 - p).norm()
}

/// (3-30), (3-69): the sine of psi is the same for a hip above and below axis 1, so below it another posture comes back;
/// both poses agree (V5 in `leg_vectors.rs`).
#[test]
fn psi_by_its_sine() {
    let mut below = 0;
    let mut dice = Dice(12);
    let n = 200_000;
    for _ in 0..n {
        below += usize::from(heights(&posture(1.0, dice.units())).0 < 0.0);
    }
    let share = below as f64 / f64::from(n);
    assert!((share - 0.005).abs() < 0.001, "{share}");
}

/// (3-38), (3-77) without a guard: NaN at a third of the poses with a straight knee.
#[test]
fn knee_without_a_guard() {
    for side in [1.0, -1.0] {
        let (mut dice, mut none, n) = (Dice(13), 0, 20_000);
        for _ in 0..n {
            let mut q = posture(side, dice.units());
            q[2] = 0.0;
            let (r, p) = leg(side).pose(&q);
            none += usize::from(angles(side, ALL, &r, &p)[2].is_nan());
            assert!(leg(side).angles(&r, &p).is_ok());
        }
        let share = f64::from(u32::try_from(none).unwrap()) / f64::from(n);
        println!("side {side}: NaN in {share} of the poses");
        assert!((0.25..0.45).contains(&share), "{share}");
    }
}

/// With the positive root and theta_5 put right, nothing else printed for the inverse is wrong while w > 0.
#[test]
fn the_rest_is_right() {
    for side in [1.0, -1.0] {
        let mut dice = Dice(14);
        let which = Printed { psi: true, root: true, theta_5: false, knee: true };
        let mut worst: f64 = 0.0;
        for _ in 0..100_000 {
            let q = posture(side, dice.units());
            if heights(&q).1 > 0.0 && q[2].abs() > 1e-3 {
                let (r, p) = leg(side).pose(&q);
                worst = worst.max(apart(&angles(side, which, &r, &p), &q));
            }
        }
        assert!(worst < 1e-10, "{worst}");
    }
}

/// (3-80), line 2, has the left leg's signs: theta_2 of the right leg by that line.
#[test]
fn right_leg_by_the_left_one_s_signs() {
    let (r, p) = leg(-1.0).pose(&[-0.1, -0.2, 0.7, -0.4, 1.7, 0.05]);
    let hip: Vector3<f64> = p + r * Vector3::new(A6, 0.0, -D6);
    let (s1, c1) = (-0.1f64).sin_cos();
    let line_2 = (hip.x + D3 * s1 - A1 * c1).hypot(hip.y - D3 * c1 - A1 * s1);
    let line_3 = (hip.x - D3 * s1 - A1 * c1).hypot(hip.y + D3 * c1 - A1 * s1);
    let phi = (A3 * 0.7f64.sin()).atan2(A3 * 0.7f64.cos() + A2);
    let theta_2 = |w: f64| (-hip.z).atan2(w) - phi;
    assert!((theta_2(line_3) + 0.2).abs() < 1e-12);
    assert!((theta_2(line_2) + 0.2).abs() > 5e-3, "{}", theta_2(line_2));
}

/// (3-25): entries (2,2) and (3,3) have wrong signs; not a rotation. (3-95), the same matrix, is right.
#[test]
fn hip_of_the_right_leg_by_3_25() {
    let [(s4, c4), (s5, c5), (s6, c6)] = [0.3f64, 1.2, -0.4].map(f64::sin_cos);
    #[rustfmt::skip]
    let printed = |sign: f64| Matrix3::new(
        c4 * c5 * c6 - s4 * s6, -c4 * c5 * s6 - s4 * c6, -c4 * s5,
        s4 * c5 * c6 + c4 * s6, -s4 * c5 * s6 + sign * c4 * c6, -s4 * s5,
        s5 * c6, -s5 * s6, sign * c5,
    );
    let by_rows: Matrix3<f64> =
        rows(-1.0)[3..].iter().zip([0.3, 1.2, -0.4]).map(|(row, t)| row.transform(t).0).product();
    assert!((printed(1.0) - by_rows).amax() < 1e-15, "(3-95)");
    let wrong = printed(-1.0);
    assert!((wrong.determinant() + 0.331).abs() < 5e-4, "{}", wrong.determinant());
    assert!(((wrong * wrong.transpose() - Matrix3::identity()).amax() - 0.645).abs() < 5e-4);
}

/// (3-4) shifts along x by alpha instead of a; the factor Rot(x, alpha) of (3-6) has a 0 at (1, 1). The final matrix of (3-6)
/// is right.
#[test]
fn product_of_one_row_as_printed() {
    let row = rows(1.0)[0];
    let theta = 0.3f64;
    let turn_z = Matrix4::from_euler_angles(0.0, 0.0, theta);
    let shift = |x: f64| Matrix4::new_translation(&Vector3::new(x, 0.0, 0.0));
    let turn_x = Matrix4::from_euler_angles(row.alpha, 0.0, 0.0);
    let right = turn_z * shift(row.a) * turn_x;
    let (r, p) = row.transform(theta);
    assert!((right.fixed_view::<3, 3>(0, 0) - r).amax() < 1e-15);
    assert!((right.fixed_view::<3, 1>(0, 3) - p).amax() < 1e-15);
    let by_3_4 = turn_z * shift(row.alpha) * turn_x;
    assert!((by_3_4[(0, 3)] - row.alpha * theta.cos()).abs() < 1e-15, "1.5 cm instead of 7.6");
    let mut factor = turn_x;
    factor[(0, 0)] = 0.0;
    let by_3_6 = turn_z * shift(row.a) * factor;
    assert!(by_3_6.fixed_view::<3, 3>(0, 0).determinant().abs() < 1e-15);
    assert!(off(&(by_3_6.fixed_view::<3, 3>(0, 0).into(), p), &(r, p)).0 > 0.9);
}
