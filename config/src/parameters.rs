//! Parameters that may be changed while the robot runs: name, unit, range, meaning; [`crate::registry`] has those of all
//! processes, with those that are fixed at start.
//!
//! The default of each is what the gait file says.

use crate::gait::{StabilizerGains, StepSettings};

/// One parameter of `T`.
pub struct Parameter<T: 'static> {
    /// Name, as in the gait file; of a list of numbers with the component behind a dot.
    pub name: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// Least and greatest value.
    pub range: [f64; 2],
    /// Kind.
    pub about: &'static str,
    get: fn(&T) -> f64,
    put: fn(&mut T, f64),
}

/// A row of a table below: name, unit, range, meaning, and where in `T` it stands.
macro_rules! parameter {
    ($name:literal, $unit:literal, $range:expr, $about:literal, $($place:tt)+) => {
        Parameter {
            name: $name,
            unit: $unit,
            range: $range,
            about: $about,
            get: |t| t.$($place)+,
            put: |t, value| t.$($place)+ = value,
        }
    };
}

/// Those of the stabilizer; the place in this table is the number in `stabilize/parameter`: append only.
#[rustfmt::skip]
pub const STABILIZER: &[Parameter<StabilizerGains>] = &[
    parameter!("inclination_p.x", "N m/rad", [0.0, 1e4], "K_P of phi_x (5.3)", inclination_p[0]),
    parameter!("inclination_p.y", "N m/rad", [0.0, 1e4], "K_P of phi_y (5.2)", inclination_p[1]),
    parameter!("inclination_d.x", "N m s/rad", [0.0, 2e3], "K_D of phi_x (5.3)", inclination_d[0]),
    parameter!("inclination_d.y", "N m s/rad", [0.0, 2e3], "K_D of phi_y (5.2)", inclination_d[1]),
    parameter!("height_p", "N/m", [0.0, 5e4], "K_P of the height of the centre of gravity (5.4)", height_p),
    parameter!("height_d", "N s/m", [0.0, 5e3], "K_D of the same", height_d),
    parameter!("force_gain.z", "1/s", [0.0, 100.0], "K_lambda of the normal force (5.26)", force_gain[0]),
    parameter!("force_gain.x", "1/s", [0.0, 100.0], "K_lambda of the moment about x (5.26)", force_gain[1]),
    parameter!("force_gain.y", "1/s", [0.0, 100.0], "K_lambda of the moment about y (5.26)", force_gain[2]),
    parameter!("force_feed_forward", "", [0.0, 1.0], "K_lambda,FF (5.31)", force_feed_forward),
    parameter!("position_gain", "1/s", [0.0, 100.0], "return of a modification to zero (5.32)", position_gain),
    parameter!("drift_gain", "1/s", [0.0, 500.0], "K_x, drift compensation of the inverse kinematics", drift_gain),
    parameter!("force_filter", "s", [1e-4, 0.1], "time constant of the force sensor filter", force_filter),
    parameter!("force_shift", "", [0.0, 1.0], "share of the shift of normal force (5.14)", force_shift),
    parameter!("inclination_compensation", "", [0.0, 1.0], "share of the inclination error that the swing foot compensates (4.9)", inclination_compensation),
    parameter!("planned_deformation", "", [0.0, 1.0], "share of the soles' deformation in the foot trajectories (4.9)", planned_deformation),
];

/// Those of the planner; the place in this table is the number in `walk/parameter`: append only. A new value holds from
/// the next step that is planned.
#[rustfmt::skip]
pub const PLANNER: &[Parameter<StepSettings>] = &[
    parameter!("swing_height", "m", [0.0, 0.15], "height of the swing foot z_swing, from the next step on", swing_height),
];

impl<T> Parameter<T> {
    /// Its value.
    pub fn get(&self, of: &T) -> f64 {
        (self.get)(of)
    }

    /// Gives it another value; `false` if that is not a number in its range.
    pub fn set(&self, of: &mut T, value: f64) -> bool {
        let [low, high] = self.range;
        let good = value >= low && value <= high;
        if good {
            (self.put)(of, value);
        }
        good
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_parameter_has_a_place_of_its_own_and_the_shipped_values_are_in_range() {
        let gait = crate::Gait::load(&crate::root(None).join("gaits/lola.toml")).unwrap();
        for (i, p) in STABILIZER.iter().enumerate() {
            let shipped = p.get(&gait.control);
            assert!(shipped >= p.range[0] && shipped <= p.range[1], "{} = {shipped}", p.name);
            let mut control = gait.control;
            let other = if shipped == p.range[1] { p.range[0] } else { p.range[1] };
            assert!(p.set(&mut control, other));
            for (j, q) in STABILIZER.iter().enumerate() {
                let expected = if i == j { other } else { q.get(&gait.control) };
                assert_eq!(q.get(&control), expected, "{} after setting {}", q.name, p.name);
            }
        }
        for p in PLANNER {
            let shipped = p.get(&gait.step);
            assert!(shipped >= p.range[0] && shipped <= p.range[1], "{} = {shipped}", p.name);
        }
    }

    #[test]
    fn what_is_no_number_in_range_changes_nothing() {
        let gait = crate::Gait::load(&crate::root(None).join("gaits/lola.toml")).unwrap();
        let mut control = gait.control;
        let p = STABILIZER.iter().find(|p| p.name == "height_p").unwrap();
        for bad in [f64::NAN, f64::INFINITY, -1.0, 5.1e4] {
            assert!(!p.set(&mut control, bad));
            assert_eq!(p.get(&control), gait.control.height_p);
        }
    }
}
