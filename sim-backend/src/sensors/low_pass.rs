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
//! instead would make the filter faster by half a cycle.) The same step for orientations goes along rotation vectors.

use nalgebra::UnitQuaternion;

/// What one step takes over.
#[derive(Clone, Copy, Debug)]
struct Step {
    /// \[1\] 1 - a: share of the old error that is made up for.
    old: f64,
    /// \[1\] 1 - r: share of the input's change within this cycle.
    new: f64,
}

impl Step {
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
pub struct LowPass<const N: usize> {
    step: Option<Step>,
    /// Output and input of the last cycle.
    last: Option<([f64; N], [f64; N])>,
}

impl<const N: usize> LowPass<N> {
    /// Time constant and cycle \[s\]; a time constant of 0 gives the input back, bit for bit.
    pub fn new(time: f64, cycle: f64) -> Self {
        Self { step: Step::new(time, cycle), last: None }
    }

    /// One cycle. The first input is taken as the steady state. An input that is not finite gives NaN and is forgotten.
    pub fn filter(&mut self, u: [f64; N]) -> [f64; N] {
        let Some(Step { old, new }) = self.step else { return u };
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
pub struct OrientationLowPass {
    step: Option<Step>,
    last: Option<[UnitQuaternion<f64>; 2]>,
}

impl OrientationLowPass {
    /// Time constant and cycle \[s\].
    pub fn new(time: f64, cycle: f64) -> Self {
        Self { step: Step::new(time, cycle), last: None }
    }

    /// One cycle. The first input is taken as the steady state; all inputs must be finite.
    pub fn filter(&mut self, u: UnitQuaternion<f64>) -> UnitQuaternion<f64> {
        let Some(Step { old, new }) = self.step else { return u };
        let [y0, u0] = self.last.unwrap_or([u, u]);
        let error = y0.inverse() * u0;
        let change = error * (u0.inverse() * u).scaled_axis(); // from the axes of u0 to those of y0
        let mut y = y0 * UnitQuaternion::from_scaled_axis(old * error.scaled_axis() + new * change);
        y.renormalize(); // rounding would add up over hours
        self.last = Some([y, u]);
        y
    }
}
