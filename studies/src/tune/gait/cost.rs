//! Cost of a walk: named terms over a span of periodic walking, and their weighted sum.

use std::str::FromStr;

use chain::{Chain, Cycle};
use config::Setup;
use serde::Serialize;

use super::parameters::forward;
use super::robustness::Trials;
use crate::Error;
use crate::undisturbed::{doubted, ended, walk_on};
use crate::way::Way;

/// \[s\] The gait is periodic by then ...
pub(super) const SETTLED: f64 = 10.0;
/// \[s\] ... and is looked at for that long, the T of (5.54).
pub(super) const SPAN: f64 = 10.0;
/// \[1\] By how much a walk may be slower or faster than it was told.
const AS_TOLD: f64 = 0.05;
/// Cost of a walk that was none: a fall, not as told, or not to be trusted. The sooner it ends, the more.
pub(super) const NO_WALK: f64 = 1e6;

/// A term: name, unit, meaning.
pub(super) const TERMS: [(&str, &str, &str); 6] = [
    ("inclination", "rad^2 s", "inclination errors of the upper body, squared (5.54)"),
    ("zmp", "m^2 s", "zero-moment point, measured less planned, squared"),
    ("landing", "1", "largest force on a foot over the weight"),
    ("joint_speed", "1", "largest speed of a joint over its limit"),
    ("ground", "1", "share of random places of unknown ground that are not walked over"),
    ("pushes", "1", "share of random pushes that are not survived"),
];
/// Places in [`TERMS`] of those that take walks of their own.
pub(super) const GROUND: usize = 4;
/// The same.
pub(super) const PUSHES: usize = 5;

/// A term and its weight.
#[derive(Clone, Debug, PartialEq)]
pub struct WeightedTerm {
    pub(super) term: usize,
    pub(super) weight: f64,
}

impl FromStr for WeightedTerm {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, weight) = text.split_once('=').unwrap_or((text, "1"));
        let names = || TERMS.map(|(name, ..)| name).join(", ");
        let term =
            TERMS.iter().position(|(n, ..)| *n == name).ok_or_else(|| format!("terms are {}", names()))?;
        let weight = weight.parse::<f64>().ok().filter(|w| w.is_finite() && *w > 0.0);
        Ok(Self { term, weight: weight.ok_or("a weight is a number above 0")? })
    }
}

/// Terms and cost of one walk.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct WalkCost {
    /// Each term of [`TERMS`]; NaN of a walk that was none, and of one that takes walks of its own and was not asked for.
    pub(super) terms: [f64; TERMS.len()],
    /// Weighted sum.
    pub(super) cost: f64,
}

impl WalkCost {
    /// `true` if the robot walked as told.
    pub(super) fn walked(&self) -> bool {
        self.cost < NO_WALK
    }

    fn none(at: f64) -> Self {
        Self { terms: [f64::NAN; TERMS.len()], cost: NO_WALK * (2.0 - at / (SETTLED + SPAN)) }
    }
}

/// Walks a scene to the end of the span and, where the sum has terms of theirs, over the ground and under the pushes of `trials`.
///
/// # Errors
/// The robot cannot be built.
pub(super) fn walk(given: &Setup, sum: &[WeightedTerm], trials: &Trials) -> Result<WalkCost, Error> {
    let mut setup = given.clone();
    walk_on(&mut setup, SETTLED + SPAN);
    let mut chain = Chain::new(&setup)?;
    let dt = chain.cycle();
    let limits: Vec<f64> = setup.robot.joints.iter().map(|joint| joint.speed_limit).collect();
    let weight = setup.robot.weight();
    let (mut way, mut terms) = (Way::default(), [0.0; TERMS.len()]);
    let cycles = ((SETTLED + SPAN) / dt).round() as u64;
    for tick in 0..cycles {
        let (time, c) = (tick as f64 * dt, chain.step());
        if ended(c) || doubted(c) {
            return Ok(WalkCost::none(time));
        }
        if time > SETTLED {
            way.add(&c.sim_state, dt);
            add(&mut terms, c, (dt, weight, &limits));
        }
    }
    // Slower steps cost less: they are not what was asked for.
    let told = forward(&setup).unwrap_or(0.0) * SPAN;
    if (way.gone[0] - told).abs() > AS_TOLD * told.abs() + 0.02 {
        return Ok(WalkCost::none(SETTLED + SPAN));
    }
    // What takes walks of its own. A gait that does not walk at one of their speeds on level ground has no cost, either.
    let asked = |term: usize| sum.iter().any(|t| t.term == term);
    let share = |term: usize| if asked(term) { trials.share(term, given) } else { Ok(f64::NAN) };
    let (Ok(ground), Ok(pushes)) = (share(GROUND), share(PUSHES)) else {
        return Ok(WalkCost::none(SETTLED + SPAN));
    };
    (terms[GROUND], terms[PUSHES]) = (ground, pushes);
    Ok(WalkCost { terms, cost: sum.iter().map(|t| t.weight * terms[t.term]).sum() })
}

/// Adds a cycle of `dt` \[s\] to the terms; `weight` \[N\] is the robot's, `limits` \[rad/s\] those of its joints.
fn add(terms: &mut [f64; TERMS.len()], c: &Cycle, (dt, weight, limits): (f64, f64, &[f64])) {
    let state = &c.controller_state;
    let square = |[x, y]: [f64; 2]| x * x + y * y;
    let zmp = [0, 1].map(|i| state.zmp[i] - state.zmp_desired[i]);
    let force = c.sensors.foot_wrench.iter().map(|w| w.force[2] / weight).fold(0.0, f64::max);
    let speeds = c.sensors.joint_speed.iter().zip(limits).map(|(v, most)| v.abs() / most);
    terms[0] += square(state.inclination_error) * dt;
    terms[1] += if zmp[0].is_finite() { square(zmp) * dt } else { 0.0 };
    terms[2] = terms[2].max(force);
    terms[3] = terms[3].max(speeds.fold(0.0, f64::max));
}
