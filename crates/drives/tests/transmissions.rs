//! Transmissions against finite differences, energy balance, their own inverses, and at their dead points.

use crate::linkages::{ankle, knee, sample_ankle, sample_knee};
use drives::{Ankle, AnkleGeometry, Gear, Knee, OutOfDomain, Transmission};
use proptest::prelude::*;

/// Angles over Lola's ranges: right knee, ankle adduction, ankle flexion.
fn poses() -> impl Strategy<Value = [f64; 3]> {
    [-0.07..2.09, -0.41..0.41, -0.85..0.76]
}

fn speeds() -> impl Strategy<Value = [f64; 3]> {
    [-5.0..5.0, -5.0..5.0, -5.0..5.0]
}

fn along(q: [f64; 3], qd: [f64; 3], t: f64) -> [f64; 3] {
    std::array::from_fn(|i| q[i] + qd[i] * t)
}

/// Ratio and bias against central differences of the angle along a motion of constant speed.
fn check_derivatives(t: &Transmission, q: [f64; 3], qd: [f64; 3]) -> Result<(), TestCaseError> {
    let h = 1e-5;
    let angle = |x: f64| t.at(along(q, qd, x), [0.0; 3]).unwrap().angle;
    let speed = |x: f64| t.at(along(q, qd, x), qd).unwrap().speed(qd);
    let gear = t.at(q, qd).unwrap();
    let scale = 1.0 + gear.speed(qd).abs() + gear.bias.abs();
    prop_assert!(((angle(h) - angle(-h)) / (2.0 * h) - gear.speed(qd)).abs() < 1e-6 * scale);
    prop_assert!(((speed(h) - speed(-h)) / (2.0 * h) - gear.bias).abs() < 1e-6 * scale);
    Ok(())
}

proptest! {
    #[test]
    fn derivatives_of_the_knee(q in poses(), qd in speeds()) {
        check_derivatives(&knee(1.0), q, qd)?;
    }

    #[test]
    fn derivatives_of_the_ankle(q in poses(), qd in speeds()) {
        check_derivatives(&Transmission::Ankle(ankle(1.0)), q, qd)?;
        check_derivatives(&Transmission::Ankle(Ankle::new(&sample_ankle(-1.0)).unwrap()), q.map(|x| 0.5 * x), qd)?;
    }

    /// A mirrored joint, axis and angle negated, turns its motor alike.
    #[test]
    fn mirrored_knee(q in poses(), qd in speeds()) {
        let (right, left) = (knee(1.0).at(q, qd).unwrap(), knee(-1.0).at(q.map(|x| -x), qd.map(|x| -x)).unwrap());
        prop_assert!((right.angle - left.angle).abs() < 1e-12);
        prop_assert!((right.ratio[0] + left.ratio[0]).abs() < 1e-12);
        prop_assert!((right.bias - left.bias).abs() < 1e-9);
    }

    /// Reflected at the sagittal plane, inner and outer motor change places.
    #[test]
    fn mirrored_ankle(q in poses(), qd in speeds()) {
        let (inner, outer) = (Transmission::Ankle(ankle(1.0)), Transmission::Ankle(ankle(-1.0)));
        let [a, b] = [q, [-q[0], -q[1], q[2]]];
        let (a, b) = (inner.at(a, qd).unwrap(), outer.at(b, [-qd[0], -qd[1], qd[2]]).unwrap());
        prop_assert!((a.angle - b.angle).abs() < 1e-9);
        prop_assert!((a.speed(qd) - b.speed([-qd[0], -qd[1], qd[2]])).abs() < 1e-9);
    }

    #[test]
    fn knee_and_back(q in poses()) {
        for (t, sign) in [(knee(1.0), 1.0), (knee(-1.0), -1.0)] {
            let angle = t.at([sign * q[0], 0.0, 0.0], [0.0; 3]).unwrap().angle;
            prop_assert!((t.joint_angle(angle).unwrap() - sign * q[0]).abs() < 1e-9);
        }
    }

    /// Both motor angles lead back to both joint angles, from a guess that knows nothing.
    #[test]
    fn ankle_and_back(q in poses()) {
        let pair = [ankle(1.0), ankle(-1.0)];
        let motors = pair.map(|a| Transmission::Ankle(a).at(q, [0.0; 3]).unwrap().angle);
        let back = Ankle::joint_angles([&pair[0], &pair[1]], q[0], motors, [0.0; 2]).unwrap();
        prop_assert!((back[0] - q[1]).abs() < 1e-9 && (back[1] - q[2]).abs() < 1e-9, "{back:?} instead of {q:?}");
    }

    /// Nothing but a finite value or an error, whatever comes.
    #[test]
    fn never_nan(q in [any::<f64>(), any::<f64>(), any::<f64>()], qd in [any::<f64>(), any::<f64>(), any::<f64>()]) {
        let all = [Transmission::Harmonic { ratio: -100.0 }, knee(1.0), Transmission::Ankle(ankle(1.0))];
        for t in all {
            if let Ok(Gear { angle, ratio, bias }) = t.at(q, qd) {
                prop_assert!(angle.is_finite() && bias.is_finite() && ratio.iter().all(|n| n.is_finite()));
            }
            prop_assert!(t.joint_angle(q[0]).map_or(true, f64::is_finite));
        }
        let pair = [ankle(1.0), ankle(-1.0)];
        if let Ok(angles) = Ankle::joint_angles([&pair[0], &pair[1]], q[0], [q[1], q[2]], [qd[0], qd[1]]) {
            prop_assert!(angles.iter().all(|x| x.is_finite()));
        }
    }
}

#[test]
fn harmonic_drive() {
    let t = Transmission::Harmonic { ratio: -50.0 };
    let gear = t.at([0.2, 9.0, 9.0], [1.0, 9.0, 9.0]).unwrap();
    assert_eq!(gear, Gear { angle: -10.0, ratio: [-50.0, 0.0, 0.0], bias: 0.0 });
    assert_eq!(t.joint_angle(-10.0), Ok(0.2));
}

/// Pendulum with a rotor behind the sample knee: (I + J N²) q'' + J N φ''₀ = -m g l sin q (errata 1, (2.20)). Energy drift
/// of RK4 in 0.5 s, with the bias and without it.
fn drift(bias: f64) -> f64 {
    let t = Transmission::Knee(Knee::new(&sample_knee()).unwrap());
    let (inertia, rotor, weight) = (0.35, 3e-4, 12.0);
    let gear = |x: [f64; 2]| t.at([x[0], 0.0, 0.0], [x[1], 0.0, 0.0]).unwrap();
    let f = |x: [f64; 2]| {
        let g = gear(x);
        let n = g.ratio[0];
        [x[1], -(weight * x[0].sin() + rotor * n * g.bias * bias) / (inertia + rotor * n * n)]
    };
    let energy = |x: [f64; 2]| {
        0.5 * inertia * x[1] * x[1] + 0.5 * rotor * gear(x).speed([x[1], 0.0, 0.0]).powi(2)
            - weight * x[0].cos()
    };
    let (mut x, h) = ([0.2, 2.5], 1e-4);
    let start = energy(x);
    for _ in 0..5000 {
        let step = |k: [f64; 2], h: f64| [x[0] + h * k[0], x[1] + h * k[1]];
        let k1 = f(x);
        let k2 = f(step(k1, h / 2.0));
        let k3 = f(step(k2, h / 2.0));
        let k4 = f(step(k3, h));
        x = std::array::from_fn(|i| x[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
    }
    (energy(x) - start).abs()
}

#[test]
fn pendulum_with_rotor_keeps_its_energy() {
    let (with, without) = (drift(1.0), drift(0.0));
    assert!(with < 1e-11, "{with} J");
    assert!(without > 1e-2, "the second derivative would not be missed: {without} J");
}

/// F24 of the failure studies: near D = 0 the ratio grows with the distance to the power -1/2, beyond it there is an
/// error that says how far.
#[test]
fn ankle_at_its_dead_point() {
    let short = AnkleGeometry { coupler: 0.04, ..sample_ankle(0.0) };
    let t = Transmission::Ankle(Ankle::new(&short).unwrap());
    let at = |q2: f64| t.at([0.0, 0.0, q2], [0.0, 0.0, 1.0]);
    let (mut inside, mut outside) = (0.0, 1.5);
    for _ in 0..200 {
        let middle = 0.5 * (inside + outside);
        if at(middle).is_ok() { inside = middle } else { outside = middle }
    }
    let ratio = |distance: f64| at(inside - distance).unwrap().ratio[2].abs();
    for distance in [1e-4, 1e-5, 1e-6] {
        let slope = (ratio(distance).ln() - ratio(distance / 10.0).ln()) / 10.0_f64.ln();
        assert!((slope + 0.5).abs() < 0.02, "slope {slope} at {distance}");
    }
    let margin = |distance: f64| match at(inside + distance) {
        Err(OutOfDomain::Coupler { margin }) => margin,
        other => panic!("{other:?}"),
    };
    assert!(margin(1e-3) < 0.0 && margin(2e-3) < margin(1e-3));
    let said = OutOfDomain::Coupler { margin: margin(1e-3) }.to_string();
    assert!(said.contains("ankle") && said.contains("m^2"), "{said}");
}

/// The knee's lever is 0 where screw and lever are in line: attachment at 32.5 deg, so at 147.5 and -32.5 deg.
#[test]
fn knee_at_its_dead_points() {
    let at = |degrees: f64| knee(1.0).at([degrees.to_radians(), 0.0, 0.0], [1.0, 0.0, 0.0]);
    for (inside, outside) in [(147.0, 148.0), (-32.0, -33.0)] {
        let lever = at(inside).unwrap().ratio[0] * 0.01 / std::f64::consts::TAU;
        assert!(lever > 0.0 && lever < 1e-3, "{lever}");
        assert!(matches!(at(outside), Err(OutOfDomain::Lever { margin }) if margin < 0.0 && margin > -1e-3));
    }
    let beyond = knee(1.0).at([2.5, 0.0, 0.0], [0.0; 3]).unwrap().angle + 100.0;
    assert!(
        matches!(knee(1.0).joint_angle(beyond), Err(OutOfDomain::NoAngle { residual }) if residual > 90.0)
    );
}

/// A linkage whose parts do not meet is refused when it is built, not when it moves.
#[test]
fn impossible_linkages() {
    let short = AnkleGeometry { coupler: 1e-4, ..sample_ankle(0.0) };
    assert!(matches!(Ankle::new(&short), Err(OutOfDomain::Coupler { .. })));
    for attachment in [[-0.34, 0.06, 0.0], [-0.17, 0.03, 0.0]] {
        let straight = drives::KneeGeometry { attachment, ..sample_knee() };
        assert!(Knee::new(&straight).is_err(), "{attachment:?}");
    }
}

/// Motor angles that no pose of the foot has.
#[test]
fn ankle_motors_too_far() {
    let pair = [ankle(1.0), ankle(-1.0)];
    let error = Ankle::joint_angles([&pair[0], &pair[1]], 0.0, [500.0, -500.0], [0.0; 2]).unwrap_err();
    assert!(matches!(error, OutOfDomain::NoAngle { residual } if residual > 1.0), "{error:?}");
}
