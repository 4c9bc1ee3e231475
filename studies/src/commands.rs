//! Random commands: of so many timelines that the planner accepts, how many does the robot walk to their ends?
//!
//! A timeline is 20 to 40 s of velocities, steps and stops drawn from the whole range of the gait, each number by itself, at
//! random times; the last command is held for `HELD`. Walked means: to the end, with the supply on, and then as fast in
//! each direction as the last accepted command said, or the planner if it said that it shortens the steps.

use chain::ending::{Ending, WalkEnd};
use chain::{Chain, parallel};
use config::Setup;
use config::gait::CommandLimits;
use messages::command::{StepCommand, VelocityCommand};
use messages::{Command, Detail, EventCode, GaitState, Process};
use serde::Serialize;

use crate::random::Random;
use crate::sheet::{Column, plain};
use crate::undisturbed::{STEP, on_type};
use crate::way::Way;
use crate::{Error, Given, Sheet, Study};

/// \[s\] The first command; the robot stands by then.
const BEGIN: f64 = 3.0;
/// \[s\] How long the last command is held.
const HELD: f64 = 10.0;
/// \[s\] Last part of that, in which speeds are looked at.
const WATCHED: f64 = 4.0;
/// \[m/s, m/s, rad/s\] Speeds may be off by this much, most of it the swaying of a part of a step, and by a twentieth.
const OFF: [f64; 3] = [0.03, 0.03, 0.03];

const COLUMNS: &[Column] = &[
    plain("/depth", "type"),
    plain("/timelines", "timelines"),
    plain("/accepted", "commands accepted"),
    plain("/refused", "refused"),
    plain("/shortened", "shortened"),
    plain("/fell", "fell"),
    plain("/stopped", "supply lost or stopped"),
    plain("/not_as_told", "not as told at the end"),
    plain("/seeds", "seeds of those"),
];

/// The study's arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct RandomCommands {
    /// Scene whose robot, gait and sensors they are; its own commands are left out.
    #[arg(long, default_value = "walk_2kmh_sensors")]
    pub scene: String,
    /// How many timelines each type walks.
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub timelines: u64,
    /// Seed of the first timeline; the others count on.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Simulation types.
    #[arg(long, value_delimiter = ',', default_values_t = [1, 2, 3], value_parser = clap::value_parser!(u8).range(1..=5))]
    pub types: Vec<u8>,
}

/// Timelines of one type.
#[derive(Serialize)]
struct Row {
    depth: u8,
    timelines: u64,
    accepted: u64,
    refused: u64,
    shortened: u64,
    fell: u64,
    stopped: u64,
    not_as_told: u64,
    seeds: String,
}

/// One timeline, walked.
struct Walked {
    seed: u64,
    accepted: u64,
    refused: u64,
    shortened: u64,
    end: WalkEnd,
    as_told: bool,
}

impl Walked {
    fn failed(&self) -> bool {
        self.end != WalkEnd::Done || !self.as_told
    }
}

impl Study for RandomCommands {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        let mut rows = Vec::new();
        for (done, &depth) in self.types.iter().enumerate() {
            (given.progress)(done, self.types.len(), &format!("type {depth}"));
            let setup = of_type(Setup::load(given.config, &self.scene)?, depth);
            let walked =
                parallel::map(self.timelines as usize, |k| walk(&setup, self.seed.wrapping_add(k as u64)));
            let walked = walked.into_iter().collect::<Result<Vec<_>, _>>()?;
            rows.push(summed(depth, &walked));
        }
        let mut sheet = Sheet::titled(format!(
            "Random commands of 20 to 40 s, scene {}, seeds from {}",
            self.scene, self.seed
        ));
        sheet.rows("rows", COLUMNS, &rows);
        Ok(sheet)
    }
}

/// The scene on another type, and without commands of its own.
fn of_type(mut setup: Setup, depth: u8) -> Setup {
    on_type(&mut setup, depth, if depth == 1 { 1e-3 } else { STEP });
    uncommanded(setup)
}

/// The scene standing, and nobody pushes.
fn uncommanded(mut setup: Setup) -> Setup {
    setup.scene.commands.retain(|(_, command)| matches!(command, Command::Stand));
    setup.scene.pushes.clear();
    setup
}

/// Timelines that are not walked as told: their seeds, and how they end.
///
/// # Errors
/// The robot cannot be built.
pub(crate) fn not_as_told(setup: &Setup, seeds: &[u64]) -> Result<Vec<String>, String> {
    let setup = uncommanded(setup.clone());
    let mut failed = Vec::new();
    for &seed in seeds {
        let walked = walk(&setup, seed)?;
        let how = if walked.end == WalkEnd::Done { "not as told".into() } else { walked.end.to_string() };
        failed.extend(walked.failed().then(|| format!("seed {seed}: {how}")));
    }
    Ok(failed)
}

fn summed(depth: u8, walked: &[Walked]) -> Row {
    let count = |of: &dyn Fn(&Walked) -> bool| walked.iter().filter(|w| of(w)).count() as u64;
    let seeds: Vec<String> = walked.iter().filter(|w| w.failed()).map(|w| w.seed.to_string()).collect();
    Row {
        depth,
        timelines: walked.len() as u64,
        accepted: walked.iter().map(|w| w.accepted).sum(),
        refused: walked.iter().map(|w| w.refused).sum(),
        shortened: walked.iter().map(|w| w.shortened).sum(),
        fell: count(&|w| w.end == WalkEnd::Fell),
        stopped: count(&|w| !matches!(w.end, WalkEnd::Fell | WalkEnd::Done)),
        not_as_told: count(&|w| w.end == WalkEnd::Done && !w.as_told),
        seeds: seeds.join(" "),
    }
}

/// What the robot was told to do, as far as the planner accepted it.
#[derive(Clone, Copy, Default)]
struct Told {
    walks: bool,
    /// \[m/s, m/s, rad/s\] Forward, to the left, turn.
    speeds: [f64; 3],
}

impl Told {
    fn take(&mut self, command: &Command) {
        match command {
            Command::Velocity(v) => {
                let speeds = [v.forward, v.left, v.turn];
                (self.walks, self.speeds) = (speeds != [0.0; 3], speeds);
            }
            Command::Step(s) => self.speeds = [s.length, s.side, s.turn].map(|x| x / s.duration),
            Command::Stop => self.walks = false,
            _ => {}
        }
    }

    /// The planner said that it walks these steps instead.
    fn shorten(&mut self, detail: Detail) {
        if let Detail::Steps { length, side, turn, duration } = detail {
            self.speeds = [length, side, turn].map(|x| f64::from(x) / f64::from(duration));
        }
    }

    fn is_near(&self, speeds: [f64; 3]) -> bool {
        let told = if self.walks { self.speeds } else { [0.0; 3] };
        (0..3).all(|i| (speeds[i] - told[i]).abs() <= OFF[i] + 0.05 * told[i].abs())
    }
}

/// Walks the timeline of a seed.
fn walk(setup: &Setup, seed: u64) -> Result<Walked, String> {
    let mut random = Random(seed);
    let commands = timeline(&setup.gait.limits, &mut random);
    let end = commands.last().map_or(BEGIN, |(time, _)| *time) + HELD;
    let mut chain = Chain::new(setup).map_err(|e| e.to_string())?;
    let (mut ending, mut told) = (Ending::default(), Told::default());
    let (mut accepted, mut refused, mut shortened) = (0, 0, 0);
    let mut next = commands.iter().peekable();
    let (mut way, mut gone, mut watched) = (Way::default(), [0.0; 3], 0.0);
    for tick in 1..=(end / chain.cycle()) as u64 {
        let (time, cycle) = (tick as f64 * chain.cycle(), chain.cycle());
        let command = next.next_if(|(due, _)| *due <= time).map(|(_, command)| command);
        if let Some(command) = command {
            chain.command(command);
        }
        let c = chain.step();
        if let Some(command) = command {
            let no = |&(who, code, _): &(Process, EventCode, _)| {
                who == Process::Planner && matches!(code, EventCode::CommandRefused | EventCode::NotStanding)
            };
            if c.events.iter().any(no) {
                refused += 1;
            } else {
                accepted += 1;
                told.take(command);
            }
            for &(_, _, detail) in c.events.iter().filter(|e| e.1 == EventCode::CommandShortened) {
                shortened += 1;
                told.shorten(detail);
            }
        }
        // How it ends, and how fast the robot is then, in its own axes.
        c.events.iter().for_each(|&(_, code, detail)| ending.tell(time, code, detail));
        ending.see(time, c.power.on == 1, GaitState::from(c.controller_state.gait));
        if c.sim_state.fallen == 1 {
            break;
        }
        // Weighed by a triangle: what she sways to the sides, over a time that is no whole stride, is no speed.
        if time > end - WATCHED {
            let before = way.gone;
            way.add(&c.sim_state, cycle);
            let weight = 1.0 - (2.0 * (end - time) / WATCHED - 1.0).abs();
            watched += weight * cycle;
            gone = std::array::from_fn(|i| gone[i] + weight * (way.gone[i] - before[i]));
        }
    }
    Ok(Walked {
        seed,
        accepted,
        refused,
        shortened,
        end: ending.end().0,
        as_told: told.is_near(gone.map(|x| x / watched)),
    })
}

/// Commands with their times \[s\].
fn timeline(limits: &CommandLimits, random: &mut Random) -> Vec<(f64, Command)> {
    let length = random.within([20.0, 40.0]);
    let (mut time, mut commands) = (BEGIN, Vec::new());
    while time < BEGIN + length {
        commands.push((time, command(limits, random)));
        time += random.within([0.3, 8.0]);
    }
    commands
}

/// A command within the ranges of the gait: velocities three times as often as steps, a stop now and then.
fn command(limits: &CommandLimits, random: &mut Random) -> Command {
    let duration = random.within(limits.duration);
    let mut number = |range: [f64; 2]| if random.unit() < 0.3 { 0.0 } else { random.within(range) };
    let [length, side, turn] = [limits.length, limits.side, limits.turn].map(&mut number);
    match random.unit() {
        kind if kind < 0.1 => Command::Stop,
        kind if kind < 0.3 => Command::Step(StepCommand { length, side, turn, duration }),
        _ => Command::Velocity(VelocityCommand {
            forward: length / duration,
            left: side / duration,
            turn: turn / duration,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use config::root;

    #[test]
    fn the_same_seed_is_the_same_timeline_and_ranges_are_kept() {
        let limits = Setup::load(&root(None), "walk_1kmh").unwrap().gait.limits;
        let of = |seed| timeline(&limits, &mut Random(seed));
        assert_eq!(of(7), of(7));
        assert_ne!(of(7), of(8));
        let all: Vec<Command> = (0..200).flat_map(of).map(|(_, command)| command).collect();
        let (mut stops, mut steps) = (0, 0);
        for command in &all {
            match command {
                Command::Stop => stops += 1,
                Command::Step(s) => {
                    steps += 1;
                    assert!(s.length >= limits.length[0] && s.length <= limits.length[1], "{s:?}");
                }
                Command::Velocity(_) => {}
                other => panic!("{other:?}"),
            }
        }
        assert!(stops > all.len() / 20 && steps > all.len() / 8, "{stops}, {steps} of {}", all.len());
    }

    /// A robot that is told nothing walks as told; one that was told to walk and stands still does not.
    #[test]
    fn speeds_are_held_against_what_was_accepted() {
        let mut told = Told::default();
        assert!(told.is_near([0.0; 3]) && !told.is_near([0.2, 0.0, 0.0]));
        told.take(&Command::Velocity(VelocityCommand { forward: 0.3, left: 0.0, turn: 0.1 }));
        assert!(told.is_near([0.31, 0.0, 0.1]) && !told.is_near([0.0; 3]) && !told.is_near([0.3, 0.0, 0.0]));
        told.take(&Command::Stop);
        assert!(told.is_near([0.0; 3]));
    }

    /// One whole timeline, whatever comes of it, is the same twice.
    #[test]
    fn a_timeline_is_walked_the_same_way_twice() {
        let setup = of_type(Setup::load(&root(None), "walk_1kmh").unwrap(), 1);
        let of = || walk(&setup, 3).map(|w| (w.accepted, w.refused, w.end, w.as_told)).unwrap();
        let first = of();
        assert_eq!(first, of());
        assert!(first.0 > 1, "{first:?}");
    }

    /// Timelines that nobody chose, with an IMU up to three times as askew as the thesis's: none ends in a fall or a stop. Without the
    /// trim that is learned while she stands 2 of the 12 do.
    #[test]
    fn timelines_are_walked_with_an_imu_that_is_askew() {
        let setup = of_type(Setup::load(&root(None), "walk_2kmh_sensors").unwrap(), 1);
        let ends = parallel::map(12, |k| {
            let (seed, mut setup) = (53_001 + k as u64, setup.clone());
            let mut random = Random(!seed);
            let bias = [0, 1].map(|_| random.within([-0.015, 0.015]));
            setup.scene.sensors.imu.bias = [bias[0], bias[1], 0.0];
            (seed, bias, walk(&setup, seed).unwrap().end)
        });
        let fell: Vec<_> = ends.iter().filter(|(_, _, end)| *end != WalkEnd::Done).collect();
        assert!(fell.is_empty(), "{fell:?}");
    }
}
