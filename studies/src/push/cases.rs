//! What is pushed: every combination of walk, type, cycle, sensors and height that the arguments name.

use std::path::Path;

use config::Setup;
use messages::Command;

use super::Push;
use super::instants::{Instant, at_random, at_rest};
use crate::Error;
use crate::undisturbed::{STEP, on_type, walk_at};

/// Walking in place, and walking at 1 km/h: what is pushed unless told otherwise.
const SCENES: [&str; 2] = ["push", "walk_1kmh"];
/// Scenes with the sensors of a robot as they really err, by the robot.
const ERRING: [(&str, &str); 2] = [("lola", "walk_2kmh_sensors"), ("johnnie", "johnnie_motor_encoders")];

/// Sensors of the robot that is pushed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum SensorChoice {
    /// Everything is measured exactly.
    Ideal,
    /// They err as those of the robot do.
    Erring,
}

/// One robot that is pushed.
#[derive(Clone)]
pub(super) struct Case {
    pub(super) setup: Setup,
    /// In tables: the scene, or how it walks.
    pub(super) walk: String,
    pub(super) sensors: String,
    /// \[m\] Above the torso's own centre of gravity.
    pub(super) above: f64,
    stands: bool,
}

/// A number that is not below zero.
pub(super) fn number(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|x| (0.0..=100.0).contains(x));
    number.ok_or_else(|| "it takes a number from 0 to 100".into())
}

/// A bus cycle \[ms\].
pub(super) fn cycle(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|x| (0.1..=20.0).contains(x));
    number.ok_or_else(|| "it takes a number from 0.1 to 20 ms".into())
}

/// All of them.
pub(super) fn of(arguments: &Push, config: &Path) -> Result<Vec<Case>, Error> {
    let mut cases = Vec::new();
    for case in walks(arguments, config)? {
        for depth in or_none(&arguments.types) {
            for cycle in or_none(&arguments.cycles) {
                for sensors in or_none(&arguments.sensors) {
                    for &above in &arguments.height {
                        let mut case = Case { above, ..case.clone() };
                        case.choose(depth, cycle.map(|ms| 1e-3 * ms));
                        case.sense(sensors, config)?;
                        cases.push(case);
                    }
                }
            }
        }
    }
    Ok(cases)
}

/// Each of a list, or the scene's own if it is empty.
fn or_none<T: Copy>(list: &[T]) -> Vec<Option<T>> {
    if list.is_empty() { vec![None] } else { list.iter().copied().map(Some).collect() }
}

/// How the robot walks, or that it stands.
fn walks(arguments: &Push, config: &Path) -> Result<Vec<Case>, Error> {
    let case = |scene: &str| -> Result<Case, Error> {
        let setup = Setup::load(config, scene)?;
        Ok(Case { setup, walk: scene.into(), sensors: "scene's".into(), above: 0.0, stands: false })
    };
    // As the scenes walk, then at the speeds asked for, then standing.
    let base = arguments.scene.as_deref();
    let mut all = Vec::new();
    if arguments.speeds.is_empty() && !arguments.standing {
        for scene in base.map_or(SCENES.to_vec(), |scene| vec![scene]) {
            all.push(case(scene)?);
        }
    }
    for &kmh in &arguments.speeds {
        let mut walking = case(base.unwrap_or(SCENES[1]))?;
        walking.walk_at(kmh)?;
        all.push(walking);
    }
    if arguments.standing {
        let mut standing = case(base.unwrap_or(SCENES[1]))?;
        standing.setup.scene.commands.retain(|(_, command)| *command == Command::Stand);
        (standing.walk, standing.stands) = (format!("{} stands", standing.setup.scene.robot), true);
        all.push(standing);
    }
    Ok(all)
}

impl Case {
    fn walk_at(&mut self, kmh: f64) -> Result<(), String> {
        self.walk = format!("{} at {kmh} km/h", self.setup.scene.robot);
        walk_at(&mut self.setup, kmh)?;
        // A velocity of zero is a stop.
        for (_, command) in &mut self.setup.scene.commands {
            if kmh == 0.0 && matches!(command, Command::Velocity(_)) {
                *command = Command::Start;
            }
        }
        Ok(())
    }

    fn choose(&mut self, depth: Option<u8>, cycle: Option<f64>) {
        let scene = &mut self.setup.scene;
        if depth.is_some() || cycle.is_some() {
            scene.cycle = cycle.unwrap_or(scene.cycle);
            let depth = depth.unwrap_or(scene.depth);
            on_type(&mut self.setup, depth, STEP);
        }
    }

    fn sense(&mut self, sensors: Option<SensorChoice>, config: &Path) -> Result<(), Error> {
        let scene = &mut self.setup.scene;
        match sensors {
            None => {}
            Some(SensorChoice::Ideal) => (scene.sensors, self.sensors) = (Default::default(), "ideal".into()),
            Some(SensorChoice::Erring) => {
                let of = ERRING.iter().find(|(robot, _)| *robot == scene.robot);
                let (_, of) =
                    of.ok_or_else(|| format!("nobody has said how the sensors of {} err", scene.robot))?;
                (scene.sensors, self.sensors) = (Setup::load(config, of)?.scene.sensors, "erring".into());
            }
        }
        Ok(())
    }

    /// The robot at so many instants of a seed.
    pub(super) fn starts(&self, instants: usize, seed: u64) -> Result<Vec<Instant>, Error> {
        if self.stands { at_rest(&self.setup) } else { at_random(&self.setup, instants, seed) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        push: Push,
    }

    fn cases(line: &str) -> Vec<Case> {
        let line = Line::try_parse_from(std::iter::once("push").chain(line.split_whitespace())).unwrap();
        of(&line.push, &config::root(None)).unwrap()
    }

    #[test]
    fn arguments_are_combined_and_none_leaves_the_scenes_as_they_are() {
        let [spot, walk] = &cases("")[..] else { panic!() };
        assert_eq!([&*spot.walk, &*walk.walk], SCENES);
        assert_eq!((walk.setup.scene.depth, walk.setup.scene.cycle, walk.above), (1, 1e-3, 0.0));
        let all =
            cases("--speeds 0,2 --standing --types 1,3 --cycles 1,3.5 --sensors ideal,erring --height 0,0.3");
        assert_eq!(all.len(), 3 * 2 * 2 * 2 * 2);
        let last = all.last().unwrap();
        assert!(last.stands && last.setup.scene.sensors != Default::default());
        assert_eq!((last.setup.scene.depth, last.setup.scene.cycle, last.above), (3, 3.5e-3, 0.3));
        assert_eq!(last.setup.scene.substeps, 14);
        let starts = |case: &Case| case.setup.scene.commands.iter().any(|(_, c)| *c == Command::Start);
        assert!(starts(&all[0]) && !starts(last));
    }
}
