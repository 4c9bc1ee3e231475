//! Robustness of a gait: random places of unknown ground that it does not walk over, and random pushes that it does not survive.
//!
//! The same places and pushes for every gait of a search, so that two gaits differ by what they are; a gait that is the best of
//! hundreds on them has to be held against others ([`Trials::others`]).

use std::f64::consts::TAU;

use chain::parallel;
use config::Setup;

use super::cost::GROUND;
use crate::Error;
use crate::ground::{GroundKind, LevelWalk};
use crate::push::{at_random, survives};
use crate::random::Random;
use crate::undisturbed::walk_at;

/// Unknown ground that is tried, with its size in its unit.
const PLACES: [(GroundKind, f64); 5] = [
    (GroundKind::Board, 0.02),
    (GroundKind::StepUp, 0.04),
    (GroundKind::StepDown, 0.04),
    (GroundKind::Slope, 5.0),
    (GroundKind::HeightField, 0.03),
];
/// \[N s/kg\] Impulses of the pushes: from what every gait survives to what none does.
const IMPULSES: [f64; 2] = [0.1, 0.7];
/// Seeds between the trials of a search and those that it is held against afterwards.
const APART: u64 = 1_000_000;

/// Places and pushes that a gait is tried on.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Trials {
    /// \[km/h\]
    pub(super) speeds: Vec<f64>,
    /// Of each kind of ground, at each speed.
    pub(super) places: u64,
    /// At each speed.
    pub(super) pushes: u64,
    /// Seed of the first place and of the pushes.
    pub(super) seed: u64,
}

impl Trials {
    /// As many, on which no gait was tuned.
    pub(super) fn others(&self) -> Self {
        Self { seed: self.seed.wrapping_add(APART), ..self.clone() }
    }

    /// \[1\] Share of that term of [`super::cost::TERMS`].
    ///
    /// # Errors
    /// The robot cannot be built, or does not walk on level ground.
    pub(super) fn share(&self, term: usize, setup: &Setup) -> Result<f64, Error> {
        if term == GROUND { self.ground(setup) } else { self.pushes(setup) }
    }

    /// Share of the places that are not walked over.
    fn ground(&self, setup: &Setup) -> Result<f64, Error> {
        let mut fell = Vec::new();
        for &kmh in &self.speeds {
            let level = LevelWalk::of(setup.clone(), (setup.scene.depth, kmh))?;
            fell.extend(parallel::map(PLACES.len() * self.places as usize, |k| {
                let (kind, size) = PLACES[k % PLACES.len()];
                let seed = self.seed.wrapping_add((k / PLACES.len()) as u64);
                level.over(kind, size, seed).map(|failed| failed.is_some())
            }));
        }
        Ok(share(&fell.into_iter().collect::<Result<Vec<_>, _>>()?))
    }

    /// Share of the pushes that are not survived: at random instants of a stride, from all sides.
    fn pushes(&self, setup: &Setup) -> Result<f64, Error> {
        let (mut fell, mass) = (Vec::new(), setup.robot.total_mass);
        for &kmh in &self.speeds {
            let mut setup = setup.clone();
            walk_at(&mut setup, kmh)?;
            let starts = at_random(&setup, self.pushes as usize, self.seed)?;
            let mut random = Random(!self.seed);
            let mut drawn = || ((TAU * random.unit()).sin_cos(), random.within(IMPULSES));
            let drawn: Vec<_> = starts.iter().map(|_| drawn()).collect();
            fell.extend(parallel::map(starts.len(), |k| {
                let ((sin, cos), impulse) = drawn[k];
                !survives(&starts[k], [cos, sin], 0.0, impulse * mass)
            }));
        }
        Ok(share(&fell))
    }
}

/// Share of those that are true.
fn share(of: &[bool]) -> f64 {
    of.iter().filter(|fell| **fell).count() as f64 / of.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn few(seed: u64) -> Trials {
        Trials { speeds: vec![2.0], places: 2, pushes: 12, seed }
    }

    /// A gait whose steps do not react falls more often; other trials are others, the same ones the same.
    #[test]
    fn a_gait_that_does_not_react_falls_more_often() {
        let setup = Setup::load(&config::root(None), "walk_2kmh").unwrap();
        let mut rigid = setup.clone();
        rigid.gait.reaction = None;
        let [reacts, does_not] = [&setup, &rigid].map(|setup| few(52_101).pushes(setup).unwrap());
        assert!(reacts < does_not && does_not > 0.3, "{reacts}, {does_not}");
        let ground = few(52_101).ground(&setup).unwrap();
        assert_eq!(few(52_101).ground(&setup).unwrap(), ground);
        assert!((0.0..=1.0).contains(&ground));
        let others = few(52_101).others();
        assert!(others.seed != 52_101 && others.places == 2);
    }

    #[test]
    fn a_share_counts_what_is_true() {
        assert_eq!(share(&[true, false, false, true]), 0.5);
    }
}
