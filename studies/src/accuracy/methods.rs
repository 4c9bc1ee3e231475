//! Integrators with their steps or tolerances, as they are compared on whole robots.
//!
//! Only the semi-implicit one sees dry friction as it is; the others see a ramp, whose width is part of the method. All are
//! held against one reference, which is that of dry friction (`reference.rs`).

use std::error::Error;

use config::Robot;
use config::method::Integrator;
use config::scene::FRICTION_RAMP;
use sim_backend::integrate::Stepper;
use sim_backend::step_limit::step_limit_of_ramp;

use super::Point;
use super::order::in_ms;

/// Steps in a cycle of which methods are compared.
const STEPS: [u32; 5] = [1, 2, 4, 10, 40];
/// Steps of models whose contact takes long.
const FEW: [u32; 3] = [1, 4, 10];
/// Tolerances of the adaptive method.
const TOLERANCES: [f64; 5] = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8];
/// \[rad/s\] Widths of the ramp that are compared.
pub(super) const RAMPS: [f64; 4] = [10.0, 1.0, 0.1, 0.01];

/// An integrator with what sets its accuracy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntegrationMethod {
    /// Which one.
    pub integrator: Integrator,
    /// Steps in a cycle.
    pub steps: u32,
    /// Of the adaptive one.
    pub tolerance: Option<f64>,
    /// \[rad/s\] Ramp in place of dry friction; none: friction as it is, or a model that has none.
    pub ramp: Option<f64>,
}

impl IntegrationMethod {
    /// With so many steps in a cycle.
    pub(crate) fn stepping(integrator: Integrator, steps: u32) -> Self {
        Self { integrator, steps, tolerance: None, ramp: None }
    }

    /// All that are compared on a model of type `depth`.
    pub fn all(depth: u8) -> Vec<Self> {
        use Integrator::{Bdf, Euler, RungeKutta4, SemiImplicit};
        let steps: &[u32] = if depth > 3 { &FEW } else { &STEPS };
        let tolerances: &[f64] = if depth > 3 { &[] } else { &TOLERANCES };
        let stepping = |m, ramp| steps.iter().map(move |&n| Self { ramp, ..Self::stepping(m, n) });
        let adaptive = |ramp| {
            let of = move |t: &f64| Self { tolerance: Some(*t), ramp, ..Self::stepping(Bdf, 1) };
            tolerances.iter().map(of)
        };
        if depth == 1 {
            return stepping(Euler, None).chain(stepping(RungeKutta4, None)).chain(adaptive(None)).collect();
        }
        // What the ramp costs is the same for every method that needs one: all widths for one of them.
        let mut all: Vec<Self> = stepping(Euler, Some(FRICTION_RAMP)).collect();
        all.extend(RAMPS.iter().flat_map(|ramp| stepping(RungeKutta4, Some(*ramp))));
        all.extend(stepping(SemiImplicit, None));
        all.extend([FRICTION_RAMP, RAMPS[3]].iter().flat_map(|ramp| adaptive(Some(*ramp))));
        all
    }

    /// What the reference on a type is extrapolated from: steps of h, 2 h and 4 h.
    pub(super) fn references(depth: u8) -> [Self; 3] {
        let integrator = if depth == 1 { Integrator::RungeKutta4 } else { Integrator::SemiImplicit };
        let finest = if depth > 3 { 8 * FEW[FEW.len() - 1] } else { 10 * STEPS[STEPS.len() - 1] };
        [1, 2, 4].map(|coarser| Self::stepping(integrator, finest / coarser))
    }

    /// For states of `n` numbers.
    pub fn stepper(&self, n: usize) -> Stepper {
        let stepper = Stepper::new(self.integrator, n);
        match self.tolerance {
            Some(tolerance) => stepper.with_tolerance(tolerance),
            None => stepper,
        }
    }

    /// \[s\] Its largest stable step on a robot, if it is explicit.
    ///
    /// # Errors
    /// The robot's data do not allow the type.
    pub(super) fn limit(
        &self,
        robot: &Robot,
        depth: u8,
        pose: &[f64],
    ) -> Result<Option<f64>, Box<dyn Error>> {
        let ramp = self.ramp.unwrap_or(FRICTION_RAMP);
        Ok(step_limit_of_ramp(robot, depth, pose, self.integrator, ramp)?.map(|limit| limit.step))
    }

    /// Name of its curve.
    pub(super) fn name(&self) -> String {
        let which = Integrator::ALL.iter().position(|i| *i == self.integrator).unwrap_or(0);
        let ramp = self.ramp.map_or(String::new(), |ramp| format!(", {ramp} rad/s"));
        format!("{}{ramp}", Integrator::WORDS[which])
    }

    /// A point of it on a model of type `depth` in a scene, with steps of a cycle of `cycle` \[s\].
    pub fn point(&self, scene: &str, depth: u8, cycle: f64) -> Point {
        Point {
            scene: scene.into(),
            model: format!("type {depth}"),
            method: self.name(),
            step: self.tolerance.is_none().then(|| cycle / f64::from(self.steps)),
            solver: self.tolerance.map(|t| format!("{t:.0e}")),
            ..Point::default()
        }
    }
}

/// How a limit of stability is told beside a point.
pub(super) fn beyond(step: Option<f64>, limit: Option<f64>) -> Option<String> {
    let limit = limit.filter(|limit| step.is_some_and(|step| step > *limit))?;
    Some(format!("beyond the limit of stability, {}", in_ms(limit)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references_are_finer_than_what_they_judge_and_see_dry_friction() {
        for depth in 1..=5 {
            let references = IntegrationMethod::references(depth);
            for method in IntegrationMethod::all(depth) {
                assert!(references[0].steps >= 8 * method.steps, "{method:?}");
            }
            assert!(references.iter().all(|r| r.ramp.is_none()));
            assert_eq!(references[0].integrator == Integrator::SemiImplicit, depth > 1);
        }
    }
}
