//! `depth = "auto"`: which outputs of a scene must be how accurate.
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
    /// \[m\] Position of the torso at the end of the trial.
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
        matches!(self, Self::MotorCurrent)
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
