//! `gangwerk study viability`: which disturbances and errors does a gait survive?
//!
//! The thesis's way to a margin of stability (3.4): put errors and disturbances into the simulation, and see whether the
//! robot falls. Each is tried alone, larger and larger by bisection, everything else as in the scene.
//!
//! - *Pushes* of 0.1 s at the torso, in eight directions, at instants spread over a stride; survived: 4 s later the robot
//!   still walks.
//! - *Errors* are there from the beginning; survived: the robot does what it is told to the end of the scene. No command is
//!   refused, nothing stops it, and it has walked the way that it walks without the error, within a tenth, and ends standing
//!   where it does so without.
//! - *Two errors* at once: the share of what is survived of each alone that is survived of both together.
//!
//! Bisection takes for granted that what survives much survives less. Three lesser values are tried afterwards, and
//! one that is not survived is told (`holes`). Where even the most that is tried is survived there is no border, and the
//! table says so instead of a number.

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use config::Setup;
use config::method::Integrator;
use serde::Serialize;
use serde_json::{Value, json};

use super::errors::{ErrorSource, kinds};
use super::picture;
use crate::search::{NoBorder, Width, border};
use crate::sheet::{Column, fixed, plain};
use crate::{Error, Given, Sheet, Study, push, undisturbed};
use chain::Chain;
use chain::ending::{Ending, WalkEnd};
use chain::parallel;
use messages::GaitState;

/// Scene unless another one is asked for.
const SCENE: &str = "walk_1kmh";
/// Directions of pushes, counter-clockwise from forward.
pub(super) const DIRECTIONS: usize = 8;
/// Shares of a survived value at which it is looked whether less is survived, too.
const LESS: [f64; 3] = [0.25, 0.5, 0.75];
/// \[1\] By how much the way may differ from that of the undisturbed robot.
const WAY: f64 = 0.1;
/// \[m\] By how much at least, where the way is short.
const ASIDE: f64 = 0.1;
/// Errors that are tried together.
const PAIRS: [[&str; 2]; 5] = [
    ["IMU bias, roll", "tilt of the ground, roll"],
    ["IMU bias, pitch", "tilt of the ground, pitch"],
    ["IMU bias, roll", "calibration of right hip adduction"],
    ["stiffness of the soles", "delay of all sensors"],
    ["stiffness of the gears", "delay of all sensors"],
];

/// What of one error is survived.
const ERRORS: &[Column] = &[
    plain("/name", "error"),
    plain("/unit", "unit"),
    plain("/from", "from"),
    plain("/to", "to"),
    plain("/beyond", "beyond: below, above"),
    fixed("/holes", "but not", 2),
];
/// What of two errors is survived together.
const TOGETHER: &[Column] = &[
    plain("/names/0", "error"),
    plain("/names/1", "together with"),
    fixed("/shares/0", "both more [share of each alone]", 2),
    fixed("/shares/1", "less, more", 2),
    fixed("/shares/2", "both less", 2),
    fixed("/shares/3", "more, less", 2),
];
/// Push of 0.1 s at the torso, counter-clockwise from forward.
const PUSHES: &[Column] = &[
    plain("/0", "direction, push [N s]"),
    fixed("/1/0", "0°", 2),
    fixed("/1/1", "45°", 2),
    fixed("/1/2", "90°", 2),
    fixed("/1/3", "135°", 2),
    fixed("/1/4", "180°", 2),
    fixed("/1/5", "225°", 2),
    fixed("/1/6", "270°", 2),
    fixed("/1/7", "315°", 2),
];

/// The study's arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct Viability {
    /// Another scene than walk_1kmh.
    #[arg(long)]
    pub scene: Option<String>,
    /// Depth of the model, 1 to 5, instead of the scene's; with motors their implicit steps, four per cycle.
    #[arg(long, value_parser = clap::value_parser!(u8).range(1..=5))]
    pub depth: Option<u8>,
    /// Only errors whose names hold this, and no pushes.
    #[arg(long, value_name = "PART")]
    pub error: Option<String>,
    /// How many instants of a stride are pushed at.
    #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u64).range(1..=100))]
    pub instants: u64,
    /// Two instants, and borders four times as coarse.
    #[arg(long)]
    pub quick: bool,
    /// Directory of the picture.
    #[arg(long, value_name = "DIR", default_value = "runs/study/viability")]
    pub out: PathBuf,
}

/// Largest impulses survived.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Pushes {
    /// \[N s\] By instant of the stride, then by direction: counter-clockwise from forward, steps of 45 degrees.
    pub(super) impulse_n_s: Vec<Vec<f64>>,
    /// \[N s\] By direction: survived whenever it comes.
    pub(super) always_n_s: Vec<f64>,
}

/// What of one error is survived.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Survived {
    /// What is wrong.
    pub(super) name: String,
    /// Unit of the numbers.
    pub(super) unit: &'static str,
    /// From, to; zero is no error (of a factor: one). None where all that was tried is survived.
    pub(super) interval: [Option<f64>; 2],
    /// What was tried at most.
    pub(super) tried: [f64; 2],
    /// How the walk ends just beyond.
    pub(super) beyond: [String; 2],
    /// Lesser values inside of the interval that are not survived.
    pub(super) holes: Vec<f64>,
}

/// What of two errors is survived together.
#[derive(Clone, Debug, Serialize)]
struct Together {
    names: [String; 2],
    /// \[1\] Share of what is survived of each alone: both positive, then counter-clockwise; none where a side has no border.
    shares: [Option<f64>; 4],
}

/// One side of an error.
#[derive(Clone, Debug, Default)]
struct Side {
    /// The border; none where all that was tried is survived.
    border: Option<f64>,
    beyond: String,
    holes: Vec<f64>,
}

impl Study for Viability {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        let (instants, fine) = if self.quick { (2, 4.0) } else { (self.instants as usize, 1.0) };
        let mut setup = Setup::load(given.config, self.scene.as_deref().unwrap_or(SCENE))?;
        setup.scene.pushes.clear();
        if let Some(depth) = self.depth {
            setup.scene.depth = depth;
            if depth > 1 {
                (setup.scene.integrator, setup.scene.substeps) = (Integrator::SemiImplicit, 4);
            }
        }
        let scene = &setup.scene.name;
        let told = walk(&setup)?;
        if told.ended != "done" {
            return Err(format!(
                "scene {scene}: the robot does not get to the end by itself: {}",
                told.ended
            )
            .into());
        }
        let mut kinds = kinds(&setup, told.way[0]);
        kinds.retain(|kind| self.error.as_ref().is_none_or(|part| kind.name.contains(part.as_str())));
        let sides = 2 * kinds.len();
        let done = AtomicUsize::new(0);
        let tick = |of: usize| (given.progress)(done.fetch_add(1, Ordering::Relaxed) + 1, of, "");

        // Errors: both sides of each, by bisection over whole scenes.
        let found = parallel::map(sides, |k| {
            let found = side(&setup, &told, &kinds[k / 2], k % 2, fine);
            tick(sides);
            found
        });
        let found = found.into_iter().collect::<Result<Vec<_>, _>>()?;
        let errors: Vec<_> =
            kinds.iter().zip(found.chunks(2)).map(|(kind, pair)| survived(kind, pair)).collect();
        let pairs = together(&setup, &told, &kinds, &found, fine)?;

        // All of it for people, with the picture.
        let depth = setup.scene.depth;
        let mut sheet = Sheet::titled(format!("{scene}, type {depth}: what is survived, each alone"));
        sheet.fact("scene", scene);
        sheet.fact("depth", depth);
        sheet.fact("errors", &errors);
        sheet.table(ERRORS, &errors.iter().map(Survived::row).collect::<Vec<_>>());
        sheet.line("");
        sheet.rows("pairs", TOGETHER, &pairs);
        if self.error.is_none() {
            let pushes = pushes(&setup, instants, fine, &tick)?;
            sheet.fact("pushes", &pushes);
            sheet.line("");
            let each = pushes.impulse_n_s.iter().enumerate();
            let at = each.map(|(k, at)| (format!("{k}/{instants} stride"), at));
            sheet.table(PUSHES, &at.chain([("always".into(), &pushes.always_n_s)]).collect::<Vec<_>>());
            sheet.draw(&self.out, "viability.png", &picture::of_viability(scene, &pushes, &errors))?;
        }
        Ok(sheet)
    }
}

/// Pushes in every direction at every instant.
fn pushes(setup: &Setup, instants: usize, fine: f64, tick: &(dyn Fn(usize) + Sync)) -> Result<Pushes, Error> {
    let starts = push::at_instants(setup, instants)?;
    let cases = starts.len() * DIRECTIONS;
    let impulses = parallel::map(cases, |k| {
        let turn = std::f64::consts::TAU * (k % DIRECTIONS) as f64 / DIRECTIONS as f64;
        let found = push::largest(&starts[k / DIRECTIONS], [turn.cos(), turn.sin()], fine);
        tick(0);
        found
    });
    let impulses = impulses.into_iter().collect::<Result<Vec<f64>, _>>()?;
    let impulse_n_s: Vec<Vec<f64>> = impulses.chunks(DIRECTIONS).map(<[f64]>::to_vec).collect();
    let least = |d: usize| impulse_n_s.iter().map(|at| at[d]).fold(f64::INFINITY, f64::min);
    Ok(Pushes { always_n_s: (0..DIRECTIONS).map(least).collect(), impulse_n_s })
}

impl Survived {
    /// For people: a side that does not exist is left out, and one without a border says so.
    fn row(&self) -> Value {
        let number = |k: usize| match self.interval[k] {
            _ if self.tried[k] == 0.0 => None,
            Some(x) => Some(format!("{x:.2}")),
            None => Some(format!("no border up to {:.2}", self.tried[k])),
        };
        let mut row = json!(self);
        (row["from"], row["to"]) = (json!(number(0)), json!(number(1)));
        row
    }
}

/// A scene with an error of a size.
fn with(setup: &Setup, errors: &[(&ErrorSource, f64)]) -> Setup {
    let mut setup = setup.clone();
    errors.iter().for_each(|(kind, x)| (kind.apply)(&mut setup, *x));
    setup
}

/// The border on one side, and lesser values that are not survived.
fn side(setup: &Setup, told: &Walked, kind: &ErrorSource, side: usize, fine: f64) -> Result<Side, String> {
    let most = kind.tried[side];
    if most == 0.0 {
        return Ok(Side::default());
    }
    let ending =
        |x: f64| walk(&with(setup, &[(kind, x)])).map_or_else(|refused| refused, |w| w.compared(told));
    // Without the error the robot gets to the end: that is known.
    let survives = |x: f64| x == 0.0 || ending(x) == "done";
    match border([0.0, most], Width::Absolute(kind.resolution * fine), |x| Ok(survives(x))) {
        Ok([found, beyond]) => {
            let holes = holes(found, survives);
            Ok(Side { border: Some(found), beyond: ending(beyond), holes })
        }
        Err(NoBorder { holds: true, .. }) => Ok(Side { holes: holes(most, survives), ..Side::default() }),
        Err(none) => Err(none.to_string()),
    }
}

fn holes(found: f64, survives: impl Fn(f64) -> bool) -> Vec<f64> {
    LESS.into_iter().map(|s| s * found).filter(|x| *x != 0.0 && !survives(*x)).collect()
}

fn survived(kind: &ErrorSource, found: &[Side]) -> Survived {
    let shown = |x: f64| if kind.factor { x.exp2() } else { x };
    Survived {
        name: kind.name.clone(),
        unit: kind.unit,
        interval: [0, 1].map(|k| {
            let border = if kind.tried[k] == 0.0 { Some(0.0) } else { found[k].border };
            border.map(shown)
        }),
        tried: kind.tried.map(|x| if x == 0.0 { 0.0 } else { shown(x) }),
        beyond: [found[0].beyond.clone(), found[1].beyond.clone()],
        holes: found.iter().flat_map(|f| f.holes.iter().map(|x| shown(*x))).collect(),
    }
}

/// Signs of two errors, counter-clockwise from both positive: sides of the first and of the second.
const QUADRANTS: [[usize; 2]; 4] = [[1, 1], [0, 1], [0, 0], [1, 0]];

/// What is survived of the pairs of errors that there are, both at the same share of what is survived of each alone.
fn together(
    setup: &Setup,
    told: &Walked,
    kinds: &[ErrorSource],
    alone: &[Side],
    fine: f64,
) -> Result<Vec<Together>, String> {
    let place = |name: &str| kinds.iter().position(|kind| kind.name.starts_with(name));
    let pairs: Vec<[usize; 2]> = PAIRS.iter().filter_map(|[a, b]| Some([place(a)?, place(b)?])).collect();
    let shares = parallel::map(4 * pairs.len(), |k| {
        let ([a, b], [side_a, side_b]) = (pairs[k / 4], QUADRANTS[k % 4]);
        let (Some(x), Some(y)) = (alone[2 * a + side_a].border, alone[2 * b + side_b].border) else {
            return Ok(None);
        };
        let survives = |share: f64| {
            let both = with(setup, &[(&kinds[a], share * x), (&kinds[b], share * y)]);
            walk(&both).is_ok_and(|w| w.compared(told) == "done")
        };
        // Errors that help each other may go further together than alone.
        let found =
            border([0.0, 4.0], Width::Absolute(0.03 * fine), |s| Ok::<_, String>(s == 0.0 || survives(s)));
        found.map(|[good, _]| Some(good))
    });
    let shares = shares.into_iter().collect::<Result<Vec<_>, _>>()?;
    let rows = pairs.iter().zip(shares.chunks(4)).map(|([a, b], shares)| Together {
        names: [kinds[*a].name.clone(), kinds[*b].name.clone()],
        shares: std::array::from_fn(|k| shares[k]),
    });
    Ok(rows.collect())
}

/// What the robot did in a scene.
#[derive(Clone, Debug, PartialEq)]
struct Walked {
    /// \[m\] Way of the torso forward and to the left, each as it heads.
    way: [f64; 2],
    /// How that ended: `done`, or why not.
    ended: String,
    /// Where in a walk the robot is then.
    gait: GaitState,
}

impl Walked {
    /// How it ended, compared with what the robot does undisturbed.
    fn compared(&self, told: &Self) -> String {
        let ([x, y], [a, b]) = (self.way, told.way);
        let apart = (x - a).hypot(y - b);
        if self.ended == "done" && self.gait != told.gait {
            return format!("{:?} at the end", self.gait);
        }
        if self.ended == "done" && apart > ASIDE.max(WAY * a.hypot(b)) {
            return format!("{apart:.1} m less or more than told");
        }
        self.ended.clone()
    }
}

/// Walks through a scene to its end, or until the robot falls or is stopped.
///
/// # Errors
/// The robot or the scene is refused.
fn walk(setup: &Setup) -> Result<Walked, String> {
    let mut chain = Chain::new(setup).map_err(|e| e.to_string())?;
    let (mut way, mut ending) = ([0.0; 2], Ending::default());
    let cycles = (setup.scene.duration / setup.scene.cycle) as u64;
    let mut gait = GaitState::Idle;
    for _ in 0..cycles {
        let cycle = chain.step();
        let state = &cycle.sim_state;
        ending.refused += cycle.refused;
        cycle.events.iter().for_each(|&(_, code, detail)| ending.tell(state.time, code, detail));
        gait = if state.fallen == 1 { GaitState::Fallen } else { cycle.controller_state.gait.into() };
        ending.see(state.time, state.power == 1, gait);
        way = [0, 1].map(|k| way[k] + state.velocity[k] * setup.scene.cycle);
        if undisturbed::ended(cycle) {
            break;
        }
    }
    let ended = match ending.end().0 {
        WalkEnd::Done if ending.refused > 0 => "a command was refused".into(),
        end => end.to_string(),
    };
    Ok(Walked { way, ended, gait })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn walking() -> Setup {
        let mut setup = Setup::load(&config::root(None), SCENE).unwrap();
        setup.scene.duration = 8.0;
        setup.scene.commands.retain(|(time, _)| *time < 8.0);
        setup
    }

    fn alone(setup: &Setup, name: &str, x: f64) -> String {
        let told = walk(setup).unwrap();
        let kinds = kinds(setup, told.way[0]);
        let kind = kinds.iter().find(|k| k.name == name).unwrap();
        walk(&with(setup, &[(kind, x)])).unwrap().compared(&told)
    }

    /// What the bisection says to be survived is, and the upper end of its bracket is not; further up there may be islands.
    #[test]
    fn a_border_lies_between_what_is_survived_and_what_is_not() {
        let setup = walking();
        let told = walk(&setup).unwrap();
        assert!(told.way[0] > 0.5 && told.ended == "done", "{told:?}");
        let kinds = kinds(&setup, told.way[0]);
        let kind = kinds.iter().find(|k| k.name == "IMU bias, pitch").unwrap();
        let found = side(&setup, &told, kind, 1, 20.0).unwrap();
        let border = found.border.unwrap();
        assert!(border > 0.5 && border < 15.0, "{found:?}");
        assert!(found.beyond != "done" && !found.beyond.is_empty(), "{found:?}");
        assert_eq!(alone(&setup, "IMU bias, pitch", border), "done");
        assert!(found.holes.is_empty(), "{found:?}");
    }

    /// A robot that never stands on its feet does not fall, but does not walk either: every command to walk is refused. It had been
    /// counted as having survived.
    #[test]
    fn a_robot_that_never_took_a_step_has_not_survived() {
        let mut setup = walking();
        setup.scene.commands.retain(|(_, command)| *command != messages::Command::Stand);
        assert_eq!(walk(&setup).unwrap().ended, "a command was refused");
    }

    /// A search whose ends do not differ has no border, and names none.
    #[test]
    fn what_is_survived_to_the_end_of_the_search_has_no_border() {
        let setup = walking();
        let told = walk(&setup).unwrap();
        let small = ErrorSource::new("IMU bias", "deg", [-0.1, 0.1], 0.1, |s, x| {
            s.scene.sensors.imu.bias[0] = x.to_radians();
        });
        let found = side(&setup, &told, &small, 0, 1.0).unwrap();
        assert_eq!((found.border, found.beyond.as_str()), (None, ""));
        let row = survived(&small, &[found, Side { border: Some(0.05), ..Side::default() }]).row();
        assert_eq!((&row["from"], &row["to"]), (&json!("no border up to -0.10"), &json!("0.05")));
    }

    /// A hole in what is survived is told.
    #[test]
    fn less_that_is_not_survived_is_told() {
        assert_eq!(holes(-8.0, |x| !(-5.0..-3.0).contains(&x)), [-4.0]);
        assert!(holes(8.0, |_| true).is_empty());
    }

    /// A way that is too short, or aside, was not walked as told.
    #[test]
    fn a_way_that_was_not_walked_is_not_survived() {
        let walked = |way, ended: &str| Walked { way, ended: ended.into(), gait: GaitState::Standing };
        let told = walked([3.6, 0.0], "done");
        for (way, expected) in [
            ([3.5, 0.1], "done"),
            ([3.0, 0.0], "0.6 m less or more than told"),
            ([0.0; 2], "3.6 m less or more than told"),
        ] {
            assert_eq!(walked(way, "done").compared(&told), expected);
        }
        assert_eq!(walked([0.0; 2], "fell").compared(&told), "fell");
        let walks_on = Walked { gait: GaitState::Walking, ..told.clone() };
        assert_eq!(walks_on.compared(&told), "Walking at the end");
    }

    /// A robot on ground that falls away by more than its friction holds does not survive, and says so.
    #[test]
    fn a_scene_that_is_not_survived_has_a_reason() {
        let mut setup = walking();
        setup.scene.plant_mismatch.ground_tilt = [0.0, 40f64.to_radians()];
        assert_ne!(walk(&setup).unwrap().ended, "done");
    }
}
