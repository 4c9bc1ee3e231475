//! Return of a joint to where it belongs, bounded in speed and acceleration: at most its speed in between, and slowed down
//! in time to come to rest there.

/// Bounds of a joint's return.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Approach {
    /// \[1/s\] Rate at which small errors vanish.
    pub(crate) rate: f64,
    /// \[rad/s\]
    pub(crate) speed: f64,
    /// \[rad/s^2\]
    pub(crate) acceleration: f64,
}

/// Share of the acceleration that the slowing down plans with: the rest is for cycles that are not infinitely short.
pub(crate) const PLANNED: f64 = 0.8;

impl Approach {
    /// The same with a share of speed and acceleration (0 to 1), while a motion sets in.
    pub(crate) fn eased(self, share: f64) -> Self {
        Self { speed: share * self.speed, acceleration: share * self.acceleration, ..self }
    }

    /// \[rad/s\] Speed of the next cycle of `dt` \[s\] for a joint that is `error` \[rad\] away and returned with `last`
    /// \[rad/s\] so far. An error that is not finite leads nowhere.
    pub(crate) fn next(&self, error: f64, last: f64, dt: f64) -> f64 {
        if !error.is_finite() {
            return 0.0;
        }
        let in_time = (2.0 * PLANNED * self.acceleration * error.abs()).sqrt();
        let wanted = (self.rate * error.abs()).min(in_time).min(self.speed).copysign(error);
        let change = self.acceleration * dt;
        last + (wanted - last).clamp(-change, change)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// From any error and any admissible speed: within both bounds all the way, and at rest in the end.
        #[test]
        fn a_return_is_bounded_and_arrives(
            error in -3.0..3.0f64,
            rate in 1.0..100.0f64,
            speed in 0.1..1.0f64,
            acceleration in 1.0..20.0f64,
            dt in prop::sample::select(vec![0.001, 0.0035]),
        ) {
            let approach = Approach { rate, speed, acceleration };
            let (mut error, mut v) = (error, 0.0);
            let begin = error;
            for _ in 0..(35.0 / dt) as usize {
                let next = approach.next(error, v, dt);
                prop_assert!(next.abs() <= speed * (1.0 + 1e-12));
                prop_assert!((next - v).abs() <= acceleration * dt * (1.0 + 1e-9));
                error -= 0.5 * (v + next) * dt;
                v = next;
                // A few cycles at the least speed that one cycle changes.
                prop_assert!(error * begin.signum() > -4.0 * acceleration * dt * dt, "overshoot: {error}");
            }
            prop_assert!(error.abs() < 1e-3 && v.abs() < 1e-2, "{error} {v}");
        }
    }

    #[test]
    fn a_nan_error_moves_nothing() {
        let approach = Approach { rate: 2.0, speed: 0.5, acceleration: 5.0 };
        assert_eq!(approach.next(f64::NAN, 0.3, 1e-3), 0.0);
    }
}
