//! `gangwerk study viability`: which disturbances and errors does a gait survive?
//!
//! The thesis's way to a margin of stability (3.4): put errors and disturbances into the simulation, and see whether the
//! robot falls. Each is tried alone, larger and larger by bisection, everything else as in the scene.
//!
//! - *Pushes* of 0.1 s at the torso, in eight directions, at instants spread over a stride; survived: 4 s later the robot
//!   still walks.
//! - *Errors* are there from the beginning; survived: the robot gets to the end of the scene, and nothing stops it.
//!
//! Bisection takes for granted that what survives much survives less. Three lesser values are tried afterwards, and
//! one that is not survived is told (`holes`).

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use config::Setup;
use config::sensors::PerJoint;
use config::terrain::{ObjectShape, TerrainObject, TerrainPose};
use serde::Serialize;
use serde_json::{Value, json};

use super::picture;
use crate::sheet::{Column, fixed, plain};
use crate::{Error, Given, Sheet, Study, push};
use chain::Chain;
use chain::parallel;

/// Scene unless another one is asked for.
const SCENE: &str = "walk_1kmh";
/// Directions of pushes, counter-clockwise from forward.
pub(super) const DIRECTIONS: usize = 8;
/// Shares of a survived value at which it is looked whether less is survived, too.
const LESS: [f64; 3] = [0.25, 0.5, 0.75];
/// \[m\] Where the board lies, how long and wide it is; as in the scene `board`.
const BOARD: (f64, [f64; 2]) = (1.2, [0.4, 1.2]);
/// Joints whose calibration is wrong, of one leg, so far as a robot has them.
const JOINTS: [&str; 4] =
    ["right_hip_adduction", "right_knee_flexion", "right_ankle_flexion", "right_ankle_adduction"];

/// What of one error is survived.
const ERRORS: &[Column] = &[
    plain("/name", "error"),
    plain("/unit", "unit"),
    plain("/from", "from"),
    plain("/to", "to"),
    fixed("/holes", "but not", 2),
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
    /// From, to; zero is no error (of a factor: one).
    pub(super) interval: [f64; 2],
    /// What was tried at most.
    pub(super) tried: [f64; 2],
    /// Whether even that is survived.
    pub(super) beyond: [bool; 2],
    /// Lesser values inside of the interval that are not survived.
    pub(super) holes: Vec<f64>,
}

/// Puts an error of a size into a scene.
type Apply = dyn Fn(&mut Setup, f64) + Sync;

/// An error that a scene can have.
struct ErrorSource {
    name: String,
    unit: &'static str,
    /// Tried at most, in the unit; zero on a side that does not exist.
    tried: [f64; 2],
    /// Bisection ends with brackets this narrow, in the unit.
    resolution: f64,
    /// The number is a power of two.
    factor: bool,
    apply: Box<Apply>,
}

impl ErrorSource {
    fn new(
        name: impl Into<String>,
        unit: &'static str,
        tried: [f64; 2],
        resolution: f64,
        apply: impl Fn(&mut Setup, f64) + Sync + 'static,
    ) -> Self {
        Self { name: name.into(), unit, tried, resolution, factor: false, apply: Box::new(apply) }
    }
}

impl Study for Viability {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        let (instants, fine) = if self.quick { (2, 4.0) } else { (self.instants as usize, 1.0) };
        let mut setup = Setup::load(given.config, self.scene.as_deref().unwrap_or(SCENE))?;
        setup.scene.pushes.clear();
        let scene = &setup.scene.name;
        let way = walk(&setup).ok_or_else(|| format!("scene {scene}: the robot falls by itself"))?;
        let kinds = kinds(&setup, way);
        let starts = push::at_instants(&setup, instants)?;
        let (sides, cases) = (2 * kinds.len(), starts.len() * DIRECTIONS);
        let done = AtomicUsize::new(0);
        let tick = || (given.progress)(done.fetch_add(1, Ordering::Relaxed) + 1, sides + cases, "");

        // Errors: both sides of each, by bisection over whole scenes.
        let found = parallel::map(sides, |k| {
            let found = side(&setup, &kinds[k / 2], k % 2, fine);
            tick();
            found
        });
        let found = found.into_iter().collect::<Result<Vec<_>, _>>()?;
        let errors: Vec<_> =
            kinds.iter().zip(found.chunks(2)).map(|(kind, pair)| survived(kind, pair)).collect();
        // Pushes: every direction at every instant.
        let impulses = parallel::map(cases, |k| {
            let turn = std::f64::consts::TAU * (k % DIRECTIONS) as f64 / DIRECTIONS as f64;
            let found = push::largest(&starts[k / DIRECTIONS], [turn.cos(), turn.sin()], fine);
            tick();
            found
        });
        let impulses = impulses.into_iter().collect::<Result<Vec<f64>, _>>()?;
        let impulse_n_s: Vec<Vec<f64>> = impulses.chunks(DIRECTIONS).map(<[f64]>::to_vec).collect();
        let least = |d: usize| impulse_n_s.iter().map(|at| at[d]).fold(f64::INFINITY, f64::min);
        let pushes = Pushes { always_n_s: (0..DIRECTIONS).map(least).collect(), impulse_n_s };

        // All of it for people, with the picture.
        let mut sheet = Sheet::titled(format!("{scene}: what is survived, each alone"));
        sheet.fact("scene", scene);
        sheet.fact("errors", &errors);
        sheet.fact("pushes", &pushes);
        sheet.table(ERRORS, &errors.iter().map(Survived::row).collect::<Vec<_>>());
        sheet.line("");
        let at = pushes.impulse_n_s.iter().enumerate().map(|(k, at)| (format!("{k}/{instants} stride"), at));
        sheet.table(PUSHES, &at.chain([("always".into(), &pushes.always_n_s)]).collect::<Vec<_>>());
        sheet.draw(&self.out, "viability.png", &picture::of_viability(scene, &pushes, &errors))?;
        Ok(sheet)
    }
}

impl Survived {
    /// For people: a side that does not exist is left out, and one that was survived to its end is marked.
    fn row(&self) -> Value {
        let number = |k: usize| {
            let mark = if self.beyond[k] { "≥ " } else { "" };
            (self.tried[k] != 0.0).then(|| format!("{mark}{:.2}", self.interval[k]))
        };
        let mut row = json!(self);
        (row["from"], row["to"]) = (json!(number(0)), json!(number(1)));
        row
    }
}

/// All errors that make sense for a scene in which the robot gets `way` \[m\] far.
fn kinds(setup: &Setup, way: f64) -> Vec<ErrorSource> {
    let mut all = Vec::new();
    for (axis, name) in ["roll", "pitch"].into_iter().enumerate() {
        all.push(ErrorSource::new(format!("IMU bias, {name}"), "deg", [-20.0, 20.0], 0.1, move |s, x| {
            s.scene.sensors.imu.bias[axis] = x.to_radians();
        }));
    }
    for joint in JOINTS.into_iter().filter(|joint| setup.robot.joint(joint).is_some()) {
        let name = format!("calibration of {}", joint.replace('_', " "));
        all.push(ErrorSource::new(name, "deg", [-20.0, 20.0], 0.1, move |s, x| {
            let own = vec![(joint.to_string(), x.to_radians())];
            s.scene.plant_mismatch.joint_offset = PerJoint { all: None, own };
        }));
    }
    for (axis, name) in ["roll", "pitch"].into_iter().enumerate() {
        all.push(ErrorSource::new(
            format!("tilt of the ground, {name}"),
            "deg",
            [-15.0, 15.0],
            0.1,
            move |s, x| {
                s.scene.plant_mismatch.ground_tilt[axis] = x.to_radians();
            },
        ));
    }
    let stiffness = ErrorSource::new("stiffness of the soles, factor", "1", [-8.0, 6.0], 0.1, |s, x| {
        s.scene.plant_mismatch.contact_stiffness = x.exp2();
    });
    all.push(ErrorSource { factor: true, ..stiffness });
    all.push(ErrorSource::new("delay of all sensors", "ms", [0.0, 100.0], 1.0, |s, x| {
        let (delay, sensors) = (x.round() * 1e-3, &mut s.scene.sensors);
        (sensors.encoder.delay, sensors.motor_encoder.delay) = (delay, delay);
        (sensors.force_torque.delay, sensors.imu.delay) = (delay, delay);
    }));
    if way > BOARD.0 + 0.5 * BOARD.1[0] {
        all.push(ErrorSource::new("height of a board in the way", "mm", [0.0, 100.0], 0.5, |s, x| {
            s.scene.objects.push(board(x * 1e-3));
        }));
    }
    all
}

fn board(height: f64) -> TerrainObject {
    let (x, [length, width]) = BOARD;
    TerrainObject {
        name: "board".into(),
        shape: ObjectShape::Box([length, width, height]),
        pose: TerrainPose { position: [x, 0.0, 0.5 * height], rotation: [0.0; 3] },
        friction: None,
        appears: 0.0,
        vanishes: f64::INFINITY,
        known: false,
        poses: Vec::new(),
    }
}

/// The border on one side: value, whether it is beyond what was tried, lesser values that are not survived.
fn side(setup: &Setup, kind: &ErrorSource, side: usize, fine: f64) -> Result<(f64, bool, Vec<f64>), String> {
    let most = kind.tried[side];
    if most == 0.0 {
        return Ok((0.0, false, Vec::new()));
    }
    let sign = most.signum();
    let survives = |x: f64| {
        let mut setup = setup.clone();
        (kind.apply)(&mut setup, sign * x);
        walk(&setup).is_some()
    };
    if survives(most.abs()) {
        return Ok((most, true, holes(most, sign, survives)));
    }
    // That the most is not survived is known.
    let inside = |x: f64| x != most.abs() && survives(x);
    let found = sign * push::survived(most.abs(), kind.resolution * fine, inside)?;
    Ok((found, false, holes(found, sign, survives)))
}

fn holes(found: f64, sign: f64, survives: impl Fn(f64) -> bool) -> Vec<f64> {
    LESS.into_iter().map(|s| s * found).filter(|x| *x != 0.0 && !survives(sign * x)).collect()
}

fn survived(kind: &ErrorSource, found: &[(f64, bool, Vec<f64>)]) -> Survived {
    let shown = |x: f64| if kind.factor { x.exp2() } else { x };
    Survived {
        name: kind.name.clone(),
        unit: kind.unit,
        interval: [shown(found[0].0), shown(found[1].0)],
        tried: kind.tried.map(shown),
        beyond: [found[0].1, found[1].1],
        holes: found.iter().flat_map(|f| f.2.iter().map(|x| shown(*x))).collect(),
    }
}

/// \[m\] How far along x the robot gets in a scene; none if it does not survive it.
fn walk(setup: &Setup) -> Option<f64> {
    let mut chain = Chain::new(setup).ok()?;
    let start = chain.robot().state().position[0];
    let cycles = (setup.scene.duration / setup.scene.cycle) as u64;
    (0..cycles).all(|_| !push::ended(chain.step())).then(|| chain.robot().state().position[0] - start)
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

    /// What the bisection says to be survived is, and the upper end of its bracket is not; further up there may be islands.
    #[test]
    fn a_border_lies_between_what_is_survived_and_what_is_not() {
        let setup = walking();
        let way = walk(&setup).unwrap();
        assert!(way > 0.5, "{way} m");
        let kinds = kinds(&setup, way);
        let kind = kinds.iter().find(|k| k.name == "IMU bias, pitch").unwrap();
        let (found, beyond, holes) = side(&setup, kind, 1, 20.0).unwrap();
        assert!(!beyond && found > 0.5 && found < 15.0, "{found} deg");
        let mut bracket = kind.tried[1];
        while bracket > 20.0 * kind.resolution {
            bracket *= 0.5;
        }
        for (x, survives) in [(found, true), (found + bracket, false)] {
            let mut setup = setup.clone();
            (kind.apply)(&mut setup, x);
            assert_eq!(walk(&setup).is_some(), survives, "{x} deg");
        }
        assert!(holes.is_empty(), "{holes:?}");
    }

    /// A hole in what is survived is told.
    #[test]
    fn less_that_is_not_survived_is_told() {
        assert_eq!(holes(-8.0, -1.0, |x| !(3.0..5.0).contains(&x)), [-4.0]);
        assert!(holes(8.0, 1.0, |_| true).is_empty());
    }

    /// A robot on ground that falls away by more than its friction holds does not survive, and says so.
    #[test]
    fn a_scene_that_is_not_survived_has_no_way() {
        let mut setup = walking();
        setup.scene.plant_mismatch.ground_tilt = [0.0, 40f64.to_radians()];
        assert_eq!(walk(&setup), None);
    }
}
