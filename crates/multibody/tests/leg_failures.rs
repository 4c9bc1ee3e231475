//! What a leg refuses, at poses where that is known without its formulas: from the product of its rows, tangents and
//! circles. In m.

use std::f64::consts::PI;

use crate::legs::{self, Dice, posture, rows};
use multibody::{ClosedFormLeg, DhRow, LegError};
use nalgebra::{Matrix3, Vector3};

fn metres(side: f64) -> [DhRow; 6] {
    rows(side).map(|row| DhRow { a: 0.01 * row.a, d: 0.01 * row.d, ..row })
}

fn leg(side: f64) -> ClosedFormLeg {
    ClosedFormLeg::new(&metres(side)).expect("the rows of the thesis")
}

/// Frame {k} in frame {0}.
fn frame(side: f64, q: &[f64; 6], k: usize) -> (Matrix3<f64>, Vector3<f64>) {
    metres(side)[..k].iter().zip(q).fold((Matrix3::identity(), Vector3::zeros()), |(r, p), (row, theta)| {
        let (turn, shift) = row.transform(*theta);
        (r * turn, p + r * shift)
    })
}

/// The answer for a posture whose hip centre is moved by `shift`.
fn shifted(side: f64, q: &[f64; 6], shift: Vector3<f64>) -> Result<[f64; 6], LegError> {
    let (r, p) = leg(side).pose(q);
    leg(side).angles(&r, &(p + shift))
}

/// In the plane of the leg, from axis 2 to the hip centre: where the straight leg ends, and beyond it.
#[test]
fn too_far() {
    let mut dice = Dice(1);
    for side in [1.0, -1.0] {
        for _ in 0..1000 {
            let mut q = posture(side, dice.units());
            (q[1], q[2]) = (q[1] / 2.0, 0.0);
            let from = frame(side, &q, 1);
            let along = (frame(side, &q, 2).1 - from.1).normalize();
            assert!(shifted(side, &q, along * -1e-9).is_ok());
            match shifted(side, &q, along * 1e-6) {
                Err(LegError::TooFar { distance, reach }) => {
                    assert!((distance - 0.560001).abs() < 1e-12 && (reach - 0.56).abs() < 1e-15);
                }
                other => panic!("{q:?}: {other:?}"),
            }
        }
    }
}

/// A knee bent beyond 90 deg by the product of the rows; up to 90 deg there are angles.
#[test]
fn knee_limit() {
    let mut dice = Dice(2);
    for side in [1.0, -1.0] {
        for _ in 0..1000 {
            let mut q = posture(side, dice.units());
            // Hip over the ankle, so that rho is above zero whatever the knee does.
            let bend: f64 = 1.58 + 1.4 * dice.unit().abs();
            q[2] = -side * bend;
            q[1] = side * (0.3 * bend).atan2(1.0);
            if legs::heights(&q).0 < 0.5 {
                continue;
            }
            match shifted(side, &q, Vector3::zeros()) {
                Err(LegError::KneeLimit { angle, limit }) => {
                    assert!((angle - bend).abs() < 1e-9 && limit == PI / 2.0, "{q:?}: {angle}");
                }
                other => panic!("{q:?}: {other:?}"),
            }
            q[2] = -side * (PI / 2.0 - 1e-8);
            assert!(shifted(side, &q, Vector3::zeros()).is_ok(), "{q:?}");
        }
    }
}

/// Hip centre nearer to axis 2 than thigh and shank differ: on a circle of 3.9 cm around it, where 4.1 cm say knee limit.
#[test]
fn too_near() {
    for side in [1.0, -1.0] {
        for step in 0..36 {
            let (sin, cos) = (f64::from(step) * PI / 18.0).sin_cos();
            let q = [0.2, 0.0, 0.0, 0.1, 1.4, 0.2];
            // Axes of the plane of the leg: along frame {1}'s x and y; hip centre is d3 beside it.
            let (plane, ankle) = frame(side, &q, 1);
            let (r, p) = leg(side).pose(&q);
            let hip = frame(side, &q, 3).1;
            let beside = plane.column(2) * plane.column(2).dot(&(hip - ankle));
            let answer = |radius: f64| {
                let at = ankle + beside + (plane.column(0) * cos + plane.column(1) * sin) * radius;
                leg(side).angles(&r, &(p + at - hip))
            };
            match answer(0.039) {
                Err(LegError::TooNear { distance, least }) => {
                    assert!((distance - 0.039).abs() < 1e-12 && (least - 0.04).abs() < 1e-12);
                }
                other => panic!("{step}: {other:?}"),
            }
            assert!(matches!(answer(0.041), Err(LegError::KneeLimit { .. })), "{step}");
        }
    }
}

/// Hip centre inside of the cylinder that the plane of the leg touches, on it, and outside.
#[test]
fn ankle_cylinder() {
    for side in [1.0, -1.0] {
        for step in 0..360 {
            let (sin, cos) = f64::from(step).to_radians().sin_cos();
            let q = posture(side, [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]);
            let (r, p) = leg(side).pose(&q);
            let hip = frame(side, &q, 3).1;
            let answer = |radius: f64| {
                leg(side).angles(&r, &(p + Vector3::new(radius * cos, radius * sin, -side * 0.42) - hip))
            };
            match answer(0.0739) {
                Err(LegError::InsideAnkleCylinder { distance, radius }) => {
                    assert!((distance - 0.0739).abs() < 1e-12 && (radius - 0.074).abs() < 1e-12);
                }
                other => panic!("{step}: {other:?}"),
            }
            // On it rho is zero; 1e-16 m, which is rounding, are sqrt(2 d3 1e-16) = 4e-9 m of rho.
            match answer(0.074) {
                Err(LegError::AnkleSingular { rho, .. }) => assert!(rho < 1e-8),
                Err(LegError::InsideAnkleCylinder { distance, .. }) => assert!(0.074 - distance < 1e-15),
                other => panic!("{step}: {other:?}"),
            }
            // Pythagoras: rho = 1 cm. The knee is then bent by less than 90 deg at a distance of 42 cm.
            assert!(answer(0.074f64.hypot(0.01)).is_ok(), "{step}: {:?}", answer(0.074f64.hypot(0.01)));
        }
    }
}

/// Exactly on the cylinder: no distance is left to say where axis 1 points.
#[test]
fn ankle_singular() {
    let standing = Matrix3::new(0.0, 0.0, -1.0, 1.0, 0.0, 0.0, 0.0, -1.0, 0.0);
    // Frame {6} is 5.6 cm beside and 4 cm below the hip centre, which is at (0, 0.074, 0.42).
    let at = Vector3::new(-0.04, 0.074 + 0.056, 0.42);
    assert!(
        matches!(leg(1.0).angles(&standing, &at), Err(LegError::AnkleSingular { rho, .. }) if rho < 1e-8)
    );
}

/// Flexion and rotation of the hip about one axis: theta_5 of 0 or 180 deg, by the product of the rows.
#[test]
fn hip_singular() {
    let mut dice = Dice(3);
    for side in [1.0, -1.0] {
        for _ in 0..1000 {
            let mut q = posture(side, dice.units());
            q[1] /= 4.0;
            for (off, refused) in [(0.0, true), (9e-7, true), (1.1e-6, false), (1e-3, false)] {
                for theta in [off, PI - off] {
                    q[4] = theta;
                    let answer = shifted(side, &q, Vector3::zeros());
                    let named = matches!(answer, Err(LegError::HipSingular { sine, .. }) if (sine - off).abs() < 1e-12);
                    assert!(if refused { named } else { answer.is_ok() }, "{q:?}: {answer:?}");
                }
            }
        }
    }
}

#[test]
fn poses_that_are_none() {
    let (r, p) = leg(1.0).pose(&[0.1, 0.2, -0.7, 0.4, 1.4, -0.05]);
    for k in 0..3 {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut at = p;
            at[k] = bad;
            assert_eq!(leg(1.0).angles(&r, &at), Err(LegError::NotFinite));
            for l in 0..3 {
                let mut turned = r;
                turned[(k, l)] = bad;
                assert_eq!(leg(1.0).angles(&turned, &p), Err(LegError::NotFinite));
            }
        }
    }
    let answer = |r: Matrix3<f64>| leg(1.0).angles(&r, &p);
    assert!(answer(r * (1.0 + 4e-7)).is_ok(), "R^T R is off by 8e-7");
    for r in [r * (1.0 + 6e-7), r * 0.5, Matrix3::zeros(), Matrix3::repeat(1.0), r * 1e200] {
        assert!(matches!(
            answer(r),
            Err(LegError::NotARotation { mirrored: false, .. } | LegError::NotFinite)
        ));
    }
    assert!(matches!(answer(-r), Err(LegError::NotARotation { mirrored: true, .. })));
}

/// Each sentence has its value and its bound.
#[test]
fn errors_are_sentences() {
    let sentence = |e: LegError| e.to_string();
    assert_eq!(
        sentence(LegError::TooFar { distance: 0.561, reach: 0.56 }),
        "the hip is 0.561000 m from the ankle; the straight leg has 0.560000 m"
    );
    assert_eq!(
        sentence(LegError::KneeLimit { angle: 1.6, limit: PI / 2.0 }),
        "the knee would be bent by 91.673 deg; it bends up to 90 deg"
    );
    assert_eq!(
        sentence(LegError::JointLimit { joint: 3, value: 1.6, range: [0.0, 1.5] }),
        "joint 3 would be at 91.673 deg; its range is 0.000 to 85.944 deg"
    );
    for e in [
        LegError::InsideAnkleCylinder { distance: 0.05, radius: 0.074 },
        LegError::AnkleSingular { rho: 1e-9, least: 1e-8 },
        LegError::TooNear { distance: 0.03, least: 0.04 },
        LegError::HipSingular { sine: 1e-7, least: 1e-6 },
        LegError::NotARotation { error: 0.5, tolerance: 1e-6, mirrored: false },
    ] {
        let numbers = sentence(e).matches(|c: char| c.is_ascii_digit()).count();
        assert!(numbers >= 2, "{e}");
    }
}

/// Every entry that the pattern fixes, off by a little: refused, and named.
#[test]
fn rows_without_the_pattern() {
    type Entry = fn(&mut DhRow) -> &mut f64;
    const ENTRIES: [(&str, Entry); 4] =
        [("a", |r| &mut r.a), ("alpha", |r| &mut r.alpha), ("d", |r| &mut r.d), ("theta", |r| &mut r.theta)];
    // Lengths that the leg may have.
    let free = [(0, "a"), (1, "a"), (2, "a"), (2, "d"), (5, "a"), (5, "d")];
    for side in [1.0, -1.0] {
        for row in 0..6 {
            for (entry, get) in ENTRIES {
                let refused = |change: f64| {
                    let mut rows = metres(side);
                    *get(&mut rows[row]) += change;
                    ClosedFormLeg::new(&rows).err().map(|e| {
                        assert_eq!((e.row, e.entry), (row, entry), "{e}");
                        assert!(e.to_string().starts_with(&format!("row {}: {entry} is ", row + 1)), "{e}");
                    })
                };
                let fixed = entry != "theta" && !free.contains(&(row, entry));
                assert_eq!(refused(1e-9).is_some(), fixed, "row {row}, {entry}");
                assert!(refused(f64::NAN).is_some() && refused(f64::INFINITY).is_some());
            }
        }
        for row in [1, 2] {
            let mut rows = metres(side);
            rows[row].a = 0.0;
            assert_eq!(ClosedFormLeg::new(&rows).unwrap_err().row, row);
        }
    }
}
