//! Temperature of a winding: first order, heated by R I^2 (the i2t protection of drives).
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | I, I_c | current, and the one that may flow for ever | A |
//! | T, T_a, T_m | temperature of the winding, of the surroundings, the highest allowed one | degree C |
//! | tau | time constant | s |
//!
//! tau T' = (T_m - T_a) (I/I_c)^2 - (T - T_a): losses R I^2 over a thermal resistance that I_c, T_a and T_m define,
//! R R_th I_c^2 = T_m - T_a.

/// Thermal data of a winding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thermal {
    /// \[A\] I_c, positive.
    pub continuous_current: f64,
    /// \[s\] tau, positive.
    pub time_constant: f64,
    /// \[°C\] T_a.
    pub surroundings: f64,
    /// \[°C\] T_m, above T_a.
    pub highest: f64,
}

impl Thermal {
    /// \[°C\] Temperature `h` \[s\] after `temperature` at constant current \[A\], exactly; stable for every `h`.
    pub fn after(&self, temperature: f64, current: f64, h: f64) -> f64 {
        let share = current / self.continuous_current;
        let rest = self.surroundings + (self.highest - self.surroundings) * share * share;
        temperature + (rest - temperature) * -(-h / self.time_constant).exp_m1()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WINDING: Thermal =
        Thermal { continuous_current: 10.0, time_constant: 60.0, surroundings: 25.0, highest: 125.0 };

    /// At twice the continuous current T_m is reached after tau ln(4/3), in one step or in many.
    #[test]
    fn heats_as_the_closed_form() {
        let until = 60.0 * (4.0f64 / 3.0).ln();
        assert!((WINDING.after(25.0, 20.0, until) - 125.0).abs() < 1e-9);
        let mut t = 25.0;
        for _ in 0..10_000 {
            t = WINDING.after(t, -20.0, until / 10_000.0);
        }
        assert!((t - 125.0).abs() < 1e-6, "{t}");
    }

    #[test]
    fn stays_at_its_limit_with_the_continuous_current_and_cools_without() {
        assert!((WINDING.after(125.0, 10.0, 1000.0) - 125.0).abs() < 1e-9);
        assert!((WINDING.after(125.0, 0.0, 60.0) - (25.0 + 100.0 / std::f64::consts::E)).abs() < 1e-9);
    }
}
