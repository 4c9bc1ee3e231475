//! Bringing a joint to rest: the controlled stop.

use crate::limits::{Setpoint, inside, moved, range};
use config::robot::Joint;

/// One cycle of `dt` \[s\] of braking at the joint's rate, or faster where its range ends sooner; the angle stays in the range.
pub fn brake(joint: &Joint, now: Setpoint, dt: f64) -> Setpoint {
    let less = joint.braking * dt;
    let speed = if now.speed.abs() <= less { 0.0 } else { now.speed - less * now.speed.signum() };
    let wanted = moved(now, inside(joint, now, speed, dt), dt);
    let [low, high] = range(joint, now);
    let angle = wanted.angle.clamp(low, high);
    Setpoint { angle, speed: if angle == wanted.angle { wanted.speed } else { 0.0 } }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stops_after_speed_over_braking_and_half_its_square() {
        let joint = Joint {
            name: "j".into(),
            range: [-1.0, 1.0],
            speed_limit: 9.0,
            braking: 64.0,
            acceleration: f64::INFINITY,
            comfort: 0.0,
            weight: 1.0,
        };
        let mut m = Setpoint { angle: 0.0, speed: 4.0 };
        let mut cycles = 0;
        while m.speed != 0.0 {
            m = brake(&joint, m, 1.0 / 1024.0);
            cycles += 1;
        }
        assert_eq!(cycles, 64); // 4 / 64 s, and every number here is exact in binary
        assert!((m.angle - 4.0 * 4.0 / (2.0 * 64.0)).abs() < 1e-12);
        assert_eq!(
            brake(&joint, Setpoint { angle: 0.999, speed: 4.0 }, 1e-3),
            Setpoint { angle: 1.0, speed: 0.0 }
        );
    }
}
