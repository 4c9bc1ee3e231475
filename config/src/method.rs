//! Method of a simulation: depth of the model, integrator, steps.

use std::fmt;
use std::str::FromStr;

/// Integrator of the equations of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrator {
    /// Explicit Euler, first order.
    Euler,
    /// Classical Runge-Kutta, fourth order between contact changes.
    RungeKutta4,
    /// Drives implicit, contact and bodies explicit, first order: dry friction sticks, and motors do not limit the step.
    SemiImplicit,
    /// Backward differentiation with steps chosen for a tolerance; for comparison, not for real time.
    Bdf,
}

impl Integrator {
    /// All of them, in the order of [`Integrator::WORDS`].
    pub const ALL: [Self; 4] = [Self::Euler, Self::RungeKutta4, Self::SemiImplicit, Self::Bdf];
    /// Their names in scene files.
    pub const WORDS: [&str; 4] = ["euler", "rk4", "semi_implicit", "bdf"];

    /// Its name in scene files.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }
}

impl FromStr for Integrator {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|integrator| integrator.word() == text);
        let all = format!("integrators are {}", Self::WORDS.join(", "));
        found.ok_or_else(|| messages::unknown("integrator", text, &Self::WORDS, &all))
    }
}

/// Depth of a model and how it is integrated; as text `type 2, semi_implicit x 4`.
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
        write!(f, "type {}, {} x {}", self.depth, self.integrator.word(), self.substeps)
    }
}

impl FromStr for Method {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.strip_prefix("type ").and_then(|rest| {
            let (depth, rest) = rest.split_once(", ")?;
            let (word, substeps) = rest.split_once(" x ")?;
            let (depth, substeps) = (depth.parse().ok()?, substeps.parse().ok()?);
            Some(Self { depth, integrator: word.parse().ok()?, substeps })
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
        let error = "eulr".parse::<Integrator>().unwrap_err();
        assert!(error.contains("did you mean euler?") && error.contains("semi_implicit"), "{error}");
    }
}
