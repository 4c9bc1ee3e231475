//! Return to fresh targets after a pause of whoever makes them, without a jump.
//!
//! While targets are missing a joint is carried on at its last speed. When they come again they lie elsewhere: the difference
//! in angle and speed is kept as an offset, and dies out as a critically damped motion x'' = -2 w x' - w^2 x.

use crate::limits::Setpoint;

/// \[1/s\] w: an offset has died out after a tenth of a second, and asks for no more than a step does.
const RATE: f64 = 40.0;
/// \[rad\] and \[rad/s\] below which an offset has died out.
const GONE: (f64, f64) = (1e-7, 1e-5);

/// Offset of one joint from its targets.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Rejoin {
    offset: Option<Setpoint>,
}

impl Rejoin {
    /// Targets come again: at the end of this cycle the joint is where it would be without them, `carried`.
    pub(crate) fn begin(&mut self, carried: Setpoint, target: Setpoint) {
        let offset = Setpoint { angle: carried.angle - target.angle, speed: carried.speed - target.speed };
        self.offset = (offset.angle.is_finite() && offset.speed.is_finite()).then_some(offset);
    }

    /// Each cycle of `dt` after that \[s\]: the target with what is left of the offset.
    pub(crate) fn step(&mut self, target: Setpoint, dt: f64) -> Setpoint {
        let Some(o) = self.offset else { return target };
        let decay = (-RATE * dt).exp();
        let b = o.speed + RATE * o.angle;
        let next = Setpoint { angle: (o.angle + b * dt) * decay, speed: (o.speed - RATE * b * dt) * decay };
        let gone = next.angle.abs() < GONE.0 && next.speed.abs() < GONE.1;
        self.offset = (!gone).then_some(next);
        Setpoint { angle: target.angle + next.angle, speed: target.speed + next.speed }
    }

    /// What is left of the offset.
    pub(crate) fn offset(&self) -> Option<Setpoint> {
        self.offset
    }

    /// No offset left: targets are followed as they are.
    pub(crate) fn is_over(&self) -> bool {
        self.offset.is_none()
    }

    /// Nothing is left of it.
    pub(crate) fn forget(&mut self) {
        self.offset = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 1e-3;

    /// Against Euler steps a thousand times as fine.
    #[test]
    fn the_offset_dies_out_critically_damped() {
        let mut rejoin = Rejoin::default();
        let start = Setpoint { angle: 0.005, speed: -0.3 };
        rejoin.begin(start, Setpoint { angle: 0.0, speed: 0.0 });
        let (mut x, mut v) = (start.angle, start.speed);
        for cycle in 0..100 {
            let m = rejoin.step(Setpoint { angle: 0.0, speed: 0.0 }, DT);
            for _ in 0..1000 {
                let a = -2.0 * 40.0 * v - 40.0 * 40.0 * x;
                x += v * DT / 1000.0;
                v += a * DT / 1000.0;
            }
            assert!(
                (m.angle - x).abs() < 1e-6 && (m.speed - v).abs() < 1e-4,
                "cycle {cycle}: {m:?}, {x}, {v}"
            );
        }
    }

    #[test]
    fn it_begins_where_the_joint_was_and_ends_on_the_target() {
        let mut rejoin = Rejoin::default();
        let target = Setpoint { angle: 1.0, speed: 2.0 };
        assert_eq!(rejoin.step(target, DT), target, "nothing to catch up on");
        rejoin.begin(Setpoint { angle: 1.01, speed: 1.5 }, target);
        // The target stands still, so the offset alone moves: with its speed, and braked by 2 w x' and w^2 x.
        let first = rejoin.step(target, DT);
        assert!(
            (first.angle - (1.01 - 0.5 * DT)).abs() < 3e-5 && (first.speed - 1.524).abs() < 2e-3,
            "{first:?}"
        );
        let mut last = first;
        for _ in 0..2000 {
            last = rejoin.step(target, DT);
        }
        assert_eq!(last, target, "to the bit");
        rejoin.begin(Setpoint { angle: f64::NAN, speed: 0.0 }, target);
        assert_eq!(rejoin.step(target, DT), target);
    }
}
