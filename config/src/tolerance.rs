//! `depth = "auto"`: which outputs of a scene must be how accurate, and the method that was found to do it.
//!
//! ```toml
//! depth = "auto"
//!
//! [tolerance]
//! inclination = 0.002 # [rad]
//! motor_current = 5.0 # [A]
//! trial = 6.0 # [s] optional
//! ```
//!
//! Type, integrator and steps are what is chosen, so such a scene names none of them. `gangwerk sim` and `gangwerk run`
//! choose before they begin.

use std::fmt;
use std::str::FromStr;

use crate::scene::Integrator;
use crate::section::{POSITIVE, Section, listed};

/// Something that a simulation is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Output {
    /// \[rad\] Inclination of the torso: largest difference over time, of its two components.
    Inclination,
    /// \[N\] Force of the ground on a foot: root mean square over time of the difference, the larger one of the feet.
    FootForce,
    /// \[rad\] Joint angles: largest difference over time and joints.
    JointAngle,
    /// \[N m\] Torque of the motors on a joint through their gears: largest difference over time and joints.
    JointTorque,
    /// \[A\] Motor currents: largest difference over time and motors.
    MotorCurrent,
    /// \[m\] Position of the torso at the end.
    Position,
}

impl Output {
    /// All of them, in the order of [`Output::WORDS`].
    pub const ALL: [Self; 6] = [
        Self::Inclination,
        Self::FootForce,
        Self::JointAngle,
        Self::JointTorque,
        Self::MotorCurrent,
        Self::Position,
    ];
    /// Their names in scene files.
    pub const WORDS: [&str; 6] =
        ["inclination", "foot_force", "joint_angle", "joint_torque", "motor_current", "position"];
    /// Their units.
    pub(crate) const UNITS: [&str; 6] = ["rad", "N", "rad", "N m", "A", "m"];

    /// Its name in scene files.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }

    /// Its unit.
    pub fn unit(self) -> &'static str {
        Self::UNITS[self as usize]
    }

    /// Whether only models with motors have it, those of type 2 and deeper.
    pub fn needs_motors(self) -> bool {
        matches!(self, Self::JointTorque | Self::MotorCurrent)
    }
}

/// Required accuracy of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Tolerance {
    /// At least one output, each with the largest error allowed, in its unit.
    pub outputs: Vec<(Output, f64)>,
    /// \[s\] Part of the scene on which methods are tried; none: chosen automatically.
    pub trial: Option<f64>,
}

impl Tolerance {
    /// `[tolerance]` of a scene's file.
    pub(crate) fn read(top: &Section<'_, '_>) -> Self {
        let words = listed(&Output::WORDS);
        if !top.has("tolerance") {
            top.problem(
                "tolerance",
                format!("missing; depth \"auto\" takes a table with at least one of {words}"),
            );
        }
        let named = top.has("tolerance").then(|| top.table("tolerance", Self::build)).flatten();
        if named.as_ref().is_some_and(|tolerance| tolerance.outputs.is_empty()) {
            top.problem("tolerance", format!("names no output; it takes at least one of {words}"));
        }
        named.unwrap_or(Self { outputs: Vec::new(), trial: None })
    }

    fn build(table: &Section<'_, '_>) -> Self {
        let named = Output::ALL.into_iter().filter(|output| table.has(output.word()));
        let outputs: Vec<_> =
            named.map(|output| (output, table.number(output.word(), output.unit(), POSITIVE))).collect();
        Self { outputs, trial: table.has("trial").then(|| table.number("trial", "s", 0.1..=60.0)) }
    }

    /// Whether an output asks for motors.
    pub fn needs_motors(&self) -> bool {
        self.outputs.iter().any(|(output, _)| output.needs_motors())
    }
}

/// How deep a model is and how it is integrated; as text `type 2, semi_implicit x 4`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Method {
    /// Modelling depth, 1 to 5.
    pub depth: u8,
    /// Integrator of the simulated robot.
    pub integrator: Integrator,
    /// \[1\] Integration steps per bus cycle.
    pub substeps: u32,
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let integrator = Integrator::ALL.iter().position(|i| *i == self.integrator).unwrap_or(0);
        write!(f, "type {}, {} x {}", self.depth, Integrator::WORDS[integrator], self.substeps)
    }
}

impl FromStr for Method {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.strip_prefix("type ").and_then(|rest| {
            let (depth, rest) = rest.split_once(", ")?;
            let (word, substeps) = rest.split_once(" x ")?;
            let integrator = Integrator::WORDS.iter().position(|w| *w == word)?;
            let (depth, substeps) = (depth.parse().ok()?, substeps.parse().ok()?);
            Some(Self { depth, integrator: Integrator::ALL[integrator], substeps })
        });
        parts
            .filter(|m| (1..=5).contains(&m.depth) && (1..=1000).contains(&m.substeps))
            .ok_or_else(|| format!("`{text}` is no method; one is `type 2, semi_implicit x 4`"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_method_is_read_as_it_is_written() {
        for integrator in Integrator::ALL {
            let method = Method { depth: 5, integrator, substeps: 1000 };
            assert_eq!(method.to_string().parse(), Ok(method));
        }
        for wrong in ["", "type 2", "type 6, euler x 1", "type 2, euler x 0", "type 2, eulr x 1"] {
            assert!(wrong.parse::<Method>().is_err(), "{wrong}");
        }
    }
}
