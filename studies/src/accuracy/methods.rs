//! Integrators with their steps or tolerances, as they are compared on whole robots.
//!
//! Explicit methods and the adaptive one see dry friction smoothed over a small speed, the semi-implicit one sees it as it
//! is. These are two models; each family is held against a reference of its own.

use config::method::Integrator;
use sim_backend::integrate::Stepper;

use super::Point;

/// Steps in a cycle of which methods are compared.
const STEPS: [u32; 5] = [1, 2, 4, 10, 40];
/// Steps of models whose contact takes long.
const FEW: [u32; 3] = [1, 4, 10];
/// Tolerances of the adaptive method.
const TOLERANCES: [f64; 5] = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8];

/// An integrator with what sets its accuracy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntegrationMethod {
    /// Which one.
    pub integrator: Integrator,
    /// Steps in a cycle.
    pub steps: u32,
    /// Of the adaptive one.
    pub tolerance: Option<f64>,
}

impl IntegrationMethod {
    /// With so many steps in a cycle.
    pub(crate) fn stepping(integrator: Integrator, steps: u32) -> Self {
        Self { integrator, steps, tolerance: None }
    }

    /// All that are compared on a model of type `depth`.
    pub fn all(depth: u8) -> Vec<Self> {
        use Integrator::{Bdf, Euler, RungeKutta4, SemiImplicit};
        let explicit: &[Integrator] =
            if depth == 1 { &[Euler, RungeKutta4] } else { &[Euler, RungeKutta4, SemiImplicit] };
        let steps: &[u32] = if depth > 3 { &FEW } else { &STEPS };
        let mut all: Vec<Self> =
            explicit.iter().flat_map(|&m| steps.iter().map(move |&n| Self::stepping(m, n))).collect();
        if depth <= 3 {
            all.extend(TOLERANCES.map(|t| Self { integrator: Bdf, steps: 1, tolerance: Some(t) }));
        }
        all
    }

    /// Whether it sees dry friction as it is.
    pub(crate) fn exact_friction(&self) -> bool {
        self.integrator == Integrator::SemiImplicit
    }

    /// What the reference of its family is made with: `finer` steps for each of the smallest that is compared.
    pub fn reference(exact_friction: bool, depth: u8, finer: u32) -> Self {
        let finest = if depth > 3 { FEW[FEW.len() - 1] } else { STEPS[STEPS.len() - 1] };
        let integrator = if exact_friction { Integrator::SemiImplicit } else { Integrator::RungeKutta4 };
        Self::stepping(integrator, finer * finest)
    }

    /// For states of `n` numbers.
    pub fn stepper(&self, n: usize) -> Stepper {
        let stepper = Stepper::new(self.integrator, n);
        match self.tolerance {
            Some(tolerance) => stepper.with_tolerance(tolerance),
            None => stepper,
        }
    }

    /// A point of it on a model of type `depth` in a scene, with steps of a cycle of `cycle` \[s\].
    pub fn point(&self, scene: &str, depth: u8, cycle: f64) -> Point {
        let which = Integrator::ALL.iter().position(|i| *i == self.integrator).unwrap_or(0);
        Point {
            scene: scene.into(),
            model: format!("type {depth}"),
            method: Integrator::WORDS[which].into(),
            step: self.tolerance.is_none().then(|| cycle / f64::from(self.steps)),
            solver: self.tolerance.map(|t| format!("tolerance {t:.0e}")),
            ..Point::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references_are_finer_than_what_they_judge() {
        for depth in 1..=5 {
            for method in IntegrationMethod::all(depth) {
                let reference = IntegrationMethod::reference(method.exact_friction(), depth, 10);
                assert!(reference.steps >= 10 * method.steps, "{method:?}");
                assert_eq!(reference.exact_friction(), method.exact_friction());
            }
        }
    }
}
