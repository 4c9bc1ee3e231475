//! Stability of the single elastic joint against the determinants of the thesis, its roots, and tables of sampled loops.

use drives::elastic_joint::{ElasticJoint, Gains, HeldJoint};
use drives::{Feedback, Sampled};

const STANCE: ElasticJoint = ElasticJoint { stiffness: 3.1e4, link: 10.0, rotor: 1.2, friction: 0.0 };
const AIR: ElasticJoint = ElasticJoint { link: 0.5, ..STANCE };

fn gains(position: f64, speed: f64) -> Gains {
    Gains { position, speed }
}

fn close(a: f64, b: f64, relative: f64) -> bool {
    (a - b).abs() <= relative * b.abs()
}

/// The closed forms that the thesis prints.
#[test]
fn hurwitz_determinants_are_those_of_the_thesis() {
    for joint in [STANCE, AIR] {
        let (k, jj, jm) = (joint.stiffness, joint.link, joint.rotor);
        for (kp, kd) in [(100.0, 3.0), (3100.0, 500.0), (2.5e4, 2000.0)] {
            let [h2, h3] = joint.hurwitz(Feedback::Motor, gains(kp, kd));
            assert!(close(h2, k * k * kd * (jj + jm), 1e-12), "(5.47)");
            assert!(close(h3, (k * kd * jj).powi(2), 1e-9), "(5.48)");
            let [h2, h3] = joint.hurwitz(Feedback::LinkMotor, gains(kp, kd));
            assert!(close(h2, k * kd * (k * (jm + jj) - kp * jj), 1e-12), "(5.51)");
            assert!(close(h3, k * jj * jj * kd * kd * (k - kp), 1e-9), "(5.52)");
            let a = joint.characteristic(Feedback::Link, gains(kp, kd));
            assert!(a[3] == 0.0 && !joint.is_stable(Feedback::Link, gains(kp, kd)), "(5.44)");
        }
    }
}

/// The conditions say what the poles say, with friction of the rotor and without.
#[test]
fn poles_agree_with_the_conditions() {
    for joint in [STANCE, AIR] {
        for friction in [0.0, 40.0] {
            let joint = ElasticJoint { friction, ..joint };
            for feedback in Feedback::ALL {
                for kp in [0.01, 0.5, 0.99, 1.01, 5.0] {
                    for kd in [1.0, 30.0, 1000.0] {
                        let gains = gains(kp * joint.stiffness, kd);
                        let growth = joint.growth(feedback, gains);
                        // On the limit of stability itself neither can tell.
                        if growth.abs() > 1e-6 {
                            assert_eq!(
                                growth < 0.0,
                                joint.is_stable(feedback, gains),
                                "{feedback:?} {gains:?}"
                            );
                        }
                    }
                }
            }
        }
    }
}

/// Viscous friction of the rotor makes link-side control stable up to (1 + u)(J_J - J_M u) K/J_J > K_p, u = K_d/d.
#[test]
fn friction_makes_link_side_control_stable() {
    let joint = ElasticJoint { friction: 40.0, ..STANCE };
    for u in [0.5, 2.0, 5.0] {
        let (jj, jm) = (joint.link, joint.rotor);
        let limit = (1.0 + u) * (jj - jm * u) * joint.stiffness / jj;
        let stable = |kp| joint.is_stable(Feedback::Link, gains(kp, 40.0 * u));
        assert!(stable(0.999 * limit) && !stable(1.001 * limit), "u = {u}");
    }
    assert!(!joint.is_stable(Feedback::Link, gains(1.0, 40.0 * joint.link / joint.rotor * 1.001)));
}

/// Spectral radii of errata 2.14.
#[test]
fn sampled_vectors() {
    let exact = Sampled { delay: false, difference: false };
    for (feedback, period, radius) in [
        (Feedback::LinkMotor, 1e-3, 0.992_772_614_333),
        (Feedback::Motor, 1e-3, 0.992_622_261_549),
        (Feedback::LinkMotor, 3.5e-3, 0.974_965_916_015),
    ] {
        let found = STANCE.held(period).spectral_radius(feedback, gains(3100.0, 500.0), exact);
        assert!((found - radius).abs() < 1e-11, "{feedback:?}, {period} s: {found}");
    }
}

/// A step so short that nobody sees it: e^(T growth).
#[test]
fn fast_sampling_is_continuous() {
    let exact = Sampled { delay: false, difference: false };
    for feedback in Feedback::ALL {
        let (gains, period) = (gains(3100.0, 500.0), 1e-6);
        let rate = AIR.held(period).spectral_radius(feedback, gains, exact).ln() / period;
        let growth = AIR.growth(feedback, gains);
        assert!((rate - growth).abs() < 1e-3 * growth.abs(), "{feedback:?}: {rate}, {growth}");
    }
}

/// What the table of errata 2.14 says of one loop: largest K_p/K at a K_d, smallest and largest K_d at K_p = 0.1 K.
type Limits = ((f64, f64), Option<[f64; 2]>);

/// Joint, T, delay, difference; motor-side; link and motor. Above 20 stands for a limit that was not reached.
#[rustfmt::skip]
const TABLE: [(ElasticJoint, f64, bool, bool, Limits, Limits); 14] = [
    (STANCE, 1.0, false, false, ((20.0, 0.0), Some([1.6, 2380.0])), ((0.996, 2270.0), Some([1.7, 2380.0]))),
    (STANCE, 1.0, false, true, ((20.0, 0.0), Some([1.6, 2343.0])), ((0.993, 2306.0), Some([1.7, 2343.0]))),
    (STANCE, 1.0, true, false, ((9.198, 720.0), Some([4.8, 1172.0])), ((0.964, 1172.0), Some([5.1, 1172.0]))),
    (STANCE, 1.0, true, true, ((5.113, 485.0), Some([5.0, 940.0])), ((0.953, 940.0), Some([5.1, 940.0]))),
    (STANCE, 3.5, false, false, ((11.927, 665.0), Some([5.6, 665.0])), ((0.950, 665.0), Some([6.0, 665.0]))),
    (STANCE, 3.5, false, true, ((1.656, 247.0), Some([6.7, 577.0])), ((0.913, 596.0), Some([6.0, 586.0]))),
    (STANCE, 3.5, true, false, ((0.370, 144.0), Some([24.0, 232.0])), ((0.616, 247.0), Some([18.1, 247.0]))),
    (STANCE, 3.5, true, true, ((0.086, 65.0), None), ((0.458, 138.0), Some([18.1, 129.0]))),
    (AIR, 1.0, false, false, ((20.0, 0.0), Some([1.6, 2380.0])), ((1.199, 61.0), Some([1.6, 2380.0]))),
    (AIR, 1.0, false, true, ((20.0, 0.0), Some([1.6, 2343.0])), ((1.186, 62.0), Some([1.6, 2343.0]))),
    (AIR, 1.0, true, false, ((9.142, 731.0), Some([5.1, 1154.0])), ((1.147, 169.0), Some([4.8, 1172.0]))),
    (AIR, 1.0, true, true, ((5.004, 478.0), Some([5.5, 940.0])), ((1.110, 169.0), Some([4.8, 940.0]))),
    (AIR, 3.5, false, false, ((11.879, 665.0), Some([6.0, 665.0])), ((1.150, 186.0), Some([5.6, 665.0]))),
    (AIR, 3.5, false, true, ((1.284, 259.0), Some([10.9, 542.0])), ((0.993, 183.0), Some([5.7, 559.0]))),
];

/// Gains from `low` to `high`, 1.6 % apart.
fn grid(low: f64, high: f64) -> impl DoubleEndedIterator<Item = f64> + Clone {
    let count = ((high / low).ln() / 1.016_f64.ln()).ceil() as i32;
    (0..=count).map(move |i| low * 1.016_f64.powi(i))
}

fn check(name: &str, held: &HeldJoint, feedback: Feedback, sampled: Sampled, ((most, at), range): Limits) {
    let k = STANCE.stiffness;
    let stable = |kp: f64, kd: f64| held.is_stable(feedback, gains(kp * k, kd), sampled);
    if at > 0.0 {
        // K_d of the table is one of a grid, and rounded: where the limit has a corner, its neighbours count.
        let near = |kp: f64| [0.97, 0.985, 1.0, 1.015].iter().any(|f| stable(kp * most, f * at));
        assert!(near(0.985) && !near(1.03) && !near(1.3), "{name}: K_p = {most} K, K_d = {at}");
    } else {
        assert!(grid(100.0, 2400.0).any(|kd| stable(20.0, kd)), "{name}");
    }
    let found: Vec<f64> = grid(1.0, 3000.0).filter(|kd| stable(0.1, *kd)).collect();
    match range {
        None => assert!(found.is_empty(), "{name}: {found:?}"),
        Some(range) => {
            let ends = [*found.first().unwrap(), *found.last().unwrap()];
            for (end, wanted) in ends.into_iter().zip(range) {
                // One of the grid, and a digit of the table.
                assert!((end - wanted).abs() < 0.035 * wanted + 0.05, "{name}: {end} for {wanted}");
            }
        }
    }
}

#[test]
fn sampled_tables() {
    for (joint, ms, delay, difference, motor, mixed) in TABLE {
        let (held, sampled) = (joint.held(1e-3 * ms), Sampled { delay, difference });
        let name = format!("J_J {}, {ms} ms, {sampled:?}", joint.link);
        check(&format!("{name}, motor"), &held, Feedback::Motor, sampled, motor);
        check(&format!("{name}, mixed"), &held, Feedback::LinkMotor, sampled, mixed);
    }
}

/// In the air at 3.5 ms with a cycle of delay no motor-side gains are stable: f_0 (T/2 + delay) = 47.2 Hz x 5.25 ms = 0.248.
#[test]
fn delay_leaves_no_stable_gains() {
    let held = AIR.held(3.5e-3);
    for difference in [false, true] {
        let sampled = Sampled { delay: true, difference };
        let stable = |kp: f64| {
            grid(1.0, 3000.0)
                .any(|kd| held.is_stable(Feedback::Motor, gains(kp * AIR.stiffness, kd), sampled))
        };
        assert!(!grid(0.005, 1.0).step_by(8).any(stable), "{sampled:?}");
        let mixed = |kp: f64, kd| held.is_stable(Feedback::LinkMotor, gains(kp * AIR.stiffness, kd), sampled);
        let (most, at) = if difference { (0.456, 138.0) } else { (0.666, 221.0) };
        assert!(mixed(0.985 * most, at) && !mixed(1.03 * most, at), "{sampled:?}");
    }
}
