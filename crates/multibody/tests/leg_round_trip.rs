//! Legs forth and back over random postures, in cm: the pose by the product of the rows, the angles in closed form.
//!
//! 10^6 postures for each leg, 10^6 poses around each singular set, 10^5 for what needs no more.

use crate::legs::{self, Dice, apart, heights, leg, mirrored, off, posture};
use multibody::LegError;
use nalgebra::{Matrix3, Rotation3, Vector3};

/// Entry of a rotation, and cm: what the products of six rows round to.
const POSE: f64 = 1e-12;

const POSES: usize = 1_000_000;
const FEW: usize = 100_000;

/// Angles come back to 1e-9 rad, poses to 1e-12 cm. Left out: rho <= 0, where another posture has the same pose (0.55 %,
/// which must come back as a pose); and of the angles, not of the pose, knees under 1e-3 deg (one posture in 90,000), where
/// rounding of the pose by 1e-16 is divided by the bend.
#[test]
fn random_postures_come_back() {
    for side in [1.0, -1.0] {
        let (leg, mut dice) = (leg(side), Dice(1));
        let (mut angle, mut at_straight, mut rotation, mut position) = (0.0, 0.0, 0.0_f64, 0.0_f64);
        let mut others = 0;
        for _ in 0..POSES {
            let q = posture(side, dice.units());
            let pose = leg.pose(&q);
            let back = match leg.angles(&pose.0, &pose.1) {
                Ok(back) => back,
                // The other posture may need more of the knee, or lie inside of it.
                Err(LegError::KneeLimit { .. }) if heights(&q).0 <= 0.0 => continue,
                Err(e) => panic!("{q:?}: {e}"),
            };
            let (r, p) = off(&leg.pose(&back), &pose);
            (rotation, position) = (rotation.max(r), position.max(p));
            assert!(r < POSE && p < POSE, "{q:?}: pose {r}, {p} cm off");
            if heights(&q).0 <= 0.0 {
                others += 1;
            } else if q[2].abs().to_degrees() < 1e-3 {
                at_straight = f64::max(at_straight, apart(&back, &q));
            } else {
                let d = apart(&back, &q);
                assert!(d < 1e-9, "{q:?}: {d} rad off");
                angle = f64::max(angle, d);
            }
        }
        println!(
            "side {side}: angles {angle:.1e} rad ({at_straight:.1e} at the straight knee), rotation {rotation:.1e}, position {position:.1e} cm; {others} with the hip below the ankle"
        );
        assert!((others as f64) < 0.01 * POSES as f64);
        assert!(at_straight < 1e-6, "{at_straight}");
    }
}

/// With the knee exactly straight the pose is met as everywhere; angles to what rounding of its cosine leaves, 1e-7 rad
/// (reached: 7.3e-8 in 10^6).
#[test]
fn straight_knees_meet_their_pose() {
    for side in [1.0, -1.0] {
        let (leg, mut dice, mut worst) = (leg(side), Dice(2), [0.0_f64; 2]);
        for _ in 0..FEW {
            let q = posture(side, {
                let mut u = dice.units();
                u[2] = -1.0;
                u
            });
            let pose = leg.pose(&q);
            let back = leg.angles(&pose.0, &pose.1).unwrap_or_else(|e| panic!("{q:?}: {e}"));
            let (r, p) = off(&leg.pose(&back), &pose);
            assert!(r < POSE && p < POSE, "{q:?}: pose {r}, {p} cm off");
            worst = [worst[0].max(p), worst[1].max(apart(&back, &q))];
        }
        println!("side {side}: position {:.1e} cm, angles {:.1e} rad", worst[0], worst[1]);
        assert!(worst[1] < 1e-7, "{} rad", worst[1]);
    }
}

/// The mirror image of a pose has the mirrored angles on the other leg, and the same error where it has none.
#[test]
fn legs_mirror_each_other() {
    let (left, right, mut dice) = (leg(1.0), leg(-1.0), Dice(3));
    let flip = Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, 1.0));
    // Frame {6} has x to the right: the mirror image of a frame keeps its hand by another change of sign there.
    let flip_6 = Matrix3::from_diagonal(&Vector3::new(-1.0, 1.0, 1.0));
    for _ in 0..FEW {
        let q = posture(1.0, dice.units());
        let (r, p) = left.pose(&q);
        let image = (flip * r * flip_6, flip * p);
        let (dr, dp) = off(&right.pose(&mirrored(q)), &image);
        assert!(dr < POSE && dp < POSE, "{q:?}: {dr}, {dp} cm");
        // Poses of any kind, most out of reach.
        let away = Vector3::from_fn(|_, _| 70.0 * dice.unit());
        let (r, p) = if dice.unit() > 0.0 { (r, p) } else { (r, away) };
        match (left.angles(&r, &p), right.angles(&(flip * r * flip_6), &(flip * p))) {
            (Ok(l), Ok(r)) => {
                let d = apart(&mirrored(l), &r);
                assert!(d < 1e-9 || l[2].abs() < 2e-5, "{q:?}: {d}");
            }
            (Err(l), Err(r)) => assert_eq!(std::mem::discriminant(&l), std::mem::discriminant(&r)),
            (l, r) => panic!("{q:?}: {l:?}, {r:?}"),
        }
    }
}

/// Around each singular set, at distances from 1e-16 to 1 of it: finite angles that meet the pose, or a named error; never
/// NaN. The sets: knee straight; hip centre on the cylinder around axis 1; theta_5 of 0 and 180 deg.
#[test]
fn nothing_is_nan_around_the_singular_sets() {
    for side in [1.0, -1.0] {
        let (leg, mut dice) = (leg(side), Dice(4));
        let mut counts = [[0usize; 3]; 4];
        for set in 0..4 {
            for _ in 0..POSES / 2 {
                let mut q = posture(side, dice.units());
                let near = dice.unit().signum() * 10f64.powf(8.0 * (dice.unit() - 1.0));
                match set {
                    0 => q[2] = -side * near.abs(),
                    2 => q[4] = near,
                    3 => q[4] = std::f64::consts::PI + near,
                    _ => {}
                }
                let (r, mut p) = leg.pose(&q);
                if set == 1 {
                    let hip: Vector3<f64> = p - r * Vector3::new(side * legs::A6, 0.0, legs::D6);
                    let out = hip.xy().normalize() * (legs::D3 * (1.0 + near)) - hip.xy();
                    p += Vector3::new(out.x, out.y, 0.0);
                } else if set == 0 {
                    p += Rotation3::new(Vector3::repeat(near)) * Vector3::repeat(1e-3 * near);
                }
                match leg.angles(&r, &p) {
                    Ok(back) => {
                        assert!(back.iter().all(|x| x.is_finite()), "{q:?}: {back:?}");
                        counts[set][0] += 1;
                        let (dr, dp) = off(&leg.pose(&back), &(r, p));
                        // A cosine up to 1e-9 above 1 counts as 1: 1.4e-8 cm at the straight knee.
                        assert!(dr < 1e-9 && dp < 1.5e-8, "{q:?}: {dr}, {dp} cm");
                    }
                    Err(LegError::NotFinite | LegError::NotARotation { .. }) => panic!("{q:?}"),
                    Err(LegError::HipSingular { sine, .. }) => {
                        assert!(sine < 1e-6 && set > 1, "{q:?}");
                        counts[set][1] += 1;
                    }
                    Err(_) => counts[set][2] += 1,
                }
            }
        }
        println!("side {side}: [angles, hip singular, other errors] {counts:?}");
        assert!(counts[2][1] > 0 && counts[3][1] > 0 && counts.iter().all(|c| c[0] > 0), "{counts:?}");
    }
}
