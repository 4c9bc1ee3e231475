//! Which impulse does the walking robot survive? Bisection, at several instants of a stride.
//!
//! A push of 0.1 s at the torso's origin. Survived: `AFTER` later the robot has not fallen, and no process has stopped
//! it. The way it walks repeats with every stride of two steps, so the instants are spread over one stride.

use config::Setup;
use messages::command::PushCommand;
use messages::{EventCode, GaitState, LEFT, RIGHT};
use serde_json::json;

use chain::parallel;
use chain::{Chain, Cycle};

use crate::search::{Width, border};
use crate::sheet::{Column, fixed, plain};
use crate::{Error, Given, Sheet, Study};

/// \[s\] Length of a push.
const DURATION: f64 = 0.1;
/// \[s\] How long the robot must go on after it.
const AFTER: f64 = 4.0;
/// \[s\] When the stride that is disturbed begins at the earliest: the gait is periodic by then.
const SETTLED: f64 = 8.0;
/// \[N s\] Bisection ends with brackets this narrow.
const RESOLUTION: f64 = 0.25;
/// \[N s\] No robot of this size survives that.
const MOST: f64 = 128.0;

/// Walking in place, and walking at 1 km/h.
const SCENES: [&str; 2] = ["push", "walk_1kmh"];
/// World axes; both scenes walk along x.
const DIRECTIONS: [(&str, [f64; 2]); 4] =
    [("forward", [1.0, 0.0]), ("backward", [-1.0, 0.0]), ("left", [0.0, 1.0]), ("right", [0.0, -1.0])];

/// Pushes of one scene in one direction; the least one is survived whenever it comes.
const COLUMNS: &[Column] = &[
    plain("/scene", "scene"),
    plain("/direction", "push"),
    fixed("/always_n_s", "always [N s]", 2),
    fixed("/always_n_s_per_kg", "[N s/kg]", 3),
    fixed("/impulse_n_s", "at each instant [N s]", 2),
];

/// The study's arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct Push {
    /// Only this scene; default: walking in place and at 1 km/h.
    #[arg(long)]
    pub scene: Option<String>,
    /// How many instants of a stride are tried.
    #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u64).range(1..=1000))]
    pub instants: u64,
}

impl Study for Push {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        let (only, instants) = (self.scene.as_deref(), self.instants as usize);
        let (mut mass, mut rows) = (0.0, Vec::new());
        for scene in SCENES.into_iter().chain(only.filter(|s| !SCENES.contains(s))) {
            if only.is_some_and(|only| only != scene) {
                continue;
            }
            let mut setup = Setup::load(given.config, scene)?;
            // The scene's own pushes are left out.
            setup.scene.pushes.clear();
            let robot = &setup.robot;
            let order: Vec<&str> = robot.joints.iter().map(|j| j.name.as_str()).collect();
            mass = multibody::Model::from_urdf(&robot.urdf, &robot.torso, &order)?.mass();
            let starts = at_instants(&setup, instants)?;
            // Every direction at every instant is a search of its own.
            let impulses = parallel::map(DIRECTIONS.len() * instants, |k| {
                largest(&starts[k % instants], DIRECTIONS[k / instants].1, 1.0)
            });
            let impulses = impulses.into_iter().collect::<Result<Vec<f64>, _>>()?;
            for ((direction, _), each) in DIRECTIONS.iter().zip(impulses.chunks(instants)) {
                let always = each.iter().copied().fold(f64::INFINITY, f64::min);
                rows.push(json!({
                    "scene": scene, "direction": direction, "impulse_n_s": each,
                    "always_n_s": always, "always_n_s_per_kg": always / mass,
                }));
            }
        }
        let mut sheet = Sheet::titled(format!(
            "Largest impulse survived: {DURATION} s at the torso, {mass:.3} kg, instants spread over one stride"
        ));
        sheet.fact("mass_kg", mass);
        sheet.fact("push_duration_s", DURATION);
        sheet.rows("rows", COLUMNS, &rows);
        Ok(sheet)
    }
}

/// The walk of a scene at instants spread evenly over the first stride after [`SETTLED`].
pub(crate) fn at_instants(setup: &Setup, instants: usize) -> Result<Vec<Chain>, Error> {
    let (begin, end) = stride(setup, SETTLED)?;
    let (mut chain, mut tick, mut found) = (Chain::new(setup)?, 0, Vec::new());
    for k in 0..instants as u64 {
        while tick < begin + (end - begin) * k / instants as u64 {
            chain.step();
            tick += 1;
        }
        found.push(chain.clone());
    }
    Ok(found)
}

/// Ticks in which the first stride after `settled` \[s\] and the one after it begin.
pub(crate) fn stride(setup: &Setup, settled: f64) -> Result<(u64, u64), Error> {
    let mut chain = Chain::new(setup)?;
    let (mut stance, mut begins) = (LEFT, Vec::new());
    for tick in 1..=(setup.scene.duration / setup.scene.cycle) as u64 {
        let c = chain.step();
        if c.sim_state.fallen == 1 {
            return Err(format!("scene {}: the robot falls without a push", setup.scene.name).into());
        }
        let (now, gait) = (c.controller_state.load_left, GaitState::from(c.controller_state.gait));
        // A stride begins where the right foot takes all of the load from the left one.
        let carries = if now >= 1.0 {
            LEFT
        } else if now <= 0.0 {
            RIGHT
        } else {
            stance
        };
        if carries == RIGHT && stance == LEFT && gait == GaitState::Walking && c.sim_state.time >= settled {
            begins.push(tick);
        }
        stance = carries;
        if let [begin, end] = begins[..] {
            return Ok((begin, end));
        }
    }
    Err(format!("scene {}: no whole stride of walking after {settled} s", setup.scene.name).into())
}

/// Largest impulse \[N s\] in a direction that is known to be survived; brackets are `coarse` times as wide as [`RESOLUTION`].
///
/// # Errors
/// [`MOST`] is survived.
pub(crate) fn largest(start: &Chain, direction: [f64; 2], coarse: f64) -> Result<f64, String> {
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

/// Whether the robot walks on after a push now.
fn survives(start: &Chain, direction: [f64; 2], impulse: f64) -> bool {
    let mut chain = start.clone();
    let [x, y] = direction.map(|d| d * impulse / DURATION);
    chain.push(&PushCommand { force: [x, y, 0.0], duration: DURATION });
    let goes_on = (0..((DURATION + AFTER) / chain.cycle()) as u64).all(|_| !ended(chain.step()));
    goes_on && GaitState::from(chain.step().controller_state.gait) == GaitState::Walking
}

/// Whether the robot fell in this cycle, or a process stopped it.
pub(crate) fn ended(cycle: &Cycle) -> bool {
    let ends = |code| {
        matches!(code, EventCode::Fallen | EventCode::Lifted | EventCode::SafeStop | EventCode::PowerOff)
    };
    cycle.sim_state.fallen == 1 || cycle.events.iter().any(|&(_, code, _)| ends(code))
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let mut setup = Setup::load(&config::root(None), "push").unwrap();
        setup.scene.pushes.clear();
        let start = &at_instants(&setup, 1).unwrap()[0];
        assert!(survives(start, [0.0, 1.0], 1.0));
        assert!(!survives(start, [0.0, 1.0], MOST));
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
