//! One walk of a sweep: its place in the sweep's order, and the row that it becomes.

use chain::Chain;
use chain::ending::{Ending, WalkEnd};
use chain::figures::{Figures, Gatherer};
use config::sweep::SweptValues;
use config::{Setup, SetupFiles, Sweep};

use super::columns::{self, Cell};
use crate::random::Random;

/// One walk: scenes change slowest, then numbers in the order of the file, seeds fastest.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Case<'a> {
    /// Its number, from 0.
    pub(super) walk: u64,
    pub(super) scene: &'a str,
    /// Its place among the sweep's scenes.
    pub(super) of: usize,
    pub(super) seed: u64,
    /// One for each of the sweep's numbers.
    pub(super) values: Vec<f64>,
}

impl<'a> Case<'a> {
    pub(super) fn of(sweep: &'a Sweep, walk: u64) -> Self {
        let seed = sweep.first_seed + walk % sweep.seeds;
        let mut rest = walk / sweep.seeds;
        let mut values = vec![0.0; sweep.numbers.len()];
        for (value, number) in values.iter_mut().zip(&sweep.numbers).rev() {
            if let SweptValues::Each(each) = &number.values {
                *value = each[(rest % each.len() as u64) as usize];
                rest /= each.len() as u64;
            }
        }
        // What is drawn depends on the seed alone: combinations are compared in the same cases.
        let mut random = Random(seed);
        for (value, number) in values.iter_mut().zip(&sweep.numbers) {
            if let SweptValues::Drawn(range) = number.values {
                *value = random.within(range);
            }
        }
        Self { walk, scene: &sweep.scenes[rest as usize], of: rest as usize, seed, values }
    }

    /// Its scene and numbers, in words.
    pub(super) fn told(&self, sweep: &Sweep) -> String {
        let numbers = sweep.numbers.iter().zip(&self.values).map(|(n, value)| format!("{} = {value}", n.key));
        [format!("scene {}", self.scene)].into_iter().chain(numbers).collect::<Vec<_>>().join(", ")
    }

    /// Its configuration, from the files of its scene.
    ///
    /// # Errors
    /// A file says something wrong with these values.
    pub(super) fn setup(&self, sweep: &Sweep, files: &SetupFiles) -> Result<Setup, String> {
        let mut setup = files.setup(&sweep.setup_numbers(&self.values)).map_err(|e| e.to_string())?;
        setup.scene.seed = self.seed;
        setup.with_method(None)
    }

    /// Walks it. Values that do not go together are refused: a row of their own.
    ///
    /// # Errors
    /// The robot cannot be built.
    pub(super) fn walk(&self, sweep: &Sweep, files: &SetupFiles) -> Result<Vec<Cell>, String> {
        match self.setup(sweep, files) {
            Err(why) => Ok(columns::refused(self, &why)),
            Ok(setup) => Ok(columns::walked(self, sweep, &walk(&setup)?)),
        }
    }
}

/// Walks a scene to its end, or until the robot has lain for a while.
fn walk(setup: &Setup) -> Result<Figures, String> {
    let mut chain = Chain::new(setup).map_err(|e| e.to_string())?;
    let (mut gatherer, mut ending) = (Gatherer::default(), Ending::default());
    let cycle = setup.scene.cycle;
    for tick in 1..=(setup.scene.duration / cycle).round() as u64 {
        let (time, c) = (tick as f64 * cycle, chain.step());
        ending.follow(time, c);
        gatherer.add(&c.sim_state, &c.controller_state);
        if ending.is_over(time) {
            break;
        }
    }
    Ok(gatherer.figures(setup, 0.0, None).ended(&ending))
}

/// True if the robot did what it was told, to the end, of a simulation that is to be trusted, and its figures are within the bounds of
/// the sweep.
pub(super) fn survived(figures: &Figures, sweep: &Sweep) -> bool {
    let within = |(name, [low, high]): &(String, [f64; 2])| {
        columns::figure(name).is_some_and(|f| (*low..=*high).contains(&f(figures)))
    };
    figures.ended_by == WalkEnd::Done.to_string()
        && figures.commands_refused == 0
        && figures.doubts.is_empty()
        && sweep.survived.iter().all(within)
}
