//! Minimisation of a cost over the unit box, where each evaluation takes seconds and the cost is noisy: several points at a time,
//! on all cores.
//!
//! | file | method | from |
//! |---|---|---|
//! | `implicit_filtering` | difference gradients on shrinking stencils | Kelley 2011, and thesis 5.6 |
//! | `cma_es` | evolution strategy that adapts its covariance matrix | Hansen 2016 |
//! | here | points drawn at random: what the others must beat | - |
//!
//! A cost that is not finite marks a point that could not be evaluated.

mod cma_es;
mod implicit_filtering;

use chain::parallel;
use clap::ValueEnum;
use nalgebra::DVector;
use serde::Serialize;

use crate::random::Random;

/// Methods of minimisation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Optimizer {
    /// Difference gradients on a stencil that shrinks (thesis 5.6).
    ImplicitFiltering,
    /// Evolution strategy that adapts its covariance matrix.
    CmaEs,
    /// Points drawn at random.
    Random,
}

/// Reasons why a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Ending {
    /// The method's own measure of size is small enough.
    Converged,
    /// The next batch would have been more than the evaluations that were left.
    OutOfEvaluations,
}

/// A point of the unit box, and what it costs.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Evaluation {
    pub(crate) point: DVector<f64>,
    pub(crate) cost: f64,
}

/// The cost, and what was asked of it so far.
pub(crate) struct Evaluations<'a> {
    cost: &'a (dyn Fn(&DVector<f64>) -> f64 + Sync),
    most: usize,
    /// All evaluations, in the order in which they were asked for.
    pub(crate) all: Vec<Evaluation>,
}

impl<'a> Evaluations<'a> {
    /// Of `cost`, and `most` of them.
    pub(crate) fn new(cost: &'a (dyn Fn(&DVector<f64>) -> f64 + Sync), most: usize) -> Self {
        Self { cost, most, all: Vec::new() }
    }

    /// The cheapest one; the first of several.
    pub(crate) fn best(&self) -> Option<&Evaluation> {
        self.all.iter().filter(|e| e.cost.is_finite()).min_by(|a, b| a.cost.total_cmp(&b.cost))
    }

    /// Evaluations that are left.
    fn left(&self) -> usize {
        self.most - self.all.len()
    }

    /// Costs of `points`; nothing is evaluated if they are more than are left.
    fn of(&mut self, points: &[DVector<f64>]) -> Result<Vec<f64>, Ending> {
        if points.len() > self.left() {
            return Err(Ending::OutOfEvaluations);
        }
        let costs = parallel::map(points.len(), |k| (self.cost)(&points[k]));
        let pairs = points.iter().zip(&costs);
        self.all.extend(pairs.map(|(point, &cost)| Evaluation { point: point.clone(), cost }));
        Ok(costs)
    }
}

impl Optimizer {
    /// Its name, as on the command line.
    pub(crate) fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
    }

    /// Searches from `start`; the same for the same `seed`, on however many cores.
    pub(crate) fn search(self, start: &DVector<f64>, seed: u64, on: &mut Evaluations<'_>) -> Ending {
        let mut random = Random(seed);
        let end = match self {
            Self::ImplicitFiltering => implicit_filtering::search(start, on),
            Self::CmaEs => cma_es::search(start, &mut random, on),
            Self::Random => at_random(start, &mut random, on),
        };
        end.map_or_else(|end| end, |()| Ending::Converged)
    }
}

/// Points that are drawn at once, for as many cores.
const BATCH: usize = 16;

/// The start, and then points drawn at random, until the evaluations run out.
fn at_random(start: &DVector<f64>, random: &mut Random, on: &mut Evaluations<'_>) -> Result<(), Ending> {
    on.of(std::slice::from_ref(start))?;
    loop {
        let count = on.left().clamp(1, BATCH);
        let points: Vec<DVector<f64>> = (0..count).map(|_| start.map(|_| random.unit())).collect();
        on.of(&points)?;
    }
}

/// The nearest point of the unit box.
fn into_box(point: DVector<f64>) -> DVector<f64> {
    point.map(|x| x.clamp(0.0, 1.0))
}

/// Costs in an order in which those that are not finite come last.
fn order(cost: f64) -> f64 {
    if cost.is_finite() { cost } else { f64::INFINITY }
}

#[cfg(test)]
mod tests;
