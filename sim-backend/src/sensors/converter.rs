//! The end of an analogue signal: noise, converter, range.

use super::noise::Noise;

/// White noise, then rounding to the nearest step, then a limit. Zeros and an infinite range change no bit.
#[derive(Clone, Debug)]
pub(crate) struct Converter {
    /// Standard deviation.
    deviation: f64,
    /// Quantisation.
    step: f64,
    /// Largest absolute value.
    range: f64,
    noise: Noise,
}

impl Converter {
    /// All three in the unit of the signal; noise from `stream`.
    pub(crate) fn new(deviation: f64, step: f64, range: f64, stream: Noise) -> Self {
        Self { deviation, step, range, noise: stream }
    }

    /// Noise alone.
    pub(crate) fn noise(&mut self) -> f64 {
        if self.deviation > 0.0 { self.deviation * self.noise.gaussian() } else { 0.0 }
    }

    /// Converts a number and adds to `clipped` if it was out of range. What is not finite becomes NaN.
    pub(crate) fn convert(&mut self, x: f64, clipped: &mut u32) -> f64 {
        if !x.is_finite() {
            return f64::NAN;
        }
        let mut y = x;
        if self.deviation > 0.0 {
            y += self.noise();
        }
        y = round_to(y, self.step);
        if y.abs() > self.range {
            *clipped += 1;
            y = self.range.copysign(y);
        }
        y
    }
}

/// The nearest multiple of `step`; `x` itself if `step` is 0.
pub(crate) fn round_to(x: f64, step: f64) -> f64 {
    if step > 0.0 { (x / step).round() * step } else { x }
}
