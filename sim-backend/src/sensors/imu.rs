//! Inertial measurement unit (thesis 2.5.3, figure 2.24): limited bandwidth, misaligned mounting, noise, converter, dead
//! time.
//!
//! | symbol | name | unit | frame |
//! |---|---|---|---|
//! | o | orientation, world_from_torso | 1 | |
//! | w | angular velocity | rad/s | torso |
//! | a | specific force | m/s^2 | torso |
//! | b | mounting bias, a rotation vector | rad | torso |
//!
//! Global error models, as in the thesis: o is filtered along rotation vectors, then turned by b and by noise, all in
//! the axes of the torso: o exp(b) exp(n). Neither w nor a has a bias. The quaternion is converted by components, in
//! steps of half the step of an angle, since a rotation by a small angle moves them by its half.
//!
//! Bandwidth and dead time are those of the integration's steps. A sensor with a period converts once per period, and its
//! readings travel for the dead time; one without is read when the bus asks.

use config::sensors::SignalErrors;
use messages::Imu as Reading;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::converter::{Converter, round_to};
use super::delay_line::DelayLine;
use super::low_pass::{LowPass, OrientationLowPass, time_constant};
use super::noise::Noise;

/// The sensor of the upper body.
#[derive(Clone, Debug)]
pub struct ImuSensor {
    orientation: Option<Orientation>,
    low_pass: [LowPass<3>; 2],
    rate: Converter,
    acceleration: Converter,
    line: DelayLine<Reading>,
    /// \[cycles\] Between two readings, if the sensor has a period of its own; since the last one; the last one.
    period: Option<u32>,
    age: u32,
    held: Option<Reading>,
}

/// Errors of the orientation.
#[derive(Clone, Debug)]
struct Orientation {
    low_pass: OrientationLowPass,
    bias: UnitQuaternion<f64>,
    /// \[rad\] of each component of the rotation vector
    noise: Converter,
    /// \[1\] of each component of the quaternion
    step: f64,
}

impl ImuSensor {
    /// `cycle` of the bus and `step` of the integration in s; `stream(i)`: noise of orientation, angular velocity and
    /// specific force.
    pub fn new(
        errors: &config::sensors::ImuErrors,
        cycle: f64,
        step: f64,
        stream: impl Fn(u64) -> Noise,
    ) -> Self {
        let time = time_constant(errors.bandwidth);
        let converter = |s: &SignalErrors, i| Converter::new(s.noise, s.step, s.range, stream(i));
        let exact = errors.bandwidth == 0.0
            && errors.bias == [0.0; 3]
            && errors.orientation == SignalErrors::default();
        let orientation = || Orientation {
            low_pass: OrientationLowPass::new(time, step),
            bias: UnitQuaternion::from_scaled_axis(Vector3::from(errors.bias)),
            noise: converter(&errors.orientation, 0),
            step: 0.5 * errors.orientation.step,
        };
        Self {
            orientation: (!exact).then(orientation),
            low_pass: std::array::from_fn(|_| LowPass::new(time, step)),
            rate: converter(&errors.rate, 1),
            acceleration: converter(&errors.acceleration, 2),
            line: DelayLine::new(errors.delay, step),
            period: Some((errors.period / cycle).round() as u32).filter(|cycles| *cycles > 0),
            age: 0,
            held: None,
        }
    }

    /// One more step of the integration within a cycle.
    pub fn observe(&mut self, truth: &Reading) {
        let now = self.filter(truth);
        self.line.push(self.held.unwrap_or(now));
    }

    /// The last step of a cycle, and the reading at its end. What is not finite, or no orientation, is read as NaN.
    pub fn measure(&mut self, truth: &Reading, clipped: &mut u32) -> Reading {
        let now = self.filter(truth);
        let Some(period) = self.period else {
            self.line.push(now);
            let read = self.interpolated();
            return self.convert(read, clipped);
        };
        let held = match self.held {
            Some(held) if self.age > 0 => held,
            _ => self.convert(now, clipped),
        };
        self.age = (self.age + 1) % period;
        self.held = Some(held);
        self.line.push(held);
        self.line.arrived()
    }

    fn filter(&mut self, truth: &Reading) -> Reading {
        Reading {
            orientation: match &mut self.orientation {
                Some(errors) => errors.filter(truth.orientation),
                None => truth.orientation,
            },
            angular_velocity: self.low_pass[0].filter(truth.angular_velocity),
            acceleration: self.low_pass[1].filter(truth.acceleration),
        }
    }

    /// All signals at the dead time.
    fn interpolated(&self) -> Reading {
        let (older, newer, share) = self.line.read();
        if share == 0.0 {
            return *newer;
        }
        let turned = |q: [f64; 4]| UnitQuaternion::new_normalize(Quaternion::from(q));
        Reading {
            orientation: turned(newer.orientation).nlerp(&turned(older.orientation), share).coords.into(),
            angular_velocity: std::array::from_fn(|i| self.line.chord(|x| x.angular_velocity[i])),
            acceleration: std::array::from_fn(|i| self.line.chord(|x| x.acceleration[i])),
        }
    }

    fn convert(&mut self, read: Reading, clipped: &mut u32) -> Reading {
        Reading {
            orientation: match &mut self.orientation {
                Some(errors) => errors.convert(read.orientation),
                None => read.orientation,
            },
            angular_velocity: read.angular_velocity.map(|x| self.rate.convert(x, clipped)),
            acceleration: read.acceleration.map(|x| self.acceleration.convert(x, clipped)),
        }
    }
}

impl Orientation {
    fn filter(&mut self, [x, y, z, w]: [f64; 4]) -> [f64; 4] {
        let truth = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-6);
        match truth.filter(|o| o.coords.iter().all(|x| x.is_finite())) {
            Some(truth) => self.low_pass.filter(truth).coords.into(),
            None => [f64::NAN; 4],
        }
    }

    fn convert(&mut self, o: [f64; 4]) -> [f64; 4] {
        if !o.iter().all(|x| x.is_finite()) {
            return [f64::NAN; 4];
        }
        let noise = Vector3::from_fn(|_, _| self.noise.noise());
        let o = UnitQuaternion::new_unchecked(Quaternion::from(o))
            * self.bias
            * UnitQuaternion::from_scaled_axis(noise);
        let coarse = o.coords.map(|x| round_to(x, self.step));
        Quaternion::from(coarse).normalize().coords.into()
    }
}
