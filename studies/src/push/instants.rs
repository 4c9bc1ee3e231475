//! Instants of a stride at which a robot is pushed, and what it survives there.

use chain::Chain;
use config::Setup;
use messages::command::PushCommand;

use crate::Error;
use crate::random::Random;
use crate::search::{Width, border};
use crate::undisturbed::{AFTER, Stride, ended, standing, stride, walk_on};

/// \[s\] Length of a push.
pub(crate) const DURATION: f64 = 0.1;
/// \[s\] When the stride that is disturbed begins at the earliest: the gait is periodic by then.
const SETTLED: f64 = 8.0;
/// \[N s\] Bisection ends with brackets this narrow.
const RESOLUTION: f64 = 0.25;
/// \[N s\] No robot of this size survives that.
const MOST: f64 = 128.0;

/// The undisturbed walk at an instant.
#[derive(Clone)]
pub(crate) struct Instant {
    pub(crate) chain: Chain,
    /// \[1\] Share of the stride that has gone.
    pub(super) share: f64,
    /// Its stride.
    stride: Stride,
}

/// The walk of a scene at instants spread evenly over the first stride after [`SETTLED`].
pub(crate) fn at_instants(setup: &Setup, instants: usize) -> Result<Vec<Instant>, Error> {
    let shares: Vec<f64> = (0..instants).map(|k| k as f64 / instants as f64).collect();
    at_shares(setup, &shares)
}

/// The walk of a scene at instants drawn from that stride, in their order.
pub(crate) fn at_random(setup: &Setup, instants: usize, seed: u64) -> Result<Vec<Instant>, Error> {
    let mut random = Random(seed);
    let mut shares: Vec<f64> = (0..instants).map(|_| random.unit()).collect();
    shares.sort_by(f64::total_cmp);
    at_shares(setup, &shares)
}

/// The walk of a scene at ascending shares of that stride.
fn at_shares(setup: &Setup, shares: &[f64]) -> Result<Vec<Instant>, Error> {
    let mut setup = setup.clone();
    walk_on(&mut setup, SETTLED);
    instants(&setup, shares, stride(&setup, SETTLED)?)
}

/// The standing robot of a scene, once: every instant is like the other.
pub(crate) fn at_rest(setup: &Setup) -> Result<Vec<Instant>, Error> {
    let mut setup = setup.clone();
    walk_on(&mut setup, SETTLED);
    instants(&setup, &[0.0], standing(&setup, SETTLED))
}

/// A scene at ascending shares of a stride of it.
fn instants(setup: &Setup, shares: &[f64], stride: Stride) -> Result<Vec<Instant>, Error> {
    let [begin, end] = stride.ticks;
    let (mut chain, mut tick, mut found) = (Chain::new(setup)?, 0, Vec::new());
    for &share in shares {
        while tick < begin + ((end - begin) as f64 * share) as u64 {
            chain.step();
            tick += 1;
        }
        found.push(Instant { chain: chain.clone(), share, stride });
    }
    Ok(found)
}

/// Largest impulse \[N s\] in a direction that is known to be survived; brackets are `coarse` times as wide as [`RESOLUTION`].
///
/// # Errors
/// [`MOST`] is survived.
pub(crate) fn largest(start: &Instant, direction: [f64; 2], coarse: f64) -> Result<f64, String> {
    survived(MOST, RESOLUTION * coarse, |impulse| survives(start, direction, 0.0, impulse))
}

/// The same of a push `above` \[m\] the torso's own centre of gravity.
///
/// # Errors
/// [`MOST`] is survived.
pub(super) fn largest_above(start: &Instant, direction: [f64; 2], above: f64) -> Result<f64, String> {
    survived(MOST, RESOLUTION, |impulse| survives(start, direction, above, impulse))
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

/// Whether the robot walks on, or stands, as before after a push now, `above` \[m\] the torso's own centre of gravity.
pub(crate) fn survives(start: &Instant, direction: [f64; 2], above: f64, impulse: f64) -> bool {
    let mut chain = start.chain.clone();
    let [x, y] = direction.map(|d| d * impulse / DURATION);
    chain.push_above(&PushCommand { force: [x, y, 0.0], duration: DURATION }, above);
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
        assert!(survives(start, [0.0, 1.0], 0.0, 1.0));
        assert!(!survives(start, [0.0, 1.0], 0.0, MOST));
    }

    /// A robot that stands survives by standing; walking off is another thing. The higher a push, the sooner it topples.
    #[test]
    fn a_standing_robot_is_to_stand_and_a_high_push_topples_it_sooner() {
        let setup = Setup::load(&config::root(None), "stand").unwrap();
        let start = &at_rest(&setup).unwrap()[0];
        let [low, high] = [0.0, 0.5].map(|above| largest_above(start, [1.0, 0.0], above).unwrap());
        assert!(low > 1.0 && high < low, "{low} N s, {high} N s from above");
        let mut chain = start.chain.clone();
        chain.command(&Command::Start);
        (0..4000).for_each(|_| _ = chain.step());
        assert!(!start.stride.is_repeated(&mut chain, |_| ()));
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
