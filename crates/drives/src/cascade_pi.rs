//! Sampled cascade of a servo drive: position P, speed PI, feed-forward of speed and acceleration, saturation of each stage
//! with anti-windup (Daniali 2013, (5-25) to (5-29), figures 5.8, 5.9). All at the motor's shaft.
//!
//! ```text
//! w_c = K_x e + v_1 w_d                                  within the fastest the shaft may turn
//! I_d = K_v (w_c - w) + z + v_2 (K_v/w_v) w'_d           within the current limit                      (5-22)
//! U   = R I_d + k_M v_1 w_d                              within the supply, and what drives that current (5-17), (5-21)
//! z  += K_v k_I T (w_c - w)                              unless that goes further into a limit
//! ```
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | e, w_d, w'_d | error of the angle, reference of speed and acceleration | rad, rad/s, rad/s^2 |
//! | w_c, w | speed that the position loop asks for, and the estimated one | rad/s |
//! | K_x, K_v, k_I | gains of position and speed, integral gain over K_v | 1/s, A s/rad, 1/s |
//! | w_v | bandwidth of the speed loop, K_v = w_v J/k_M (errata 3, 2.9); so K_v/w_v = J/k_M | rad/s |
//! | v_1, v_2 | shares of speed and acceleration that are fed forward | 1 |
//! | T, z | period of the speed loop, its integral | s, A |

use crate::Motor;

/// Gains of a sampled cascade, always closed on the motor's side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CascadePi {
    /// \[1/s\] K_x.
    pub position_gain: f64,
    /// \[rad/s\] w_v, with the inertia of a hanging robot.
    pub speed_bandwidth: f64,
    /// \[1/s\] k_I.
    pub speed_integral: f64,
    /// \[s\] Time constant of the filter behind the [`SpeedEstimator`](crate::SpeedEstimator); 0: none.
    pub speed_filter: f64,
    /// \[1\] v_1, v_2.
    pub feed_forward: [f64; 2],
    /// What the speed loop puts out.
    pub output: CascadeOutput,
}

/// Quantity that the speed loop puts out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CascadeOutput {
    /// A current (5-22), which a loop of this bandwidth \[rad/s\] holds.
    Current(f64),
    /// A voltage (5-17).
    Voltage,
}

/// Motor of a cascade with its limits.
#[derive(Clone, Copy, Debug)]
pub struct ServoMotor<'a> {
    /// The motor.
    pub motor: &'a Motor,
    /// \[A s/rad\] K_v.
    pub speed_gain: f64,
    /// \[A\]
    pub current_limit: f64,
    /// \[V\]
    pub voltage_limit: f64,
}

/// References of a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ServoReference {
    /// \[rad/s\] w_d.
    pub speed: f64,
    /// \[rad/s^2\] w'_d.
    pub acceleration: f64,
}

/// What a cascade keeps from sample to sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CascadeMemory {
    /// \[rad/s\] w_c, held between two samples of the position loop.
    pub speed_wanted: f64,
    /// \[A\] z.
    pub integral: f64,
}

impl CascadePi {
    /// Sample of the position loop: w_c \[rad/s\], at most `fastest`.
    pub fn sample_position(
        &self,
        memory: &mut CascadeMemory,
        error: f64,
        reference: ServoReference,
        fastest: f64,
    ) {
        let wanted = self.position_gain * error + self.feed_forward[0] * reference.speed;
        memory.speed_wanted = wanted.clamp(-fastest, fastest);
    }

    /// Sample of the speed loop, `period` \[s\] after the last one, with the estimated `speed` \[rad/s\]: current \[A\] or
    /// voltage \[V\].
    pub fn sample_speed(
        &self,
        memory: &mut CascadeMemory,
        servo: ServoMotor<'_>,
        period: f64,
        reference: ServoReference,
        speed: f64,
    ) -> f64 {
        let ServoMotor { motor, speed_gain, current_limit, voltage_limit } = servo;
        let lag = memory.speed_wanted - speed;
        let integral = memory.integral + speed_gain * self.speed_integral * period * lag;
        let [v_1, v_2] = self.feed_forward;
        let ahead = v_2 * speed_gain / self.speed_bandwidth * reference.acceleration;
        let current = speed_gain * lag + integral + ahead;
        // A drive without a current loop knows its current by voltage and speed only, and limits it by them.
        let (wanted, within) = match self.output {
            CascadeOutput::Current(_) => (current, current.clamp(-current_limit, current_limit)),
            CascadeOutput::Voltage => {
                let wanted = motor.voltage(current, 0.0) + motor.torque_constant * v_1 * reference.speed;
                let [low, high] = [-current_limit, current_limit].map(|limit| motor.voltage(limit, speed));
                (wanted, wanted.clamp(low, high).clamp(-voltage_limit, voltage_limit))
            }
        };
        // Anti-windup: at a limit the integral takes only what leads back.
        if wanted == within || lag * (wanted - within) < 0.0 {
            memory.integral = integral;
        }
        within
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOTOR: Motor = Motor { inductance: 3.6e-4, resistance: 0.98, torque_constant: 0.03355 };
    const SERVO: ServoMotor<'static> =
        ServoMotor { motor: &MOTOR, speed_gain: 0.2, current_limit: 5.0, voltage_limit: 24.0 };
    const LAW: CascadePi = CascadePi {
        position_gain: 75.0,
        speed_bandwidth: 390.0,
        speed_integral: 75.0,
        speed_filter: 0.0,
        feed_forward: [1.0, 1.0],
        output: CascadeOutput::Current(3000.0),
    };
    const REST: ServoReference = ServoReference { speed: 0.0, acceleration: 0.0 };

    fn last(law: CascadePi, memory: &mut CascadeMemory, speed: f64, samples: u32) -> f64 {
        (0..samples).map(|_| law.sample_speed(memory, SERVO, 160e-6, REST, speed)).last().unwrap()
    }

    #[test]
    fn sums_error_integral_and_what_is_fed_forward() {
        let mut memory = CascadeMemory::default();
        let reference = ServoReference { speed: 3.0, acceleration: 40.0 };
        LAW.sample_position(&mut memory, 0.01, reference, 100.0);
        assert!((memory.speed_wanted - 3.75).abs() < 1e-15);
        let current = LAW.sample_speed(&mut memory, SERVO, 160e-6, reference, 3.25);
        let expected = 0.1 + 0.1 * 75.0 * 160e-6 + 0.2 / 390.0 * 40.0;
        assert!((current - expected).abs() < 1e-15, "{current}");
        let voltage = CascadePi { output: CascadeOutput::Voltage, ..LAW };
        let mut memory = CascadeMemory { integral: 0.0, ..memory };
        let found = voltage.sample_speed(&mut memory, SERVO, 160e-6, reference, 3.25);
        assert!((found - 0.98 * expected - 0.03355 * 3.0).abs() < 1e-15, "{found}");
    }

    #[test]
    fn saturates_without_winding_up() {
        for (output, limit) in [(CascadeOutput::Current(3e3), 5.0), (CascadeOutput::Voltage, 4.9)] {
            let law = CascadePi { output, ..LAW };
            let mut memory = CascadeMemory { speed_wanted: 100.0, integral: 0.0 };
            assert_eq!(last(law, &mut memory, 0.0, 10_000), limit, "1.6 s at the limit");
            memory.speed_wanted = -1.0;
            let back = last(law, &mut memory, 0.0, 1);
            assert!(back < 0.0, "{back}: leaves the limit at once");
        }
        let mut memory = CascadeMemory::default();
        LAW.sample_position(&mut memory, 10.0, REST, 60.0);
        assert_eq!(memory.speed_wanted, 60.0);
    }
}
