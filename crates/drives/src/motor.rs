//! Motor: L İ + R I + k_M ω = U (2.57), torque k_M I (2.58).
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | L, R | inductance, resistance | H, Ω |
//! | k_M | torque constant, and voltage at speed | N m/A = V s/rad |
//! | U, I | voltage, current (of a synchronous motor: amplitudes of the active part) | V, A |
//! | ω | speed of the rotor relative to the stator (errata 1, (2.57)) | rad/s |

/// Electrical side of a motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motor {
    /// \[H\] L, positive.
    pub inductance: f64,
    /// \[Ω\] R, positive.
    pub resistance: f64,
    /// \[N m/A\] k_M.
    pub torque_constant: f64,
}

impl Motor {
    /// \[N m\] Torque on the rotor; its reaction acts on the stator.
    pub fn torque(&self, current: f64) -> f64 {
        self.torque_constant * current // (2.58)
    }

    /// \[A/s\] İ at current I \[A\], voltage U \[V\], speed ω \[rad/s\].
    pub fn current_rate(&self, current: f64, voltage: f64, speed: f64) -> f64 {
        (voltage - self.resistance * current - self.torque_constant * speed) / self.inductance // (2.57)
    }

    /// \[A\] Where the current comes to rest at constant voltage and speed.
    pub fn steady_current(&self, voltage: f64, speed: f64) -> f64 {
        (voltage - self.torque_constant * speed) / self.resistance
    }

    /// \[V\] Voltage that holds a current at a speed.
    pub fn voltage(&self, current: f64, speed: f64) -> f64 {
        self.resistance * current + self.torque_constant * speed
    }

    /// \[V\] Voltage by which a current loop of `bandwidth` \[rad/s\] leads to the `wanted` current: R I_d + k_M w + L w_c
    /// (I_d - I).
    pub fn loop_voltage(&self, bandwidth: f64, wanted: f64, current: f64, speed: f64) -> f64 {
        self.voltage(wanted, speed) + self.inductance * bandwidth * (wanted - current)
    }

    /// \[s\] L/R.
    pub fn time_constant(&self) -> f64 {
        self.inductance / self.resistance
    }

    /// \[A\] Current after `h` \[s\] at constant voltage and speed, exactly; stable for every `h`.
    pub fn current_after(&self, current: f64, voltage: f64, speed: f64, h: f64) -> f64 {
        let gone = -(-h / self.time_constant()).exp_m1();
        current + (self.steady_current(voltage, speed) - current) * gone
    }
}
