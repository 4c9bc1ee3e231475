//! Which impulse does the walking robot survive? Bisection, at several instants of a stride.
//!
//! A push of 0.1 s at the torso's origin. Survived: 6 s later the robot has not fallen, no process has stopped it, and
//! over the next stride it goes as far, as far sideways and as much round as it did before. The way it walks repeats
//! with every stride of two steps, so the instants are drawn from one stride.

use config::Setup;
use messages::command::PushCommand;
use serde_json::json;
use std::sync::atomic::{AtomicUsize, Ordering};

use chain::Chain;
use chain::parallel;

use crate::random::Random;
use crate::search::{Width, border};
use crate::sheet::{Column, fixed, plain};
use crate::undisturbed::{AFTER, Stride, ended, stride, walk_on};
use crate::{Error, Given, Sheet, Study};

/// \[s\] Length of a push.
const DURATION: f64 = 0.1;
/// \[s\] When the stride that is disturbed begins at the earliest: the gait is periodic by then.
const SETTLED: f64 = 8.0;
/// \[N s\] Bisection ends with brackets this narrow.
const RESOLUTION: f64 = 0.25;
/// \[N s\] No robot of this size survives that.
const MOST: f64 = 128.0;

/// Walking in place, and walking at 1 km/h.
const SCENES: [&str; 2] = ["push", "walk_1kmh"];
/// Directions of the pushes, counterclockwise from the world's x axis; both scenes walk along it.
const DIRECTIONS: [&str; 8] = [
    "forward",
    "forward left",
    "left",
    "backward left",
    "backward",
    "backward right",
    "right",
    "forward right",
];

/// Pushes of one scene in one direction; the least one is survived whenever it comes.
const COLUMNS: &[Column] = &[
    plain("/scene", "scene"),
    plain("/direction", "push"),
    fixed("/always_n_s", "always [N s]", 2),
    fixed("/always_n_s_per_kg", "[N s/kg]", 3),
    fixed("/median_n_s_per_kg", "median [N s/kg]", 3),
    fixed("/impulse_n_s", "at each instant [N s]", 2),
];

/// The study's arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct Push {
    /// Only this scene; default: walking in place and at 1 km/h.
    #[arg(long)]
    pub scene: Option<String>,
    /// How many instants of a stride are tried.
    #[arg(long, default_value_t = 16, value_parser = clap::value_parser!(u64).range(1..=1000))]
    pub instants: u64,
    /// Seed from which the instants are drawn.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

/// The undisturbed walk at an instant.
#[derive(Clone)]
pub(crate) struct Instant {
    pub(crate) chain: Chain,
    /// Its stride.
    stride: Stride,
}

impl Study for Push {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        let (only, instants) = (self.scene.as_deref(), self.instants as usize);
        let (mut mass, mut rows) = (0.0, Vec::new());
        for scene in SCENES.into_iter().chain(only.filter(|s| !SCENES.contains(s))) {
            if only.is_some_and(|only| only != scene) {
                continue;
            }
            let setup = Setup::load(given.config, scene)?;
            let robot = &setup.robot;
            let order: Vec<&str> = robot.joints.iter().map(|j| j.name.as_str()).collect();
            mass = multibody::Model::from_urdf(&robot.urdf, &robot.torso, &order)?.mass();
            let starts = at_random(&setup, instants, self.seed)?;
            // Every direction at every instant is a search of its own.
            let cases = DIRECTIONS.len() * instants;
            let done = AtomicUsize::new(0);
            let impulses = parallel::map(cases, |k| {
                let turn = std::f64::consts::FRAC_PI_4 * (k / instants) as f64;
                let found = largest(&starts[k % instants], [turn.cos(), turn.sin()], 1.0);
                (given.progress)(done.fetch_add(1, Ordering::Relaxed), cases, scene);
                found
            });
            let impulses = impulses.into_iter().collect::<Result<Vec<f64>, _>>()?;
            for (direction, each) in DIRECTIONS.iter().zip(impulses.chunks(instants)) {
                let mut sorted = each.to_vec();
                sorted.sort_by(f64::total_cmp);
                let (always, median) = (sorted[0], sorted[instants / 2]);
                rows.push(json!({
                    "scene": scene, "direction": direction, "impulse_n_s": each, "always_n_s": always,
                    "always_n_s_per_kg": always / mass, "median_n_s_per_kg": median / mass,
                }));
            }
        }
        let mut sheet = Sheet::titled(format!(
            "Largest impulse survived: {DURATION} s at the torso, {mass:.3} kg, instants of one stride from seed {}",
            self.seed
        ));
        sheet.fact("mass_kg", mass);
        sheet.fact("push_duration_s", DURATION);
        sheet.rows("rows", COLUMNS, &rows);
        Ok(sheet)
    }
}

/// The walk of a scene at instants spread evenly over the first stride after [`SETTLED`].
pub(crate) fn at_instants(setup: &Setup, instants: usize) -> Result<Vec<Instant>, Error> {
    let shares: Vec<f64> = (0..instants).map(|k| k as f64 / instants as f64).collect();
    at_shares(setup, &shares)
}

/// The walk of a scene at instants drawn from that stride, in their order.
fn at_random(setup: &Setup, instants: usize, seed: u64) -> Result<Vec<Instant>, Error> {
    let mut random = Random(seed);
    let mut shares: Vec<f64> = (0..instants).map(|_| random.unit()).collect();
    shares.sort_by(f64::total_cmp);
    at_shares(setup, &shares)
}

/// The walk of a scene at ascending shares of that stride.
fn at_shares(setup: &Setup, shares: &[f64]) -> Result<Vec<Instant>, Error> {
    let mut setup = setup.clone();
    walk_on(&mut setup, SETTLED);
    let stride = stride(&setup, SETTLED)?;
    let [begin, end] = stride.ticks;
    let (mut chain, mut tick, mut found) = (Chain::new(&setup)?, 0, Vec::new());
    for share in shares {
        while tick < begin + ((end - begin) as f64 * share) as u64 {
            chain.step();
            tick += 1;
        }
        found.push(Instant { chain: chain.clone(), stride });
    }
    Ok(found)
}

/// Largest impulse \[N s\] in a direction that is known to be survived; brackets are `coarse` times as wide as [`RESOLUTION`].
///
/// # Errors
/// [`MOST`] is survived.
pub(crate) fn largest(start: &Instant, direction: [f64; 2], coarse: f64) -> Result<f64, String> {
    survived(MOST, RESOLUTION * coarse, |impulse| survives(start, direction, impulse))
}

/// Largest value from 0, which the undisturbed walk survives, to `most` that is known to be survived when the bracket is as
/// narrow as `resolution`.
///
/// # Errors
/// `most` is survived.
pub(crate) fn survived(most: f64, resolution: f64, survives: impl Fn(f64) -> bool) -> Result<f64, String> {
    let [good, _] =
        border([0.0, most], Width::Absolute(resolution), |x| Ok::<_, String>(x == 0.0 || survives(x)))?;
    Ok(good)
}

/// Whether the robot walks on as before after a push now.
fn survives(start: &Instant, direction: [f64; 2], impulse: f64) -> bool {
    let mut chain = start.chain.clone();
    let [x, y] = direction.map(|d| d * impulse / DURATION);
    chain.push(&PushCommand { force: [x, y, 0.0], duration: DURATION });
    let goes_on = (0..((DURATION + AFTER) / chain.cycle()) as u64).all(|_| !ended(chain.step()));
    goes_on && start.stride.is_repeated(&mut chain, |_| ())
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::Command;
    use messages::command::VelocityCommand;

    #[test]
    fn bisection_finds_the_edge_from_below() {
        let found = survived(MOST, RESOLUTION, |x| x < 17.3).unwrap();
        assert!(found < 17.3 && found > 17.3 - RESOLUTION, "{found}");
        assert_eq!(survived(MOST, RESOLUTION, |_| false), Ok(0.0));
        assert!(survived(MOST, RESOLUTION, |_| true).unwrap_err().contains("still holds at 128"));
    }

    /// What is said to be survived is, and twice as much is not.
    #[test]
    fn a_small_push_is_survived_and_a_huge_one_is_not() {
        let setup = Setup::load(&config::root(None), "push").unwrap();
        let start = &at_instants(&setup, 1).unwrap()[0];
        assert!(survives(start, [0.0, 1.0], 1.0));
        assert!(!survives(start, [0.0, 1.0], MOST));
    }

    /// To be on one's feet is not enough: a robot that stopped, or walks at another speed, has not survived.
    #[test]
    fn a_robot_that_no_longer_walks_as_told_has_not_survived() {
        let setup = Setup::load(&config::root(None), "walk_1kmh").unwrap();
        let start = &at_instants(&setup, 1).unwrap()[0];
        let after = |command: Option<Command>| {
            let mut chain = start.chain.clone();
            command.iter().for_each(|command| chain.command(command));
            (0..4000).for_each(|_| _ = chain.step());
            start.stride.is_repeated(&mut chain, |_| ())
        };
        let speed = |forward| Command::Velocity(VelocityCommand { forward, left: 0.0, turn: 0.0 });
        assert!(after(None));
        assert!(!after(Some(Command::Stop)));
        assert!(!after(Some(speed(0.2))));
    }

    /// A copied walk goes on like the one it was copied from, bit for bit.
    #[test]
    fn a_copy_of_a_walk_goes_on_like_it() {
        let setup = Setup::load(&config::root(None), "walk_1kmh").unwrap();
        let mut chain = Chain::new(&setup).unwrap();
        (0..5000).for_each(|_| _ = chain.step());
        let mut copy = chain.clone();
        (0..1500).for_each(|_| _ = (chain.step(), copy.step()));
        assert_eq!(chain.robot().integrated(), copy.robot().integrated());
    }
}
