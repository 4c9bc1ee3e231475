//! What a joint may be asked to do.

use config::robot::Joint;

/// Why a target was changed or refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// NaN or infinite: the whole set of targets is worth nothing.
    NotFinite,
    /// Outside of the range or too fast: held back to the limit.
    Limited,
}

/// Angle \[rad\] and speed \[rad/s\] of one joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// \[rad\]
    pub angle: f64,
    /// \[rad/s\]
    pub speed: f64,
}

/// The nearest admissible target to `wanted`, one cycle of `dt` \[s\] after `last`, and whether anything was held back.
///
/// Finite first: a NaN passes every comparison of a clamp.
pub fn admit(joint: &Joint, last: Motion, wanted: Motion, dt: f64) -> Result<(Motion, bool), Refusal> {
    if !(wanted.angle.is_finite() && wanted.speed.is_finite()) {
        return Err(Refusal::NotFinite);
    }
    let reach = joint.speed_limit * dt;
    let [low, high] = joint.range;
    // A joint found outside of its range may stay where it is or come back, never go further out.
    let (low, high) = (low.min(last.angle), high.max(last.angle));
    let angle = wanted.angle.clamp(low, high).clamp(last.angle - reach, last.angle + reach);
    let mut speed = wanted.speed.clamp(-joint.speed_limit, joint.speed_limit);
    let held = angle != wanted.angle || speed != wanted.speed;
    if angle != wanted.angle {
        speed = speed.clamp(-((angle - last.angle) / dt).abs(), ((angle - last.angle) / dt).abs());
    }
    Ok((Motion { angle, speed }, held))
}

/// Largest allowed distance between target and measured angle at a joint speed: a floor plus a delay (scales with
/// speed).
pub fn following_limit(floor: f64, time: f64, speed: f64) -> f64 {
    floor + time * speed.abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn joint() -> Joint {
        Joint {
            name: "knee".into(),
            range: [-0.1, 2.0],
            speed_limit: 8.0,
            braking: 100.0,
            comfort: 0.3,
            weight: 1.0,
        }
    }

    #[test]
    fn a_target_in_range_passes_unchanged() {
        let wanted = Motion { angle: 0.504, speed: 4.0 };
        assert_eq!(admit(&joint(), Motion { angle: 0.5, speed: 4.0 }, wanted, 1e-3), Ok((wanted, false)));
    }

    #[test]
    fn a_joint_outside_of_its_range_may_come_back() {
        let last = Motion { angle: -0.3, speed: 0.0 };
        let (m, held) = admit(&joint(), last, Motion { angle: -0.295, speed: 5.0 }, 1e-3).unwrap();
        assert!(!held && m.angle == -0.295);
        let (m, held) = admit(&joint(), last, Motion { angle: -0.305, speed: -5.0 }, 1e-3).unwrap();
        assert!(held && m.angle == -0.3 && m.speed == 0.0);
    }

    fn any_f64() -> impl Strategy<Value = f64> {
        prop_oneof![
            -10.0..10.0f64,
            Just(f64::NAN),
            Just(f64::INFINITY),
            Just(f64::NEG_INFINITY),
            Just(1e308),
            Just(-0.0),
            Just(5e-324)
        ]
    }

    proptest! {
        #[test]
        fn whatever_is_asked_stays_within_range_and_rate(angle in any_f64(), speed in any_f64(), last in -0.1..2.0f64) {
            let j = joint();
            match admit(&j, Motion { angle: last, speed: 0.0 }, Motion { angle, speed }, 1e-3) {
                Err(Refusal::NotFinite) => prop_assert!(!(angle.is_finite() && speed.is_finite())),
                Err(other) => prop_assert!(false, "{other:?}"),
                Ok((m, held)) => {
                    prop_assert!(angle.is_finite() && speed.is_finite());
                    prop_assert!((j.range[0]..=j.range[1]).contains(&m.angle));
                    prop_assert!((m.angle - last).abs() <= j.speed_limit * 1e-3 * (1.0 + 1e-12));
                    prop_assert!(m.speed.abs() <= j.speed_limit);
                    prop_assert_eq!(held, m.angle != angle || m.speed != speed);
                }
            }
        }
    }
}
