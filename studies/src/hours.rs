//! Hours of random pushes: how often does the walking robot fall?
//!
//! Pushes of 0.1 s at the torso's own centre of gravity come from all sides after exponentially distributed times (a Poisson
//! process); their impulses are exponentially distributed, too, so that some are larger than any that is survived. A robot that
//! fell, was stopped, or no longer walks begins anew with the undisturbed walk; the largest push of the last seconds felled her.

use chain::{Chain, parallel};
use config::Setup;
use messages::GaitState;
use messages::command::PushCommand;
use serde::Serialize;
use std::f64::consts::TAU;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::push::DURATION;
use crate::random::Random;
use crate::sheet::{Column, fixed, plain};
use crate::undisturbed::{STEP, ended, on_type, stride, walk_at, walk_on};
use crate::{Error, Given, Sheet, Study};

/// \[s\] Time from which on she walks as she will go on.
const SETTLED: f64 = 8.0;

const COLUMNS: &[Column] = &[
    plain("/depth", "type"),
    plain("/kmh", "speed [km/h]"),
    fixed("/hours", "hours", 2),
    plain("/pushes", "pushes"),
    plain("/falls", "falls"),
    fixed("/falls_in_10_hours", "in 10 hours", 1),
    fixed("/least_fatal_n_s_per_kg", "least that felled her [N s/kg]", 3),
    plain("/fell/0", "fell below 0.1"),
    plain("/fell/1", "0.1 to 0.2"),
    plain("/fell/2", "0.2 to 0.3"),
    plain("/fell/3", "0.3 to 0.4"),
    plain("/fell/4", "above"),
];
/// \[N s/kg\] Least impulses of the classes in which pushes are counted.
const CLASSES: [f64; 5] = [0.0, 0.1, 0.2, 0.3, 0.4];
/// Share of the speed by which an undisturbed walk may differ from it.
const HELD: f64 = 0.1;
/// \[s\] Time that a fall takes at most.
const FALLING: f64 = 4.0;

/// The study's arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct Hours {
    /// Scene whose robot, gait and sensors they are; it walks straight on from a velocity command.
    #[arg(long, default_value = "walk_1kmh")]
    pub scene: String,
    /// Speeds (km/h).
    #[arg(long, value_delimiter = ',', default_values_t = [1.0, 2.0])]
    pub speeds: Vec<f64>,
    /// Simulation types.
    #[arg(long, value_delimiter = ',', default_values_t = [1], value_parser = clap::value_parser!(u8).range(1..=5))]
    pub types: Vec<u8>,
    /// Length of each walk (h); one of type 1 takes a core some 4 minutes per hour.
    #[arg(long, default_value_t = 0.1)]
    pub hours: f64,
    /// Number of walks of each type and speed.
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u64).range(1..=1000))]
    pub walks: u64,
    /// Seed of the first walk; the others count on.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Mean time between pushes (s).
    #[arg(long, default_value_t = 10.0)]
    pub every: f64,
    /// Mean impulse (N s/kg).
    #[arg(long, default_value_t = 0.1)]
    pub mean: f64,
}

#[derive(Serialize)]
struct Row {
    depth: u8,
    kmh: f64,
    hours: f64,
    pushes: usize,
    falls: usize,
    falls_in_10_hours: f64,
    /// \[N s/kg\] None if she never fell.
    least_fatal_n_s_per_kg: Option<f64>,
    /// Falls, and pushes, of each class: `3 of 40`.
    fell: [String; CLASSES.len()],
}

/// A push; a fatal one is the largest of the last [`FALLING`] seconds before a fall or a stop.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pushed {
    /// \[s\]
    at: f64,
    /// \[N s/kg\]
    impulse: f64,
    fatal: bool,
}

/// Marks the push, of those since the robot `begun` anew, that felled it: it ended at `at` \[s\]. A fall that no push explains
/// counts, too.
fn blame(pushes: &mut Vec<Pushed>, begun: usize, at: f64) {
    let late = pushes[begun..].iter_mut().rev().take_while(|push| at - push.at < FALLING);
    match late.max_by(|a, b| a.impulse.total_cmp(&b.impulse)) {
        Some(push) => push.fatal = true,
        None => pushes.push(Pushed { at, impulse: 0.0, fatal: true }),
    }
}

impl Study for Hours {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        let positive = |x: f64| x.is_finite() && x > 0.0;
        let numbers = [self.hours, self.every, self.mean];
        if !numbers.iter().chain(&self.speeds).all(|&x| positive(x)) {
            return Err("--hours, --every, --mean and --speeds take numbers above 0".into());
        }
        // Walks of one type and speed all begin with the same stride, each with pushes of its own seed.
        let mut rows = Vec::new();
        let (walks, done) = (self.walks as usize, AtomicUsize::new(0));
        let all = walks * self.types.len() * self.speeds.len();
        for &depth in &self.types {
            for &kmh in &self.speeds {
                let (start, mass) = self.walking(given, depth, kmh)?;
                let pushes = parallel::map(walks, |k| {
                    let pushes = self.walk(&start, mass, self.seed.wrapping_add(k as u64));
                    (given.progress)(done.fetch_add(1, Ordering::Relaxed), all, &format!("{kmh} km/h"));
                    pushes
                });
                rows.push(self.row(depth, kmh, &pushes.concat()));
            }
        }
        let mut sheet = Sheet::titled(format!(
            "Random pushes of {DURATION} s: every {} s, {} N s/kg on average, seeds from {}",
            self.every, self.mean, self.seed
        ));
        sheet.rows("rows", COLUMNS, &rows);
        Ok(sheet)
    }
}

impl Hours {
    /// The undisturbed walk, and the mass \[kg\] of the robot.
    fn walking(&self, given: &Given<'_>, depth: u8, kmh: f64) -> Result<(Chain, f64), Error> {
        let mut setup = Setup::load(given.config, &self.scene)?;
        on_type(&mut setup, depth, if depth == 1 { 1e-3 } else { STEP });
        walk_at(&mut setup, kmh)?;
        walk_on(&mut setup, SETTLED);
        let walked = 3.6 * stride(&setup, SETTLED)?.speed(setup.scene.cycle);
        if (walked - kmh).abs() > HELD * kmh {
            let name = &self.scene;
            return Err(format!(
                "scene {name}: told to walk at {kmh} km/h, the robot walks at {walked:.2} km/h"
            )
            .into());
        }
        let mut chain = Chain::new(&setup)?;
        for _ in 0..(SETTLED / chain.cycle()) as u64 {
            if ended(chain.step()) {
                return Err(format!("scene {}: the robot falls without a push", self.scene).into());
            }
        }
        Ok((chain, setup.robot.total_mass))
    }

    /// All pushes of one walk.
    fn walk(&self, start: &Chain, mass: f64, seed: u64) -> Vec<Pushed> {
        let mut random = Random(seed);
        let drawn = |random: &mut Random, mean: f64| -mean * (1.0 - random.unit()).ln();
        let (mut chain, cycle) = (start.clone(), start.cycle());
        let (mut pushes, mut begun) = (Vec::new(), 0);
        let mut next = drawn(&mut random, self.every);
        for k in 0..(3600.0 * self.hours / cycle) as u64 {
            let at = k as f64 * cycle;
            if at >= next {
                next += drawn(&mut random, self.every).max(DURATION);
                let impulse = drawn(&mut random, self.mean);
                let (sin, cos) = (TAU * random.unit()).sin_cos();
                let force = [cos, sin, 0.0].map(|share| share * impulse * mass / DURATION);
                chain.push(&PushCommand { force, duration: DURATION });
                pushes.push(Pushed { at, impulse, fatal: false });
            }
            let c = chain.step();
            if ended(c) || GaitState::from(c.controller_state.gait) != GaitState::Walking {
                blame(&mut pushes, begun, at);
                (chain, begun) = (start.clone(), pushes.len());
            }
        }
        pushes
    }

    fn row(&self, depth: u8, kmh: f64, pushes: &[Pushed]) -> Row {
        let fatal = pushes.iter().filter(|push| push.fatal);
        let falls = fatal.clone().count();
        let hours = self.hours * self.walks as f64;
        let class = |push: &Pushed| CLASSES.iter().rposition(|&least| push.impulse >= least);
        let fell = std::array::from_fn(|k| {
            let of =
                |fatal: bool| pushes.iter().filter(|p| class(p) == Some(k) && (p.fatal || !fatal)).count();
            format!("{} of {}", of(true), of(false))
        });
        Row {
            depth,
            kmh,
            hours,
            pushes: pushes.len(),
            falls,
            falls_in_10_hours: 10.0 * falls as f64 / hours,
            least_fatal_n_s_per_kg: fatal.map(|push| push.impulse).reduce(f64::min),
            fell,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        hours: Hours,
    }

    /// A small push on the way down felled nobody, nor did a large one long before; a fall without any is one.
    #[test]
    fn the_largest_of_the_last_pushes_is_to_blame() {
        let fatal = |pushes: &[(f64, f64)], at: f64| {
            let push = |&(at, impulse): &(f64, f64)| Pushed { at, impulse, fatal: false };
            let mut pushes: Vec<_> = pushes.iter().map(push).collect();
            blame(&mut pushes, 0, at);
            let fatal: Vec<_> = pushes.iter().filter(|push| push.fatal).map(|push| push.impulse).collect();
            fatal
        };
        assert_eq!(fatal(&[(1.0, 0.5), (9.0, 0.2), (9.2, 0.02)], 10.5), [0.2]);
        assert_eq!(fatal(&[(1.0, 0.5)], 10.5), [0.0]);
        assert_eq!(fatal(&[], 10.5), [0.0]);
    }

    /// A larger push that had felled her before she began anew is not to blame again: two falls count as two.
    #[test]
    fn each_fall_has_a_push_of_its_own() {
        let push = |at, impulse| Pushed { at, impulse, fatal: false };
        let mut pushes = vec![push(1.0, 0.5)];
        blame(&mut pushes, 0, 2.2);
        pushes.push(push(3.0, 0.4));
        blame(&mut pushes, 1, 4.2);
        assert!(pushes.iter().all(|push| push.fatal));
    }

    /// Neither a robot that only stands nor one that walks otherwise than asked is counted as falling.
    #[test]
    fn speeds_that_are_not_walked_are_refused() {
        let root = config::root(None);
        let given = Given { config: &root, progress: &|_, _, _| () };
        for (line, why) in [
            ("hours --speeds 4", "no whole stride"),
            ("hours --scene stand", "no walk/velocity"),
            ("hours --scene push", "no walk/velocity"),
        ] {
            let hours = Line::parse_from(line.split(' ')).hours;
            let error = hours.walking(&given, 1, hours.speeds[0]).map(|_| ()).unwrap_err().to_string();
            assert!(error.contains(why), "{line}: {error}");
        }
    }

    /// A minute of small pushes are walked, of large ones not; the same seed is the same walk, and pushes come as often and are
    /// as large as told.
    #[test]
    fn small_pushes_are_walked_and_large_ones_fell_her() {
        let root = config::root(None);
        let given = Given { config: &root, progress: &|_, _, _| () };
        let of = |line: &str| Line::parse_from(line.split(' ')).hours;
        let small = of("hours --hours 0.0167 --every 0.5 --mean 0.01");
        let (start, mass) = small.walking(&given, 1, 1.0).unwrap();
        let walked = small.walk(&start, mass, 3);
        assert!(walked.iter().all(|push| !push.fatal) && walked.len() > 80 && walked.len() < 160);
        let mean = walked.iter().map(|push| push.impulse).sum::<f64>() / walked.len() as f64;
        assert!((mean - 0.01).abs() < 0.003, "{mean}");
        let large = of("hours --hours 0.0167 --every 4 --mean 1");
        let fell = large.walk(&start, mass, 3);
        let row = large.row(1, 1.0, &fell);
        assert!(row.falls > 3 && row.least_fatal_n_s_per_kg.unwrap() > 0.1, "{}", row.falls);
        assert_eq!(fell, large.walk(&start, mass, 3));
    }
}
