//! Force/torque sensors of the feet (thesis 2.5.2, figure 2.23).
//!
//! | symbol | name | unit | frame |
//! |---|---|---|---|
//! | F_c, T_c | wrench of the ground on everything below the sensor | N, N m | sensor |
//! | F_i, T_i | sum of m (a - g) over the bodies below, and its moment: what moves and carries them | N, N m | sensor |
//! | F_0, T_0 | F_i, T_i while the robot hangs at rest with level feet | N, N m | sensor |
//!
//! The strain gauges see what the bodies below press on the ankle: F = F_c - F_i. It is set to zero while hanging, where
//! F_c = 0: F = F_c - F_i + F_0 (errata 1, 4.13). A foot that stands still and level reads F_c exactly; one that is
//! tilted, or swings, does not. Strain gauges have an
//! offset, too, which goes with the zero that the joint loop takes while the robot hangs. Then, in the time of the
//! integration: anti-aliasing filter and dead time. Then, once per cycle: noise, converter, range.

use messages::Wrench;

use super::converter::Converter;
use super::delay_line::DelayLine;
use super::low_pass::LowPass;
use super::noise::Noise;

/// One sensor: forces, then moments.
#[derive(Clone, Debug)]
pub struct ForceTorqueSensor {
    inertia: bool,
    /// Wrench that is added: F_0, T_0, if it was set to zero while hanging.
    zero: Option<[f64; 6]>,
    /// Read too much.
    offset: [f64; 2],
    low_pass: [LowPass<1>; 6],
    line: DelayLine<[f64; 6]>,
    converters: [Converter; 6],
}

impl ForceTorqueSensor {
    /// `hanging`: F_0, T_0 of this foot, as [`super::carried::hanging`] gives it. `step` \[s\] of the integration. `stream(i)`: noise of the six signals.
    pub fn new(
        errors: &config::sensors::ForceTorqueErrors,
        hanging: &Wrench,
        step: f64,
        stream: impl Fn(u64) -> Noise,
    ) -> Self {
        let converter = |i: usize| {
            let (kind, axis) = (i / 3, i % 3);
            let range = [errors.force_range, errors.moment_range][kind][axis];
            Converter::new(errors.noise[kind], errors.step[kind], range, stream(i as u64))
        };
        Self {
            inertia: errors.inertia,
            zero: (errors.inertia && errors.bias_compensation).then(|| components(hanging)),
            offset: errors.offset,
            low_pass: std::array::from_fn(|_| LowPass::new(errors.filter_time, step)),
            line: DelayLine::new(errors.delay, step),
            converters: std::array::from_fn(converter),
        }
    }

    /// True if F_i, T_i matter.
    pub fn needs_inertia(&self) -> bool {
        self.inertia
    }

    /// One more step of the integration, at its end `contact` F_c, T_c and `inertial` F_i, T_i. What is not finite is
    /// read as NaN.
    pub fn observe(&mut self, contact: &Wrench, inertial: &Wrench) {
        let mut x = components(contact);
        let inertial = components(inertial);
        for i in 0..6 {
            if self.inertia {
                x[i] -= inertial[i];
            }
            if let Some(zero) = &self.zero {
                x[i] += zero[i];
            }
            x[i] += self.offset[i / 3];
            [x[i]] = self.low_pass[i].filter([x[i]]);
        }
        self.line.push(x);
    }

    /// One reading.
    pub fn measure(&mut self, clipped: &mut u32) -> Wrench {
        let Self { line, converters, .. } = self;
        let mut i = 0;
        let x = converters.each_mut().map(|converter| {
            i += 1;
            converter.convert(line.chord(|x| x[i - 1]), clipped)
        });
        Wrench { force: [x[0], x[1], x[2]], moment: [x[3], x[4], x[5]] }
    }
}

fn components(w: &Wrench) -> [f64; 6] {
    let ([a, b, c], [d, e, f]) = (w.force, w.moment);
    [a, b, c, d, e, f]
}
