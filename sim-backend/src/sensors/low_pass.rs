//! First-order low pass, sampled: T y' = u - y (anti-aliasing filter and limited bandwidth, thesis 2.5).
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | T | time constant | s |
//! | h | cycle | s |
//! | a | exp(-h/T), what is left of an old value after a cycle | 1 |
//! | r | (1 - a) T/h | 1 |
//!
//! Exact for an input that is linear between its samples: y1 = a y0 + (r - a) u0 + (1 - r) u1. (Holding the input
//! instead would make the filter faster by half a cycle.) The same step for orientations goes along rotation vectors
//! from y0.

use nalgebra::UnitQuaternion;

/// State handed from one step to the next.
#[derive(Clone, Copy, Debug)]
struct FilterStep {
    /// \[1\] 1 - a: share of the old error that is made up for.
    old: f64,
    /// \[1\] 1 - r: share of the input's change within this cycle.
    new: f64,
}

impl FilterStep {
    /// `time` T and `cycle` h \[s\]; nothing if there is no filter.
    fn new(time: f64, cycle: f64) -> Option<Self> {
        let x = cycle / time;
        let old = -(-x).exp_m1();
        (time > 0.0 && x > 0.0).then(|| Self { old, new: 1.0 - old / x })
    }
}

/// Time constant \[s\] of a cut-off frequency \[Hz\] (gain 1/sqrt 2); 0 for 0: no filter.
pub fn time_constant(bandwidth: f64) -> f64 {
    if bandwidth > 0.0 { 0.5 / (std::f64::consts::PI * bandwidth) } else { 0.0 }
}

/// Low pass of `N` numbers.
#[derive(Clone, Debug)]
pub(crate) struct LowPass<const N: usize> {
    step: Option<FilterStep>,
    /// Output and input of the last cycle.
    last: Option<([f64; N], [f64; N])>,
}

impl<const N: usize> LowPass<N> {
    /// Time constant and cycle \[s\]; a time constant of 0 gives the input back, bit for bit.
    pub(crate) fn new(time: f64, cycle: f64) -> Self {
        Self { step: FilterStep::new(time, cycle), last: None }
    }

    /// One cycle. The first input is taken as the steady state. An input that is not finite gives NaN and is forgotten.
    pub(crate) fn filter(&mut self, u: [f64; N]) -> [f64; N] {
        let Some(FilterStep { old, new }) = self.step else { return u };
        if !u.iter().all(|u| u.is_finite()) {
            return [f64::NAN; N];
        }
        let (y0, u0) = self.last.unwrap_or((u, u));
        let y = std::array::from_fn(|i| y0[i] + old * (u0[i] - y0[i]) + new * (u[i] - u0[i]));
        self.last = Some((y, u));
        y
    }
}

/// Low pass of an orientation: the filter's error is the rotation vector from its output to the input.
#[derive(Clone, Debug)]
pub(crate) struct OrientationLowPass {
    step: Option<FilterStep>,
    last: Option<[UnitQuaternion<f64>; 2]>,
}

impl OrientationLowPass {
    /// Time constant and cycle \[s\].
    pub(crate) fn new(time: f64, cycle: f64) -> Self {
        Self { step: FilterStep::new(time, cycle), last: None }
    }

    /// One cycle. The first input is taken as the steady state; all inputs must be finite.
    pub(crate) fn filter(&mut self, u: UnitQuaternion<f64>) -> UnitQuaternion<f64> {
        let Some(FilterStep { old, new }) = self.step else { return u };
        let [y0, u0] = self.last.unwrap_or([u, u]);
        let [error, to_new] = [u0, u].map(|u| (y0.inverse() * u).scaled_axis());
        let mut y = y0 * UnitQuaternion::from_scaled_axis(old * error + new * (to_new - error));
        y.renormalize(); // rounding would add up over hours
        self.last = Some([y, u]);
        y
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Unit, Vector3};

    const T: f64 = 0.02;
    const H: f64 = 1e-3;

    /// The exact answer to an input that rises from 0 to 1 within the first cycle, and to a ramp.
    #[test]
    fn step_and_ramp_are_exact() {
        let (mut step, mut ramp) = (LowPass::new(T, H), LowPass::new(T, H));
        step.filter([0.0]);
        ramp.filter([0.0]);
        for k in 1..200 {
            let t = f64::from(k) * H;
            let [y] = step.filter([1.0]);
            assert!((y - (1.0 - T / H * (H / T).exp_m1() * (-t / T).exp())).abs() < 1e-13, "{k}: {y}");
            let [y] = ramp.filter([t]);
            assert!((y - (t - T * (1.0 - (-t / T).exp()))).abs() < 1e-14, "{k}: {y}");
        }
    }

    /// At the cut-off frequency the amplitude is 1/sqrt 2 and the phase 45 degrees behind.
    #[test]
    fn cut_off_is_where_it_should_be() {
        let bandwidth = 5.0;
        let mut filter = LowPass::new(time_constant(bandwidth), H);
        let omega = std::f64::consts::TAU * bandwidth;
        let (mut re, mut im) = (0.0, 0.0);
        for k in 0..3000 {
            let t = f64::from(k) * H;
            let [y] = filter.filter([(omega * t).sin()]);
            if k >= 1000 {
                re += y * (omega * t).sin() / 1000.0;
                im += y * (omega * t).cos() / 1000.0;
            }
        }
        // A sine through chords is smaller by (omega h)^2 / 12 = 8e-5.
        assert!((re - 0.5).abs() < 1e-4 && (im + 0.5).abs() < 1e-4, "{re} {im}");
    }

    #[test]
    fn without_a_time_constant_no_bit_changes() {
        for x in [0.1, -0.0, f64::MIN_POSITIVE, 1e300] {
            let [y] = LowPass::new(0.0, H).filter([x]);
            assert_eq!(y.to_bits(), x.to_bits());
        }
    }

    #[test]
    fn what_is_not_finite_is_forgotten() {
        let (mut clean, mut hit) = (LowPass::new(T, H), LowPass::new(T, H));
        for k in 0..20 {
            if k == 10 {
                assert!(hit.filter([f64::NAN])[0].is_nan() && hit.filter([f64::INFINITY])[0].is_nan());
            }
            assert_eq!(clean.filter([f64::from(k)]), hit.filter([f64::from(k)]));
        }
    }

    /// About a fixed axis, through several turns, the orientation follows as an angle would.
    #[test]
    fn orientations_about_one_axis_are_filtered_as_angles() {
        let axis = Unit::new_normalize(Vector3::new(0.3, -0.5, 0.8));
        let start = UnitQuaternion::from_euler_angles(0.4, 0.1, -2.0);
        let (mut turned, mut angle) = (OrientationLowPass::new(T, H), LowPass::new(T, H));
        for k in 0..2000 {
            let t = f64::from(k) * H;
            let phi = 8.0 * t + 0.3 * (40.0 * t).sin();
            let [expected] = angle.filter([phi]);
            // q and -q are the same orientation; both occur.
            let mut o = start * UnitQuaternion::from_axis_angle(&axis, phi);
            if k % 3 == 0 {
                o = UnitQuaternion::new_unchecked(-o.into_inner());
            }
            let got = turned.filter(o);
            let expected = start * UnitQuaternion::from_axis_angle(&axis, expected);
            assert!(got.angle_to(&expected) < 1e-7, "{k}: {}", got.angle_to(&expected)); // angle_to: sqrt of rounding
            assert!((got.norm() - 1.0).abs() < 1e-14);
        }
    }

    /// After a jump about any axis the error shrinks along the shortest way: its direction stays, its size is that of
    /// the closed form. A filter of components, renormalised, would be 20 % off after a jump of 2.5 rad.
    #[test]
    fn a_jump_decays_along_its_rotation_vector() {
        let from = UnitQuaternion::from_euler_angles(-0.7, 0.5, 2.8);
        let jump = Vector3::new(1.5, -2.0, 0.0);
        let to = from * UnitQuaternion::from_scaled_axis(jump);
        let mut filter = OrientationLowPass::new(T, H);
        filter.filter(from);
        for k in 1..100 {
            let left = (filter.filter(to).inverse() * to).scaled_axis();
            let expected = T / H * (H / T).exp_m1() * (-f64::from(k) * H / T).exp() * jump;
            assert!((left - expected).norm() < 1e-12, "{k}: {left} {expected}");
        }
    }

    /// While the axis turns: against y' = y log(y^-1 u)/T in steps of 20 us. The filter's error is of second order in the
    /// cycle, so half the cycle leaves a quarter of it.
    #[test]
    fn a_turning_axis_is_followed_to_second_order() {
        let input =
            |t: f64| UnitQuaternion::from_euler_angles((7.0 * t).sin(), 0.8 * (5.0 * t).cos(), 3.0 * t);
        let fine = 2e-5;
        let deviation = |cycles: usize| {
            let (h, mut y) = (fine * cycles as f64, input(0.0));
            let mut filter = OrientationLowPass::new(T, h);
            filter.filter(y);
            let mut most = 0.0_f64;
            for k in 1..=25_000 {
                let lag = |t: f64, y: &UnitQuaternion<f64>| (y.inverse() * input(t)).scaled_axis() * fine / T;
                let t = k as f64 * fine;
                let half = y * UnitQuaternion::from_scaled_axis(0.5 * lag(t - fine, &y));
                y *= UnitQuaternion::from_scaled_axis(lag(t - 0.5 * fine, &half));
                if k % cycles == 0 {
                    most = most.max((y.inverse() * filter.filter(input(t))).scaled_axis().norm());
                }
            }
            most
        };
        let (whole, half) = (deviation(100), deviation(50));
        assert!(whole < 1e-4 && (3.5..4.5).contains(&(whole / half)), "{whole} {half}");
    }
}
