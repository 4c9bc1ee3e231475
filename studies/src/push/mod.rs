//! Which impulse does the robot survive? Bisection, at several instants of a stride.
//!
//! A push of 0.1 s at the torso's own centre of gravity, or above it. Survived: 6 s later the robot has not fallen, no
//! process has stopped it, and over the next stride it goes as far, as far sideways and as much round as it did before. The
//! way it walks repeats with every stride of two steps, so the instants are drawn from one stride. Beside it stands what a linear
//! pendulum with the same soles, reach and timing would be caught from in one step.

mod bound;
mod cases;
mod instants;
mod picture;

use std::f64::consts::FRAC_PI_4;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use chain::parallel;
use serde::Serialize;

pub use cases::SensorChoice;
pub(crate) use instants::{DURATION, Instant, at_instants, at_random, at_rest, largest, survives};

use crate::sheet::{Column, fixed, plain};
use crate::{Error, Given, Sheet, Study};
use bound::Pendulum;
use cases::Case;
use instants::largest_above;

/// Directions of the pushes, counterclockwise from the world's x axis, along which scenes walk.
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

/// Pushes of one case in one direction; the least one is survived whenever it comes.
const COLUMNS: &[Column] = &[
    plain("/walk", "robot"),
    plain("/depth", "type"),
    fixed("/cycle_s", "cycle [ms]", 1).times(1e3),
    plain("/sensors", "sensors"),
    fixed("/above_m", "above [m]", 2),
    plain("/direction", "push"),
    fixed("/always_n_s", "always [N s]", 2),
    fixed("/always_n_s_per_kg", "[N s/kg]", 3),
    fixed("/bound_always_n_s_per_kg", "pendulum [N s/kg]", 3),
    fixed("/median_n_s_per_kg", "median [N s/kg]", 3),
    fixed("/impulse_n_s", "at each instant [N s]", 2),
];

/// The study's arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct Push {
    /// Scene whose robot, gait and sensors they are, and with no other arguments its type, cycle and speed; default: walking
    /// in place and at 1 km/h.
    #[arg(long)]
    pub scene: Option<String>,
    /// Speeds [km/h] instead of the scene's; 0: on the spot.
    #[arg(long, value_delimiter = ',', value_parser = cases::number)]
    pub speeds: Vec<f64>,
    /// Standing, too; alone if no speeds are given.
    #[arg(long)]
    pub standing: bool,
    /// Simulation types instead of the scene's.
    #[arg(long, value_delimiter = ',', value_parser = clap::value_parser!(u8).range(1..=5))]
    pub types: Vec<u8>,
    /// Bus cycles (ms) instead of the scene's.
    #[arg(long, value_delimiter = ',', value_parser = cases::cycle)]
    pub cycles: Vec<f64>,
    /// Sensors instead of the scene's.
    #[arg(long, value_delimiter = ',', value_enum)]
    pub sensors: Vec<SensorChoice>,
    /// Height of the pushes above the torso's own centre of gravity (m).
    #[arg(long, value_delimiter = ',', default_values_t = [0.0], value_parser = cases::number)]
    pub height: Vec<f64>,
    /// How many instants of a stride are tried.
    #[arg(long, default_value_t = 16, value_parser = clap::value_parser!(u64).range(1..=1000))]
    pub instants: u64,
    /// Seed from which the instants are drawn.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Directory of the pictures; none are drawn without it.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// What is survived in one direction.
#[derive(Clone, Debug, Serialize)]
struct Row {
    walk: String,
    depth: u8,
    cycle_s: f64,
    sensors: String,
    /// \[m\] Above the torso's own centre of gravity.
    above_m: f64,
    direction: &'static str,
    /// \[1\] Shares of the stride of the instants.
    share: Vec<f64>,
    impulse_n_s: Vec<f64>,
    always_n_s: f64,
    always_n_s_per_kg: f64,
    /// \[N s/kg\] Bound of a pendulum at each instant, and the least one; none of a gait without steps that react.
    bound_n_s_per_kg: Vec<f64>,
    bound_always_n_s_per_kg: Option<f64>,
    median_n_s_per_kg: f64,
}

impl Study for Push {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        let mut sheet = Sheet::titled(format!(
            "Largest impulse survived: {DURATION} s at the torso, instants of one stride from seed {}",
            self.seed
        ));
        let (mut rows, mut pictures) = (Vec::new(), Vec::new());
        for (k, case) in cases::of(self, given.config)?.into_iter().enumerate() {
            let (mass, found) = case.pushes(self, given)?;
            sheet.fact("mass_kg", mass);
            pictures.push((format!("push_{k}.png"), picture::polar(&found, mass)));
            if found.iter().any(|row| row.bound_always_n_s_per_kg.is_some()) {
                pictures.push((format!("push_bound_{k}.png"), picture::beside_bound(&found, mass)));
            }
            rows.extend(found);
        }
        sheet.fact("push_duration_s", DURATION);
        sheet.rows("rows", COLUMNS, &rows);
        if let Some(out) = &self.out {
            for (name, figure) in pictures {
                sheet.draw(out, &name, &figure)?;
            }
        }
        Ok(sheet)
    }
}

impl Case {
    /// Mass \[kg\] of the robot that is believed, and what is survived by direction.
    fn pushes(&self, arguments: &Push, given: &Given<'_>) -> Result<(f64, Vec<Row>), Error> {
        let mass = self.setup.robot.total_mass;
        let starts = self.starts(arguments.instants as usize, arguments.seed)?;
        let instants = starts.len();
        // Every direction at every instant is a search of its own.
        let (searches, done) = (DIRECTIONS.len() * instants, AtomicUsize::new(0));
        let direction = |k: usize| {
            let (sin, cos) = (FRAC_PI_4 * k as f64).sin_cos();
            [cos, sin]
        };
        let impulses = parallel::map(searches, |k| {
            let found = largest_above(&starts[k % instants], direction(k / instants), self.above);
            (given.progress)(done.fetch_add(1, Ordering::Relaxed), searches, &self.walk);
            found
        });
        let impulses = impulses.into_iter().collect::<Result<Vec<f64>, _>>()?;
        let pendulums: Option<Vec<_>> = starts.iter().map(|start| Pendulum::of(&self.setup, start)).collect();
        let row = |(k, each): (usize, &[f64])| {
            let bounds = pendulums.iter().flatten().map(|pendulum| pendulum.bound(direction(k)));
            let bounds: Vec<f64> = bounds.collect();
            let mut sorted = each.to_vec();
            sorted.sort_by(f64::total_cmp);
            Row {
                walk: self.walk.clone(),
                depth: self.setup.scene.depth,
                cycle_s: self.setup.scene.cycle,
                sensors: self.sensors.clone(),
                above_m: self.above,
                direction: DIRECTIONS[k],
                share: starts.iter().map(|start| start.share).collect(),
                impulse_n_s: each.to_vec(),
                always_n_s: sorted[0],
                always_n_s_per_kg: sorted[0] / mass,
                bound_always_n_s_per_kg: bounds.iter().copied().reduce(f64::min),
                bound_n_s_per_kg: bounds,
                median_n_s_per_kg: 0.5 * (sorted[(instants - 1) / 2] + sorted[instants / 2]) / mass,
            }
        };
        Ok((mass, impulses.chunks(instants).enumerate().map(row).collect()))
    }
}
