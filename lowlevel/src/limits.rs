//! Limits of a joint: range, speed, acceleration.

use config::WITH_LOAD;
use config::robot::Joint;

/// Share of the acceleration with which a joint that catches up plans to slow down.
const PLANNED: f64 = 0.8;
/// \[1\] Rounding of a target at its limit.
const ROUNDING: f64 = 1.0 + 1e-9;

/// Reason why a target was changed or refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TargetRefusal {
    /// NaN or infinite: the whole set of targets is worth nothing.
    NotFinite,
    /// Outside of the range or too fast: held back to the limit.
    Limited,
}

/// Angle \[rad\] and speed \[rad/s\] of one joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setpoint {
    /// \[rad\]
    pub angle: f64,
    /// \[rad/s\]
    pub speed: f64,
}

/// The nearest admissible target to `wanted`, one cycle of `dt` \[s\] after `last`, and whether anything was held back.
///
/// Range, in which it comes to rest before its end, speed, and what its drives can accelerate with a load that helps
/// ([`WITH_LOAD`]): alone `possible` \[rad/s^2\], asked for only when the target needs more than they can everywhere. A joint that was held back follows as fast as it can and slows down in time, so that it meets its
/// targets again without passing them.
///
/// Finite first: a NaN passes every comparison of a clamp.
pub fn admit(
    joint: &Joint,
    possible: impl FnOnce() -> f64,
    last: Setpoint,
    wanted: Setpoint,
    dt: f64,
) -> Result<(Setpoint, bool), TargetRefusal> {
    if !(wanted.angle.is_finite() && wanted.speed.is_finite()) {
        return Err(TargetRefusal::NotFinite);
    }
    // Acceleration first: where the drives can get to within this cycle.
    let asked = needed(last, wanted, dt);
    let reached = if asked <= WITH_LOAD * joint.acceleration {
        wanted
    } else {
        accelerated(joint, WITH_LOAD * possible(), last, wanted, dt)
    };
    // Then speed and range, with what it takes to come to rest there.
    let reach = joint.speed_limit * dt;
    let [low, high] = range(joint, last);
    let speed = inside(joint, last, reached.speed, dt);
    let reached = if speed == reached.speed { reached } else { moved(last, speed, dt) };
    let angle = reached.angle.clamp(low, high).clamp(last.angle - reach, last.angle + reach);
    let mut speed = reached.speed.clamp(-joint.speed_limit, joint.speed_limit);
    if angle != reached.angle {
        speed = speed.clamp(-((angle - last.angle) / dt).abs(), ((angle - last.angle) / dt).abs());
    }
    let motion = Setpoint { angle, speed };
    Ok((motion, motion != wanted))
}

/// \[rad\] Range of a joint. One found outside of it may stay where it is or come back, never go further out.
pub(crate) fn range(joint: &Joint, last: Setpoint) -> [f64; 2] {
    [joint.range[0].min(last.angle), joint.range[1].max(last.angle)]
}

/// `speed` \[rad/s\] one cycle of `dt` \[s\] after `last`, or as much of it as the joint can brake in what is left of its range.
pub(crate) fn inside(joint: &Joint, last: Setpoint, speed: f64, dt: f64) -> f64 {
    let ([low, high], braking) = (range(joint, last), PLANNED * WITH_LOAD * joint.acceleration);
    // s^2 <= 2 b r with the r that is left after the cycle. Without a limit of acceleration this is NaN, which min and max pass over.
    let most = |room: f64, speed: f64| {
        let half = 0.5 * braking * dt;
        let left = (room - 0.5 * dt * speed).max(0.0);
        (half * half + 2.0 * braking * left).sqrt() - half
    };
    speed.min(most(high - last.angle, last.speed)).max(-most(last.angle - low, -last.speed))
}

/// Where a joint gets to whose speed changes evenly to `speed`.
pub(crate) fn moved(last: Setpoint, speed: f64, dt: f64) -> Setpoint {
    Setpoint { angle: last.angle + 0.5 * (last.speed + speed) * dt, speed }
}

/// \[rad/s^2\] Acceleration that a target needs: by its speed, or by its angle if that is further from where the joint moves
/// at its last speed (a target whose angle and speed agree needs half of it for the angle).
fn needed(last: Setpoint, wanted: Setpoint, dt: f64) -> f64 {
    let ahead = wanted.angle - last.angle - last.speed * dt;
    ((wanted.speed - last.speed) / dt).abs().max((ahead / (dt * dt)).abs()) / ROUNDING
}

/// The motion with at most `most` \[rad/s^2\] that leads to `wanted`.
fn accelerated(joint: &Joint, most: f64, last: Setpoint, wanted: Setpoint, dt: f64) -> Setpoint {
    if needed(last, wanted, dt) <= most {
        return wanted;
    }
    let ahead = wanted.angle - last.angle - last.speed * dt;
    let in_time = (2.0 * PLANNED * most * ahead.abs()).sqrt().min(ahead.abs() / dt);
    let speed = wanted.speed + in_time.copysign(ahead);
    let speed = speed.clamp(last.speed - most * dt, last.speed + most * dt);
    let speed = speed.clamp(-joint.speed_limit, joint.speed_limit);
    moved(last, speed, dt)
}

/// Largest allowed distance between target and measured angle at a joint speed: a floor plus a delay (scales with
/// speed).
pub(crate) fn following_limit(floor: f64, time: f64, speed: f64) -> f64 {
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
            acceleration: 200.0,
            comfort: 0.3,
            weight: 1.0,
        }
    }

    #[test]
    fn a_target_in_range_passes_unchanged() {
        let wanted = Setpoint { angle: 0.504, speed: 4.0 };
        assert_eq!(
            admit(&joint(), || 200.0, Setpoint { angle: 0.5, speed: 4.0 }, wanted, 1e-3),
            Ok((wanted, false))
        );
    }

    #[test]
    fn a_joint_outside_of_its_range_may_come_back() {
        let last = Setpoint { angle: -0.3, speed: 0.0 };
        let joint = Joint { acceleration: f64::INFINITY, ..joint() };
        let (m, held) =
            admit(&joint, || f64::INFINITY, last, Setpoint { angle: -0.295, speed: 5.0 }, 1e-3).unwrap();
        assert!(!held && m.angle == -0.295);
        let (m, held) =
            admit(&joint, || f64::INFINITY, last, Setpoint { angle: -0.305, speed: -5.0 }, 1e-3).unwrap();
        assert!(held && m.angle == -0.3 && m.speed == 0.0);
    }

    /// A step of the target by half a radian: the drive's acceleration is kept, the target met and not passed.
    #[test]
    fn a_target_that_jumps_is_followed_as_fast_as_the_drive_can_and_met() {
        let (j, target) = (joint(), Setpoint { angle: 1.0, speed: 0.0 });
        let mut last = Setpoint { angle: 0.5, speed: 0.0 };
        let mut cycles = 0;
        while last != target {
            let (next, held) = admit(&j, || 200.0, last, target, 1e-3).unwrap();
            assert!((next.speed - last.speed).abs() <= 0.4 * (1.0 + 1e-9), "{last:?} {next:?}");
            assert_eq!(held, next != target);
            assert!(next.angle <= 1.0 + 4e-4, "passed: {next:?}");
            last = next;
            cycles += 1;
            assert!(cycles < 200, "{last:?}");
        }
        // Half of the way at 400 rad/s^2 each, at best.
        let best = 2.0 * (0.5 / 400.0f64).sqrt() / 1e-3;
        assert!((best..1.5 * best).contains(&f64::from(cycles)), "{cycles} cycles, {best:.0} at best");
    }

    /// Targets that lead or run out of the range, from wherever and for however long: the drive's acceleration is kept, with a
    /// load that helps, and so it is by braking from there.
    #[test]
    fn the_end_of_the_range_is_met_within_the_acceleration() {
        let (j, dt) = (joint(), 1e-3);
        let mut seed = 20_261_129_u64;
        let mut draw = |low: f64, high: f64| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            low + (high - low) * (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        let within = |last: Setpoint, next: Setpoint| {
            // Twice what the drives have alone: docs/safety.md.
            let most = 400.0 * dt * (1.0 + 1e-6);
            assert!((next.speed - last.speed).abs() <= most, "{last:?} {next:?}");
            assert!((j.range[0]..=j.range[1]).contains(&next.angle), "{next:?}");
        };
        let mut last = Setpoint { angle: 0.5, speed: 0.0 };
        for _ in 0..2000 {
            let (ramp, cycles) = (draw(-1.0, 1.0) > 0.0, draw(1.0, 300.0) as usize);
            let (mut angle, speed) = (draw(-2.0, 4.0), if ramp { draw(-8.0, 8.0) } else { 0.0 });
            if ramp && draw(0.0, 1.0) < 0.5 {
                angle = last.angle;
            }
            for _ in 0..cycles {
                angle += speed * dt;
                let (next, _) = admit(&j, || 200.0, last, Setpoint { angle, speed }, dt).unwrap();
                within(last, next);
                last = next;
            }
            // A controlled stop from here.
            let mut braked = last;
            while braked.speed != 0.0 {
                let next = crate::braking::brake(&j, braked, dt);
                within(braked, next);
                braked = next;
            }
        }
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
            match admit(&j, || 200.0, Setpoint { angle: last, speed: 0.0 }, Setpoint { angle, speed }, 1e-3) {
                Err(TargetRefusal::NotFinite) => prop_assert!(!(angle.is_finite() && speed.is_finite())),
                Err(other) => prop_assert!(false, "{other:?}"),
                Ok((m, held)) => {
                    prop_assert!(angle.is_finite() && speed.is_finite());
                    prop_assert!((j.range[0]..=j.range[1]).contains(&m.angle));
                    prop_assert!((m.angle - last).abs() <= j.speed_limit * 1e-3 * (1.0 + 1e-12));
                    prop_assert!(m.speed.abs() <= j.speed_limit);
                    prop_assert!(m.speed.abs() <= 2.0 * j.acceleration * 1e-3 * (1.0 + 1e-9), "from rest");
                    prop_assert_eq!(held, m.angle != angle || m.speed != speed);
                }
            }
        }
    }
}
