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

use config::sensors::SignalErrors;
use messages::Imu as Reading;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::converter::{Converter, round_to};
use super::latency::Latency;
use super::low_pass::{LowPass, OrientationLowPass, time_constant};
use super::noise::Noise;

/// The sensor of the upper body.
#[derive(Clone, Debug)]
pub struct ImuSensor {
    orientation: Option<Orientation>,
    low_pass: [LowPass<3>; 2],
    rate: Converter,
    acceleration: Converter,
    latency: Latency<Reading>,
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
    /// `cycle` in s; `stream(i)`: noise of orientation, angular velocity and specific force.
    pub fn new(errors: &config::sensors::ImuErrors, cycle: f64, stream: impl Fn(u64) -> Noise) -> Self {
        let time = time_constant(errors.bandwidth);
        let converter = |s: &SignalErrors, i| Converter::new(s.noise, s.step, s.range, stream(i));
        let exact = errors.bandwidth == 0.0
            && errors.bias == [0.0; 3]
            && errors.orientation == SignalErrors::default();
        let orientation = || Orientation {
            low_pass: OrientationLowPass::new(time, cycle),
            bias: UnitQuaternion::from_scaled_axis(Vector3::from(errors.bias)),
            noise: converter(&errors.orientation, 0),
            step: 0.5 * errors.orientation.step,
        };
        Self {
            orientation: (!exact).then(orientation),
            low_pass: std::array::from_fn(|_| LowPass::new(time, cycle)),
            rate: converter(&errors.rate, 1),
            acceleration: converter(&errors.acceleration, 2),
            latency: Latency::new(errors.delay, errors.period, cycle),
        }
    }

    /// One reading. What is not finite, or no orientation, is read as NaN.
    pub fn measure(&mut self, truth: &Reading, clipped: &mut u32) -> Reading {
        let rate = self.low_pass[0].filter(truth.angular_velocity);
        let acceleration = self.low_pass[1].filter(truth.acceleration);
        let orientation = match &mut self.orientation {
            Some(errors) => errors.measure(truth.orientation),
            None => truth.orientation,
        };
        self.latency.pass(Reading {
            orientation,
            angular_velocity: rate.map(|x| self.rate.convert(x, clipped)),
            acceleration: acceleration.map(|x| self.acceleration.convert(x, clipped)),
        })
    }
}

impl Orientation {
    fn measure(&mut self, [x, y, z, w]: [f64; 4]) -> [f64; 4] {
        let Some(truth) = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-6) else {
            return [f64::NAN; 4];
        };
        if !truth.coords.iter().all(|x| x.is_finite()) {
            return [f64::NAN; 4];
        }
        let noise = Vector3::from_fn(|_, _| self.noise.noise());
        let o = self.low_pass.filter(truth) * self.bias * UnitQuaternion::from_scaled_axis(noise);
        let coarse = o.coords.map(|x| round_to(x, self.step));
        Quaternion::from(coarse).normalize().coords.into()
    }
}
