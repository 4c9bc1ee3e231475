//! Which impulse does the walking robot survive? Bisection, at several instants of a stride.
//!
//! A push of 0.1 s at the torso's origin. Survived: `AFTER` later the robot has not fallen, and no process has stopped
//! it. The way it walks repeats with every stride of two steps, so the instants are spread over one stride.

use std::path::Path;

use config::Setup;
use messages::command::PushCommand;
use messages::{EventCode, GaitState, LEFT, RIGHT};
use serde::Serialize;

use chain::parallel;
use chain::{Chain, Cycle};

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

/// What was found.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// \[kg\] Mass of the robot.
    pub mass_kg: f64,
    /// \[s\] Length of a push.
    pub push_duration_s: f64,
    /// One row per scene and direction.
    pub rows: Vec<Row>,
}

/// Pushes of one scene in one direction.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Name of the scene; its own pushes are left out.
    pub scene: String,
    /// World axes.
    pub direction: String,
    /// \[N s\] Largest impulse survived, at instants spread evenly over a stride; a stride begins with the single
    /// support of the right foot.
    pub impulse_n_s: Vec<f64>,
    /// \[N s\] The least of them: survived whenever it comes.
    pub always_n_s: f64,
    /// \[N s/kg\] The same over the robot's mass.
    pub always_n_s_per_kg: f64,
}

/// Pushes at `instants` of a stride, of all scenes, or of `only`.
///
/// # Errors
/// A configuration or robot is wrong, or a robot falls without a push.
pub fn run(config: &Path, only: Option<&str>, instants: usize) -> Result<Report, Box<dyn std::error::Error>> {
    let mut report = Report { mass_kg: 0.0, push_duration_s: DURATION, rows: Vec::new() };
    for scene in SCENES.into_iter().chain(only.filter(|s| !SCENES.contains(s))) {
        if only.is_some_and(|only| only != scene) {
            continue;
        }
        let mut setup = Setup::load(config, scene)?;
        setup.scene.pushes.clear();
        let robot = &setup.robot;
        let order: Vec<&str> = robot.joints.iter().map(|j| j.name.as_str()).collect();
        report.mass_kg = multibody::Model::from_urdf(&robot.urdf, &robot.torso, &order)?.mass();
        let starts = at_instants(&setup, instants)?;
        let impulses = parallel::map(DIRECTIONS.len() * instants, |k| {
            largest(&starts[k % instants], DIRECTIONS[k / instants].1, 1.0)
        });
        for ((direction, _), impulse_n_s) in DIRECTIONS.iter().zip(impulses.chunks(instants)) {
            let always = impulse_n_s.iter().copied().fold(f64::INFINITY, f64::min);
            report.rows.push(Row {
                scene: scene.into(),
                direction: (*direction).into(),
                impulse_n_s: impulse_n_s.to_vec(),
                always_n_s: always,
                always_n_s_per_kg: always / report.mass_kg,
            });
        }
    }
    Ok(report)
}

/// The walk of a scene at instants spread evenly over the first stride after [`SETTLED`].
pub(crate) fn at_instants(setup: &Setup, instants: usize) -> Result<Vec<Chain>, Box<dyn std::error::Error>> {
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
pub(crate) fn stride(setup: &Setup, settled: f64) -> Result<(u64, u64), Box<dyn std::error::Error>> {
    let mut chain = Chain::new(setup)?;
    let (mut stance, mut begins) = (LEFT, Vec::new());
    for tick in 1..=(setup.scene.duration / setup.scene.cycle) as u64 {
        let c = chain.step();
        if c.sim_state.fallen == 1 {
            return Err(format!("scene {}: the robot falls without a push", setup.scene.name).into());
        }
        let (now, gait) = (c.controller_state.load_left, GaitState::from(c.controller_state.gait));
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
pub(crate) fn largest(start: &Chain, direction: [f64; 2], coarse: f64) -> f64 {
    bisect(MOST, RESOLUTION * coarse, |impulse| survives(start, direction, impulse))
}

/// Largest value from 0 to `most` that is known to be survived when the bracket is as narrow as `resolution`.
pub(crate) fn bisect(most: f64, resolution: f64, survives: impl Fn(f64) -> bool) -> f64 {
    let (mut low, mut high) = (0.0, most);
    while high - low > resolution {
        let middle = 0.5 * (low + high);
        if survives(middle) { low = middle } else { high = middle }
    }
    low
}

/// Whether the robot goes on after a push now.
fn survives(start: &Chain, direction: [f64; 2], impulse: f64) -> bool {
    let mut chain = start.clone();
    let [x, y] = direction.map(|d| d * impulse / DURATION);
    chain.push(&PushCommand { force: [x, y, 0.0], duration: DURATION });
    (0..((DURATION + AFTER) / chain.cycle()) as u64).all(|_| !ended(chain.step()))
}

/// Whether the robot fell in this cycle, or a process stopped it.
pub(crate) fn ended(cycle: &Cycle) -> bool {
    let ends = |code| {
        matches!(code, EventCode::Fallen | EventCode::Lifted | EventCode::SafeStop | EventCode::PowerOff)
    };
    cycle.sim_state.fallen == 1 || cycle.events.iter().any(|&(_, code, _)| ends(code))
}

/// The report as lines for people.
pub fn table(r: &Report) -> String {
    let mut text = format!(
        "Largest impulse survived [N s]: {} s at the torso, {:.3} kg, instants spread over one stride\n\
         {:12}{:10}{:>8}{:>10}   at each instant",
        r.push_duration_s, r.mass_kg, "scene", "push", "always", "N s/kg"
    );
    for row in &r.rows {
        let each: String = row.impulse_n_s.iter().map(|x| format!("{x:7.2}")).collect();
        text += &format!(
            "\n{:12}{:10}{:8.2}{:10.3}   {each}",
            row.scene, row.direction, row.always_n_s, row.always_n_s_per_kg
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bisection_finds_the_edge_from_below() {
        let found = bisect(MOST, RESOLUTION, |x| x < 17.3);
        assert!(found < 17.3 && found > 17.3 - RESOLUTION, "{found}");
        assert_eq!(bisect(MOST, RESOLUTION, |_| false), 0.0);
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
