//! Legs against numbers that were computed apart from this project (errata 3, V1 to V6), in cm.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::legs::{A6, D6, STANDING, leg, rows};
use multibody::LegError;
use nalgebra::{Matrix3, Vector3};

/// The printed digits.
const DIGITS: f64 = 1e-11;

fn close(what: &str, is: &[f64], wanted: &[f64]) {
    assert_eq!(is.len(), wanted.len());
    for (a, b) in is.iter().zip(wanted) {
        assert!((a - b).abs() < DIGITS, "{what}: {is:?} is not {wanted:?}");
    }
}

fn entries(r: &Matrix3<f64>) -> Vec<f64> {
    r.transpose().iter().copied().collect()
}

#[rustfmt::skip]
const V1: (f64, [f64; 6], [f64; 3], [f64; 9]) = (1.0, [0.1, 0.2, -0.7, 0.4, 1.4, -0.05],
    [55.219967872722, 19.200209481480, -8.640259495835],
    [0.074769632876, -0.095717363039, -0.992596437840, 0.996661840171, 0.039895478696, 0.071228695952,
     0.032782287090, -0.994608735731, 0.098380813478]);
#[rustfmt::skip]
const V1R: (f64, [f64; 6], [f64; 3], [f64; 9]) = (-1.0, [-0.1, -0.2, 0.7, -0.4, PI - 1.4, 0.05],
    [55.219967872722, -19.200209481480, -8.640259495835],
    [-0.074769632876, -0.095717363039, -0.992596437840, 0.996661840171, -0.039895478696, -0.071228695952,
     -0.032782287090, -0.994608735731, 0.098380813478]);

/// V1 and V1R: forward kinematics of both legs; the angles come back to the printed digits.
#[test]
fn pose_of_both_legs() {
    for (side, q, position, rotation) in [V1, V1R] {
        let (r, p) = leg(side).pose(&q);
        close("P", p.as_slice(), &position);
        close("R", &entries(&r), &rotation);
        let back = leg(side).angles(&Matrix3::from_row_slice(&rotation), &position.into()).unwrap();
        close("theta", &back, &q);
    }
}

/// V1b: T_6^3 of the right leg, (3-95), not (3-25).
#[test]
fn hip_of_the_right_leg() {
    let mut pose = (Matrix3::identity(), Vector3::zeros());
    for (row, theta) in rows(-1.0)[3..].iter().zip([0.3, 1.2, -0.4]) {
        let (r, p) = row.transform(theta);
        pose = (pose.0 * r, pose.1 + pose.0 * p);
    }
    #[rustfmt::skip]
    close("R", &entries(&pose.0), &[0.433927975266, -0.137385791686, -0.890410948116, -0.273394621010, 0.921623665037,
        -0.275436383301, 0.858464846971, 0.362953115824, 0.362357754477]);
    close("P", pose.1.as_slice(), &[-5.991640453953, 0.429264344452, -3.357972125128]);
}

/// V2: hip centre of V1 and the angle psi that the plane of the leg takes from theta_1.
#[test]
fn hip_centre_and_psi() {
    let (r, p) = leg(1.0).pose(&V1.1);
    let hip: Vector3<f64> = p - r * Vector3::new(A6, 0.0, D6);
    close("P_5", hip.as_slice(), &[58.771643679973, 13.333988392716, -9.217363557454]);
    close("psi", &[hip.y.atan2(hip.x) - V1.1[0]], &[0.123101155107]);
}

/// V3: angles of both legs under an upright torso.
#[test]
fn angles_under_an_upright_torso() {
    let angles = |side: f64| leg(side).angles(&STANDING, &Vector3::new(52.0, side * 10.0, 6.0)).unwrap();
    let left = [-0.053710554207, 0.708601250115, -1.081163099684, 0.372561849569, 1.624506881002, 0.0];
    close("left", &angles(1.0), &left);
    let right = [0.053710554207, -0.708601250115, 1.081163099684, -0.372561849569, 1.517085772588, 0.0];
    close("right", &angles(-1.0), &right);
}

/// V4: angles of both legs under a torso turned about all three axes.
#[test]
fn angles_under_a_turned_torso() {
    #[rustfmt::skip]
    let r = Matrix3::new(0.049979169271, 0.079814821411, -0.995555963732, 0.993760669166, 0.095540003756, 0.057548589053,
        0.099708650872, -0.992220591383, -0.074541820315);
    let angles = |side: f64| leg(side).angles(&r, &Vector3::new(50.0, side * 9.0, -7.0)).unwrap();
    #[rustfmt::skip]
    close("left", &angles(1.0),
        &[-0.078383981411, 0.504126339624, -1.225802203154, 0.796302729371, 1.591381647304, -0.101693146401]);
    #[rustfmt::skip]
    close("right", &angles(-1.0),
        &[0.069045872400, -0.515171943349, 1.199013363623, -0.759053908276, 1.444363862215, -0.090652556346]);
}

/// V5c: the hip below axis 2 (w < 0) but above axis 1. V5: below both (rho < 0): the posture above axis 1 with the same pose
/// is what comes back.
#[test]
fn hip_below_the_ankle() {
    #[rustfmt::skip]
    let r = Matrix3::new(-0.169523123381, -0.895711797309, 0.411050224183, 0.985270373043, -0.144530890114, 0.091395370816,
        -0.022454457076, 0.420489236444, 0.907019624591);
    let back = leg(1.0).angles(&r, &Vector3::new(4.712362098931, 13.493397315193, -42.630804180858)).unwrap();
    close("V5c", &back, &[0.05, -1.0, -1.2, 0.2, 1.5, 0.1]);
    #[rustfmt::skip]
    let r = Matrix3::new(-0.170794607732, -0.731376099718, 0.660241018667, 0.985206745794, -0.136307251059, 0.103865303883,
        0.014031037441, 0.668213539274, 0.743837210631);
    let p = Vector3::new(-0.669297551690, 13.224089872380, -36.778487275931);
    let back = leg(1.0).angles(&r, &p).unwrap();
    #[rustfmt::skip]
    close("V5", &back,
        &[0.574512635272, -0.881028003229, -1.540802289835, 0.163621205887, 1.845852997208, -0.298491732913]);
    assert!((leg(1.0).pose(&back).1 - p).amax() < DIGITS);
}

/// V6: hip centres that no left leg reaches, the straight leg, and a bent one, under an upright torso.
#[test]
fn hip_centres_in_and_out_of_reach() {
    let at = |x, y, z| {
        let hip = Vector3::new(x, y, z);
        leg(1.0).angles(&STANDING, &(hip + STANDING * Vector3::new(A6, 0.0, D6)))
    };
    assert!(matches!(at(5.0, 5.0, 20.0), Err(LegError::InsideAnkleCylinder { radius: 7.4, .. })));
    assert!(matches!(at(64.1, 7.4, 0.0), Err(LegError::TooFar { reach: 56.0, .. })));
    assert!(matches!(at(40.0, 7.4, 0.0), Err(LegError::KneeLimit { .. })));
    close("straight", &at(64.0, 7.4, 0.0).unwrap(), &[0.0, 0.0, 0.0, 0.0, FRAC_PI_2, 0.0]);
    let bent = at(60.0, 7.4, 5.0).unwrap();
    for (a, b) in bent.iter().zip([0.0, 0.49304759, -0.73905926, 0.24601167, FRAC_PI_2, 0.0]) {
        assert!((a - b).abs() < 1e-8, "{bent:?}");
    }
}
